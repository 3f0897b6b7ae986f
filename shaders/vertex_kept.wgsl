// A vertex of any chunk, where those of all chunks are in `places`.

// Offset from its sample and that sample's height of the vertex at a lattice place of a chunk.
fn place_in(chunk: Chunk, at: vec2<u32>) -> vec4<f32> {
    return places[vertex_index(chunk, (at - chunk.origin) >> vec2<u32>(firstTrailingBit(chunk.step)))];
}
