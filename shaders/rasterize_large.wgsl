// One workgroup a share of a queued facet's tiles: clips it to the near plane and the guard band, then draws the
// parts with 64-bit edge functions.

struct Queue {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    ids: array<u32>,
}

@group(0) @binding(21) var<storage, read> queue: Queue;

// An invocation draws half a column of a tile.
// Limits the tile-local part of an edge function to i32: see `tile_edge`.
const EDGE_LIMIT: i32 = 1 << 30;

// Signed distance of a point in camera space from clip plane k; inside is not negative.
fn plane_distance(q: vec3<f32>, k: u32) -> f32 {
    switch k {
        case 0u: { return q.z - scene.near; }
        case 1u: { return GUARD * q.z - camera.focal * q.x; }
        case 2u: { return GUARD * q.z + camera.focal * q.x; }
        case 3u: { return GUARD * q.z - camera.focal * q.y; }
        default: { return GUARD * q.z + camera.focal * q.y; }
    }
}

// Each invocation's polygon before and after a cut: points in camera space, and in w the corner of the facet (0 to 2)
// that a point still is, or CUT. In workgroup memory, each in its own rows: compilers handle indexed registers badly.
// These are the 16 KiB that every device grants.
var<workgroup> polygons: array<array<array<vec4<f32>, 8>, 2>, 64>;

const CUT: f32 = 3.0;

// Sutherland, Hodgman 1974: cuts polygon `side` of `size` points by plane k into the other side; returns the new size.
// A cut is computed from the inside end of its edge: both facets of an edge get the same.
fn cut(lane: u32, side: u32, size: u32, k: u32) -> u32 {
    var kept = 0u;
    for (var i = 0u; i < size; i++) {
        let p = polygons[lane][side][i];
        let q = polygons[lane][side][select(i + 1u, 0u, i + 1u == size)];
        let dp = plane_distance(p.xyz, k);
        let dq = plane_distance(q.xyz, k);
        if dp >= 0.0 {
            polygons[lane][1u - side][kept] = p;
            kept += 1u;
        }
        if (dp >= 0.0) != (dq >= 0.0) {
            let inside = select(q.xyz, p.xyz, dp >= 0.0);
            let outside = select(p.xyz, q.xyz, dp >= 0.0);
            let d_inside = max(dp, dq);
            let t = d_inside / (d_inside - min(dp, dq));
            polygons[lane][1u - side][kept] = vec4<f32>(inside + (outside - inside) * t, CUT);
            kept += 1u;
        }
    }
    return kept;
}

// An edge function over a tile: E = 256 * whole + rest, where `whole` changes by the gradient a pixel.
struct TileEdge {
    whole: i32,
    rest: i32,
    estimate: f32,
    gradient: vec2<i32>,
    // Whether `whole` does not tell the value, only its sign.
    estimated: bool,
}

fn tile_edge(p: vec2<i32>, q: vec2<i32>, corner_px: vec2<i32>, wide: bool) -> TileEdge {
    let g = edge_gradient(p, q);
    let d = corner_px * 256 + 128 - p;
    var e = wide_add(wide_mul(g.x, d.x), wide_mul(g.y, d.y));
    let estimate = wide_f32(e);
    let bias = edge_bias(g);
    if wide {
        e = wide_add(e, wide_mul(128, abs(g.x) + abs(g.y)));
    } else if bias < 0 {
        e = wide_sub(e, vec2<u32>(1u, 0u));
    }
    // Floor of e / 256, cut to +-2^30: within a tile it changes by less, so its sign stays right.
    let high = bitcast<i32>(e.y) >> 8u;
    let low = bitcast<i32>((e.x >> 8u) | (e.y << 24u));
    let fits = high == (low >> 31u) && low > -EDGE_LIMIT && low < EDGE_LIMIT;
    let whole = select(select(EDGE_LIMIT, -EDGE_LIMIT, high < 0), low, fits);
    return TileEdge(whole, i32(e.x & 255u) - bias, estimate, g, wide || !fits);
}

// The largest `whole` in the tile: negative where all of it lies outside.
fn largest_whole(e: TileEdge) -> i32 {
    let rise = max(e.gradient, vec2<i32>(0)) * (TILE - 1);
    return e.whole + rise.x + rise.y;
}

fn edge_value(e: TileEdge, whole: i32, at: vec2<i32>) -> f32 {
    let exact = f32(whole) * 256.0 + f32(e.rest);
    let g = vec2<f32>(e.gradient) * vec2<f32>(at);
    return select(exact, e.estimate + 256.0 * (g.x + g.y), e.estimated);
}

