// 64 invocations a chunk whose contours may be seen, one a vertex of its side: adds what all chunks that meet there have for it,
// in the order of the lattice. Each of them does the same sum of the same numbers and has the same bits.

@group(0) @binding(20) var<storage, read_write> out_turns: array<f32>;
@group(0) @binding(21) var<storage, read> turning: array<u32>;
@group(0) @binding(22) var<storage, read> around: array<u32>;
@group(0) @binding(23) var<storage, read> sides: array<f32>;

// The value that a chunk has for a vertex of its side.
fn value_in(slot: u32, at: vec2<u32>) -> f32 {
    let number = around[slot * AROUND + SIDES_AT] * SIDE_VERTICES + side_number(at);
    return select(NO_HEIGHT, sides[min(number, arrayLength(&sides) - 1u)], number < arrayLength(&sides));
}

// What the facets of a chunk add to a vertex: beside a coarser chunk those of the next vertex too, which has become this one.
fn share_of(slot: u32, at: vec2<u32>) -> f32 {
    let chunk = chunks[slot];
    let place = (at - chunk.origin) / chunk.step;
    var share = value_in(slot, place);
    let east = vec2<u32>(1u, 0u);
    let south = vec2<u32>(0u, 1u);
    if place.x < CHUNK_QUADS && any(shared_vertex(chunk.coarser, place + east) != place + east) {
        share += value_in(slot, place + east);
    }
    if place.y < CHUNK_QUADS && any(shared_vertex(chunk.coarser, place + south) != place + south) {
        share += value_in(slot, place + south);
    }
    return share;
}

@compute @workgroup_size(64)
fn meet(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.seen || (turning[slot] & DRAWN) == 0u {
        return;
    }
    let chunk = chunks[slot];
    let column_row = side_vertex(invocation.x);
    let shared_at = shared_vertex(chunk.coarser, column_row);
    let at = chunk.origin + shared_at * chunk.step;
    var g = 0.0;
    var done = vec4<u32>(NO_SLOT);
    for (var quadrant = 0u; quadrant < 4u; quadrant++) {
        let quad = vec2<i32>(shared_at + vec2<u32>(quadrant & 1u, quadrant >> 1u)) - 1;
        let outside = any(quad < vec2<i32>(0)) || any(quad >= vec2<i32>(i32(CHUNK_QUADS)));
        var there = slot;
        if outside {
            there = around[slot * AROUND + around_at(quad)];
        }
        if there != NO_SLOT && all(done != vec4<u32>(there)) {
            g += share_of(there, at);
        }
        done[quadrant] = there;
    }
    let number = invocation.y * CHUNK_VERTICES + column_row.y * CHUNK_SIDE + column_row.x;
    out_turns[number] = select(g, NO_HEIGHT, out_turns[number] >= NO_HEIGHT);
}
