// One invocation a vertex on a side that a chunk shares with a coarser one: every other vertex becomes the one before it,
// so that both chunks have the same.

@group(0) @binding(20) var<storage, read_write> out_places: array<vec4<f32>>;
@group(0) @binding(21) var<storage, read> fresh: array<u32>;

@compute @workgroup_size(32, 2)
fn seam(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let side = invocation.x / (CHUNK_QUADS / 2u);
    let number = batch.first_slot + invocation.y;
    let chunk = chunks[fresh[min(number, camera.fresh - 1u)]];
    if number >= camera.fresh || ((chunk.coarser >> side) & 1u) == 0u {
        return;
    }
    let along = invocation.x % (CHUNK_QUADS / 2u) * 2u;
    let across = select(0u, CHUNK_QUADS, side == 1u || side == 2u);
    let at = select(vec2<u32>(along, across), vec2<u32>(across, along), (side & 1u) == 1u);
    let from_vertex = vertex_index(chunk, at);
    out_places[from_vertex + select(1u, CHUNK_SIDE, (side & 1u) == 1u)] = out_places[from_vertex];
}
