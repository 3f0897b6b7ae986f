// The cut of the surface by the plane through the eye and two places on the page, facet by facet across their edges. Where
// the land is about as thin as a pixel, the straight way on the lattice may lead along its flank and never round it. The cut
// does not: on toward facets it goes on along the page, so that it has turned away or ended before a place without surface.

const NO_FACET: u32 = 0xffffffffu;
// Facets that a cut is followed over at most: some two cells of them at the finest level, more cells at coarser ones. What
// takes longer, as a plain seen edge-on, the straight way alone decides.
const LONGEST_SECTION: u32 = 4u * CELL_STEPS;

// Whether a place in walk units lies inside a facet.
fn holds(f: Facet, at: vec2<i32>) -> bool {
    let corners = array<vec2<i32>, 3>(vec2<i32>(f.a * UNITS), vec2<i32>(f.b * UNITS), vec2<i32>(f.c * UNITS));
    var inside = true;
    for (var k = 0u; k < 3u; k++) {
        inside = inside && wide_sign(wide_cross(corners[(k + 1u) % 3u] - corners[k], corners[k], at)) > 0;
    }
    return inside;
}

// The facet around a place in walk units that lies on no edge. Beside a coarser chunk a facet may reach out of its quad, not
// out of the two by two quads around it.
fn facet_at(at: vec2<i32>) -> u32 {
    let slot = slot_at(at >> vec2<u32>(firstTrailingBit(UNITS)));
    if slot == NO_SLOT {
        return NO_FACET;
    }
    let chunk = chunks[slot];
    let quad = (vec2<u32>(at) / UNITS - chunk.origin) >> vec2<u32>(firstTrailingBit(chunk.step));
    let seam = beside_coarser(chunk.coarser, quad);
    let first = select(quad, quad & ~vec2<u32>(1u), seam);
    for (var k = 0u; k < select(2u, 8u, seam); k++) {
        let beside = first + vec2<u32>((k >> 1u) & 1u, k >> 2u);
        let f = chunk_facet(chunk, beside, k & 1u);
        if !is_collapsed(f) && holds(f, at) {
            return select(slot * CHUNK_FACETS + quad_local(beside) + (k & 1u), NO_FACET, lacks_vertex(f));
        }
    }
    return NO_FACET;
}

// The facet beyond the edge from vertex k of a facet to the next: around a place a little beyond the edge's middle.
fn facet_beyond(f: Facet, k: u32) -> u32 {
    let corners = array<vec2<i32>, 3>(vec2<i32>(f.a * UNITS), vec2<i32>(f.b * UNITS), vec2<i32>(f.c * UNITS));
    let middle = corners[k] + (corners[(k + 1u) % 3u] - corners[k]) / 2;
    return facet_at(middle + (middle - corners[(k + 2u) % 3u]) / 64);
}

// A vertex in metres from the eye: the same bits in whichever facet of a chunk.
fn eye_vertex(chunk: Chunk, at: vec2<u32>) -> vec3<f32> {
    return eye_relative(at / CELL_STEPS, place_in(chunk, at));
}

// Whether an away facet beyond an edge of a toward one, which leads from vertex k, lies behind it. Else it lies before it: an
// underside, seen from outside, that hides the edge.
fn folds_back(t: Corners, k: u32, beyond: u32) -> bool {
    let other = corners_of(chunks[beyond / CHUNK_FACETS], facet_of(beyond));
    let corners = array<vec3<f32>, 3>(vec3<f32>(0.0), t.edge_1, t.edge_2);
    let edge = corners[(k + 1u) % 3u] - corners[k];
    return dot(cross(cross(t.edge_1, t.edge_2), cross(other.edge_1, other.edge_2)), edge) > 0.0;
}

// Follows the cut from a point of a toward facet, metres from the eye, toward a ray: what it meets before the ray.
fn follow_section(first: u32, origin: vec3<f32>, ray: vec3<f32>) -> Meeting {
    let across = cross(origin, ray);
    let ahead = cross(across, ray);
    var meeting: Meeting;
    var id = first;
    while !meeting.done {
        meeting.steps += 1u;
        let f = facet_of(id);
        let chunk = chunks[id / CHUNK_FACETS];
        let at = array<vec2<u32>, 3>(f.a, f.b, f.c);
        let p = array<vec3<f32>, 3>(eye_vertex(chunk, f.a), eye_vertex(chunk, f.b), eye_vertex(chunk, f.c));
        let sides = vec3<f32>(dot(across, p[0]), dot(across, p[1]), dot(across, p[2]));
        // Counter-clockwise on the page, the edge ahead leads from the right of the cut to its left.
        let right = sides >= vec3<f32>(0.0);
        let leaves = right & !right.yzx;
        let k = select(select(2u, 1u, leaves.y), 0u, leaves.x);
        let share = sides[k] / (sides[k] - sides[(k + 1u) % 3u]);
        let is_ahead = dot(ahead, mix(p[k], p[(k + 1u) % 3u], share)) > 0.0;
        if !any(leaves) || is_ahead {
            meeting.reached = any(leaves) && is_ahead;
            meeting.id = id;
            meeting.done = true;
            break;
        }
        id = facet_beyond(f, k);
        meeting.left_land = id == NO_FACET;
        let turned = !meeting.left_land && is_away(id);
        meeting.met = turned && folds_back(corners_of(chunk, f), k, id);
        meeting.done = meeting.left_land || turned || meeting.steps == LONGEST_SECTION;
        if meeting.met {
            let edge = vec2<f32>(vec2<i32>(at[(k + 1u) % 3u]) - vec2<i32>(at[k]));
            meeting.id = id;
            meeting.entered = (vec2<f32>(vec2<i32>(at[k]) - vec2<i32>(facet_of(id).a)) + edge * share) * f32(UNITS);
        }
    }
    return meeting;
}
