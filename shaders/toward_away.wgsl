// One invocation a block of 4 x 8 pixels: ink where the nearest toward surface is nearer than the nearest away surface,
// and that is nearer than the toward surface of a neighbour. Mower 2015, algorithm 2. Wide: the nearest away surface that
// touches the pixel or that neighbour takes the place of the one at the pixel's centre; the line between them runs
// through one of the two.
override wide: bool = false;

@group(0) @binding(20) var<storage, read> touched: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

// Pixels across and down that one invocation works off: each pixel is read one and a half times instead of nine.
const COLUMNS: i32 = 4;
const ROWS: i32 = 8;

const NONE: u32 = 0xffffffffu;

// Four pixels side by side: their own depths, and of each and its two neighbours the farthest toward depth and the
// farthest touched away depth that is nearer than the toward depth beside it.
struct Row {
    own_toward: vec4<u32>,
    own_away: vec4<u32>,
    toward: vec4<u32>,
    before: vec4<u32>,
}

// The pixel at a page place; off the page the nearest one.
fn pixel_at(at: vec2<i32>) -> vec2<u32> {
    return pixels[pixel_index(clamp(at, vec2<i32>(0), vec2<i32>(camera.size) - 1))];
}

fn touched_at(at: vec2<i32>) -> u32 {
    return touched[pixel_index(clamp(at, vec2<i32>(0), vec2<i32>(camera.size) - 1))];
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
    let first = select(0u, a.y, a.y > a.x);
    let last = select(0u, f.y, f.y > f.x);
    let west = vec4<u32>(first, toward.xyz);
    let east = vec4<u32>(toward.yzw, last);
    return Row(nearer, away, min(toward, min(west, east)), before_toward(at, toward, first, last));
}

// Of four pixels side by side and their neighbours, the farthest depth at which away facets touch one of them before the
// toward surface that it shows.
fn before_toward(at: vec2<i32>, toward: vec4<u32>, first: u32, last: u32) -> vec4<u32> {
    if !wide {
        return vec4<u32>(NONE);
    }
    let a = touched_at(at - vec2<i32>(1, 0));
    let own = touched_of(at);
    let f = touched_at(at + vec2<i32>(4, 0));
    let middle = select(vec4<u32>(NONE), own, own > toward);
    let west = vec4<u32>(select(NONE, a, a > first), middle.xyz);
    let east = vec4<u32>(middle.yzw, select(NONE, f, f > last));
    return min(middle, min(west, east));
}

// Nearest depths of away facets that touch four pixels side by side.
fn touched_of(at: vec2<i32>) -> vec4<u32> {
    return vec4<u32>(
        touched_at(at),
        touched_at(at + vec2<i32>(1, 0)),
        touched_at(at + vec2<i32>(2, 0)),
        touched_at(at + vec2<i32>(3, 0)),
    );
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
        // The pixel itself is among the nine: its toward depth is nearer than its away depth, so it inks nothing.
        let toward = min(here.toward, min(north.toward, south.toward));
        var inked = (here.own_toward > here.own_away) & (here.own_away > toward);
        if wide {
            let away = touched_of(at);
            let own = (here.own_toward > away) & (away > toward);
            let beside = here.own_toward > min(here.before, min(north.before, south.before));
            inked = (here.own_toward > here.own_away) & (own | beside);
        }
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
