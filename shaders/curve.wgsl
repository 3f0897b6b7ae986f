// What the passes share that look for the boundary of the surface that faces the eye: contours and rim.

// What is noted of a chunk and its neighbours: facets toward, facets away.
const HOLDS_TOWARD: u32 = 1u;
const HOLDS_AWAY: u32 = 2u;
const BOTH: u32 = 3u;
// Chunks that share the values of one batch.
const BATCH_CHUNKS: u32 = 16384u;
