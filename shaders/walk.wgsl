// One invocation a pixel with open pairs: of each pair with a neighbour, walks the lattice from the nearer pixel's point on
// the surface to the farther one's, facet by facet, in integers. An away facet on the way makes the nearer one ink; a
// void or the outside ends the walk. Pairs with a pixel without surface, and walks past squares that lack facets or past
// facets beside a coarser chunk, are rare and left to `walk_rest`: drivers that run both sides of every branch pay for
// them here.

@group(0) @binding(21) var<storage, read> pairs: ListRead;
@group(0) @binding(22) var<storage, read_write> out_ink: array<atomic<u32>>;
@group(0) @binding(23) var<storage, read_write> out_counts: Counts;
@group(0) @binding(24) var<storage, read_write> out_rest: List;

// Whether what is rare is left to another pass.
override defers: bool = true;

// A facet as a point and two edges, metres, eye-relative.
struct Corners {
    p: vec3<f32>,
    edge_1: vec3<f32>,
    edge_2: vec3<f32>,
}

fn corners_of(chunk: Chunk, f: Facet) -> Corners {
    let a = place_in(chunk, f.a);
    let b = place_in(chunk, f.b);
    let c = place_in(chunk, f.c);
    return Corners(eye_relative(f.a / CELL_STEPS, a), edge_between(f.a, a, f.b, b), edge_between(f.a, a, f.c, c));
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

// Lattice units from vertex a of a facet for barycentrics of b and c.
fn from_a(f: Facet, w: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) * w.x + vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a)) * w.y;
}

