// One invocation a column of eight pixels: ink where the nearest toward surface is nearer than the nearest away surface, and that is
// nearer than the toward surface of a neighbour. Mower 2015, algorithm 2. Wide: the nearest away depth of the 3 x 3
// block takes the place of the pixel's own.
override wide_block: bool = false;

@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

const STRIP: i32 = 8;

// Three pixels side by side: the middle one, the farthest toward depth and the nearest away depth of the three.
struct Row {
    middle: vec2<u32>,
    toward: u32,
    away: u32,
}

// The pixel at a page place; off the page the nearest one.
fn pixel_at(at: vec2<i32>) -> vec2<u32> {
    return pixels[pixel_index(clamp(at, vec2<i32>(0), vec2<i32>(camera.size) - 1))];
}

// Toward depth of a pixel; 0 where it shows sky or an underside.
fn toward_depth(pixel: vec2<u32>) -> u32 {
    return select(0u, pixel.y, pixel.y > pixel.x);
}

fn row_at(at: vec2<i32>) -> Row {
    let west = pixel_at(at - vec2<i32>(1, 0));
    let middle = pixel_at(at);
    let east = pixel_at(at + vec2<i32>(1, 0));
    let toward = min(toward_depth(middle), min(toward_depth(west), toward_depth(east)));
    return Row(middle, toward, max(middle.x, max(west.x, east.x)));
}

@compute @workgroup_size(64)
fn toward_away(@builtin(global_invocation_id) invocation: vec3<u32>) {
    var at = vec2<i32>(i32(invocation.x), i32(invocation.y) * STRIP);
    if !on_page(at) {
        return;
    }
    let end = min(at.y + STRIP, i32(camera.size.y));
    var north = row_at(at - vec2<i32>(0, 1));
    var here = row_at(at);
    for (; at.y < end; at.y++) {
        let south = row_at(at + vec2<i32>(0, 1));
        let p = here.middle;
        let away = select(p.x, max(here.away, max(north.away, south.away)), wide_block);
        // The pixel itself is among the nine: its toward depth is nearer than its away depth, so it inks nothing.
        let toward = min(here.toward, min(north.toward, south.toward));
        let inked = p.y > away && away > toward;
        out_ink[pixel_index(at)] = select(0u, SILHOUETTE, inked);
        north = here;
        here = south;
    }
}
