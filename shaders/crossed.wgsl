// 16 invocations a chunk whose contours may be seen, one a row of quads: lists the facets whose vertices do not all face one
// way. A vertex with a value of 0 faces away.

@group(0) @binding(20) var<storage, read> turns: array<f32>;
@group(0) @binding(21) var<storage, read> turning: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_crossed: array<u32>;
@group(0) @binding(23) var<storage, read_write> out_tally: Tally;

// Of a row of vertices which face the eye, and which are there, as bits.
fn facing_row(first: u32) -> vec2<u32> {
    var bits = vec2<u32>(0u);
    for (var column = 0u; column < CHUNK_SIDE; column++) {
        let g = turns[first + column];
        bits |= select(vec2<u32>(0u), vec2<u32>(1u), vec2<bool>(g > 0.0, g < NO_HEIGHT)) << vec2<u32>(column);
    }
    return bits & vec2<u32>(bits.y, 0xffffffffu);
}

@compute @workgroup_size(16, 4)
fn crossed(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.seen || (turning[slot] & DRAWN) == 0u {
        return;
    }
    let first = invocation.y * CHUNK_VERTICES;
    let row = invocation.x;
    let north = facing_row(first + row * CHUNK_SIDE);
    let south = facing_row(first + (row + 1u) * CHUNK_SIDE);
    // Bit by bit the vertices of the quads of this row.
    let north_east = north >> vec2<u32>(1u);
    let south_east = south >> vec2<u32>(1u);
    let quads = (1u << CHUNK_QUADS) - 1u;
    let diagonal = north.x ^ south_east.x;
    let there = north.y & south_east.y & quads;
    let below = (diagonal | (north.x ^ south.x)) & there & south.y;
    let above = (diagonal | (north.x ^ north_east.x)) & there & north_east.y;
    var left = below | (above << CHUNK_QUADS);
    if left == 0u {
        return;
    }
    var n = atomicAdd(&out_tally.crossed, countOneBits(left));
    for (; left != 0u; left &= left - 1u) {
        let k = firstTrailingBit(left);
        if n < arrayLength(&out_crossed) {
            let quad = vec2<u32>(k % CHUNK_QUADS, row);
            out_crossed[n] = slot * CHUNK_FACETS + quad_local(quad) + k / CHUNK_QUADS;
        }
        n += 1u;
    }
}
