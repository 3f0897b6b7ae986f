// Pairs of facets between which no facet is away, told from the summaries of their chunks.

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

// Whether no away facet can lie between two facets. Of facets in chunks that are no neighbours it does not know.
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
