// A vertex of any chunk, where those of one batch alone are in `places`: to the bit what was there.

// Offset from its sample and that sample's height of the vertex at a lattice place of a chunk.
fn place_in(chunk: Chunk, at: vec2<u32>) -> vec4<f32> {
    return vertex_place(chunk, at);
}
