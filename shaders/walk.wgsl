// One invocation a pixel with open pairs: of each pair with a neighbour, walks the lattice from the nearer pixel's point on
// the surface to the farther one's, facet by facet, in integers. An away facet on the way makes the nearer one ink; a
// void or the outside ends the walk. Pairs with a pixel without surface, walks past squares that lack facets or past
// facets beside a coarser chunk, and those that meet an away facet which the page shows elsewhere or under which the
// surface does not turn away are rare and left to `walk_rest`: drivers that run both sides of every branch pay for them here.

@group(0) @binding(21) var<storage, read> pairs: ListRead;
@group(0) @binding(22) var<storage, read_write> out_ink: array<atomic<u32>>;
@group(0) @binding(23) var<storage, read_write> out_counts: Counts;
@group(0) @binding(24) var<storage, read_write> out_rest: List;

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

// Barycentrics of where the ray through a page place meets a facet, clamped to the facet.
fn hit_weights(t: Corners, px: vec2<f32>) -> vec3<f32> {
    let w = max(volumes(t, ray_through(px)), vec3<f32>(0.0));
    let sum = w.x + w.y + w.z;
    return select(w / sum, vec3<f32>(1.0, 0.0, 0.0), sum == 0.0);
}

// The same place in walk units.
fn facet_hit(id: u32, px: vec2<f32>) -> vec2<i32> {
    let f = facet_of(id);
    let w = hit_weights(corners_of(chunks[id / CHUNK_FACETS], f), px);
    return vec2<i32>(f.a * UNITS) + vec2<i32>(round(from_a(f, w.yz) * f32(UNITS)));
}

// Page place in pixels of a point of a facet given in walk units from its vertex a.
fn place_of(id: u32, at: vec2<f32>) -> vec2<f32> {
    let f = facet_of(id);
    let t = corners_of(chunks[id / CHUNK_FACETS], f);
    let b = vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) * f32(UNITS);
    let c = vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a)) * f32(UNITS);
    let area = b.x * c.y - b.y * c.x;
    let weights = max(vec2<f32>(at.x * c.y - at.y * c.x, b.x * at.y - b.y * at.x) / area, vec2<f32>(0.0));
    return on_paper(camera_space(t.p + t.edge_1 * weights.x + t.edge_2 * weights.y));
}

// Centre of a pixel on the page.
fn centre_of(at: vec2<i32>) -> vec2<f32> {
    return vec2<f32>(at + camera.origin) + 0.5;
}

// How far from a pixel's centre a line may lie that parts it from a neighbour, px right or down.
const BESIDE_PAIR: f32 = 1.5;

// Where the facet that a walk from a pixel met begins, from the pixel's centre.
fn offset_of(at: vec2<i32>, meeting: Meeting) -> vec2<f32> {
    return place_of(meeting.id, meeting.entered) - centre_of(at);
}

// Whether that is elsewhere on the page.
fn is_elsewhere(offset: vec2<f32>) -> bool {
    return max(abs(offset.x), abs(offset.y)) > BESIDE_PAIR;
}

// Inks a pixel for a line at this offset. Of the walks that ink a pixel, the one whose line runs nearest to its centre gives
// the place.
fn ink(at: vec2<i32>, offset: vec2<f32>) {
    atomicMax(&out_ink[pixel_index(at)], silhouette_at(offset));
}

// How many times as fine the surface under a facet in doubt is looked at. Facets of level 1 and coarser are the surface as it is known
// here, those of the finest two as fine as any.
const FINER: u32 = 4u;
// Of the facets of a quad and of those about it in its chunk at most this share faces away in an island.
const ISLAND: f32 = 0.34;

// Whether an away facet may be one of an island of such: few about it face away, too, and the surface is known finer.
fn is_in_doubt(id: u32) -> bool {
    let slot = id / CHUNK_FACETS;
    let step = chunks[slot].step;
    let quad = local_quad(id % CHUNK_FACETS);
    let first = max(quad, vec2<u32>(1u)) - 1u;
    let last = min(quad + 1u, vec2<u32>(CHUNK_QUADS - 1u));
    var away = 0u;
    for (var row = first.y; row <= last.y; row++) {
        for (var column = first.x; column <= last.x; column++) {
            away += countOneBits(away_bits(slot * CHUNK_FACETS + quad_local(vec2<u32>(column, row))) & 3u);
        }
    }
    let about = 2u * (last.x - first.x + 1u) * (last.y - first.y + 1u);
    return step < CELL_STEPS && step >= FINER && f32(away) <= ISLAND * f32(about);
}

// Whether a facet faces away whose corners lie so far, metres, from a place that is given from the eye: edges between near places
// keep their digits far from it.
fn turns_away(place: vec3<f32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    return dot(cross(b - a, c - a), place + a) >= 0.0;
}

// Whether the surface turns away under an away facet of a patch: some of the finer facets that it is made of do. Beside coarser
// chunks, too, no facet lies in two patches.
fn surface_turns(id: u32) -> bool {
    let chunk = chunks[id / CHUNK_FACETS];
    let f = facet_of(id);
    let cell = (f.a + f.b + f.c) / (3u * CELL_STEPS);
    let sub = f.a + f.b + f.c - cell * (3u * CELL_STEPS);
    let of_cell = patch_of(chunk.tile, tile_place(chunk, cell * CELL_STEPS), sub.x > sub.y);
    let corner = eye_relative(cell, vec4<f32>(0.0, 0.0, 0.0, of_cell.height));
    let at = vec2<f32>(vec2<i32>(f.a) - vec2<i32>(cell * CELL_STEPS)) / f32(CELL_STEPS);
    let along = vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) / f32(CELL_STEPS * FINER);
    let up = vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a)) / f32(CELL_STEPS * FINER);
    for (var row = 0u; row < FINER; row++) {
        let start = at + up * f32(row);
        var low = patch_point(of_cell, start);
        var high = patch_point(of_cell, start + up);
        for (var column = 1u; column <= FINER - row; column++) {
            let next = start + along * f32(column);
            let next_low = patch_point(of_cell, next);
            let next_high = patch_point(of_cell, next + up);
            // The last of a row has none on its tip.
            let on_tip = column < FINER - row && turns_away(corner, next_low, next_high, high);
            if turns_away(corner, low, next_low, high) || on_tip {
                return true;
            }
            low = next_low;
            high = next_high;
        }
    }
    return false;
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
            let at = select(one, other, swapped);
            let offset = offset_of(at, meeting);
            let goes_on = meeting.met && !meeting.deferred && is_in_doubt(meeting.id) && !surface_turns(meeting.id);
            let is_left = meeting.deferred || goes_on || (meeting.met && is_elsewhere(offset));
            deferred |= select(0u, left & (~left + 1u), is_left);
            if meeting.met && !is_left {
                ink(at, offset);
            }
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
