// One invocation 32 facets: decides toward or away once for every method, and notes which 8 x 8 blocks hold an away
// facet (low half of a chunk's summary) or lack a facet (high half).

@group(0) @binding(20) var<storage, read_write> out_facing: array<u32>;
@group(0) @binding(21) var<storage, read_write> out_summaries: array<atomic<u32>>;

// Whether the plane through the facet's lowest vertex faces the eye; zero is away.
fn faces_eye(lowest: vec3<f32>, edge_1: vec3<f32>, edge_2: vec3<f32>) -> bool {
    return dot(cross(edge_1, edge_2), lowest) < 0.0;
}

// Which halves of the quad north-west of vertex `v` lack a vertex, as two bits.
fn lacking(v: u32) -> u32 {
    let nw_se = screens[v].w | screens[v + CHUNK_SIDE + 1u].w;
    let sw = screens[v + CHUNK_SIDE].w;
    let ne = screens[v + 1u].w;
    return select(0u, 1u, ((nw_se | sw) & MISSING) != 0) | select(0u, 2u, ((nw_se | ne) & MISSING) != 0);
}

// Which halves of a quad face away, as two bits. `at` is the lattice place of its north-west vertex.
fn away_halves(at: vec2<u32>, step: u32, nw: vec4<f32>, ne: vec4<f32>, sw: vec4<f32>, se: vec4<f32>) -> u32 {
    let east = vec2<u32>(step, 0u);
    let south = vec2<u32>(0u, step);
    let lowest = eye_relative(at / CELL_STEPS, nw);
    let to_se = edge_between(at, nw, at + east + south, se);
    let away_0 = !faces_eye(lowest, edge_between(at, nw, at + south, sw), to_se);
    let away_1 = !faces_eye(lowest, to_se, edge_between(at, nw, at + east, ne));
    return select(0u, 1u, away_0) | select(0u, 2u, away_1);
}

@compute @workgroup_size(64)
fn facing(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let slot = batch.first_slot + group.y;
    if !in_wedge(sphere_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    let ragged = has_voids
        || any(chunk.origin + CHUNK_QUADS * chunk.step > (scene.samples - 1u) * CELL_STEPS);
    let quad = local_quad(invocation.x * 32u);
    var v = group.y * CHUNK_VERTICES + quad.y * CHUNK_SIDE + quad.x;
    var at = chunk.origin + quad * chunk.step;
    var bits = 0u;
    var missing = 0u;
    // Two columns of eight quads, row by row: each vertex is read once.
    var north = array<vec4<f32>, 3>(places[v], places[v + 1u], places[v + 2u]);
    for (var k = 0u; k < 16u; k += 2u) {
        var lacks = vec2<u32>(0u);
        if ragged {
            lacks = vec2<u32>(lacking(v), lacking(v + 1u));
            missing |= lacks.x | lacks.y;
        }
        v += CHUNK_SIDE;
        let south = array<vec4<f32>, 3>(places[v], places[v + 1u], places[v + 2u]);
        let east = at + vec2<u32>(chunk.step, 0u);
        bits |= (away_halves(at, chunk.step, north[0], north[1], south[0], south[1]) & ~lacks.x) << k;
        bits |= (away_halves(east, chunk.step, north[1], north[2], south[1], south[2]) & ~lacks.y) << (k + 16u);
        north = south;
        at.y += chunk.step;
    }
    out_facing[(batch.part_slot + group.y) * CHUNK_WORDS + invocation.x] = bits;
    let block = invocation.x >> 2u;
    let summary = select(0u, 1u << block, bits != 0u) | (select(0u, 1u, missing != 0u) << (block + 16u));
    if summary != 0u {
        atomicOr(&out_summaries[slot], summary);
    }
}
