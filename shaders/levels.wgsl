// Walks between chunks of different levels: into which quad of the next chunk a segment comes, and what it meets among the
// facets beside a coarser chunk, some of which reach out of their quads or have collapsed.

// Walk units in a lattice step of the finest level.
const UNITS: u32 = 256u;

// The away facet a walk met and where it entered it, in walk units from the facet's vertex a.
struct Meeting {
    met: bool,
    left_land: bool,
    done: bool,
    deferred: bool,
    // Of a cut: whether it came to where it leads, in the facet of `id`.
    reached: bool,
    id: u32,
    entered: vec2<f32>,
    steps: u32,
}

fn lacks_vertex(f: Facet) -> bool {
    return is_missing(f.a) || is_missing(f.b) || is_missing(f.c);
}

// Twice the signed area between a vector and the way from one walk place to another.
fn wide_cross(v: vec2<i32>, from_place: vec2<i32>, to_place: vec2<i32>) -> vec2<u32> {
    let d = to_place - from_place;
    return wide_sub(wide_mul(v.y, d.x), wide_mul(v.x, d.y));
}

// The share of a segment at which it enters the interior of a facet; 2 where it has no part in it.
fn entry_share(f: Facet, origin: vec2<i32>, end: vec2<i32>) -> f32 {
    let corners = array<vec2<i32>, 3>(vec2<i32>(f.a * UNITS), vec2<i32>(f.b * UNITS), vec2<i32>(f.c * UNITS));
    var share = 0.0;
    var left = false;
    var right = false;
    for (var k = 0u; k < 3u; k++) {
        let p = corners[k];
        let edge = corners[(k + 1u) % 3u] - p;
        let here = wide_cross(edge, p, origin);
        let there = wide_cross(edge, p, end);
        if wide_sign(here) <= 0 && wide_sign(there) <= 0 {
            return 2.0;
        }
        if wide_sign(here) <= 0 {
            let before = -wide_f32(here);
            share = max(share, before / (before + wide_f32(there)));
        }
        let side = wide_sign(wide_cross(end - origin, origin, p));
        left = left || side < 0;
        right = right || side > 0;
    }
    return select(2.0, share, left && right);
}

// What a segment meets first among the facets of a square of two by two quads beside a coarser chunk.
fn meet_beside_coarser(slot: u32, quad: vec2<u32>, origin: vec2<i32>, end: vec2<i32>) -> Meeting {
    var meeting: Meeting;
    let chunk = chunks[slot];
    var first = 2.0;
    for (var k = 0u; k < 8u; k++) {
        let at = (quad & ~vec2<u32>(1u)) + vec2<u32>((k >> 1u) & 1u, k >> 2u);
        let id = slot * CHUNK_FACETS + quad_local(at) + (k & 1u);
        let f = chunk_facet(chunk, at, k & 1u);
        if is_collapsed(f) {
            continue;
        }
        let missing = lacks_vertex(f);
        if !missing && is_away(id) == seeks_toward {
            continue;
        }
        let share = entry_share(f, origin, end);
        if share < first {
            first = share;
            meeting.met = !missing;
            meeting.left_land = missing;
            meeting.id = id;
            meeting.entered = vec2<f32>(origin - vec2<i32>(f.a * UNITS)) + vec2<f32>(end - origin) * share;
        }
    }
    return meeting;
}

// How much later a segment meets the column line than the row line at a walk place, up to a positive factor.
fn lead_between(lines: vec2<i32>, origin: vec2<i32>, d: vec2<i32>) -> vec2<u32> {
    let to_line = select((lines - origin) * sign(d), vec2<i32>(1), d == vec2<i32>(0));
    return wide_sub(wide_mul(to_line.x, abs(d.y)), wide_mul(to_line.y, abs(d.x)));
}

// The quad of a chunk at half or twice the step into which a segment comes by a quad at `step`; and which of its lines
// it comes across.
struct Arrival {
    quad: vec2<i32>,
    crossed: vec2<bool>,
}

fn arrival(step: u32, to_step: u32, quad: vec2<i32>, crossed: vec2<bool>, origin: vec2<i32>, d: vec2<i32>) -> Arrival {
    let ahead = d > vec2<i32>(0);
    if to_step > step {
        let even = (quad & vec2<i32>(1)) == vec2<i32>(0);
        return Arrival(quad >> vec2<u32>(1u), crossed & (even == ahead));
    }
    if to_step == step {
        return Arrival(quad, crossed);
    }
    // Across a line the nearer half. Along the side quads are looked at two by two, so that either half will do, unless the
    // segment never leaves its own.
    let near = select(vec2<i32>(1), vec2<i32>(0), ahead);
    let side = i32(step * UNITS);
    let own = select(vec2<i32>(0), vec2<i32>(1), origin >= quad * side + side / 2);
    return Arrival(quad * 2 + select(near, own, d == vec2<i32>(0)), crossed);
}
