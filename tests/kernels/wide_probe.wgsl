// One invocation a pair of operands: one operation of wide.wgsl.

override operation: u32 = 0u;

@group(0) @binding(0) var<storage, read> operands: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> out_results: array<vec4<u32>>;

@compute @workgroup_size(64)
fn wide_probe(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let i = invocation.x;
    if i >= arrayLength(&operands) {
        return;
    }
    let v = operands[i];
    var result = vec2<u32>(0u);
    switch operation {
        case 0u: { result = wide_mul_u32(v.x, v.y); }
        case 1u: { result = wide_mul(i32(v.x), i32(v.y)); }
        case 2u: { result = wide_add(v.xy, v.zw); }
        case 3u: { result = wide_sub(v.xy, v.zw); }
        case 4u: { result = wide_scale(v.xy, v.z & 63u); }
        default: { result = vec2<u32>(u32(wide_sign(v.xy)), 0u); }
    }
    out_results[i] = vec4<u32>(result, 0u, 0u);
}
