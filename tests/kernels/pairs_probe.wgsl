// One invocation a pair of facets: whether a walk between them is held open.

@group(0) @binding(25) var<storage, read> facet_pairs: array<vec2<u32>>;
@group(0) @binding(26) var<storage, read_write> out_results: array<vec4<u32>>;

@compute @workgroup_size(64)
fn pairs_probe(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let i = invocation.x;
    if i >= arrayLength(&facet_pairs) {
        return;
    }
    let p = facet_pairs[i].x;
    let open = is_open(p, facet_pairs[i].y, chunks[p / CHUNK_FACETS]);
    out_results[i] = vec4<u32>(u32(open), 0u, 0u, 0u);
}
