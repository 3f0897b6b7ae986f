// One invocation a pixel with pairs that `walk` has left: with neighbours that show no surface, or with a walk past
// squares that lack facets or past facets beside a coarser chunk, or that meets a facet which the page shows elsewhere, or under
// which the surface does not turn away. Where the page shows it elsewhere or no surface, the cut of the land is followed too.
//
// Where the straight way to a pixel without surface meets nothing, the cut of the surface by the plane through the eye and
// both pixels is followed: land as thin as a pixel turns away beside that way, and a straight way along its flank never
// rounds it. An away facet on the cut inks the pixel where it lies behind the toward one before it; one that lies before it is
// an underside, seen through a void or past the border, and hides the edge between the two.
//
// Where both pixels show land, the straight way from a flank to one beside it may cross land that turns away far above, as on a
// needle. The page shows it elsewhere, and the cut decides: where it reaches the facet that the other pixel shows over toward
// ones, no line parts the two.
//
// A facet may turn away where the surface that it stands for does not: seen nearly edge-on, and on land whose samples are rounded,
// there are islands of such facets. Few about it in its chunk face away then, and the surface under it is looked at four times as
// fine. Where nothing of it turns away and the stretch is short and hides next to nothing, the way goes on: tangent to the sight
// for 8 km F .975 to .998, on Yosemite's cliffs precision .991 to .994 at the same recall.
//
// Cost: at most 256 facets a pair; in a plain seen edge-on against the sky, all of them. Not handled: land that takes more
// facets than that to turn away within a pixel, and pairs that both show land whose straight way meets nothing, so that
// the foot of a spire may lack ink for a few pixels before land beside it.

@group(0) @binding(25) var<storage, read> rest: ListRead;

// Where the map projection of a page place's ray leaves the DEM, in walk units; `origin` where it never meets it.
fn map_exit(px: vec2<f32>, origin: vec2<i32>) -> vec2<i32> {
    let ray = ray_through(px).xy * vec2<f32>(1.0, -1.0);
    let eye = vec2<f32>(1.0, -1.0) * camera.eye_offset / scene.cell;
    let low = vec2<f32>(-camera.eye_cell) - eye;
    let high = vec2<f32>(vec2<i32>(scene.samples - 1u) - camera.eye_cell) - eye;
    let heading = ray / scene.cell;
    let exits = select(high, low, heading < vec2<f32>(0.0)) / heading;
    let entries = select(low, high, heading < vec2<f32>(0.0)) / heading;
    let exit = min(select(exits.x, 1e30, heading.x == 0.0), select(exits.y, 1e30, heading.y == 0.0));
    let entry = max(select(entries.x, -1e30, heading.x == 0.0), select(entries.y, -1e30, heading.y == 0.0));
    if exit <= max(entry, 0.0) || exit >= 1e30 {
        return origin;
    }
    let end = clamp(heading * exit, low, high) - low;
    return vec2<i32>(round(end * f32(CELL_STEPS * UNITS)));
}

// Snapping moves a rim by up to 1/256 px: a pixel without surface may have its centre on the land by that much. The way
// to it is aimed beyond its centre by this share.
const OVERSHOOT: f32 = 1.0 / 64.0;

fn ray_beyond(centre: vec2<f32>, to_centre: vec2<f32>) -> vec3<f32> {
    return ray_through(to_centre + (to_centre - centre) * OVERSHOOT);
}

// Where a walk ends, and whether it then follows the ray of the pixel it leads to.
struct Goal {
    at: vec2<i32>,
    goes_on: bool,
}

// The way to a pixel without surface. It leads to where that pixel's ray meets the plane of the facet at `origin`: if the
// land ends on the way there, the pixels are parted by a rim, no silhouette. If that place is farther than the facet, the
// ray has the land below it so far, and the way goes on under the ray to the edge of the map. If it is nearer, the ray
// passes under the land behind.
fn open_goal(id: u32, centre: vec2<f32>, to_centre: vec2<f32>, origin: vec2<i32>) -> Goal {
    let f = facet_of(id);
    let t = corners_of(chunks[id / CHUNK_FACETS], f);
    let normal = cross(t.edge_1, t.edge_2);
    let ray = ray_beyond(centre, to_centre);
    if dot(normal, ray) >= 0.0 {
        return Goal(map_exit(to_centre, origin), false);
    }
    let w = volumes(t, ray);
    let sum = w.x + w.y + w.z;
    // In walk units, times `sum`, which may be next to nothing.
    let d = vec2<f32>(vec2<i32>(f.a * UNITS) - origin) * sum + from_a(f, w.yz) * f32(UNITS);
    // No farther than one cell beyond the edge of the map.
    let cell = i32(CELL_STEPS * UNITS);
    let room = vec2<f32>(select(vec2<i32>(scene.samples) * cell - origin, origin + cell, d < vec2<f32>(0.0)));
    let reach = select(vec2<f32>(1e30), room / abs(d), abs(d) * 1e30 > room);
    let at = origin + vec2<i32>(round(d * min(1.0 / sum, min(reach.x, reach.y))));
    let px = (to_centre - centre) / camera.focal;
    return Goal(at, dot(normal, camera.right.xyz * px.x - camera.up.xyz * px.y) >= 0.0);
}

