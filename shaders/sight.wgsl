// One invocation a segment of a curve: whether the eye sees it. From each of the four pixel centres about its middle nothing
// stands before it where the pixel shows what is farther, or where the straight way on the lattice from the pixel's point
// to the segment meets no facet that faces away and no void. Where the four differ, what the nearest says is kept. And how
// deep lies what is behind it.

// What is found: nothing stands before it, something does; they differ, and so says the nearest.
const FREE: u32 = 0u;
const HIDDEN: u32 = 1u;
const NEAREST_FREE: u32 = 2u;
const NEAREST_HIDDEN: u32 = 3u;

// The segment is looked at this far off the surface, in steps of its lattice.
const NUDGE: f32 = 0.25;
// Facets so near to the segment may face away without hiding it, in steps of its lattice: it does not run along their edges.
const BESIDE_LINE: f32 = 2.0;
// What lies behind is looked for this far outwards, px.
const OUTWARD: f32 = 1.2;

// Whether the surface in a pixel stands before a point on the lattice, at a depth.
fn stands_before(at: vec2<i32>, place: vec2<i32>, depth: f32, reach: f32) -> bool {
    let p = pixels[pixel_index(at)];
    if p.x == 0u || bitcast<f32>(p.y) <= depth {
        return false;
    }
    if is_away(p.x - 1u) {
        return true;
    }
    let meeting = walk_between(facet_hit(p.x - 1u, centre_of(at)), place);
    check_done(meeting);
    if !meeting.met {
        return meeting.left_land;
    }
    let met = vec2<i32>(facet_of(meeting.id).a * UNITS) - place;
    let to_line = abs(vec2<f32>(met) + meeting.entered);
    return max(to_line.x, to_line.y) > reach;
}

// Depth of what lies behind a line at a page place: of the surface outwards, or of the farthest beside it.
fn depth_behind(px: vec2<f32>, outward: vec2<f32>, depth: f32) -> f32 {
    let end = vec2<i32>(camera.size) - 1;
    let beyond = clamp(vec2<i32>(floor(px + outward * OUTWARD)) - camera.origin, vec2<i32>(0), end);
    let there = bitcast<f32>(pixel_depth(pixels[pixel_index(beyond)]));
    if there < depth {
        return there;
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
    let q = camera_space(mix((*segment).start, (*segment).end, 0.5) + normal * (NUDGE * step));
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
    let first = vec2<i32>(floor(px - 0.5));
    let within = fract(px - 0.5);
    let nearest = select(0, 1, within.x > 0.5) + select(0, 2, within.y > 0.5);
    var free = 0u;
    var hidden = 0u;
    for (var k = 0; k < 4; k++) {
        let at = first + vec2<i32>(k & 1, k >> 1u) - camera.origin;
        if on_page(at) {
            let stands = stands_before(at, place, depth, BESIDE_LINE * f32(chunk.step * UNITS));
            let bit = 1u << u32(k);
            free |= select(bit, 0u, stands);
            hidden |= select(0u, bit, stands);
        }
    }
    let at_nearest = select(NEAREST_FREE, NEAREST_HIDDEN, ((hidden >> u32(nearest)) & 1u) == 1u);
    (*segment).sight = select(select(at_nearest, HIDDEN, free == 0u && hidden != 0u), FREE, hidden == 0u);
    // On the page: of a contour the way its normal points, of the rim away from the surface on its left.
    let along = on_paper(camera_space((*segment).end)) - on_paper(camera_space((*segment).start));
    let of_normal = vec2<f32>(dot(normal, camera.right.xyz), -dot(normal, camera.up.xyz));
    let outward = select(of_normal, vec2<f32>(-along.y, along.x), is_rim);
    (*segment).outward = outward / max(length(outward), 1e-30);
    (*segment).behind = depth_behind(px, (*segment).outward, depth);
}

@compute @workgroup_size(64)
fn sight(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let k = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if k < min(atomicLoad(&out_segments.count), arrayLength(&out_segments.list)) {
        var segment = out_segments.list[k];
        look(&segment);
        out_segments.list[k] = segment;
    }
}
