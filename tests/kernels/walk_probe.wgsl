// One invocation a segment: what a walk from its first point to its second meets.

@group(0) @binding(25) var<storage, read> segments: array<vec4<i32>>;
@group(0) @binding(26) var<storage, read_write> out_results: array<vec4<u32>>;

@compute @workgroup_size(64)
fn walk_probe(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let i = invocation.x;
    if i >= arrayLength(&segments) {
        return;
    }
    let meeting = walk_between(segments[i].xy, segments[i].zw);
    out_results[i] = vec4<u32>(u32(meeting.met), meeting.id, 0u, 0u);
}