// What an away stretch of at most `SEEN_TOWARD` nodes may lead back on the page and hide next to nothing, px.
const LEAST_HIDDEN: f32 = 0.02;
// The so-manieth such stretch on a way counts as one that hides.
const MOST_STRETCHES: u32 = 4u;

// Where on the map a meeting is, a little on along the way.
fn beyond_entry(meeting: Meeting, d: vec2<i32>) -> vec2<i32> {
    let on = normalize(vec2<f32>(d)) * 1.5;
    return vec2<i32>(facet_of(meeting.id).a * UNITS) + vec2<i32>(round(meeting.entered + on));
}

// The way on the page that a facet faces.
fn page_normal(id: u32) -> vec2<f32> {
    let t = corners_of(chunks[id / CHUNK_FACETS], facet_of(id));
    let normal = cross(t.edge_1, t.edge_2);
    let on_page = vec2<f32>(dot(normal, camera.right.xyz), -dot(normal, camera.up.xyz));
    return on_page / max(length(on_page), 1e-30);
}

// The first away facet between two points that is in no doubt, or under which the surface turns away too, or behind which the way
// leads back on the page.
fn turn_between(origin: vec2<i32>, end: vec2<i32>) -> Meeting {
    var start = origin;
    var meeting: Meeting;
    for (var k = 0u; k < MOST_STRETCHES; k++) {
        meeting = walk_between(start, end);
        if !meeting.met || !is_in_doubt(meeting.id) || surface_turns(meeting.id) {
            break;
        }
        seeks_toward = true;
        let beyond = walk_between(beyond_entry(meeting, end - start), end);
        seeks_toward = false;
        let back = place_of(meeting.id, meeting.entered) - place_of(beyond.id, beyond.entered);
        let hides_little = dot(back, page_normal(meeting.id)) <= LEAST_HIDDEN;
        if !beyond.met || !hides_little {
            break;
        }
        start = beyond_entry(beyond, end - start);
    }
    return meeting;
}

// What the cut of the surface from a pixel meets before a ray.
fn cut_between(id: u32, centre: vec2<f32>, ray: vec3<f32>) -> Meeting {
    let t = corners_of(chunks[id / CHUNK_FACETS], facet_of(id));
    let w = hit_weights(t, centre);
    return follow_section(id, t.p + t.edge_1 * w.y + t.edge_2 * w.z, ray);
}

// Inks the nearer pixel of a pair if the walk to the farther one, or the cut, meets an away facet. Says how far it walked.
fn walk_pair(one: vec2<i32>, other: vec2<i32>) -> u32 {
    let first = pixels[pixel_index(one)];
    let second = pixels[pixel_index(other)];
    let swapped = is_behind(first, second);
    let p = select(first, second, swapped);
    let q = select(second, first, swapped);
    let at = select(one, other, swapped);
    let centre = centre_of(at);
    let to_centre = centre_of(select(other, one, swapped));
    let origin = facet_hit(p.x - 1u, centre);
    let to_open = q.y == 0u || is_away(q.x - 1u);
    var goal: Goal;
    if to_open {
        goal = open_goal(p.x - 1u, centre, to_centre, origin);
    } else {
        goal = Goal(facet_hit(q.x - 1u, to_centre), false);
    }
    var meeting: Meeting;
    var start = origin;
    var longest = 0u;
    var by_rim = false;
    for (var leg = 0u; leg < select(1u, 2u, goal.goes_on); leg++) {
        meeting = turn_between(start, goal.at);
        longest = max(longest, meeting.steps);
        check_done(meeting);
        if meeting.met || meeting.left_land {
            by_rim = meeting.left_land && leg == 0u;
            break;
        }
        start = goal.at;
        goal.at = map_exit(to_centre, start);
    }
    if to_open && !meeting.met && !by_rim {
        meeting = cut_between(p.x - 1u, centre, ray_beyond(centre, to_centre));
        longest = max(longest, meeting.steps);
        check_done(meeting);
    } else if !to_open && meeting.met && is_elsewhere(offset_of(at, meeting)) {
        let cut = cut_between(p.x - 1u, centre, ray_through(to_centre));
        longest = max(longest, cut.steps);
        meeting.met = !(cut.reached && cut.id == q.x - 1u);
        if cut.met {
            meeting = cut;
        }
    }
    if meeting.met {
        ink(at, offset_of(at, meeting));
    }
    return longest;
}

@compute @workgroup_size(64)
fn walk_rest(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var longest = 0u;
    for (var k = invocation.x; k < rest.count; k += groups.x * 64u) {
        let item = rest.pixels[k];
        let at = listed_place(item);
        for (var left = listed_neighbours(item); left != 0u; left &= left - 1u) {
            longest = max(longest, walk_pair(at, at + neighbour(firstTrailingBit(left))));
        }
    }
    atomicMax(&out_counts.longest_walk, longest);
}
