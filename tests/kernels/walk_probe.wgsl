// One invocation a segment: what a walk from its first point to its second meets, and where it enters it.

@group(0) @binding(25) var<storage, read> segments: array<vec4<i32>>;
@group(0) @binding(26) var<storage, read_write> out_results: array<vec4<u32>>;

@compute @workgroup_size(64)
fn walk_probe(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let i = invocation.x;
    if i >= arrayLength(&segments) {
        return;
    }
    let meeting = walk_between(segments[i].xy, segments[i].zw);
    // 2: a driver has ended the walk.
    let met = select(2u, u32(meeting.met), meeting.done);
    out_results[i] = vec4<u32>(met, meeting.id, bitcast<vec2<u32>>(meeting.entered));
}
