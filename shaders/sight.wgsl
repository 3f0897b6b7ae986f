// One invocation a segment of a curve that is looked at: whether the eye sees it. Seen from one of the four pixel centres
// about its middle nothing stands before it where the pixel shows what is farther, or where the straight way on the lattice
// from the pixel's point to the segment meets no facet that faces away and no void. Of pixels that show what is nearer one
// is asked, and where all do another. Where they differ, what the nearest says is kept. And how deep lies what is behind it.

// The segment is looked at this far off the surface, in steps of its lattice.
const NUDGE: f32 = 0.25;
// And no farther than this on the page, px.
const MOST_NUDGE: f32 = 0.5;
// Facets so near to the segment may face away without hiding it, in steps of its lattice: it does not run along their edges.
const BESIDE_LINE: f32 = 2.0;
// What lies behind is looked for this far outwards, px: with the nudge and the half pixel of what lies about it, 2 px are drawn
// around every piece of a page.
const OUTWARD: f32 = 1.0;

// Whether the surface in a pixel lies nearer than a depth.
fn is_nearer(at: vec2<i32>, depth: f32) -> bool {
    return on_page(at) && bitcast<f32>(pixels[pixel_index(at)].y) > depth;
}

// Whether the surface in a pixel, nearer than a line, is another one than that which bears the line: `reach` is how near to its
// place on the lattice facets may face away.
fn hides(at: vec2<i32>, place: vec2<i32>, reach: f32) -> bool {
    let id = pixels[pixel_index(at)].x - 1u;
    if is_away(id) {
        return true;
    }
    let hit = facet_hit(id, centre_of(at));
    let from_line = abs(vec2<f32>(hit - place));
    if culls && !has_voids && max(from_line.x, from_line.y) <= reach {
        // So are all facets on the way.
        return false;
    }
    let meeting = walk_between(hit, place);
    if !meeting.done {
        atomicAdd(&out_tally.cut_short, 1u);
    }
    if !meeting.met {
        return meeting.left_land;
    }
    let met = vec2<i32>(facet_of(meeting.id).a * UNITS) - place;
    let to_line = abs(vec2<f32>(met) + meeting.entered);
    return max(to_line.x, to_line.y) > reach;
}

// Depth of what lies behind a line at a page place: of the surface outwards, or of the farthest beside it. Outwards it is what
// the four pixels say that show what is farther than the line, each the more the nearer it is: a line that moves a little
// has a little more or less behind it, where the depth of one pixel would leap with every row that it passes.
fn depth_behind(px: vec2<f32>, outward: vec2<f32>, depth: f32) -> f32 {
    let end = vec2<i32>(camera.size) - 1;
    let beyond = px + outward * OUTWARD - 0.5;
    let corner = vec2<i32>(floor(beyond)) - camera.origin;
    let share = fract(beyond);
    var land = 0.0;
    var sky = 0.0;
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let turn = vec2<i32>(k & 1, k >> 1u);
        let at = clamp(corner + turn, vec2<i32>(0), end);
        let there = bitcast<f32>(pixel_depth(pixels[pixel_index(at)]));
        let shares = select(1.0 - share, share, turn == vec2<i32>(1));
        let weight = select(0.0, shares.x * shares.y, there < depth);
        sky += select(0.0, weight, there == 0.0);
        land += select(weight, 0.0, there == 0.0);
        sum += weight * there;
    }
    if sky + land > 0.0 {
        return select(sum / max(land, 1e-30), 0.0, sky > land);
    }
    var farthest = depth;
    let first = vec2<i32>(floor(px - 0.5)) - camera.origin;
    for (var k = 0; k < 4; k++) {
        let at = clamp(first + vec2<i32>(k & 1, k >> 1u), vec2<i32>(0), end);
        farthest = min(farthest, bitcast<f32>(pixel_depth(pixels[pixel_index(at)])));
    }
    return farthest;
}

fn look(segment: ptr<function, Segment>) {
    let id = (*segment).facet;
    let chunk = chunks[id / CHUNK_FACETS];
    let f = facet_of(id);
    let t = corners_of(chunk, f);
    let normal = normalize(cross(t.edge_1, t.edge_2));
    let step = f32(chunk.step) / f32(CELL_STEPS) * max(scene.cell.x, scene.cell.y);
    let start = camera_space(place_from((*segment).start));
    let end = camera_space(place_from((*segment).end));
    let middle = mix(start, end, 0.5);
    // No farther than look-ups reach beyond a piece of the page.
    let off = min(NUDGE * step, MOST_NUDGE * middle.z / camera.focal);
    let q = middle + camera_space(normal) * off;
    let px = on_paper(q);
    let depth = depth_of(q);
    let is_rim = ((*segment).code & OF_RIM) != 0u;
    var place = (*segment).at;
    if is_rim {
        // A little inland, so that the way there does not end outside.
        let centre = (vec2<f32>(vec2<i32>(f.b) - vec2<i32>(f.a)) + vec2<f32>(vec2<i32>(f.c) - vec2<i32>(f.a))) * (f32(UNITS) / 3.0);
        let to_centre = vec2<f32>(vec2<i32>(f.a * UNITS) - place) + centre;
        place += vec2<i32>(round(to_centre * 0.25));
    }
    // The four pixels about it, the nearest first and its opposite last.
    let nearest = vec2<i32>(floor(px)) - camera.origin;
    let beyond = select(vec2<i32>(-1), vec2<i32>(1), fract(px) > vec2<f32>(0.5));
    let opposite = nearest + beyond;
    let across = vec2<i32>(nearest.x + beyond.x, nearest.y);
    let along = vec2<i32>(nearest.x, nearest.y + beyond.y);
    let nearer = vec4<bool>(
        is_nearer(nearest, depth),
        is_nearer(across, depth),
        is_nearer(along, depth),
        is_nearer(opposite, depth),
    );
    // One walk tells whose surface is nearer; two where all are.
    let reach = BESIDE_LINE * f32(chunk.step * UNITS);
    let first = select(select(select(opposite, along, nearer.z), across, nearer.y), nearest, nearer.x);
    var hidden = vec2<bool>(false);
    if any(nearer) {
        hidden = vec2<bool>(hides(first, place, reach));
    }
    if all(nearer) {
        hidden.y = hides(opposite, place, reach);
    }
    let in_doubt = hidden.x != hidden.y || (hidden.x && !all(nearer));
    let at_nearest = select(NEAREST_FREE, NEAREST_HIDDEN, hidden.x && nearer.x);
    (*segment).sight = select(select(FREE, HIDDEN, hidden.x), at_nearest, in_doubt);
    // On the page: of a contour the way its normal points, of the rim away from the surface on its left.
    let course = on_paper(end) - on_paper(start);
    let of_normal = vec2<f32>(dot(normal, camera.right.xyz), -dot(normal, camera.up.xyz));
    let outward = select(of_normal, vec2<f32>(-course.y, course.x), is_rim);
    (*segment).outward = outward / max(length(outward), 1e-30);
    (*segment).behind = depth_behind(px, (*segment).outward, depth);
}

@compute @workgroup_size(64)
fn sight(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let k = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if k < atomicLoad(&out_tally.asked) {
        let n = out_asked[k];
        var segment = out_segments[n];
        look(&segment);
        out_segments[n] = segment;
    }
}
