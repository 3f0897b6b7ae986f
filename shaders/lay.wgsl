// One invocation a point of a line on the land: the facet under it, where it lies on that, and whether it is to be looked at.
// Every line of the world goes this way, so that what is seen of it is decided as for contours, by `sight`. Cost: a look-up of
// the facet, and a look at the nine pixels about it. Not handled: points on the very edge of a facet.

// Points of lines by their places in walk units; those at the very north-west corner are none.
@group(0) @binding(20) var<storage, read> laid: array<vec2<i32>>;

// Code of a segment that is a point of a line on the land: no facet has such a corner. The rest is the point's number.
const LAID: u32 = 3u;

// The place on a facet's plane above a place in walk units, metres from the eye.
fn place_on(t: Corners, f: Facet, at: vec2<i32>) -> vec3<f32> {
    let b = vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) * f32(UNITS);
    let c = vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a)) * f32(UNITS);
    let p = vec2<f32>(at - vec2<i32>(f.a * UNITS));
    let area = b.x * c.y - b.y * c.x;
    return t.p + t.edge_1 * ((p.x * c.y - p.y * c.x) / area) + t.edge_2 * ((b.x * p.y - b.y * p.x) / area);
}

@compute @workgroup_size(64)
fn lay(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let k = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if k >= arrayLength(&laid) || all(laid[k] == vec2<i32>(0)) {
        return;
    }
    // On the edge of the land its facet lies on one side of the place.
    var at = laid[k];
    var id = NO_FACET;
    for (var side = 0u; side < 4u && id == NO_FACET; side++) {
        at = laid[k] - vec2<i32>(select(0, 2, (side & 1u) == 1u), select(0, 4, side >= 2u));
        id = facet_at(at);
    }
    if id == NO_FACET {
        return;
    }
    let f = facet_of(id);
    let place = place_on(corners_of(chunks[id / CHUNK_FACETS], f), f, at);
    let q = camera_space(place);
    let px = vec2<i32>(floor(on_paper(q))) - camera.origin;
    if q.z < scene.near || !on_page(px) {
        return;
    }
    var segment: Segment;
    segment.start = words_of(place);
    segment.end = segment.start;
    segment.fall = 1.0;
    segment.at = at;
    segment.facet = id;
    segment.code = LAID | (k << PART_SHIFT);
    segment.pixel = u32(px.x) | (u32(px.y) << 16u);
    // What faces away is hidden by the land before it.
    let is_hidden = is_away(id) || is_buried(px, depth_of(q));
    segment.sight = select(NOT_ASKED, HIDDEN, is_hidden);
    append(segment, !is_hidden);
}
