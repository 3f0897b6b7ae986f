// What the passes share that look for the boundary of the surface that faces the eye: contours and rim.

// What is noted of a chunk: it or a neighbour holds facets toward the eye, away from it; its values are wanted for its own
// lines or a neighbour's; it has contours that may be seen.
const HOLDS_TOWARD: u32 = 1u;
const HOLDS_AWAY: u32 = 2u;
const BOTH: u32 = 3u;
const WANTED: u32 = 4u;
const DRAWN: u32 = 8u;
// How much nearer than a line the surface about it must be for it to be certainly hidden.
const NEARER: f32 = 1.02;
// Chunks that share the values of one batch.
const BATCH_CHUNKS: u32 = 16384u;
// Words that tell what lies around a chunk: slots by column and row of a 4 x 4 grid, of which the chunk itself fills the
// inner four. The first of these holds where the values of its side are kept.
const AROUND: u32 = 16u;
const SIDES_AT: u32 = 5u;
// Vertices of a chunk's side.
const SIDE_VERTICES: u32 = 64u;

// Number among the vertices of a chunk's side, clockwise from its north-west corner.
fn side_number(at: vec2<u32>) -> u32 {
    if at.y == 0u && at.x < CHUNK_QUADS {
        return at.x;
    }
    if at.x == CHUNK_QUADS && at.y < CHUNK_QUADS {
        return CHUNK_QUADS + at.y;
    }
    return select(4u * CHUNK_QUADS - at.y, 3u * CHUNK_QUADS - at.x, at.y == CHUNK_QUADS);
}

// The vertex of that number.
fn side_vertex(number: u32) -> vec2<u32> {
    let along = number % CHUNK_QUADS;
    let side = number / CHUNK_QUADS;
    let ahead = select(along, CHUNK_QUADS - along, side >= 2u);
    let across = select(0u, CHUNK_QUADS, side == 1u || side == 2u);
    return select(vec2<u32>(ahead, across), vec2<u32>(across, ahead), (side & 1u) == 1u);
}

// Which word around a chunk tells the slot of the quad at a column and row, from -1 to 16.
fn around_at(quad: vec2<i32>) -> u32 {
    let half = vec2<i32>(i32(CHUNK_QUADS) / 2);
    let at = select(quad / half + 1, vec2<i32>(0), quad < vec2<i32>(0));
    return u32(at.y * 4 + at.x);
}
