// One invocation a pixel: lists the pixels, and of each the neighbours, between which a walk could meet an away
// facet. The others are blank for certain: no block of facets between the two holds an away one.

struct Candidates {
    count: atomic<u32>,
    pixels: array<u32>,
}

@group(0) @binding(21) var<storage, read_write> out_candidates: Candidates;
@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

// Blocks of a chunk between two of its facets, as bits of its summary.
fn blocks_between(local_p: u32, local_q: u32) -> u32 {
    let p = local_p >> 7u;
    let q = local_q >> 7u;
    let low_x = min(p & 3u, q & 3u);
    let high_x = max(p & 3u, q & 3u);
    let low_y = min(p, q) >> 2u;
    let high_y = max(p, q) >> 2u;
    let row = ((2u << high_x) - 1u) & ~((1u << low_x) - 1u);
    let rows = ((16u << (4u * high_y)) - 1u) & ~((1u << (4u * low_y)) - 1u);
    return (row * 0x1111u) & rows;
}

// Whether no facet between two is away. Of facets in chunks that are no neighbours it does not know.
fn is_quiet(p: u32, q: u32) -> bool {
    let slot_p = p / CHUNK_FACETS;
    let slot_q = q / CHUNK_FACETS;
    if slot_p == slot_q {
        return (summaries[slot_p] & blocks_between(p % CHUNK_FACETS, q % CHUNK_FACETS)) == 0u;
    }
    let size = CHUNK_QUADS * scene.step;
    let chunk_p = chunks[slot_p].origin / size;
    let chunk_q = chunks[slot_q].origin / size;
    if any(max(chunk_p, chunk_q) - min(chunk_p, chunk_q) > vec2<u32>(1u)) {
        return false;
    }
    let beside = slots[chunk_p.y * scene.chunk_grid.x + chunk_q.x];
    let above = slots[chunk_q.y * scene.chunk_grid.x + chunk_p.x];
    var summary = summaries[slot_p] | summaries[slot_q];
    if beside != NO_SLOT {
        summary |= summaries[beside];
    }
    if above != NO_SLOT {
        summary |= summaries[above];
    }
    return (summary & 0xffffu) == 0u;
}

@compute @workgroup_size(64)
fn candidates(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = vec2<i32>(invocation.xy);
    if !on_page(at) {
        return;
    }
    let i = pixel_index(at);
    out_ink[i] = 0u;
    let p = pixels[i];
    if p.y == 0u {
        return;
    }
    var neighbours = 0u;
    for (var k = 0u; k < 8u; k++) {
        let to = at + neighbour(k);
        if !on_page(to) {
            continue;
        }
        let q = pixels[pixel_index(to)];
        // Equal depth: the lower ID is nearer.
        let farther = q.y < p.y || (q.y == p.y && q.x > p.x);
        if farther && (q.y == 0u || !is_quiet(p.x - 1u, q.x - 1u)) {
            neighbours |= 1u << k;
        }
    }
    if neighbours != 0u {
        out_candidates.pixels[atomicAdd(&out_candidates.count, 1u)] = i | (neighbours << 24u);
    }
}
