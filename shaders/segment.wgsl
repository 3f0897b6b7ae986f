// Stretches of curves on their way into the list that is read back.

// A stretch of at most about a pixel, with the surface that faces the eye on its left, seen from above.
struct Segment {
    start: array<f32, 3>,   // metres from the eye
    fall: f32,              // how steeply facing falls along the view: sine of the angle between ray and stretch, below 0 concave
    end: array<f32, 3>,
    behind: f32,            // depth of what lies behind
    at: vec2<i32>,          // its middle, in walk units
    facet: u32,
    code: u32,              // which line of the facet, and which part of it
    outward: vec2<f32>,     // on the page, from the surface to what lies behind
    pixel: u32,             // of its middle, in what is drawn: column, and row in the high half
    sight: u32,             // FREE, HIDDEN, in doubt or NOT_ASKED
}

// Code of a segment. Lowest two bits: corner of the facet that faces the other way, or edge of the rim.
// The corner faces away.
const AWAY_CORNER: u32 = 4u;
const OF_RIM: u32 = 8u;
// It starts, or ends, where the line of the facet does.
const STARTS: u32 = 16u;
const ENDS: u32 = 32u;
// That is where the rim turns away.
const STARTS_TURNING: u32 = 64u;
const ENDS_TURNING: u32 = 128u;
// The rest is its number among the parts of the line.
const PART_SHIFT: u32 = 8u;
const MOST_PARTS: f32 = 65536.0;

// What is found: nothing stands before it, something does; they differ, and so says the nearest; nobody looked.
const FREE: u32 = 0u;
const HIDDEN: u32 = 1u;
const NEAREST_FREE: u32 = 2u;
const NEAREST_HIDDEN: u32 = 3u;
const NOT_ASKED: u32 = 4u;

// How steeply facing rises along the view where the surface certainly hides the segment itself.
const CONCAVE: f32 = -0.5;

@group(0) @binding(22) var<storage, read_write> out_segments: array<Segment>;
@group(0) @binding(23) var<storage, read_write> out_tally: Tally;
// Which of them are looked at.
@group(0) @binding(24) var<storage, read_write> out_asked: array<u32>;

// A line of a facet, eye-relative, with its ends on the lattice in walk units from the facet's vertex a.
struct FacetLine {
    facet: u32,
    code: u32,
    fall: f32,
    start: vec3<f32>,
    end: vec3<f32>,
    start_at: vec2<f32>,
    end_at: vec2<f32>,
}

// A place as segments hold it, and back.
fn words_of(place: vec3<f32>) -> array<f32, 3> {
    return array<f32, 3>(place.x, place.y, place.z);
}

fn place_from(words: array<f32, 3>) -> vec3<f32> {
    return vec3<f32>(words[0], words[1], words[2]);
}

// Whether all pixels about one show surface that is certainly nearer.
fn is_buried(at: vec2<i32>, depth: f32) -> bool {
    let low = max(at - 1, vec2<i32>(0));
    let high = min(at + 1, vec2<i32>(camera.size) - 1);
    var farthest = 0x7f800000u;
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            farthest = min(farthest, pixel_depth(pixels[pixel_index(vec2<i32>(x, y))]));
        }
    }
    return bitcast<f32>(farthest) > depth * NEARER;
}

// Whether a line crosses one through the centres of pixels, upright or level: there curves are looked at, at least every root
// of two pixels.
fn crosses_centres(p: vec2<f32>, q: vec2<f32>) -> bool {
    return any(floor(p - 0.5) != floor(q - 0.5));
}

fn append(segment: Segment, asks: bool) {
    let n = atomicAdd(&out_tally.segments, 1u);
    if n >= arrayLength(&out_segments) {
        return;
    }
    out_segments[n] = segment;
    if asks {
        out_asked[atomicAdd(&out_tally.asked, 1u)] = n;
    }
}

// Lists the parts of a line of a facet that are on the page and not certainly hidden, each of at most about a pixel. They are
// the same whatever piece of the page is drawn.
fn list_line(line: FacetLine) {
    let p = camera_space(line.start);
    let q = camera_space(line.end);
    if line.fall < CONCAVE || max(p.z, q.z) < scene.near {
        return;
    }
    // Shares of the line beyond the near plane.
    let from_near = select(0.0, (scene.near - p.z) / (q.z - p.z), p.z < scene.near);
    let to_near = select(1.0, (p.z - scene.near) / (p.z - q.z), q.z < scene.near);
    let near_p = mix(p, q, from_near);
    let near_q = mix(p, q, to_near);
    let a = on_paper(near_p);
    let b = on_paper(near_q);
    // Shares of what is left on the page.
    let d = b - a;
    let flat = d == vec2<f32>(0.0);
    let to_low = -a / select(d, vec2<f32>(1.0), flat);
    let to_high = (2.0 * camera.centre - a) / select(d, vec2<f32>(1.0), flat);
    let enters = select(min(to_low, to_high), vec2<f32>(0.0), flat);
    let leaves = select(max(to_low, to_high), vec2<f32>(1.0), flat);
    let from_page = max(0.0, max(enters.x, enters.y));
    let to_page = min(1.0, min(leaves.x, leaves.y));
    if from_page >= to_page && any(d != vec2<f32>(0.0)) {
        return;
    }
    let parts = clamp(ceil(length(d) * (to_page - from_page)), 1.0, MOST_PARTS);
    let f = facet_of(line.facet);
    for (var k = 0.0; k < parts; k += 1.0) {
        let shares = mix(vec3<f32>(from_page), vec3<f32>(to_page), vec3<f32>(k, k + 0.5, k + 1.0) / parts);
        let middle = mix(a, b, shares.y);
        let at = vec2<i32>(floor(middle)) - camera.origin;
        // Depth is linear on the page; shares of the line itself are not.
        let depths = mix(vec3<f32>(scene.near / near_p.z), vec3<f32>(scene.near / near_q.z), shares);
        if !on_page(at) || (!all_curves && is_buried(at, depths.y)) {
            continue;
        }
        let along = mix(vec3<f32>(from_near), vec3<f32>(to_near), shares * (scene.near / near_q.z) / depths);
        var segment: Segment;
        let starts = k == 0.0 && from_page == 0.0 && from_near == 0.0;
        let ends = k == parts - 1.0 && to_page == 1.0 && to_near == 1.0;
        segment.start = words_of(select(mix(line.start, line.end, along.x), line.start, starts));
        segment.end = words_of(select(mix(line.start, line.end, along.z), line.end, ends));
        segment.fall = line.fall;
        segment.at = vec2<i32>(f.a * UNITS) + vec2<i32>(round(mix(line.start_at, line.end_at, along.y)));
        segment.facet = line.facet;
        segment.code = line.code | (u32(k) << PART_SHIFT) | select(0u, STARTS, starts) | select(0u, ENDS, ends);
        segment.pixel = u32(at.x) | (u32(at.y) << 16u);
        segment.sight = NOT_ASKED;
        append(segment, crosses_centres(mix(a, b, shares.x), mix(a, b, shares.z)));
    }
}
