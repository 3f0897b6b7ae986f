// One invocation an edge, a facet and which of its vertices the edge leads from: the facet beyond.

@group(0) @binding(25) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(26) var<storage, read_write> out_results: array<vec4<u32>>;

@compute @workgroup_size(64)
fn beyond_probe(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let i = invocation.x;
    if i < arrayLength(&edges) {
        out_results[i] = vec4<u32>(facet_beyond(facet_of(edges[i].x), edges[i].y));
    }
}
