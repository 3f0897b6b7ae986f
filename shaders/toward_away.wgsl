// One invocation a block of 4 x 8 pixels: ink where the nearest toward surface is nearer than the nearest away surface,
// and that is nearer than the toward surface of a neighbour. Mower 2015, algorithm 2. Wide: the nearest away depth that
// touches the 3 x 3 block takes the place of the pixel's own.
override wide_block: bool = false;

@group(0) @binding(20) var<storage, read> touched: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

// Pixels across and down that one invocation works off: each pixel is read one and a half times instead of nine.
const COLUMNS: i32 = 4;
const ROWS: i32 = 8;

// Four pixels side by side, and of each and its two neighbours the farthest toward and the nearest touched away depth.
struct Row {
    own_toward: vec4<u32>,
    own_away: vec4<u32>,
    toward: vec4<u32>,
    touched: vec4<u32>,
}

// The pixel at a page place; off the page the nearest one.
fn pixel_at(at: vec2<i32>) -> vec2<u32> {
    return pixels[pixel_index(clamp(at, vec2<i32>(0), vec2<i32>(camera.size) - 1))];
}

fn row_at(at: vec2<i32>) -> Row {
    let a = pixel_at(at - vec2<i32>(1, 0));
    let b = pixel_at(at);
    let c = pixel_at(at + vec2<i32>(1, 0));
    let d = pixel_at(at + vec2<i32>(2, 0));
    let e = pixel_at(at + vec2<i32>(3, 0));
    let f = pixel_at(at + vec2<i32>(4, 0));
    let nearer = vec4<u32>(b.y, c.y, d.y, e.y);
    let away = vec4<u32>(b.x, c.x, d.x, e.x);
    // Toward depths are 0 where a pixel shows sky or an underside.
    let toward = select(vec4<u32>(0u), nearer, nearer > away);
    let west = vec4<u32>(select(0u, a.y, a.y > a.x), toward.xyz);
    let east = vec4<u32>(toward.yzw, select(0u, f.y, f.y > f.x));
    return Row(nearer, away, min(toward, min(west, east)), nearest_touched(at));
}

// Of four pixels side by side and their neighbours, the nearest depth of away facets that touch them.
fn nearest_touched(at: vec2<i32>) -> vec4<u32> {
    if !wide_block {
        return vec4<u32>(0u);
    }
    var depths: array<u32, 6>;
    for (var k = 0; k < 6; k++) {
        depths[k] = touched[pixel_index(clamp(at + vec2<i32>(k - 1, 0), vec2<i32>(0), vec2<i32>(camera.size) - 1))];
    }
    let own = vec4<u32>(depths[1], depths[2], depths[3], depths[4]);
    return max(own, max(vec4<u32>(depths[0], own.xyz), vec4<u32>(own.yzw, depths[5])));
}

@compute @workgroup_size(64)
fn toward_away(@builtin(global_invocation_id) invocation: vec3<u32>) {
    var at = vec2<i32>(invocation.xy) * vec2<i32>(COLUMNS, ROWS);
    if !on_page(at) {
        return;
    }
    let end = min(at + vec2<i32>(COLUMNS, ROWS), vec2<i32>(camera.size));
    var north = row_at(at - vec2<i32>(0, 1));
    var here = row_at(at);
    for (; at.y < end.y; at.y++) {
        let south = row_at(at + vec2<i32>(0, 1));
        let away = select(here.own_away, max(here.touched, max(north.touched, south.touched)), wide_block);
        // The pixel itself is among the nine: its toward depth is nearer than its away depth, so it inks nothing.
        let toward = min(here.toward, min(north.toward, south.toward));
        let inked = (here.own_toward > away) & (away > toward);
        let marks = select(vec4<u32>(0u), vec4<u32>(SILHOUETTE), inked);
        let i = pixel_index(at);
        out_ink[i] = marks.x;
        if at.x + 1 < end.x {
            out_ink[i + 1u] = marks.y;
        }
        if at.x + 2 < end.x {
            out_ink[i + 2u] = marks.z;
        }
        if at.x + 3 < end.x {
            out_ink[i + 3u] = marks.w;
        }
        north = here;
        here = south;
    }
}
