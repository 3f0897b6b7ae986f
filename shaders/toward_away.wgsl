// One invocation a pixel: ink where the nearest toward surface is nearer than the nearest away surface, and that is
// nearer than the toward surface of a neighbour. Mower 2015, algorithm 2. Wide: the nearest away depth of the 3 x 3
// block takes the place of the pixel's own.
override wide_block: bool = false;

@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

// Toward depth of a pixel; 0 where it shows sky or an underside.
fn toward_depth(pixel: vec2<u32>) -> u32 {
    return select(0u, pixel.y, pixel.y > pixel.x);
}

@compute @workgroup_size(64)
fn toward_away(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = vec2<i32>(invocation.xy);
    if !on_page(at) {
        return;
    }
    let i = pixel_index(at);
    let p = pixels[i];
    var nearest_away = p.x;
    var farthest_toward = 0xffffffffu;
    for (var k = 0u; k < 8u; k++) {
        let to = at + neighbour(k);
        if on_page(to) {
            let q = pixels[pixel_index(to)];
            farthest_toward = min(farthest_toward, toward_depth(q));
            if wide_block {
                nearest_away = max(nearest_away, q.x);
            }
        }
    }
    let inked = p.y > p.x && p.y > nearest_away && nearest_away > farthest_toward;
    out_ink[i] = select(0u, SILHOUETTE, inked);
}
