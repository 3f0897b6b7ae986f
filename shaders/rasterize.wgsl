// One invocation a column of eight quads, facet by facet, both sides: each vertex is read once. Small facets are drawn
// here, large and clipped ones queued.

// Facets for another pass, and the workgroups it takes: one a facet along x, as far as they go, one a share of the
// largest along y.
struct Queue {
    groups_x: atomic<u32>,
    groups_y: atomic<u32>,
    groups_z: u32,
    count: atomic<u32>,
    ids: array<u32>,
}

@group(0) @binding(21) var<storage, read_write> out_queue: Queue;

// Beyond 126 px products of two differences, in 1/256 px, overflow i32. A column of such boxes would be 16 x 127 x 127
// turns of the loop; the software driver ends an invocation's loops, all together, after 65 535: 16 x 61 x 61 are fewer.
const LARGEST_BOX: i32 = 60 * 256;
// Facets of a column of eight quads.
const STRIP_FACETS: u32 = 16u;

// Tiles that one workgroup draws of a facet at most: 16 turns each.
const SHARE_TILES: u32 = 128u;

// Queues a facet with a box of so many pixels across and down.
fn enqueue(id: u32, size: vec2<i32>) {
    let n = atomicAdd(&out_queue.count, 1u);
    out_queue.ids[n] = id;
    atomicMax(&out_queue.groups_x, min(n + 1u, MOST_GROUPS));
    // A box may begin and end within a tile.
    let tiles = vec2<u32>(size / TILE) + 2u;
    atomicMax(&out_queue.groups_y, (tiles.x * tiles.y - 1u) / SHARE_TILES + 1u);
}

// `wide`: the corner of the pixel that lies deepest inside counts.
fn small_bias(gradient: vec2<i32>, wide: bool) -> i32 {
    return select(edge_bias(gradient), 128 * (abs(gradient.x) + abs(gradient.y)), wide);
}

fn rasterize_small(either: Triangle, id: u32, away: bool) {
    let wide = conservative && away;
    let ab = either.b - either.a;
    let ac = either.c - either.a;
    let area = ab.x * ac.y - ab.y * ac.x;
    if area == 0 {
        return;
    }
    let t = oriented(either, area);
    let box = pixel_box(t, wide);
    if any(box.low > box.high) {
        return;
    }
    let first = box.low * 256 + 128;
    let g_a = edge_gradient(t.b, t.c);
    let g_b = edge_gradient(t.c, t.a);
    let g_c = edge_gradient(t.a, t.b);
    let bias = vec3<i32>(small_bias(g_a, wide), small_bias(g_b, wide), small_bias(g_c, wide));
    let step_x = vec3<i32>(g_a.x, g_b.x, g_c.x) * 256;
    let step_y = vec3<i32>(g_a.y, g_b.y, g_c.y) * 256;
    let from_a = first - t.a;
    let from_b = first - t.b;
    let from_c = first - t.c;
    var row = bias + vec3<i32>(
        g_a.x * from_b.x + g_a.y * from_b.y,
        g_b.x * from_c.x + g_b.y * from_c.y,
        g_c.x * from_a.x + g_c.y * from_a.y,
    );
    var e = row;
    let scale = 1.0 / f32(abs(area));
    var at = box.low;
    loop {
        if (e.x | e.y | e.z) >= 0 {
            let inside = e - bias;
            let depth = depth_at(t, f32(inside.y) * scale, f32(inside.z) * scale);
            let exact = inside + vec3<i32>(edge_bias(g_a), edge_bias(g_b), edge_bias(g_c));
            let centre = !wide || (exact.x | exact.y | exact.z) >= 0;
            emit(u32(at.y) * camera.size.x + u32(at.x), depth, id, away, centre);
        }
        at.x += 1;
        e += step_x;
        if at.x > box.high.x {
            at = vec2<i32>(box.low.x, at.y + 1);
            row += step_y;
            e = row;
            if at.y > box.high.y {
                break;
            }
        }
    }
}

// One half of the quad whose north-west vertex is `v`.
fn rasterize_facet(id: u32, a: vec3<i32>, b: vec3<i32>, c: vec3<i32>, v: u32, away: bool) {
    if any(vec3<i32>(a.x, b.x, c.x) == vec3<i32>(NO_PLACE)) {
        let third = v + select(CHUNK_SIDE, 1u, (id & 1u) == 1u);
        let flags = vec3<i32>(screens[v].w, screens[v + CHUNK_SIDE + 1u].w, screens[third].w);
        let seen = (flags.x & flags.y & flags.z & BESIDE) == 0;
        if ((flags.x | flags.y | flags.z) & MISSING) == 0 && seen {
            // What is clipped may lie anywhere.
            enqueue(id, vec2<i32>(camera.size));
        }
        return;
    }
    let extent = max(a.xy, max(b.xy, c.xy)) - min(a.xy, min(b.xy, c.xy));
    let t = screen_triangle(a, b, c);
    if max(extent.x, extent.y) <= LARGEST_BOX {
        rasterize_small(t, id, away);
    } else {
        let box = pixel_box(t, true);
        if all(box.low <= box.high) {
            enqueue(id, box.high - box.low);
        }
    }
}

@compute @workgroup_size(32, 2)
fn rasterize(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.seen || !in_view(bounds_of(slot)) {
        return;
    }
    let local = invocation.x * STRIP_FACETS;
    let quad = local_quad(local);
    var id = slot * CHUNK_FACETS + local;
    var v = invocation.y * CHUNK_VERTICES + quad.y * CHUNK_SIDE + quad.x;
    let bits = emitted_bits(id);
    var nw = screens[v].xyz;
    var ne = screens[v + 1u].xyz;
    for (var k = 0u; k < STRIP_FACETS; k += 2u) {
        let sw = screens[v + CHUNK_SIDE].xyz;
        let se = screens[v + CHUNK_SIDE + 1u].xyz;
        rasterize_facet(id, nw, sw, se, v, ((bits >> k) & 1u) == 1u);
        rasterize_facet(id + 1u, nw, se, ne, v, ((bits >> k) & 2u) == 2u);
        nw = sw;
        ne = se;
        v += CHUNK_SIDE;
        id += 2u;
    }
}
