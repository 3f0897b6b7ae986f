// What the silhouette and border passes leave in a pixel's word of ink, and what a frame counts.

const SILHOUETTE: u32 = 1u;
const BORDER: u32 = 2u;

struct Counts {
    longest_walk: atomic<u32>,  // nodes a walk visited
    orphans: atomic<u32>,       // pixels with a depth and no ID: must be 0
    cut_short: atomic<u32>,     // walks that a driver ended before they were done: must be 0
}

// A silhouette whose sub-pixel place lies `offset` px from the pixel's centre, right and down, in 1/64 px. Of two such
// words the larger has the smaller offset.
fn silhouette_at(offset: vec2<f32>) -> u32 {
    let d = vec2<i32>(round(clamp(offset, vec2<f32>(-1.5), vec2<f32>(1.5)) * 64.0));
    let nearness = 255u - u32(max(abs(d.x), abs(d.y)));
    return SILHOUETTE | ((u32(d.x) & 255u) << 8u) | ((u32(d.y) & 255u) << 16u) | (nearness << 24u);
}