fn rasterize_tile(t: Triangle, box: Box, corner_px: vec2<i32>, lane: u32, area: f32, id: u32, away: bool, wide: bool) {
    let a = tile_edge(t.b, t.c, corner_px, wide);
    let b = tile_edge(t.c, t.a, corner_px, wide);
    let c = tile_edge(t.a, t.b, corner_px, wide);
    if (largest_whole(a) | largest_whole(b) | largest_whole(c)) < 0 {
        return;
    }
    let x = i32(lane & 31u);
    let top = i32(lane >> 5u) * (TILE / 2);
    for (var y = top; y < top + TILE / 2; y++) {
        let at = vec2<i32>(x, y);
        let e_a = a.whole + a.gradient.x * x + a.gradient.y * y;
        let e_b = b.whole + b.gradient.x * x + b.gradient.y * y;
        let e_c = c.whole + c.gradient.x * x + c.gradient.y * y;
        if (e_a | e_b | e_c) >= 0 && all(corner_px + at >= box.low) && all(corner_px + at <= box.high) {
            let depth = depth_at(t, edge_value(b, e_b, at) / area, edge_value(c, e_c, at) / area);
            emit(pixel_index(corner_px + at), depth, id, away, !wide);
        }
    }
}

fn rasterize_triangle(either: Triangle, share: vec2<u32>, lane: u32, id: u32, away: bool, wide: bool) {
    let ab = either.b - either.a;
    let ac = either.c - either.a;
    let area = wide_sub(wide_mul(ab.x, ac.y), wide_mul(ab.y, ac.x));
    let sign = wide_sign(area);
    if sign == 0 {
        return;
    }
    let t = oriented(either, sign);
    let box = pixel_box(t, wide);
    if any(box.low > box.high) {
        return;
    }
    // Tiles of the whole page, so that estimates are the same whatever part of it is drawn.
    let corner_px = ((box.low + camera.origin) & vec2<i32>(-TILE)) - camera.origin;
    let tiles = vec2<u32>((box.high - corner_px) / TILE + 1);
    for (var k = share.x; k < tiles.x * tiles.y; k += share.y) {
        let tile = vec2<i32>(i32(k % tiles.x), i32(k / tiles.x));
        rasterize_tile(t, box, corner_px + tile * TILE, lane, abs(wide_f32(area)), id, away, wide);
    }
}

// Draws a share of one facet of the batch: which, of how many.
fn rasterize_facet(id: u32, share: vec2<u32>, lane: u32) {
    let slot = id / CHUNK_FACETS - batch.first_slot;
    let quad = local_quad(id % CHUNK_FACETS);
    let chunk = chunks[id / CHUNK_FACETS];
    let half = id & 1u;
    let away = (emitted_bits(id) & 1u) == 1u;
    let base = slot * CHUNK_VERTICES + quad.y * CHUNK_SIDE + quad.x;
    var flags = 0;
    for (var k = 0u; k < 3u; k++) {
        let d = corner(half, k);
        let v = base + d.y * CHUNK_SIDE + d.x;
        let at = chunk.origin + shared_vertex(chunk.coarser, quad + d) * chunk.step;
        polygons[lane][0][k] = vec4<f32>(camera_space(eye_relative(at / CELL_STEPS, places[vertex_index(chunk, quad + d)])), f32(k));
        flags |= screens[v].w;
    }
    let planes = select(0u, 5u, (flags & CLIPPED) != 0);
    var size = 3u;
    for (var k = 0u; k < planes; k++) {
        size = cut(lane, k & 1u, size, k);
    }
    var first = vec4<i32>(0);
    var last = vec4<i32>(0);
    for (var k = 0u; k < size; k++) {
        let point = polygons[lane][planes & 1u][k];
        var screen = vec4<i32>(NO_PLACE);
        if point.w != CUT {
            // Corners keep the place that the facets beside this one know.
            let d = corner(half, u32(point.w));
            screen = screens[base + d.y * CHUNK_SIDE + d.x];
        }
        if screen.x == NO_PLACE {
            screen = vec4<i32>(snapped(point.xyz), bitcast<i32>(depth_of(point.xyz)), 0);
        }
        if k == 0u {
            first = screen;
        }
        if k >= 2u {
            let t = screen_triangle(first.xyz, last.xyz, screen.xyz);
            rasterize_triangle(t, share, lane, id, away, false);
            if conservative && away {
                rasterize_triangle(t, share, lane, id, away, true);
            }
        }
        last = screen;
    }
}

@compute @workgroup_size(64)
fn rasterize_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    for (var k = group.x; k < queue.count; k += groups.x) {
        rasterize_facet(queue.ids[k], vec2<u32>(group.y, groups.y), lane);
    }
}