// Where the ray through a page place meets a facet, clamped to the facet, in walk units.
fn facet_hit(id: u32, px: vec2<f32>) -> vec2<i32> {
    let f = facet_of(id);
    var w = max(volumes(corners_of(chunks[id / CHUNK_FACETS], f), ray_through(px)), vec3<f32>(0.0));
    let sum = w.x + w.y + w.z;
    w = select(w / sum, vec3<f32>(1.0, 0.0, 0.0), sum == 0.0);
    return vec2<i32>(f.a * UNITS) + vec2<i32>(round(from_a(f, w.yz) * f32(UNITS)));
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

// Whether a half of a quad, which no coarser chunk is beside, is no facet.
fn is_no_facet(chunk: Chunk, quad: vec2<u32>, half: u32) -> bool {
    let at = chunk.origin + quad * chunk.step;
    let cell = vec2<i32>(at / CELL_STEPS);
    let sub = at % CELL_STEPS;
    let patch_half = select(0u, 1u, sub.x > sub.y || (sub.x == sub.y && half == 1u));
    // Coarser chunks have no voids, but some reach beyond the DEM.
    let beyond = any(at + chunk.step > (scene.samples - 1u) * CELL_STEPS);
    return beyond || (chunk.step <= CELL_STEPS && !patch_exists(cell.x, cell.y, patch_half));
}

// Whether some facet of a quad reaches out of it or has collapsed, for the coarser chunk beside it.
fn beside_coarser(coarser: u32, quad: vec2<u32>) -> bool {
    let first = quad == vec2<u32>(0u);
    let last = quad == vec2<u32>(CHUNK_QUADS - 1u);
    return (first.y && (coarser & NORTH) != 0u) || (last.y && (coarser & SOUTH) != 0u)
        || (first.x && (coarser & WEST) != 0u) || (last.x && (coarser & EAST) != 0u);
}

// Whether a segment runs along a line of the lattice: there it meets the interior of no facet.
fn runs_along_line(side: i32, origin: vec2<i32>, d: vec2<i32>) -> bool {
    return (d.x == 0 && origin.x % side == 0) || (d.y == 0 && origin.y % side == 0)
        || (d.x == d.y && (origin.x - origin.y) % side == 0);
}

// Walks from one point to another in walk units.
fn walk_between(origin: vec2<i32>, end: vec2<i32>) -> Meeting {
    var meeting: Meeting;
    // Some drivers end a loop that takes too long: then this stays false.
    meeting.done = false;
    let d = end - origin;
    let heading = sign(d);
    // On a line the quad ahead of it, on the last line of the map the one before.
    let limit = vec2<i32>((scene.samples - 1u) * (CELL_STEPS * UNITS));
    let first = select(origin, origin - 1, (d < vec2<i32>(0)) | ((d == vec2<i32>(0)) & (origin == limit)));
    var slot = slot_at(first >> vec2<u32>(firstTrailingBit(UNITS)));
    var quad = first;
    var step = 1u;
    var crossed = vec2<bool>(false);
    var steps = 0u;
    // Chunk by chunk.
    loop {
        if slot == NO_SLOT || all(d == vec2<i32>(0)) {
            meeting.left_land = slot == NO_SLOT;
            meeting.done = true;
            break;
        }
        let chunk = chunks[slot];
        let side = i32(chunk.step * UNITS);
        let shift = vec2<u32>(firstTrailingBit(chunk.step * UNITS));
        if steps == 0u {
            quad = first >> shift;
        } else {
            let to = arrival(step, chunk.step, quad, crossed, origin, d);
            quad = to.quad;
            crossed = to.crossed;
        }
        step = chunk.step;
        let along = runs_along_line(side, origin, d);
        let summary = summaries[slot];
        let start = origin - (quad << shift);
        var entry = select(half_behind(crossed, d), half_at(start.x - start.y, d.x - d.y), steps == 0u);
        let last = select(select(end, end - 1, d > vec2<i32>(0)) >> shift, quad, d == vec2<i32>(0));
        var left = vec2<u32>(abs(last - quad));
        // Its sign: whether the next column line (-) or the next row line (+) is met first.
        let lines = (quad + select(vec2<i32>(0), vec2<i32>(1), d > vec2<i32>(0))) << shift;
        var lead = lead_between(lines, origin, d);
        let per_column = wide_mul_u32(u32(side), u32(abs(d.y)));
        let per_row = wide_mul_u32(u32(side), u32(abs(d.x)));
        let chunk_at = quad >> vec2<u32>(firstTrailingBit(CHUNK_QUADS));
        // Node by node: leaps over a chunk or a square where nothing can happen.
        loop {
            steps += 1u;
            let inner = vec2<u32>(quad) & vec2<u32>(CHUNK_QUADS - 1u);
            let square = square_of(inner);
            let eventful = ((summary >> square) & 0x10001u) != 0u;
            let node = select(select(4u, 1u, eventful || !thrifty), CHUNK_QUADS, summary == 0u && thrifty);
            let in_node = inner & vec2<u32>(node - 1u);
            let to_side = select(in_node + 1u, node - in_node, d > vec2<i32>(0));
            let column_end = wide_add(lead, wide_scale(per_column, to_side.x - 1u));
            let order = wide_sign(wide_sub(column_end, wide_scale(per_row, to_side.y - 1u)));
            let leaves = vec2<bool>(order <= 0, order >= 0);
            let ends = any(leaves & (to_side > left));
            let seam = beside_coarser(chunk.coarser, inner);
            if defers && ((eventful && seam) || ((summary >> square) & 0x10000u) != 0u) {
                meeting.deferred = true;
                meeting.done = true;
                break;
            }
            if !defers && eventful && seam {
                let met = meet_beside_coarser(slot, inner, origin, end);
                if met.met || met.left_land {
                    meeting = met;
                    meeting.done = true;
                    break;
                }
            }
            if eventful && !seam && !along {
                let at_end = end - (quad << shift);
                let exit = select(half_behind(leaves, -d), half_at(at_end.x - at_end.y, d.y - d.x), ends);
                let id = slot * CHUNK_FACETS + quad_local(inner);
                let away = away_bits(id);
                let entry_away = ((away >> entry) & 1u) == 1u;
                let entry_missing = !defers && is_no_facet(chunk, inner, entry);
                let exit_missing = !defers && is_no_facet(chunk, inner, exit);
                if entry_away || entry_missing || exit_missing || ((away >> exit) & 1u) == 1u {
                    meeting.left_land = entry_missing || (!entry_away && exit_missing);
                    meeting.met = !meeting.left_land;
                    meeting.id = id + select(exit, entry, entry_away);
                    let by_diagonal = !entry_away && exit != entry;
                    meeting.entered = entry_point(origin - (quad << shift), d, f32(side), crossed, by_diagonal);
                    meeting.done = true;
                    break;
                }
            }
            if ends {
                meeting.done = true;
                break;
            }
            // Lines of the other direction met on the way to the node's side.
            let ahead = select(column_end, wide_sub(wide_scale(per_row, to_side.y - 1u), lead), vec2<bool>(leaves.y));
            let cost = select(per_row, per_column, vec2<bool>(leaves.y));
            var count = 0u;
            if !all(leaves) {
                for (var k = node >> 1u; k > 0u; k >>= 1u) {
                    if wide_sign(wide_sub(ahead, wide_scale(cost, count + k - 1u))) >= 0 {
                        count += k;
                    }
                }
            }
            let at_corner = count > 0u && wide_sign(wide_sub(ahead, wide_scale(cost, count - 1u))) == 0;
            let moved = select(to_side, vec2<u32>(count), !leaves & vec2<bool>(!all(leaves)));
            crossed = leaves | vec2<bool>(at_corner);
            quad += heading * vec2<i32>(moved);
            if any(chunk_at != (quad >> vec2<u32>(firstTrailingBit(CHUNK_QUADS)))) {
                break;
            }
            left -= moved;
            lead = wide_sub(wide_add(lead, wide_scale(per_column, moved.x)), wide_scale(per_row, moved.y));
            entry = half_behind(crossed, d);
        }
        if meeting.done {
            break;
        }
        slot = slot_at(quad * i32(chunk.step));
    }
    meeting.steps = steps;
    return meeting;
}

// Where a segment that starts at `start` (relative to the quad's north-west vertex, walk units) entered a quad through a
// side, or its second half through the diagonal; in walk units from that vertex.
fn entry_point(start: vec2<i32>, d: vec2<i32>, side: f32, crossed: vec2<bool>, by_diagonal: bool) -> vec2<f32> {
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
    return clamp(s + v * t, vec2<f32>(0.0), vec2<f32>(side));
}

// Page place in pixels of a point of a facet given in walk units from its vertex a.
fn place_of(id: u32, at: vec2<f32>) -> vec2<f32> {
    let f = facet_of(id);
    let t = corners_of(chunks[id / CHUNK_FACETS], f);
    let b = vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) * f32(UNITS);
    let c = vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a)) * f32(UNITS);
    let area = b.x * c.y - b.y * c.x;
    let weights = max(vec2<f32>(at.x * c.y - at.y * c.x, b.x * at.y - b.y * at.x) / area, vec2<f32>(0.0));
    let q = camera_space(t.p + t.edge_1 * weights.x + t.edge_2 * weights.y);
    return vec2<f32>(q.x, -q.y) * (camera.focal / q.z) + camera.centre;
}

