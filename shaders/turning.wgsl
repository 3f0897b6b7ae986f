// One invocation a chunk: notes for itself, and for every chunk that shares a vertex with it, whether it holds facets that
// face the eye, or face away; and which chunks these are. Contours run only through chunks for which both are noted.

@group(0) @binding(20) var<storage, read_write> out_turning: array<atomic<u32>>;
@group(0) @binding(21) var<storage, read_write> out_around: array<u32>;

// What a chunk holds. Beside the page's map projection nobody has looked: there it may be both.
fn holds(slot: u32) -> u32 {
    if !in_frustum(bounds_of(slot)) {
        return BOTH;
    }
    if (summaries[slot] & 0xffffu) == 0u {
        return HOLDS_TOWARD;
    }
    var any_away = 0u;
    var all_away = 0xffffffffu;
    for (var word = 0u; word < CHUNK_WORDS; word++) {
        let bits = away_bits(slot * CHUNK_FACETS + word * 32u);
        any_away |= bits;
        all_away &= bits;
    }
    return select(0u, HOLDS_TOWARD, all_away != 0xffffffffu) | select(0u, HOLDS_AWAY, any_away != 0u);
}

@compute @workgroup_size(64)
fn turning(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if slot >= camera.chunks {
        return;
    }
    let chunk = chunks[slot];
    let held = holds(slot);
    atomicOr(&out_turning[slot], held);
    // Neighbours differ by one level at most: two along each side, one at each corner.
    let side = i32(CHUNK_QUADS * chunk.step);
    for (var k = 0u; k < AROUND; k++) {
        let at = vec2<i32>(i32(k & 3u), i32(k >> 2u));
        if any(at == vec2<i32>(0)) || any(at == vec2<i32>(3)) {
            let from_origin = select((at - 1) * (side / 2), vec2<i32>(-1), at == vec2<i32>(0));
            let beside = slot_at(vec2<i32>(chunk.origin) + from_origin);
            out_around[slot * AROUND + k] = beside;
            if beside != NO_SLOT {
                atomicOr(&out_turning[beside], held);
            }
        }
    }
}
