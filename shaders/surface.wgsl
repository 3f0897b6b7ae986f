// The PN surface (Vlachos et al. 2001) and its projection. The twin in f64 is `surface::patch`.

// Three corners of a patch: NW, SE and the third (SW below the diagonal, NE above), as edges from NW, and their
// normals up to length.
struct Patch {
    height: f32,
    to_se: vec3<f32>,
    to_third: vec3<f32>,
    normal_nw: vec3<f32>,
    normal_se: vec3<f32>,
    normal_third: vec3<f32>,
}

fn normal_at(i: u32) -> vec3<f32> {
    return vec3<f32>(-gradients[i], 1.0);
}

// The patch of cell `at` above or below the diagonal. Corners outside the grid are clamped: they have weight 0.
fn patch_of(at: vec2<u32>, above: bool) -> Patch {
    let low = min(at, scene.samples - 1u);
    let high = min(at + 1u, scene.samples - 1u);
    let columns = scene.samples.x;
    let nw = low.y * columns + low.x;
    let se = high.y * columns + high.x;
    let third = select(high.y * columns + low.x, low.y * columns + high.x, above);
    let south = vec2<f32>(0.0, -scene.cell.y);
    let east = vec2<f32>(scene.cell.x, 0.0);
    let height = heights[nw];
    return Patch(
        height,
        vec3<f32>(east + south, heights[se] - height),
        vec3<f32>(select(south, east, above), heights[third] - height),
        normal_at(nw),
        normal_at(se),
        normal_at(third),
    );
}

// A third of what of an edge lies in the tangent plane with that normal; `scale` is 1 / its squared length.
fn tangent(edge: vec3<f32>, normal: vec3<f32>, scale: f32) -> vec3<f32> {
    return (edge - normal * (dot(edge, normal) * scale)) * (1.0 / 3.0);
}

// Offset in metres from the NW sample to the point at (u, v) of the cell, u east, v south, 0 to 1.
fn patch_point(p: Patch, at: vec2<f32>) -> vec3<f32> {
    let a = 1.0 - max(at.x, at.y);
    let b = min(at.x, at.y);
    let c = abs(at.x - at.y);
    let across = p.to_third - p.to_se;
    let nw = 1.0 / dot(p.normal_nw, p.normal_nw);
    let se = 1.0 / dot(p.normal_se, p.normal_se);
    let third = 1.0 / dot(p.normal_third, p.normal_third);
    let ab = tangent(p.to_se, p.normal_nw, nw);
    let ba = p.to_se - tangent(p.to_se, p.normal_se, se);
    let ac = tangent(p.to_third, p.normal_nw, nw);
    let ca = p.to_third - tangent(p.to_third, p.normal_third, third);
    let bc = p.to_se + tangent(across, p.normal_se, se);
    let cb = p.to_third - tangent(across, p.normal_third, third);
    let centre = (ab + ba + ac + ca + bc + cb) * 0.25 - (p.to_se + p.to_third) * (1.0 / 6.0);
    let a3 = 3.0 * a;
    let b3 = 3.0 * b;
    let c3 = 3.0 * c;
    return p.to_se * (b * b * b) + p.to_third * (c * c * c)
        + ab * (a3 * a * b) + ba * (b3 * b * a) + ac * (a3 * a * c) + ca * (c3 * c * a)
        + bc * (b3 * b * c) + cb * (c3 * c * b) + centre * (2.0 * a3 * b * c);
}

// A lattice vertex: offset from its own sample (NW of its cell) in xyz, that sample's height in w, metres.
// The one function that evaluates shared vertices, so that neighbours agree to the bit.
fn vertex_place(at: vec2<u32>) -> vec4<f32> {
    let sub = at % CELL_STEPS;
    let p = patch_of(at / CELL_STEPS, sub.x > sub.y);
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

// Pixels from the centre beyond which facets are clipped: with pages up to 16 384 px coordinates stay within 2^15.
const GUARD: f32 = 24576.0;

// Page place in 1/256 px of a point in camera space, within the guard band and in front of the near plane.
fn snapped(q: vec3<f32>) -> vec2<i32> {
    let px = vec2<f32>(q.x, -q.y) * (camera.focal / q.z) + camera.centre;
    return vec2<i32>(round(px * 256.0));
}

fn depth_of(q: vec3<f32>) -> f32 {
    return scene.near / q.z;
}

// Metres along the ray through a page place for each metre along the view axis.
fn ray_through(px: vec2<f32>) -> vec3<f32> {
    let d = (px - camera.centre) / camera.focal;
    return camera.forward.xyz + camera.right.xyz * d.x - camera.up.xyz * d.y;
}
