// Identity by integers: from a facet's ID to its place on the lattice and back.

// A facet by its lattice vertices, counter-clockwise from above; two are the same where it has collapsed beside a coarser
// chunk.
struct Facet {
    a: vec2<u32>,
    b: vec2<u32>,
    c: vec2<u32>,
}

// Column and row within its chunk of the quad of facet `local`.
fn local_quad(local: u32) -> vec2<u32> {
    let block = local >> 7u;
    let quad = (local >> 1u) & 63u;
    return vec2<u32>(block % CHUNK_BLOCKS * 8u + (quad >> 3u), block / CHUNK_BLOCKS * 8u + (quad & 7u));
}

// The inverse: number within its chunk of half 0 of a quad.
fn quad_local(quad: vec2<u32>) -> u32 {
    let block = (quad.y >> 3u) * CHUNK_BLOCKS + (quad.x >> 3u);
    return block * 128u + ((quad.x & 7u) * 8u + (quad.y & 7u)) * 2u;
}

// Column and row of the vertex that stands at a column and row of a chunk: on a side shared with a coarser chunk every
// other vertex is the one before it.
fn shared_vertex(coarser: u32, at: vec2<u32>) -> vec2<u32> {
    let first = at == vec2<u32>(0u);
    let last = at == vec2<u32>(CHUNK_QUADS);
    let on_row = (first.y && (coarser & NORTH) != 0u) || (last.y && (coarser & SOUTH) != 0u);
    let on_column = (first.x && (coarser & WEST) != 0u) || (last.x && (coarser & EAST) != 0u);
    return at & ~select(vec2<u32>(0u), vec2<u32>(1u), vec2<bool>(on_row, on_column));
}

// Number of the square of 4 x 4 quads of a chunk that holds a quad, row by row: its bit in the chunk's summary.
fn square_of(quad: vec2<u32>) -> u32 {
    return (quad.y >> 2u) * 4u + (quad.x >> 2u);
}

// Steps from the quad's north-west vertex to vertex k of a half, counter-clockwise from above.
fn corner(half: u32, k: u32) -> vec2<u32> {
    // Two bits a corner, east below south: NW 00, SW 10, SE 11, NE 01; the first corner lowest.
    let code = select(0x38u, 0x1cu, half == 1u) >> (2u * k);
    return vec2<u32>(code & 1u, (code >> 1u) & 1u);
}

// Half 0 (NW, SW, SE) or 1 (NW, SE, NE) of a quad of a chunk.
fn chunk_facet(chunk: Chunk, quad: vec2<u32>, half: u32) -> Facet {
    return Facet(
        chunk.origin + shared_vertex(chunk.coarser, quad) * chunk.step,
        chunk.origin + shared_vertex(chunk.coarser, quad + corner(half, 1u)) * chunk.step,
        chunk.origin + shared_vertex(chunk.coarser, quad + corner(half, 2u)) * chunk.step,
    );
}

fn facet_of(id: u32) -> Facet {
    return chunk_facet(chunks[id / CHUNK_FACETS], local_quad(id % CHUNK_FACETS), id & 1u);
}

fn is_collapsed(f: Facet) -> bool {
    return all(f.a == f.b) || all(f.b == f.c) || all(f.c == f.a);
}

// Slot of the chunk that holds the quad south-east of a lattice place, NO_SLOT where there is none.
fn slot_at(at: vec2<i32>) -> u32 {
    let root = at >> vec2<u32>(firstTrailingBit(scene.root_size));
    if any(root < vec2<i32>(0)) || any(root >= vec2<i32>(scene.roots)) {
        return NO_SLOT;
    }
    var node = nodes[u32(root.y) * scene.roots.x + u32(root.x)];
    var size = scene.root_size;
    while node != NO_SLOT && (node & INNER) != 0u {
        size >>= 1u;
        let half = select(vec2<u32>(0u), vec2<u32>(1u, 2u), (vec2<u32>(at) & vec2<u32>(size)) != vec2<u32>(0u));
        node = nodes[(node & ~INNER) + half.x + half.y];
    }
    return node;
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

// Whether a vertex lies outside the DEM or depends on a void: no facet that has it exists, and every facet that does not
// exist has one.
fn is_missing(at: vec2<u32>) -> bool {
    if any(at > (scene.samples - 1u) * CELL_STEPS) {
        return true;
    }
    if !has_voids {
        return false;
    }
    let cell = at / CELL_STEPS;
    let sub = at % CELL_STEPS;
    let west = cell.x;
    let east = min(cell.x + 1u, scene.samples.x - 1u);
    let north = cell.y;
    let south = min(cell.y + 1u, scene.samples.y - 1u);
    return (max(sub.x, sub.y) < CELL_STEPS && !is_valid(west, north))
        || (min(sub.x, sub.y) > 0u && !is_valid(east, south))
        || (sub.x > sub.y && !is_valid(east, north))
        || (sub.y > sub.x && !is_valid(west, south));
}
