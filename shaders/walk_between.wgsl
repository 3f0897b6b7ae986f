// A straight walk over the lattice, in integers: chunk by chunk, in each node by node, up to the first away facet.

// Whether what is rare is left to another pass.
override defers: bool = true;

// Whether a walk looks for the first facet that does not face away, and through how many nodes.
var<private> seeks_toward: bool = false;
const SEEN_TOWARD: u32 = 4u;

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

// A walk from one point to another, in walk units, and where it is.
struct Walk {
    origin: vec2<i32>,
    end: vec2<i32>,
    d: vec2<i32>,
    // Counted over the map in quads of this many lattice steps; before the first chunk in walk units.
    quad: vec2<i32>,
    step: u32,
    // Which of the quad's lines it came in across.
    crossed: vec2<bool>,
    // Nodes so far.
    steps: u32,
}

// What there is of a walk in one chunk.
struct Leg {
    slot: u32,
    chunk: Chunk,
    summary: u32,
    // Walk units along a quad, as a power of two.
    shift: vec2<u32>,
    // Whether it runs along a line of the lattice.
    along: bool,
    // Half of the quad that it is in first.
    entry: u32,
    // Columns and rows to the quad in which the walk ends.
    left: vec2<u32>,
    // Its sign: whether the next column line (-) or the next row line (+) is met first. What a column adds, and a row takes.
    lead: vec2<u32>,
    per_column: vec2<u32>,
    per_row: vec2<u32>,
}

// What a walk goes through at once: a quad, or a square or chunk of them where nothing can happen.
struct Node {
    // The quad in its chunk.
    inner: vec2<u32>,
    // Whether the square around it holds an away facet or lacks one; and the latter alone.
    eventful: bool,
    lacking: bool,
    // Quads along its side, and to beyond the sides ahead.
    size: u32,
    to_side: vec2<u32>,
    // The lead at its last column line.
    column_end: vec2<u32>,
    // Whether it is left across a column line, a row line or both.
    leaves: vec2<bool>,
    // Whether the walk ends in it.
    ends: bool,
}

// A walk that has not begun. On a line it is in the quad ahead of it, on the last line of the map in the one before.
fn walk_from(origin: vec2<i32>, end: vec2<i32>) -> Walk {
    let d = end - origin;
    let limit = vec2<i32>((scene.samples - 1u) * (CELL_STEPS * UNITS));
    let first = select(origin, origin - 1, (d < vec2<i32>(0)) | ((d == vec2<i32>(0)) & (origin == limit)));
    return Walk(origin, end, d, first, 1u, vec2<bool>(false), 0u);
}

// Takes a walk into the chunk in this slot.
fn leg_in(walk: ptr<function, Walk>, slot: u32) -> Leg {
    let w = *walk;
    let chunk = chunks[slot];
    let shift = vec2<u32>(firstTrailingBit(chunk.step * UNITS));
    var to = Arrival(w.quad >> shift, w.crossed);
    if w.steps > 0u {
        to = arrival(w.step, chunk.step, w.quad, w.crossed, w.origin, w.d);
    }
    (*walk).quad = to.quad;
    (*walk).crossed = to.crossed;
    (*walk).step = chunk.step;
    var leg: Leg;
    leg.slot = slot;
    leg.chunk = chunk;
    leg.summary = summaries[slot];
    leg.shift = shift;
    let side = i32(chunk.step * UNITS);
    leg.along = runs_along_line(side, w.origin, w.d);
    let start = w.origin - (to.quad << shift);
    leg.entry = select(half_behind(to.crossed, w.d), half_at(start.x - start.y, w.d.x - w.d.y), w.steps == 0u);
    let last = select(select(w.end, w.end - 1, w.d > vec2<i32>(0)) >> shift, to.quad, w.d == vec2<i32>(0));
    leg.left = vec2<u32>(abs(last - to.quad));
    let lines = (to.quad + select(vec2<i32>(0), vec2<i32>(1), w.d > vec2<i32>(0))) << shift;
    leg.lead = lead_between(lines, w.origin, w.d);
    leg.per_column = wide_mul_u32(u32(side), u32(abs(w.d.y)));
    leg.per_row = wide_mul_u32(u32(side), u32(abs(w.d.x)));
    return leg;
}

// The node that a walk is in, and how it leaves it.
fn node_of(walk: ptr<function, Walk>, leg: ptr<function, Leg>) -> Node {
    var node: Node;
    let ahead = (*walk).d > vec2<i32>(0);
    let summary = (*leg).summary;
    node.inner = vec2<u32>((*walk).quad) & vec2<u32>(CHUNK_QUADS - 1u);
    let of_square = summary >> square_of(node.inner);
    node.eventful = seeks_toward || (of_square & 0x10001u) != 0u;
    node.lacking = (of_square & 0x10000u) != 0u;
    node.size = select(select(4u, 1u, node.eventful || !culls), CHUNK_QUADS, summary == 0u && culls && !seeks_toward);
    let in_node = node.inner & vec2<u32>(node.size - 1u);
    node.to_side = select(in_node + 1u, node.size - in_node, ahead);
    node.column_end = wide_add((*leg).lead, wide_scale((*leg).per_column, node.to_side.x - 1u));
    let order = wide_sign(wide_sub(node.column_end, wide_scale((*leg).per_row, node.to_side.y - 1u)));
    node.leaves = vec2<bool>(order <= 0, order >= 0);
    node.ends = any(node.leaves & (node.to_side > (*leg).left));
    return node;
}

