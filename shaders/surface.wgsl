// The PN surface (Vlachos et al. 2001) and its projection. The twin in f64 is `surface::patch`.

// A cubic patch over the corners NW (the origin), SE and the third (SW below the diagonal, NE above it), with its
// control points: `ab` lies a third of the way from NW to SE, `ba` two thirds, and so on with c for the third corner.
struct Patch {
    height: f32,
    b: vec3<f32>,
    c: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    ac: vec3<f32>,
    ca: vec3<f32>,
    bc: vec3<f32>,
    cb: vec3<f32>,
    centre: vec3<f32>,
}

// A sample: metres, and dz/d east and north.
struct Sample {
    height: f32,
    gradient: vec2<f32>,
}

fn normal_of(sample: Sample) -> vec3<f32> {
    return vec3<f32>(-sample.gradient, 1.0);
}

// A third of what of an edge lies in the tangent plane with that normal; `scale` is 1 / its squared length.
fn tangent(edge: vec3<f32>, normal: vec3<f32>, scale: f32) -> vec3<f32> {
    return (edge - normal * (dot(edge, normal) * scale)) * (1.0 / 3.0);
}

// Samples along a tile's edge.
const TILE_SIDE: u32 = 17u;
const TILE_SAMPLES: u32 = 289u;

// Index of the sample at column and row `at` of a tile.
fn tile_sample(tile: u32, at: vec2<u32>) -> u32 {
    return tile * TILE_SAMPLES + at.y * TILE_SIDE + at.x;
}

// Column and row within its tile of the sample north-west of a lattice place in or beside a chunk.
fn tile_place(chunk: Chunk, at: vec2<u32>) -> vec2<u32> {
    if chunk.step > CELL_STEPS {
        return (at - chunk.origin) / chunk.step;
    }
    // A tile is as wide as a chunk of level 1.
    return (at - chunk.origin / (CHUNK_QUADS * CELL_STEPS) * (CHUNK_QUADS * CELL_STEPS)) / CELL_STEPS;
}

// The sample at column and row `at` of a tile; beyond it the last one.
fn sample_of(tile: u32, at: vec2<u32>) -> Sample {
    let i = tile_sample(tile, min(at, vec2<u32>(TILE_SIDE - 1u)));
    return Sample(heights[i], vec2<f32>(gradients_east[i], gradients_north[i]));
}

// The patch above or below the diagonal of the cell at a column and row of a tile. Corners outside the tile have weight 0.
fn patch_of(tile: u32, low: vec2<u32>, above: bool) -> Patch {
    let third = low + select(vec2<u32>(0u, 1u), vec2<u32>(1u, 0u), above);
    return patch_over(sample_of(tile, low), sample_of(tile, low + 1u), sample_of(tile, third), above);
}

// The patch over three corners of a cell: north-west, south-east, and north-east (above the diagonal) or south-west.
fn patch_over(nw: Sample, se: Sample, third: Sample, above: bool) -> Patch {
    let south = vec2<f32>(0.0, -scene.cell.y);
    let east = vec2<f32>(scene.cell.x, 0.0);
    let b = vec3<f32>(east + south, se.height - nw.height);
    let c = vec3<f32>(select(south, east, above), third.height - nw.height);
    let normal_a = normal_of(nw);
    let normal_b = normal_of(se);
    let normal_c = normal_of(third);
    let scale_a = 1.0 / dot(normal_a, normal_a);
    let scale_b = 1.0 / dot(normal_b, normal_b);
    let scale_c = 1.0 / dot(normal_c, normal_c);
    let ab = tangent(b, normal_a, scale_a);
    let ba = b - tangent(b, normal_b, scale_b);
    let ac = tangent(c, normal_a, scale_a);
    let ca = c - tangent(c, normal_c, scale_c);
    let bc = b + tangent(c - b, normal_b, scale_b);
    let cb = c - tangent(c - b, normal_c, scale_c);
    let centre = (ab + ba + ac + ca + bc + cb) * 0.25 - (b + c) * (1.0 / 6.0);
    return Patch(nw.height, b, c, ab, ba, ac, ca, bc, cb, centre);
}

