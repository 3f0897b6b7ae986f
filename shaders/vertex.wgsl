// Vertices of chunks and the edges between them, where all vertices of a batch are in `places`.

// A vertex: its place on the lattice, offset and height from `places`.
struct Vertex {
    at: vec2<u32>,
    place: vec4<f32>,
}

// The vertex at column and row `at` of a chunk, number `v` in `places`.
fn vertex_of(chunk: Chunk, at: vec2<u32>, v: u32) -> Vertex {
    return Vertex(chunk.origin + shared_vertex(chunk.coarser, at) * chunk.step, places[v]);
}

fn edge_of(from_vertex: Vertex, to_vertex: Vertex) -> vec3<f32> {
    return edge_between(from_vertex.at, from_vertex.place, to_vertex.at, to_vertex.place);
}

// Which halves of a quad lack a vertex.
fn lacking(nw: Vertex, ne: Vertex, sw: Vertex, se: Vertex) -> vec2<bool> {
    let diagonal = max(nw.place.w, se.place.w);
    return vec2<bool>(max(diagonal, sw.place.w) >= NO_HEIGHT, max(diagonal, ne.place.w) >= NO_HEIGHT);
}
