// From patch edges of the rim to the edges of facets: each is given to `at_rim`, which the pass that stands on this declares.

struct RimEdge {
    sample: vec2<u32>,  // where the patch edge starts, column and row
    direction: u32,     // 0 east, 1 south, 2 south-east
    half: u32,          // of the quad whose edge it is: 0 or 1
}

@group(0) @binding(25) var<storage, read> rim: array<RimEdge>;

// Visits the part of a patch's edge that lies in one quad, or starts an edge of many patches. `at` is where it starts. Returns
// how many lattice units it is long.
fn visit_part(edge: RimEdge, at: vec2<u32>, along: vec2<u32>) -> u32 {
    // The quad above or left of the edge, or the one it starts in.
    let above = edge.direction == 0u && edge.half == 0u;
    let left = edge.direction == 1u && edge.half == 1u;
    let slot = slot_at(vec2<i32>(at) - select(vec2<i32>(0), vec2<i32>(1), vec2<bool>(left, above)));
    if slot == NO_SLOT {
        // Half a cell, the smallest chunk: the next one may be there.
        return CHUNK_QUADS;
    }
    let chunk = chunks[slot];
    let from_origin = at - chunk.origin;
    if any(from_origin % chunk.step != vec2<u32>(0u)) {
        return CELL_STEPS;
    }
    let vertex = from_origin / chunk.step;
    let quad = vertex - select(vec2<u32>(0u), vec2<u32>(1u), vec2<bool>(left, above));
    // The facet lies on the right of the way: half 1 below an edge to the east and before one to the south, half 0 beside a
    // diagonal.
    let turned = (edge.half == 1u) != (edge.direction == 2u);
    at_rim(slot, quad, edge.half, vertex, vertex + along, turned);
    return chunk.step;
}

// Visits the edges of facets along patch edge `i`, if there is one.
fn visit_rim(i: u32) {
    if i >= arrayLength(&rim) {
        return;
    }
    let edge = rim[i];
    let along = vec2<u32>(select(1u, 0u, edge.direction == 1u), select(1u, 0u, edge.direction == 0u));
    var done = 0u;
    while done < CELL_STEPS {
        done += visit_part(edge, edge.sample * CELL_STEPS + along * done, along);
    }
}
