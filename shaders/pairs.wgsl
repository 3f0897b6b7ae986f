// One invocation a candidate pixel: keeps its pairs with sky, and those with an away facet in the rectangle of quads
// that a walk between the two cannot leave. Few remain, and the walk finds them side by side.

@group(0) @binding(21) var<storage, read> candidates: ListRead;
@group(0) @binding(22) var<storage, read_write> out_pairs: List;

// Beside a coarser chunk a facet may reach into the quad before it: 1 where quads must be taken by twos.
fn by_twos(chunk: Chunk) -> vec2<u32> {
    return select(vec2<u32>(0u), vec2<u32>(1u), chunk.coarser != 0u);
}

// What of the lattice a facet lies in: corners of a rectangle.
fn rectangle_of(chunk: Chunk, local: u32) -> vec4<u32> {
    let quad = local_quad(local);
    let twos = by_twos(chunk);
    return vec4<u32>(chunk.origin + (quad & ~twos) * chunk.step, chunk.origin + ((quad | twos) + 1u) * chunk.step);
}

// Whether an away facet lies within one block between two quads of it, given within the block.
fn block_has_away(first_facet: u32, low: vec2<u32>, high: vec2<u32>) -> bool {
    let rows = (1u << (2u * (high.y + 1u))) - (1u << (2u * low.y));
    for (var column = low.x; column <= high.x; column++) {
        if (away_bits(first_facet + column * 16u) & rows) != 0u {
            return true;
        }
    }
    return false;
}

// Whether an away facet lies between two quads of a chunk.
fn chunk_has_away(slot: u32, first: vec2<u32>, last: vec2<u32>) -> bool {
    let summary = summaries[slot];
    let eight = vec2<u32>(3u);
    for (var block = first >> eight; block.y <= (last.y >> 3u); ) {
        // Four squares of the summary.
        if (summary & (0x33u << (block.y * 8u + block.x * 2u))) != 0u {
            let corner_quad = block << eight;
            let block_low = max(first, corner_quad) - corner_quad;
            let block_high = min(last - corner_quad, vec2<u32>(7u));
            if block_has_away(slot * CHUNK_FACETS + quad_local(corner_quad), block_low, block_high) {
                return true;
            }
        }
        block.x += 1u;
        if block.x > (last.x >> 3u) {
            block = vec2<u32>(first.x >> 3u, block.y + 1u);
        }
    }
    return false;
}

// The quads of a chunk between two lattice places, low inside and high not, that lie in it or touch it.
fn quads_between(chunk: Chunk, low: vec2<u32>, high: vec2<u32>) -> vec4<u32> {
    let end = chunk.origin + CHUNK_QUADS * chunk.step - 1u;
    let inner_low = clamp(low, chunk.origin, end) - chunk.origin;
    let inner_high = clamp(high - 1u, chunk.origin, end) - chunk.origin;
    let shift = vec2<u32>(firstTrailingBit(chunk.step));
    let twos = by_twos(chunk);
    return vec4<u32>((inner_low >> shift) & ~twos, (inner_high >> shift) | twos);
}

// Whether two chunks cover all between two lattice places.
fn cover(a: Chunk, b: Chunk, low: vec2<u32>, high: vec2<u32>) -> bool {
    let a_end = a.origin + CHUNK_QUADS * a.step;
    let b_end = b.origin + CHUNK_QUADS * b.step;
    let holds = (max(a.origin, b.origin) <= low) & (high <= min(a_end, b_end));
    let meet = (a_end == b.origin) | (b_end == a.origin);
    return (holds.y && meet.x) || (holds.x && meet.y);
}

// Whether a walk between two facets could meet an away one; `chunk_p` is the chunk of the first.
fn is_open(p: u32, q: u32, chunk_p: Chunk) -> bool {
    let slot_p = p / CHUNK_FACETS;
    let slot_q = q / CHUNK_FACETS;
    let a = local_quad(p % CHUNK_FACETS);
    let b = local_quad(q % CHUNK_FACETS);
    let twos = by_twos(chunk_p);
    var between = vec4<u32>(min(a, b) & ~twos, max(a, b) | twos);
    var other = vec4<u32>(0u);
    var covered = true;
    if slot_p != slot_q {
        let chunk_q = chunks[slot_q];
        let in_p = rectangle_of(chunk_p, p % CHUNK_FACETS);
        let in_q = rectangle_of(chunk_q, q % CHUNK_FACETS);
        let low = min(in_p.xy, in_q.xy);
        let high = max(in_p.zw, in_q.zw);
        covered = cover(chunk_p, chunk_q, low, high);
        between = quads_between(chunk_p, low, high);
        other = quads_between(chunk_q, low, high);
    }
    if !culls || !covered {
        return true;
    }
    var slot = slot_p;
    loop {
        if chunk_has_away(slot, between.xy, between.zw) {
            return true;
        }
        if slot == slot_q {
            return false;
        }
        slot = slot_q;
        between = other;
    }
    return false;
}

@compute @workgroup_size(64)
fn pairs(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    for (var k = invocation.x; k < candidates.count; k += groups.x * 64u) {
        let item = candidates.pixels[k];
        let i = listed_pixel(item);
        let at = listed_place(item);
        let p = pixels[i].x;
        let chunk_p = chunks[(max(p, 1u) - 1u) / CHUNK_FACETS];
        var open = 0u;
        for (var left = listed_neighbours(item); left != 0u; left &= left - 1u) {
            let to = at + neighbour(firstTrailingBit(left));
            if on_page(to) {
                let q = pixels[pixel_index(to)].x;
                if p == 0u || q == 0u || is_open(p - 1u, q - 1u, chunk_p) {
                    open |= left & (~left + 1u);
                }
            }
        }
        if open != 0u {
            let n = atomicAdd(&out_pairs.count, 1u);
            out_pairs.pixels[n] = listed(i, open);
            if n % 64u == 0u {
                atomicMax(&out_pairs.groups_x, min(n / 64u + 1u, MOST_GROUPS));
            }
        }
    }
}
