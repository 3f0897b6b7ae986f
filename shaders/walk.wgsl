// One invocation a pixel with open pairs: of each pair with a neighbour, walks the lattice from the nearer pixel's point on
// the surface to the farther one's, facet by facet, in integers. An away facet on the way makes the nearer one ink; a
// void or the outside ends the walk.

struct Pairs {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    pixels: array<u32>,
}

@group(0) @binding(21) var<storage, read> pairs: Pairs;
@group(0) @binding(22) var<storage, read_write> out_ink: array<atomic<u32>>;
@group(0) @binding(23) var<storage, read_write> out_counts: Counts;

// Walk units in a lattice step of the finest level.
const UNITS: u32 = 256u;

// A facet as a point and two edges, metres, eye-relative.
struct Corners {
    p: vec3<f32>,
    edge_1: vec3<f32>,
    edge_2: vec3<f32>,
}

fn corners_of(f: Facet) -> Corners {
    let cell = f.origin / CELL_STEPS;
    let sub = f.origin % CELL_STEPS;
    let patch_here = patch_of(cell, patch_half(f) == 1u);
    let scale = 1.0 / f32(CELL_STEPS);
    let a = patch_point(patch_here, vec2<f32>(sub) * scale);
    let b = patch_point(patch_here, vec2<f32>(sub + corner(f.half, 1u) * f.step) * scale);
    let c = patch_point(patch_here, vec2<f32>(sub + corner(f.half, 2u) * f.step) * scale);
    return Corners(eye_relative(cell, vec4<f32>(a, patch_here.height)), b - a, c - a);
}

// Volumes that a ray spans with the edges of a facet: up to scale the perspective-correct barycentrics of where it
// meets the facet's plane, whatever lies behind the eye.
fn volumes(t: Corners, ray: vec3<f32>) -> vec3<f32> {
    let w = vec3<f32>(
        dot(ray, cross(t.p + t.edge_1, t.edge_2 - t.edge_1)),
        dot(ray, cross(t.edge_2, t.p)),
        dot(ray, cross(t.p, t.edge_1)),
    );
    return select(w, -w, w.x + w.y + w.z < 0.0);
}

// Where the ray through a page place meets a facet, clamped to the facet, in walk units.
fn facet_hit(id: u32, px: vec2<f32>) -> vec2<i32> {
    let f = facet_of(id);
    var w = max(volumes(corners_of(f), ray_through(px)), vec3<f32>(0.0));
    let sum = w.x + w.y + w.z;
    w = select(w / sum, vec3<f32>(1.0, 0.0, 0.0), sum == 0.0);
    let along = vec2<f32>(corner(f.half, 1u)) * w.y + vec2<f32>(corner(f.half, 2u)) * w.z;
    return vec2<i32>(f.origin * UNITS) + vec2<i32>(round(along * f32(f.step * UNITS)));
}

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
    let t = corners_of(f);
    let normal = cross(t.edge_1, t.edge_2);
    let ray = ray_through(to_centre + (to_centre - centre) * OVERSHOOT);
    if dot(normal, ray) >= 0.0 {
        return Goal(map_exit(to_centre, origin), false);
    }
    let w = volumes(t, ray);
    let sum = w.x + w.y + w.z;
    let along = vec2<f32>(corner(f.half, 1u)) * w.y + vec2<f32>(corner(f.half, 2u)) * w.z;
    // In walk units, times `sum`, which may be next to nothing.
    let d = vec2<f32>(vec2<i32>(f.origin * UNITS) - origin) * sum + along * f32(f.step * UNITS);
    // No farther than one cell beyond the edge of the map.
    let cell = i32(CELL_STEPS * UNITS);
    let room = vec2<f32>(select(vec2<i32>(scene.samples) * cell - origin, origin + cell, d < vec2<f32>(0.0)));
    let reach = select(vec2<f32>(1e30), room / abs(d), abs(d) * 1e30 > room);
    let at = origin + vec2<i32>(round(d * min(1.0 / sum, min(reach.x, reach.y))));
    let px = (to_centre - centre) / camera.focal;
    return Goal(at, dot(normal, camera.right.xyz * px.x - camera.up.xyz * px.y) >= 0.0);
}

// The away facet a walk met and where it entered it, in quads from the facet's north-west vertex.
struct Meeting {
    met: bool,
    left_land: bool,
    done: bool,
    facet: Facet,
    entered: vec2<f32>,
    steps: u32,
}

// How the segment stands in a quad or passes its side: half 0 (south-west) or 1 (north-east) of the quad.
fn half_at(z: i32, direction_z: i32) -> u32 {
    return select(select(0u, 1u, z > 0), select(0u, 1u, direction_z > 0), z == 0);
}

