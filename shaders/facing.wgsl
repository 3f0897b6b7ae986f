// One invocation 32 facets: decides toward or away once for every method, and notes which squares of 4 x 4 quads hold an away
// facet (low half of a chunk's summary) or lack a facet (high half).

@group(0) @binding(20) var<storage, read_write> out_facing: array<u32>;
@group(0) @binding(21) var<storage, read_write> out_summaries: array<atomic<u32>>;

// Whether the plane through the facet's lowest vertex faces the eye; zero is away.
fn faces_eye(lowest: vec3<f32>, edge_1: vec3<f32>, edge_2: vec3<f32>) -> bool {
    return dot(cross(edge_1, edge_2), lowest) < 0.0;
}

// Which halves of a quad lack a vertex, as two bits.
fn lacking_halves(nw: Vertex, ne: Vertex, sw: Vertex, se: Vertex) -> u32 {
    let lacks = lacking(nw, ne, sw, se);
    return select(0u, 1u, lacks.x) | select(0u, 2u, lacks.y);
}

// Which halves of a quad are facets and face away, as two bits: beside a coarser chunk some have collapsed.
fn away_halves(nw: Vertex, ne: Vertex, sw: Vertex, se: Vertex) -> u32 {
    let lowest = eye_relative(nw.at / CELL_STEPS, nw.place);
    let to_se = edge_of(nw, se);
    let no_diagonal = all(nw.at == se.at);
    let away_0 = !(faces_eye(lowest, edge_of(nw, sw), to_se) || no_diagonal || all(nw.at == sw.at) || all(sw.at == se.at));
    let away_1 = !(faces_eye(lowest, to_se, edge_of(nw, ne)) || no_diagonal || all(nw.at == ne.at) || all(ne.at == se.at));
    return select(0u, 1u, away_0) | select(0u, 2u, away_1);
}

@compute @workgroup_size(16, 4)
fn facing(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.chunks || !in_frustum(bounds_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    var quad = local_quad(invocation.x * 32u);
    var v = vertex_index(chunk, quad);
    var bits = 0u;
    var missing = vec2<bool>(false);
    // Two columns of eight quads, row by row: each vertex is read once.
    let one = vec2<u32>(1u, 0u);
    var north_west = vertex_of(chunk, quad, v);
    var north = vertex_of(chunk, quad + one, v + 1u);
    var north_east = vertex_of(chunk, quad + one + one, v + 2u);
    for (var k = 0u; k < 16u; k += 2u) {
        v += CHUNK_SIDE;
        quad.y += 1u;
        let south_west = vertex_of(chunk, quad, v);
        let south = vertex_of(chunk, quad + one, v + 1u);
        let south_east = vertex_of(chunk, quad + one + one, v + 2u);
        let lacks_west = lacking_halves(north_west, north, south_west, south);
        let lacks_east = lacking_halves(north, north_east, south, south_east);
        let southern = k >= 8u;
        missing |= select(vec2<bool>(false), vec2<bool>(!southern, southern), (lacks_west | lacks_east) != 0u);
        bits |= (away_halves(north_west, north, south_west, south) & ~lacks_west) << k;
        bits |= (away_halves(north, north_east, south, south_east) & ~lacks_east) << (k + 16u);
        north_west = south_west;
        north = south;
        north_east = south_east;
    }
    out_facing[(batch.part_slot + invocation.y) * CHUNK_WORDS + invocation.x] = bits;
    // The northern four rows of quads, and the southern four.
    let away = vec2<bool>((bits & 0x00ff00ffu) != 0u, (bits & 0xff00ff00u) != 0u);
    let squares = vec2<u32>(1u, 16u) << vec2<u32>(square_of(local_quad(invocation.x * 32u)));
    let noted = select(vec2<u32>(0u), squares, away) | select(vec2<u32>(0u), squares << vec2<u32>(16u), missing);
    let summary = noted.x | noted.y;
    if summary != 0u {
        atomicOr(&out_summaries[slot], summary);
    }
}
