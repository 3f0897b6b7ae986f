// 32 invocations a chunk through which a contour may run, vertex after vertex: g = n . (eye - p), where n is the sum of the
// normals of all facets around the vertex, as long as twice their areas (Hertzmann, Zorin 2000). Above 0 the surface faces the
// eye. On a side the facets of all chunks that meet there count, in the order of the lattice: every one of these chunks
// does the same sum, and has the same bits.

@group(0) @binding(20) var<storage, read_write> out_turns: array<f32>;
@group(0) @binding(21) var<storage, read> turning: array<u32>;

// Vertices inside a chunk, along its side and in all.
const INNER_SIDE: u32 = 15u;
const INNER_VERTICES: u32 = 225u;

// A vertex of a chunk, or that there is none.
fn place_or_none(chunk: Chunk, at: vec2<u32>) -> vec4<f32> {
    if is_missing(at) {
        return vec4<f32>(0.0, 0.0, 0.0, NO_HEIGHT);
    }
    return place_in(chunk, at);
}

// The normal of a facet, as long as twice its area; 0 of one that does not exist or has collapsed.
fn normal_of_facet(chunk: Chunk, f: Facet) -> vec3<f32> {
    let a = place_or_none(chunk, f.a);
    let b = place_or_none(chunk, f.b);
    let c = place_or_none(chunk, f.c);
    let normal = cross(edge_between(f.a, a, f.b, b), edge_between(f.a, a, f.c, c));
    return select(normal, vec3<f32>(0.0), max(a.w, max(b.w, c.w)) >= NO_HEIGHT);
}

// Whether a vertex of a chunk lies on a side that it shares with a coarser one: there others have become it.
fn on_coarser_side(coarser: u32, at: vec2<u32>) -> bool {
    return (at.y == 0u && (coarser & NORTH) != 0u) || (at.x == CHUNK_QUADS && (coarser & EAST) != 0u)
        || (at.y == CHUNK_QUADS && (coarser & SOUTH) != 0u) || (at.x == 0u && (coarser & WEST) != 0u);
}

// Whether facets of a chunk have a vertex: by number, of its 3 x 3 quads about there those of which it may be one.
fn quad_near(at: vec2<u32>, k: u32) -> vec2<i32> {
    return vec2<i32>(at) + vec2<i32>(i32(k % 3u), i32(k / 3u)) - 1;
}

fn has_vertex(f: Facet, at: vec2<u32>) -> bool {
    return all(f.a == at) || all(f.b == at) || all(f.c == at);
}

// The sum of the normals around a vertex of the lattice that lies on a side of chunks: quadrant after quadrant.
fn normal_between(at: vec2<u32>) -> vec3<f32> {
    var normal = vec3<f32>(0.0);
    var slots = vec4<u32>(NO_SLOT);
    for (var quadrant = 0u; quadrant < 4u; quadrant++) {
        let beyond = vec2<u32>(quadrant & 1u, quadrant >> 1u);
        let slot = slot_at(vec2<i32>(at + beyond) - 1);
        let again = any(slots == vec4<u32>(slot));
        slots[quadrant] = slot;
        if slot == NO_SLOT {
            continue;
        }
        let chunk = chunks[slot];
        let place = (at - chunk.origin) / chunk.step;
        let gathers = on_coarser_side(chunk.coarser, place);
        // Of the quadrant's quad the halves that have the vertex: of the north-western and the south-eastern one both.
        var quad = vec2<i32>(place + beyond) - 1;
        for (var k = 0u; k < select(2u, 18u, gathers); k++) {
            let half = k & 1u;
            if gathers {
                quad = quad_near(place, k >> 1u);
            }
            if any(quad < vec2<i32>(0)) || any(quad >= vec2<i32>(i32(CHUNK_QUADS))) {
                continue;
            }
            let f = chunk_facet(chunk, vec2<u32>(quad), half);
            if has_vertex(f, at) && !(gathers && again) {
                normal += normal_of_facet(chunk, f);
            }
        }
    }
    return normal;
}

// The cross product of two edges, where there are both.
fn sector(p: vec4<f32>, q: vec4<f32>) -> vec3<f32> {
    return select(cross(p.xyz, q.xyz), vec3<f32>(0.0), max(p.w, q.w) >= NO_HEIGHT);
}

// The way from a vertex inside a chunk to the one so many columns and rows on; its height in w.
fn way(chunk: Chunk, column_row: vec2<u32>, place: vec4<f32>, east: i32, south: i32) -> vec4<f32> {
    let to_column_row = vec2<u32>(vec2<i32>(column_row) + vec2<i32>(east, south));
    let to_at = chunk.origin + shared_vertex(chunk.coarser, to_column_row) * chunk.step;
    let to_place = place_or_none(chunk, to_at);
    return vec4<f32>(edge_between(chunk.origin + column_row * chunk.step, place, to_at, to_place), to_place.w);
}

// The sum of the normals around a vertex inside a chunk: of the six facets, counter-clockwise from above.
fn normal_inside(chunk: Chunk, column_row: vec2<u32>, place: vec4<f32>) -> vec3<f32> {
    let east = way(chunk, column_row, place, 1, 0);
    let north = way(chunk, column_row, place, 0, -1);
    let north_west = way(chunk, column_row, place, -1, -1);
    let west = way(chunk, column_row, place, -1, 0);
    let south = way(chunk, column_row, place, 0, 1);
    let south_east = way(chunk, column_row, place, 1, 1);
    return sector(east, north) + sector(north, north_west) + sector(north_west, west) + sector(west, south)
        + sector(south, south_east) + sector(south_east, east);
}

// Column and row of a vertex of a chunk by its number: those inside come first, then those of the sides.
fn numbered(v: u32) -> vec2<u32> {
    if v < INNER_VERTICES {
        return vec2<u32>(v % INNER_SIDE, v / INNER_SIDE) + 1u;
    }
    let along = (v - INNER_VERTICES) % CHUNK_QUADS;
    let side = (v - INNER_VERTICES) / CHUNK_QUADS;
    // Clockwise, each side without its last corner.
    let ahead = select(along, CHUNK_QUADS - along, side >= 2u);
    let across = select(0u, CHUNK_QUADS, side == 1u || side == 2u);
    return select(vec2<u32>(ahead, across), vec2<u32>(across, ahead), (side & 1u) == 1u);
}

@compute @workgroup_size(32, 2)
fn turn(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.seen || turning[slot] != BOTH || !in_view(bounds_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    for (var v = invocation.x; v < CHUNK_VERTICES; v += 32u) {
        let column_row = numbered(v);
        let at = chunk.origin + shared_vertex(chunk.coarser, column_row) * chunk.step;
        let place = place_or_none(chunk, at);
        var normal = vec3<f32>(0.0);
        if v < INNER_VERTICES {
            normal = normal_inside(chunk, column_row, place);
        } else {
            normal = normal_between(at);
        }
        let g = -dot(normal, eye_relative(at / CELL_STEPS, place));
        let number = invocation.y * CHUNK_VERTICES + column_row.y * CHUNK_SIDE + column_row.x;
        out_turns[number] = select(g, NO_HEIGHT, place.w >= NO_HEIGHT);
    }
}
