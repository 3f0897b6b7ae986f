// One invocation a candidate pixel: keeps its pairs with sky, and those with an away facet in the rectangle of quads
// that a walk between the two cannot leave. Few remain, and the walk finds them side by side.

struct Candidates {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    pixels: array<u32>,
}

// Pixels for another pass, and the workgroups of 64 that it takes along x, as far as they go.
struct Pairs {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
    pixels: array<u32>,
}

@group(0) @binding(21) var<storage, read> candidates: Candidates;
@group(0) @binding(22) var<storage, read_write> out_pairs: Pairs;

// Rectangles with more quads along a side are not looked into: the walk leaps better.
const LARGEST_RECTANGLE: i32 = 16;

// A facet's quad, in quads from the north-west corner of the lattice.
fn quad_of(id: u32) -> vec2<i32> {
    return vec2<i32>(chunks[id / CHUNK_FACETS].origin / scene.step + local_quad(id % CHUNK_FACETS));
}

// Whether an away facet lies within one block between two quads of it, given within the block.
fn block_has_away(first_facet: u32, low: vec2<i32>, high: vec2<i32>) -> bool {
    let rows = (1u << u32(2 * (high.y + 1))) - (1u << u32(2 * low.y));
    for (var column = low.x; column <= high.x; column++) {
        if (away_bits(first_facet + u32(column) * 16u) & rows) != 0u {
            return true;
        }
    }
    return false;
}

// Whether a walk between two facets could meet an away one.
fn is_open(p: u32, q: u32) -> bool {
    let a = quad_of(p);
    let b = quad_of(q);
    let low = min(a, b);
    let high = max(a, b);
    if !thrifty || any(high - low >= vec2<i32>(LARGEST_RECTANGLE)) {
        return true;
    }
    let eight = vec2<u32>(3u);
    let last = high >> eight;
    for (var block = low >> eight; block.y <= last.y; ) {
        let corner_quad = block << eight;
        let slot = slot_of(corner_quad);
        if slot != NO_SLOT {
            let local = quad_local(vec2<u32>(corner_quad) % CHUNK_QUADS);
            if ((summaries[slot] >> (local >> 7u)) & 1u) != 0u {
                let inner_low = max(low - corner_quad, vec2<i32>(0));
                let inner_high = min(high - corner_quad, vec2<i32>(7));
                if block_has_away(slot * CHUNK_FACETS + local, inner_low, inner_high) {
                    return true;
                }
            }
        }
        block.x += 1;
        if block.x > last.x {
            block = vec2<i32>(low.x >> 3u, block.y + 1);
        }
    }
    return false;
}

@compute @workgroup_size(64)
fn pairs(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    for (var k = invocation.x; k < candidates.count; k += groups.x * 64u) {
        let i = candidates.pixels[k] & 0xffffffu;
        let at = vec2<i32>(vec2<u32>(i % camera.size.x, i / camera.size.x));
        let p = pixels[i].x;
        var open = 0u;
        for (var left = candidates.pixels[k] >> 24u; left != 0u; left &= left - 1u) {
            let to = at + neighbour(firstTrailingBit(left));
            if on_page(to) {
                let q = pixels[pixel_index(to)].x;
                if p == 0u || q == 0u || is_open(p - 1u, q - 1u) {
                    open |= left & (~left + 1u);
                }
            }
        }
        if open != 0u {
            let n = atomicAdd(&out_pairs.count, 1u);
            out_pairs.pixels[n] = i | (open << 24u);
            if n % 64u == 0u {
                atomicMax(&out_pairs.groups_x, min(n / 64u + 1u, MOST_GROUPS));
            }
        }
    }
}
