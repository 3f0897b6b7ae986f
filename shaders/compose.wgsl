// One invocation a pixel: packs kind, sub-pixel place and depth for readback and tracing.

@group(0) @binding(21) var<storage, read> ink: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_page: array<vec2<u32>>;
@group(0) @binding(23) var<storage, read_write> out_counts: Counts;

const KIND_SKY: u32 = 0u;
const KIND_COVER: u32 = 1u;
const KIND_SILHOUETTE: u32 = 2u;
const KIND_BORDER: u32 = 3u;

fn is_underside(pixel: vec2<u32>) -> bool {
    if two_depths {
        return pixel.x >= pixel.y;
    }
    return pixel.x != 0u && is_away(pixel.x - 1u);
}

@compute @workgroup_size(64)
fn compose(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = vec2<i32>(invocation.xy);
    if !on_page(at) {
        return;
    }
    let i = pixel_index(at);
    let pixel = pixels[i];
    let depth = pixel_depth(pixel);
    var kind = select(KIND_COVER, KIND_SKY, depth == 0u || is_underside(pixel));
    let mark = ink[i];
    var shown = select(depth, 0u, kind == KIND_SKY);
    if (mark & SILHOUETTE) != 0u {
        kind = KIND_SILHOUETTE;
    } else if (mark & BORDER) != 0u {
        kind = KIND_BORDER;
        // A border line may lie just beside its surface.
        for (var k = 0u; k < 8u; k++) {
            let to = at + neighbour(k);
            if on_page(to) {
                shown = max(shown, pixel_depth(pixels[pixel_index(to)]));
            }
        }
    }
    out_page[i] = vec2<u32>(kind | (mark & 0xffff00u), shown);
    if !two_depths && depth != 0u && pixel.x == 0u {
        atomicAdd(&out_counts.orphans, 1u);
    }
}
