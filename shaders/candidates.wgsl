// One invocation a block of 4 x 8 pixels: lists the pixels, and of each the pairs with its eastern and southern
// neighbours, between which a walk could meet an away facet. Most pairs lie in one chunk and are dismissed by its
// summary; what remains is looked into by `pairs`.

@group(0) @binding(21) var<storage, read_write> out_candidates: List;

// Pixels across and down that one invocation works off: each pixel is read one and a half times instead of five.
const COLUMNS: i32 = 4;
const ROWS: i32 = 8;

// ID + 1 of the facet in a pixel; 0 is sky. Off the page the nearest pixel counts.
fn shown(at: vec2<i32>) -> u32 {
    return pixels[pixel_index(clamp(at, vec2<i32>(0), vec2<i32>(camera.size) - 1))].x;
}

// Squares of 4 x 4 quads of a chunk between two of its facets, as bits of its summary.
fn squares_between(local_p: u32, local_q: u32) -> u32 {
    let p = local_quad(local_p) >> vec2<u32>(2u);
    let q = local_quad(local_q) >> vec2<u32>(2u);
    let low = min(p, q);
    let high = max(p, q);
    let row = (2u << high.x) - (1u << low.x);
    let rows = (16u << (4u * high.y)) - (1u << (4u * low.y));
    return (row * 0x1111u) & rows;
}

// Whether a walk between two pixels must be looked at; `slot` and `summary` belong to `p`.
fn is_open(p: u32, q: u32, slot: u32, summary: u32) -> bool {
    if p == q {
        return false;
    }
    if !culls || p == 0u || q == 0u || (q - 1u) / CHUNK_FACETS != slot {
        return true;
    }
    return (summary & squares_between((p - 1u) % CHUNK_FACETS, (q - 1u) % CHUNK_FACETS)) != 0u;
}

// Lists a pixel if one of its pairs is open; the four neighbours are those of `neighbour` from 4 on.
fn list(at: vec2<i32>, here: u32, neighbours: vec4<u32>) {
    var slot = NO_SLOT;
    var summary = 0u;
    if here != 0u {
        slot = (here - 1u) / CHUNK_FACETS;
        summary = summaries[slot];
    }
    let pairs = select(0u, 16u, is_open(here, neighbours.x, slot, summary))
        | select(0u, 32u, is_open(here, neighbours.y, slot, summary))
        | select(0u, 64u, is_open(here, neighbours.z, slot, summary))
        | select(0u, 128u, is_open(here, neighbours.w, slot, summary));
    if pairs != 0u && at.x < i32(camera.size.x) {
        let n = atomicAdd(&out_candidates.count, 1u);
        out_candidates.pixels[n] = listed(pixel_index(at), pairs);
        if n % 64u == 0u {
            atomicMax(&out_candidates.groups_x, min(n / 64u + 1u, MOST_GROUPS));
        }
    }
}

@compute @workgroup_size(64)
fn candidates(@builtin(global_invocation_id) invocation: vec3<u32>) {
    var at = vec2<i32>(invocation.xy) * vec2<i32>(COLUMNS, ROWS);
    if !on_page(at) {
        return;
    }
    let end = min(at.y + ROWS, i32(camera.size.y));
    var here = vec4<u32>(shown(at), shown(at + vec2<i32>(1, 0)), shown(at + vec2<i32>(2, 0)), shown(at + vec2<i32>(3, 0)));
    var east = shown(at + vec2<i32>(4, 0));
    for (; at.y < end; at.y++) {
        let below = at + vec2<i32>(0, 1);
        let south_west = shown(below - vec2<i32>(1, 0));
        let south = vec4<u32>(
            shown(below),
            shown(below + vec2<i32>(1, 0)),
            shown(below + vec2<i32>(2, 0)),
            shown(below + vec2<i32>(3, 0)),
        );
        let south_east = shown(below + vec2<i32>(4, 0));
        list(at, here.x, vec4<u32>(here.y, south_west, south.x, south.y));
        list(at + vec2<i32>(1, 0), here.y, vec4<u32>(here.z, south.x, south.y, south.z));
        list(at + vec2<i32>(2, 0), here.z, vec4<u32>(here.w, south.y, south.z, south.w));
        list(at + vec2<i32>(3, 0), here.w, vec4<u32>(east, south.z, south.w, south_east));
        here = south;
        east = south_east;
    }
}
