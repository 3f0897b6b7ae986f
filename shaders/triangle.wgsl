// A snapped triangle and its edge functions, as every rasterizer here sees it.

// Vertices in 1/256 px, counter-clockwise or not, with their depths.
struct Triangle {
    a: vec2<i32>,
    b: vec2<i32>,
    c: vec2<i32>,
    depth: vec3<f32>,
}

// The same triangle with positive area, `area` having the sign of its own: both sides are drawn.
fn oriented(t: Triangle, area: i32) -> Triangle {
    if area < 0 {
        return Triangle(t.a, t.c, t.b, t.depth.xzy);
    }
    return t;
}

// Pixels along a tile, of which a workgroup draws one after the other of a large facet.
const TILE: i32 = 32;

struct Box {
    low: vec2<i32>,
    high: vec2<i32>,
}

// Pixels whose centre (or, `wide`, whose square) lies in the triangle's bounding box, cut to the page.
fn pixel_box(t: Triangle, wide: bool) -> Box {
    let low = min(t.a, min(t.b, t.c));
    let high = max(t.a, max(t.b, t.c));
    let inset = select(vec2<i32>(127, 128), vec2<i32>(0, 0), wide);
    return Box(
        max((low + inset.x) >> vec2<u32>(8u), vec2<i32>(0)),
        min((high - inset.y) >> vec2<u32>(8u), vec2<i32>(camera.size) - 1),
    );
}

// Change of the function of edge p to q for a step of one unit east and one unit south.
fn edge_gradient(p: vec2<i32>, q: vec2<i32>) -> vec2<i32> {
    return vec2<i32>(p.y - q.y, q.x - p.x);
}

// What to add to an edge function so that "covered" is "not negative". Top-left rule: centres on a top or left edge
// are covered, on others not.
fn edge_bias(gradient: vec2<i32>) -> i32 {
    return select(-1, 0, gradient.x > 0 || (gradient.x == 0 && gradient.y > 0));
}

// Depth at barycentrics of b and c, never outside the triangle's own range.
fn depth_at(t: Triangle, b: f32, c: f32) -> f32 {
    let d = fma(c, t.depth.z - t.depth.x, fma(b, t.depth.y - t.depth.x, t.depth.x));
    let low = min(t.depth.x, min(t.depth.y, t.depth.z));
    let high = max(t.depth.x, max(t.depth.y, t.depth.z));
    return clamp(d, low, high);
}

// Page places in xy, depth bits in z.
fn screen_triangle(a: vec3<i32>, b: vec3<i32>, c: vec3<i32>) -> Triangle {
    return Triangle(a.xy, b.xy, c.xy, bitcast<vec3<f32>>(vec3<i32>(a.z, b.z, c.z)));
}
