// One invocation 32 facets: decides toward or away once for every method, and notes which 8 x 8 blocks hold an away
// facet (low half of a chunk's summary) or lack a facet (high half).

@group(0) @binding(20) var<storage, read_write> out_facing: array<u32>;
@group(0) @binding(21) var<storage, read_write> out_summaries: array<atomic<u32>>;

// Whether the plane through the facet's lowest vertex faces the eye; zero is away.
fn faces_eye(lowest: vec3<f32>, edge_1: vec3<f32>, edge_2: vec3<f32>) -> bool {
    return dot(cross(edge_1, edge_2), lowest) < 0.0;
}

@compute @workgroup_size(64)
fn facing(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let slot = batch.first_slot + group.y;
    if !in_wedge(sphere_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    let local = invocation.x * 32u;
    let base = group.y * CHUNK_VERTICES;
    var bits = 0u;
    var missing = 0u;
    for (var k = 0u; k < 32u; k += 2u) {
        let quad = local_quad(local + k);
        let v = base + quad.y * CHUNK_SIDE + quad.x;
        let nw = places[v];
        let ne = places[v + 1u];
        let sw = places[v + CHUNK_SIDE];
        let se = places[v + CHUNK_SIDE + 1u];
        let at = chunk.origin + quad * chunk.step;
        let east = vec2<u32>(chunk.step, 0u);
        let south = vec2<u32>(0u, chunk.step);
        let lowest = eye_relative(at / CELL_STEPS, nw);
        let to_se = edge_between(at, nw, at + east + south, se);
        let to_sw = edge_between(at, nw, at + south, sw);
        let to_ne = edge_between(at, nw, at + east, ne);
        let shared_flags = screens[v].w | screens[v + CHUNK_SIDE + 1u].w;
        let lacks_0 = ((shared_flags | screens[v + CHUNK_SIDE].w) & MISSING) != 0;
        let lacks_1 = ((shared_flags | screens[v + 1u].w) & MISSING) != 0;
        let away_0 = !lacks_0 && !faces_eye(lowest, to_sw, to_se);
        let away_1 = !lacks_1 && !faces_eye(lowest, to_se, to_ne);
        bits |= (select(0u, 1u, away_0) | select(0u, 2u, away_1)) << k;
        missing |= select(0u, 1u, lacks_0 || lacks_1);
    }
    out_facing[(batch.part_slot + group.y) * CHUNK_WORDS + invocation.x] = bits;
    let block = invocation.x >> 2u;
    let summary = select(0u, 1u << block, bits != 0u) | (missing << (block + 16u));
    if summary != 0u {
        atomicOr(&out_summaries[slot], summary);
    }
}
