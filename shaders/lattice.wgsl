// Identity by integers: from a facet's ID to its place on the lattice and back.

// A facet by its quad: lattice place of the quad's north-west vertex, lattice units between vertices, and which
// half: 0 is NW, SW, SE; 1 is NW, SE, NE.
struct Facet {
    origin: vec2<u32>,
    step: u32,
    half: u32,
}

// Column and row within its chunk of the quad of facet `local`.
fn local_quad(local: u32) -> vec2<u32> {
    let block = local >> 7u;
    let quad = (local >> 1u) & 63u;
    return vec2<u32>((block & 3u) * 8u + (quad >> 3u), (block >> 2u) * 8u + (quad & 7u));
}

// The inverse: number within its chunk of half 0 of a quad.
fn quad_local(quad: vec2<u32>) -> u32 {
    let block = (quad.y >> 3u) * 4u + (quad.x >> 3u);
    return block * 128u + ((quad.x & 7u) * 8u + (quad.y & 7u)) * 2u;
}

fn facet_of(id: u32) -> Facet {
    let chunk = chunks[id / CHUNK_FACETS];
    return Facet(chunk.origin + local_quad(id % CHUNK_FACETS) * chunk.step, chunk.step, id & 1u);
}

// Steps from the quad's north-west vertex to vertex k of a half, counter-clockwise from above.
fn corner(half: u32, k: u32) -> vec2<u32> {
    // Two bits a corner, east below south: NW 00, SW 10, SE 11, NE 01; the first corner lowest.
    let code = select(0x38u, 0x1cu, half == 1u) >> (2u * k);
    return vec2<u32>(code & 1u, (code >> 1u) & 1u);
}

// Slot of the chunk that holds a quad (in quads from the north-west), NO_SLOT where there is none.
fn slot_of(quad: vec2<i32>) -> u32 {
    let chunk = quad >> vec2<u32>(5u);
    if any(chunk < vec2<i32>(0)) || any(chunk >= vec2<i32>(scene.chunk_grid)) {
        return NO_SLOT;
    }
    return slots[u32(chunk.y) * scene.chunk_grid.x + u32(chunk.x)];
}

// Whether patch `half` of cell (c, r) exists.
fn patch_exists(c: i32, r: i32, half: u32) -> bool {
    if c < 0 || r < 0 || c + 1 >= i32(scene.samples.x) || r + 1 >= i32(scene.samples.y) {
        return false;
    }
    if !has_voids {
        return true;
    }
    let third = select(vec2<i32>(c, r + 1), vec2<i32>(c + 1, r), half == 1u);
    return is_valid(u32(c), u32(r)) && is_valid(u32(c + 1), u32(r + 1)) && is_valid(u32(third.x), u32(third.y));
}