// The first away facet of the one or two that a walk crosses in a quad, or where it leaves the land there.
fn meet_in_quad(walk: ptr<function, Walk>, leg: ptr<function, Leg>, node: Node) -> Meeting {
    var meeting: Meeting;
    let d = (*walk).d;
    let corner = (*walk).quad << (*leg).shift;
    let at_end = (*walk).end - corner;
    let exit = select(half_behind(node.leaves, -d), half_at(at_end.x - at_end.y, d.y - d.x), node.ends);
    let entry = (*leg).entry;
    let id = (*leg).slot * CHUNK_FACETS + quad_local(node.inner);
    let away = away_bits(id) ^ select(0u, 3u, seeks_toward);
    let entry_away = ((away >> entry) & 1u) == 1u;
    let entry_missing = !defers && is_no_facet((*leg).chunk, node.inner, entry);
    let exit_missing = !defers && is_no_facet((*leg).chunk, node.inner, exit);
    if entry_away || entry_missing || exit_missing || ((away >> exit) & 1u) == 1u {
        meeting.left_land = entry_missing || (!entry_away && exit_missing);
        meeting.met = !meeting.left_land;
        meeting.id = id + select(exit, entry, entry_away);
        let by_diagonal = !entry_away && exit != entry;
        let side = f32((*leg).chunk.step * UNITS);
        meeting.entered = entry_point((*walk).origin - corner, d, side, (*walk).crossed, by_diagonal);
        meeting.done = true;
    }
    return meeting;
}

// What a walk meets in a node, if anything.
fn meet_in(walk: ptr<function, Walk>, leg: ptr<function, Leg>, node: Node) -> Meeting {
    var meeting: Meeting;
    let seam = beside_coarser((*leg).chunk.coarser, node.inner);
    if defers && ((node.eventful && seam) || node.lacking) {
        meeting.deferred = true;
        meeting.done = true;
    } else if !defers && node.eventful && seam {
        meeting = meet_beside_coarser((*leg).slot, node.inner, (*walk).origin, (*walk).end);
        meeting.done = meeting.met || meeting.left_land;
    } else if node.eventful && !seam && !(*leg).along {
        meeting = meet_in_quad(walk, leg, node);
    }
    return meeting;
}

// Takes a walk to beyond a node. Says by how many columns and rows.
fn leave(walk: ptr<function, Walk>, leg: ptr<function, Leg>, node: Node) -> vec2<u32> {
    // Lines of the other direction met on the way to the node's side.
    let by_row = wide_sub(wide_scale((*leg).per_row, node.to_side.y - 1u), (*leg).lead);
    let ahead = select(node.column_end, by_row, vec2<bool>(node.leaves.y));
    let cost = select((*leg).per_row, (*leg).per_column, vec2<bool>(node.leaves.y));
    var count = 0u;
    if !all(node.leaves) {
        for (var k = node.size >> 1u; k > 0u; k >>= 1u) {
            if wide_sign(wide_sub(ahead, wide_scale(cost, count + k - 1u))) >= 0 {
                count += k;
            }
        }
    }
    let at_corner = count > 0u && wide_sign(wide_sub(ahead, wide_scale(cost, count - 1u))) == 0;
    let moved = select(node.to_side, vec2<u32>(count), !node.leaves & vec2<bool>(!all(node.leaves)));
    (*walk).crossed = node.leaves | vec2<bool>(at_corner);
    (*walk).quad += sign((*walk).d) * vec2<i32>(moved);
    return moved;
}

// The same walk so many columns and rows further in the same chunk.
fn go_on(walk: ptr<function, Walk>, leg: ptr<function, Leg>, moved: vec2<u32>) {
    (*leg).left -= moved;
    let lead = wide_add((*leg).lead, wide_scale((*leg).per_column, moved.x));
    (*leg).lead = wide_sub(lead, wide_scale((*leg).per_row, moved.y));
    (*leg).entry = half_behind((*walk).crossed, (*walk).d);
}

// Takes a walk through a chunk; not done where it leaves it.
fn cross_chunk(walk: ptr<function, Walk>, leg: ptr<function, Leg>) -> Meeting {
    var meeting: Meeting;
    let side = vec2<u32>(firstTrailingBit(CHUNK_QUADS));
    let here = (*walk).quad >> side;
    loop {
        (*walk).steps += 1u;
        let node = node_of(walk, leg);
        meeting = meet_in(walk, leg, node);
        meeting.done = meeting.done || node.ends || (seeks_toward && (*walk).steps == SEEN_TOWARD);
        if meeting.done {
            break;
        }
        let moved = leave(walk, leg, node);
        if any(here != ((*walk).quad >> side)) {
            break;
        }
        go_on(walk, leg, moved);
    }
    return meeting;
}

// Walks from one point to another in walk units.
fn walk_between(origin: vec2<i32>, end: vec2<i32>) -> Meeting {
    var walk = walk_from(origin, end);
    // Some drivers end a loop that takes too long: then it is never done.
    var meeting: Meeting;
    var slot = slot_at(walk.quad >> vec2<u32>(firstTrailingBit(UNITS)));
    loop {
        if slot == NO_SLOT || all(walk.d == vec2<i32>(0)) {
            meeting.left_land = slot == NO_SLOT;
            meeting.done = true;
            break;
        }
        var leg = leg_in(&walk, slot);
        meeting = cross_chunk(&walk, &leg);
        if meeting.done {
            break;
        }
        slot = slot_at(walk.quad * i32(walk.step));
    }
    meeting.steps = walk.steps;
    return meeting;
}