// Half of a quad next to the side, or corner, through which direction `d` leads into it.
fn half_behind(crossed: vec2<bool>, d: vec2<i32>) -> u32 {
    let a = abs(d);
    if all(crossed) && (d.x > 0) == (d.y > 0) {
        return select(0u, 1u, (a.x > a.y) == (d.x > 0));
    }
    return select(select(0u, 1u, d.y > 0), select(0u, 1u, d.x < 0), crossed.x);
}

// Which patch of its cell a facet lies in.
fn patch_half(f: Facet) -> u32 {
    let sub = f.origin % CELL_STEPS;
    return select(0u, 1u, sub.x > sub.y || (sub.x == sub.y && f.half == 1u));
}

fn is_missing(f: Facet) -> bool {
    let cell = vec2<i32>(f.origin / CELL_STEPS);
    return !patch_exists(cell.x, cell.y, patch_half(f));
}

// Walks from one point to another in walk units.
fn walk_between(origin: vec2<i32>, end: vec2<i32>) -> Meeting {
    var meeting: Meeting;
    meeting.met = false;
    meeting.left_land = false;
    meeting.done = true;
    meeting.steps = 0u;
    let d = end - origin;
    let a = vec2<u32>(abs(d));
    let shift = vec2<u32>(firstTrailingBit(scene.step * UNITS));
    let side = i32(scene.step * UNITS);
    // Along a lattice line the segment meets the interior of no facet.
    if (d.x == 0 && origin.x % side == 0) || (d.y == 0 && origin.y % side == 0)
        || (d.x == d.y && (origin.x - origin.y) % side == 0) {
        return meeting;
    }
    let heading = sign(d);
    var quad = select(origin, origin - 1, d < vec2<i32>(0)) >> shift;
    let last = select(select(end, end - 1, d > vec2<i32>(0)) >> shift, quad, d == vec2<i32>(0));
    var left = vec2<u32>(abs(last - quad));
    let start = origin - (quad << shift);
    let finish = end - (last << shift);
    let to_line = select(select(start, side - start, d > vec2<i32>(0)), vec2<i32>(1), d == vec2<i32>(0));
    // Sign of `lead`: whether the next column line (-) or the next row line (+) is met first.
    var lead = wide_sub(wide_mul_u32(u32(to_line.x), a.y), wide_mul_u32(u32(to_line.y), a.x));
    let per_column = wide_mul_u32(u32(side), a.y);
    let per_row = wide_mul_u32(u32(side), a.x);
    // Some drivers end a loop that takes too long: then this stays false.
    meeting.done = false;
    var entry = half_at(start.x - start.y, d.x - d.y);
    var crossed = vec2<bool>(false);
    loop {
        meeting.steps += 1u;
        let slot = slot_of(quad);
        if slot == NO_SLOT {
            meeting.left_land = true;
            meeting.done = true;
            break;
        }
        let inner = vec2<u32>(quad) & vec2<u32>(CHUNK_QUADS - 1u);
        let block = (inner.y >> 3u) * 4u + (inner.x >> 3u);
        let summary = summaries[slot];
        let eventful = ((summary >> block) & 0x10001u) != 0u;
        // Leap over a chunk or a block where nothing can happen.
        let node = select(select(8u, 1u, eventful || !thrifty), CHUNK_QUADS, summary == 0u && thrifty);
        let in_node = vec2<u32>(quad) & vec2<u32>(node - 1u);
        let to_side = select(in_node + 1u, node - in_node, d > vec2<i32>(0));
        let column_end = wide_add(lead, wide_scale(per_column, to_side.x - 1u));
        let first = wide_sign(wide_sub(column_end, wide_scale(per_row, to_side.y - 1u)));
        let leaves = vec2<bool>(first <= 0, first >= 0);
        let ends = any(leaves & (to_side > left));
        if eventful {
            var exit = half_behind(leaves, -d);
            if ends {
                exit = half_at(finish.x - finish.y, d.y - d.x);
            }
            let word = slot * CHUNK_FACETS + quad_local(inner);
            var half = entry;
            var through = crossed;
            loop {
                let f = Facet(vec2<u32>(quad) * scene.step, scene.step, half);
                if is_missing(f) {
                    meeting.left_land = true;
                    meeting.done = true;
                    return meeting;
                }
                if is_away(word + half) {
                    meeting.met = true;
                    meeting.done = true;
                    meeting.facet = f;
                    meeting.entered = entry_point(origin - (quad << shift), d, through, half != entry);
                    return meeting;
                }
                if half == exit {
                    break;
                }
                half = exit;
            }
        }
        if ends {
            meeting.done = true;
            break;
        }
        // Lines of the other direction met on the way to the node's side.
        var steps = to_side;
        crossed = leaves;
        if !all(leaves) {
            var ahead = column_end;
            var cost = per_row;
            if leaves.y {
                ahead = wide_sub(wide_scale(per_row, to_side.y - 1u), lead);
                cost = per_column;
            }
            var count = 0u;
            for (var k = node >> 1u; k > 0u; k >>= 1u) {
                if wide_sign(wide_sub(ahead, wide_scale(cost, count + k - 1u))) >= 0 {
                    count += k;
                }
            }
            let at_corner = count > 0u && wide_sign(wide_sub(ahead, wide_scale(cost, count - 1u))) == 0;
            steps = select(vec2<u32>(count, to_side.y), vec2<u32>(to_side.x, count), leaves.x);
            crossed = leaves | vec2<bool>(at_corner);
        }
        quad += heading * vec2<i32>(steps);
        left -= steps;
        lead = wide_sub(wide_add(lead, wide_scale(per_column, steps.x)), wide_scale(per_row, steps.y));
        entry = half_behind(crossed, d);
    }
    return meeting;
}

