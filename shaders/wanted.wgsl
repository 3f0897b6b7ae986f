// One invocation a chunk: where a contour may run through it and it may appear, notes that the values of its vertices are wanted,
// and those of all chunks that share one; and finds room for the values of their sides.

@group(0) @binding(20) var<storage, read_write> out_turning: array<atomic<u32>>;
@group(0) @binding(21) var<storage, read_write> out_around: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_tally: Tally;

fn want(slot: u32) {
    if (atomicOr(&out_turning[slot], WANTED) & WANTED) == 0u {
        out_around[slot * AROUND + SIDES_AT] = atomicAdd(&out_tally.wanted, 1u);
    }
}

@compute @workgroup_size(64)
fn wanted(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if slot >= camera.seen || (atomicLoad(&out_turning[slot]) & BOTH) != BOTH || !in_view(bounds_of(slot)) {
        return;
    }
    want(slot);
    for (var k = 0u; k < AROUND; k++) {
        let at = vec2<u32>(k & 3u, k >> 2u);
        if any(at == vec2<u32>(0u)) || any(at == vec2<u32>(3u)) {
            let beside = out_around[slot * AROUND + k];
            if beside != NO_SLOT {
                want(beside);
            }
        }
    }
}