// Centre of a pixel on the page.
fn centre_of(at: vec2<i32>) -> vec2<f32> {
    return vec2<f32>(at + camera.origin) + 0.5;
}

// Notes a facet that a walk from a pixel met. Of the walks that ink a pixel, the one whose line runs nearest to its centre
// gives the place.
fn ink(at: vec2<i32>, meeting: Meeting) {
    let mark = silhouette_at(place_of(meeting.id, meeting.entered) - centre_of(at));
    if meeting.met {
        atomicMax(&out_ink[pixel_index(at)], mark);
    }
}

fn check_done(meeting: Meeting) {
    if !meeting.done {
        atomicAdd(&out_counts.cut_short, 1u);
    }
}

// Whether of two pixels the second is nearer. Equal depth: the lower ID is.
fn is_behind(first: vec2<u32>, second: vec2<u32>) -> bool {
    return second.y > first.y || (second.y == first.y && second.x < first.x);
}

@compute @workgroup_size(64)
fn walk(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var longest = 0u;
    for (var k = invocation.x; k < pairs.count; k += groups.x * 64u) {
        let item = pairs.pixels[k];
        let one = listed_place(item);
        let first = pixels[listed_pixel(item)];
        var place = vec2<i32>(0);
        if first.x != 0u {
            place = facet_hit(first.x - 1u, centre_of(one));
        }
        var deferred = 0u;
        for (var left = listed_neighbours(item); left != 0u; left &= left - 1u) {
            let other = one + neighbour(firstTrailingBit(left));
            let second = pixels[pixel_index(other)];
            let swapped = is_behind(first, second);
            let p = select(first, second, swapped);
            let q = select(second, first, swapped);
            if p.x == 0u || is_away(p.x - 1u) {
                continue;
            }
            if q.x == 0u || is_away(q.x - 1u) {
                deferred |= left & (~left + 1u);
                continue;
            }
            let other_place = facet_hit(second.x - 1u, centre_of(other));
            let meeting = walk_between(select(place, other_place, swapped), select(other_place, place, swapped));
            deferred |= select(0u, left & (~left + 1u), meeting.deferred);
            ink(select(one, other, swapped), meeting);
            check_done(meeting);
            longest = max(longest, meeting.steps);
        }
        if deferred != 0u {
            let n = atomicAdd(&out_rest.count, 1u);
            out_rest.pixels[n] = listed(listed_pixel(item), deferred);
            if n % 64u == 0u {
                atomicMax(&out_rest.groups_x, min(n / 64u + 1u, MOST_GROUPS));
            }
        }
    }
    atomicMax(&out_counts.longest_walk, longest);
}