// Offset in metres from the NW sample to the point at (u, v) of the cell, u east, v south, 0 to 1.
fn patch_point(p: Patch, at: vec2<f32>) -> vec3<f32> {
    let a = 1.0 - max(at.x, at.y);
    let b = min(at.x, at.y);
    let c = abs(at.x - at.y);
    let a3 = 3.0 * a;
    let b3 = 3.0 * b;
    let c3 = 3.0 * c;
    return p.b * (b * b * b) + p.c * (c * c * c)
        + p.ab * (a3 * a * b) + p.ba * (b3 * b * a) + p.ac * (a3 * a * c) + p.ca * (c3 * c * a)
        + p.bc * (b3 * b * c) + p.cb * (c3 * c * b) + p.centre * (2.0 * a3 * b * c);
}

// A lattice vertex of a chunk: offset from its own sample (NW of its cell) in xyz, that sample's height in w, metres.
fn vertex_place(chunk: Chunk, at: vec2<u32>) -> vec4<f32> {
    let place = tile_place(chunk, at);
    let sub = at % CELL_STEPS;
    if all(sub == vec2<u32>(0u)) {
        return vec4<f32>(0.0, 0.0, 0.0, heights[tile_sample(chunk.tile, place)]);
    }
    let p = patch_of(chunk.tile, place, sub.x > sub.y);
    return vec4<f32>(patch_point(p, vec2<f32>(sub) / f32(CELL_STEPS)), p.height);
}

// Eye-relative position in metres of a place that hangs on sample `at`.
fn eye_relative(at: vec2<u32>, place: vec4<f32>) -> vec3<f32> {
    let from_eye = vec2<f32>(vec2<i32>(at) - camera.eye_cell) * scene.cell * vec2<f32>(1.0, -1.0);
    let height = (place.w - camera.eye_height.x) - camera.eye_height.y;
    return vec3<f32>(from_eye + (place.xy - camera.eye_offset), height + place.z);
}

// Edge in metres between two lattice vertices: an integer difference, a height difference, an offset difference.
fn edge_between(from_at: vec2<u32>, from_place: vec4<f32>, to_at: vec2<u32>, to_place: vec4<f32>) -> vec3<f32> {
    let cells = vec2<f32>(vec2<i32>(to_at / CELL_STEPS) - vec2<i32>(from_at / CELL_STEPS));
    let along = cells * scene.cell * vec2<f32>(1.0, -1.0);
    return vec3<f32>(along, to_place.w - from_place.w) + (to_place.xyz - from_place.xyz);
}

// Right, up and forward of an eye-relative position, metres.
fn camera_space(p: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(p, camera.right.xyz), dot(p, camera.up.xyz), dot(p, camera.forward.xyz));
}

// Pixels from the page's centre beyond which facets are clipped: more than half the largest page, and no facet within
// is so large that an edge function changes by 2^30 over a tile of 32 px.
const GUARD: f32 = 33280.0;

// Page place of a point in camera space, px.
fn on_paper(q: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(q.x, -q.y) * (camera.focal / q.z) + camera.centre;
}

// Place in 1/256 px of a point in camera space, within the guard band and in front of the near plane. It is snapped on
// the page and then moved to what is drawn of it, so that it is the same in every piece.
fn snapped(q: vec3<f32>) -> vec2<i32> {
    return vec2<i32>(round(on_paper(q) * 256.0)) - camera.origin * 256;
}

fn depth_of(q: vec3<f32>) -> f32 {
    return scene.near / q.z;
}

// Metres along the ray through a page place for each metre along the view axis.
fn ray_through(px: vec2<f32>) -> vec3<f32> {
    let d = (px - camera.centre) / camera.focal;
    return camera.forward.xyz + camera.right.xyz * d.x - camera.up.xyz * d.y;
}