// Where a segment that starts at `start` (relative to the quad's north-west vertex, walk units) entered a quad
// through a side, or its second half through the diagonal; in quads.
fn entry_point(start: vec2<i32>, d: vec2<i32>, crossed: vec2<bool>, by_diagonal: bool) -> vec2<f32> {
    let side = f32(scene.step * UNITS);
    let s = vec2<f32>(start);
    let v = vec2<f32>(d);
    var t = 0.0;
    if by_diagonal {
        t = (s.y - s.x) / (v.x - v.y);
    } else if crossed.x {
        t = (select(side, 0.0, d.x > 0) - s.x) / v.x;
    } else if crossed.y {
        t = (select(side, 0.0, d.y > 0) - s.y) / v.y;
    }
    return clamp((s + v * t) / side, vec2<f32>(0.0), vec2<f32>(1.0));
}

// Page place in pixels of a point of a facet given in quads from its quad's north-west vertex.
fn place_of(f: Facet, at: vec2<f32>) -> vec2<f32> {
    let t = corners_of(f);
    let se = min(at.x, at.y);
    let other = abs(at.x - at.y);
    let weights = select(vec2<f32>(other, se), vec2<f32>(se, other), f.half == 1u);
    let q = camera_space(t.p + t.edge_1 * weights.x + t.edge_2 * weights.y);
    return vec2<f32>(q.x, -q.y) * (camera.focal / q.z) + camera.centre;
}

// Inks the nearer pixel of a pair if the walk to the farther one meets an away facet. Says how far it walked.
fn walk_pair(one: vec2<i32>, other: vec2<i32>) -> u32 {
    let first = pixels[pixel_index(one)];
    let second = pixels[pixel_index(other)];
    // Equal depth: the lower ID is nearer.
    let swapped = second.y > first.y || (second.y == first.y && second.x < first.x);
    let p = select(first, second, swapped);
    let q = select(second, first, swapped);
    if p.x == 0u || is_away(p.x - 1u) {
        return 0u;
    }
    let at = select(one, other, swapped);
    let centre = vec2<f32>(at + camera.origin) + 0.5;
    let to_centre = vec2<f32>(select(other, one, swapped) + camera.origin) + 0.5;
    let origin = facet_hit(p.x - 1u, centre);
    var goal: Goal;
    if q.y == 0u || is_away(q.x - 1u) {
        goal = open_goal(p.x - 1u, centre, to_centre, origin);
    } else {
        goal = Goal(facet_hit(q.x - 1u, to_centre), false);
    }
    var meeting: Meeting;
    var start = origin;
    var longest = 0u;
    for (var legs = select(1u, 2u, goal.goes_on); legs > 0u; legs--) {
        meeting = walk_between(start, goal.at);
        longest = max(longest, meeting.steps);
        if !meeting.done {
            atomicAdd(&out_counts.cut_short, 1u);
        }
        if meeting.met || meeting.left_land {
            break;
        }
        start = goal.at;
        goal.at = map_exit(to_centre, start);
    }
    if meeting.met {
        // Of the walks that ink a pixel, the one whose line runs nearest to its centre gives the place.
        atomicMax(&out_ink[pixel_index(at)], silhouette_at(place_of(meeting.facet, meeting.entered) - centre));
    }
    return longest;
}

@compute @workgroup_size(64)
fn walk(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var longest = 0u;
    for (var k = invocation.x; k < pairs.count; k += groups.x * 64u) {
        let i = pairs.pixels[k] & 0xffffffu;
        let at = vec2<i32>(vec2<u32>(i % camera.size.x, i / camera.size.x));
        for (var left = pairs.pixels[k] >> 24u; left != 0u; left &= left - 1u) {
            longest = max(longest, walk_pair(at, at + neighbour(firstTrailingBit(left))));
        }
    }
    atomicMax(&out_counts.longest_walk, longest);
}
