// One invocation a patch edge of the rim: the parts of it where the surface faces the eye, facet by facet.

@group(0) @binding(20) var<storage, read> turns: array<f32>;
@group(0) @binding(21) var<storage, read> turning: array<u32>;

// The value at a vertex of a chunk; where no contour may run, that of its facets.
fn turn_of(slot: u32, column_row: vec2<u32>, facet: u32) -> f32 {
    if (turning[slot] & BOTH) != BOTH {
        return select(1.0, -1.0, is_away(facet));
    }
    let number = (slot - batch.first_slot) * CHUNK_VERTICES;
    return turns[number + column_row.y * CHUNK_SIDE + column_row.x];
}

// Whether a facet has an edge from one lattice vertex to another, counter-clockwise.
fn has_edge(f: Facet, p: vec2<u32>, q: vec2<u32>) -> bool {
    let starts = vec3<bool>(all(f.a == p), all(f.b == p), all(f.c == p));
    return any(starts & vec3<bool>(all(f.b == q), all(f.c == q), all(f.a == q)));
}

// The facet of a chunk on the left of the way from one lattice vertex to another: that half of a quad or, where it has
// collapsed beside a coarser chunk, the one about there that has its edge now.
fn facet_along(slot: u32, quad: vec2<u32>, half: u32, p: vec2<u32>, q: vec2<u32>) -> u32 {
    let chunk = chunks[slot];
    for (var k = 0u; k < 18u && is_collapsed(chunk_facet(chunk, quad, half)); k++) {
        let near = vec2<i32>(quad) + vec2<i32>(i32(k % 3u), i32(k / 3u % 3u)) - 1;
        if all(near >= vec2<i32>(0)) && all(near < vec2<i32>(i32(CHUNK_QUADS))) {
            let f = chunk_facet(chunk, vec2<u32>(near), k / 9u);
            if !is_collapsed(f) && has_edge(f, p, q) {
                return slot * CHUNK_FACETS + quad_local(vec2<u32>(near)) + k / 9u;
            }
        }
    }
    return slot * CHUNK_FACETS + quad_local(quad) + half;
}

// The edge of half a quad between two vertices of its chunk, where it faces the eye; `turned`: the facet lies on its right.
fn at_rim(slot: u32, quad: vec2<u32>, half: u32, from_vertex: vec2<u32>, to_vertex: vec2<u32>, turned: bool) {
    if slot < batch.first_slot || slot - batch.first_slot >= BATCH_CHUNKS || slot >= camera.seen || !in_view(bounds_of(slot)) {
        return;
    }
    if (turning[slot] & (BOTH | DRAWN)) == BOTH {
        // All of it lies hidden.
        return;
    }
    let chunk = chunks[slot];
    let vertex_p = shared_vertex(chunk.coarser, select(from_vertex, to_vertex, turned));
    let vertex_q = shared_vertex(chunk.coarser, select(to_vertex, from_vertex, turned));
    let at_p = chunk.origin + vertex_p * chunk.step;
    let at_q = chunk.origin + vertex_q * chunk.step;
    let id = facet_along(slot, quad, half, at_p, at_q);
    let g_p = turn_of(slot, vertex_p, id);
    let g_q = turn_of(slot, vertex_q, id);
    if all(at_p == at_q) || (g_p <= 0.0 && g_q <= 0.0) {
        return;
    }
    let f = facet_of(id);
    let place_p = place_in(chunk, at_p);
    let p = eye_relative(at_p / CELL_STEPS, place_p);
    let way = edge_between(at_p, place_p, at_q, place_in(chunk, at_q));
    let turns_at = select(g_q / (g_q - g_p), g_p / (g_p - g_q), g_p > 0.0);
    let share = select(1.0 - turns_at, turns_at, g_p > 0.0);
    let from_share = select(share, 0.0, g_p > 0.0);
    let to_share = select(share, 1.0, g_q > 0.0);
    let origin = vec2<f32>(vec2<i32>(at_p) - vec2<i32>(f.a)) * f32(UNITS);
    let on_map = vec2<f32>(vec2<i32>(at_q) - vec2<i32>(at_p)) * f32(UNITS);
    let edge = select(select(2u, 1u, all(at_p == f.b)), 0u, all(at_p == f.a));
    let code = edge | OF_RIM | select(STARTS_TURNING, 0u, g_p > 0.0) | select(ENDS_TURNING, 0u, g_q > 0.0);
    list_line(FacetLine(
        id,
        code,
        1.0,
        p + way * from_share,
        p + way * to_share,
        origin + on_map * from_share,
        origin + on_map * to_share,
    ));
}

@compute @workgroup_size(64)
fn rim_segments(@builtin(global_invocation_id) invocation: vec3<u32>) {
    visit_rim(invocation.y * MOST_GROUPS * 64u + invocation.x);
}
