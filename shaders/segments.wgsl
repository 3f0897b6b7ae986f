// One invocation a facet whose vertices do not all face one way: the line along which it turns. A lattice edge holds one crossing
// at most, a facet one line: contours cannot branch.

@group(0) @binding(20) var<storage, read> turns: array<f32>;
@group(0) @binding(21) var<storage, read> crossed: array<u32>;

// The value at a corner of a facet that stands `from_quad` from its quad's north-west vertex.
fn turn_at(first: u32, quad: vec2<u32>, from_quad: vec2<u32>) -> f32 {
    let at = quad + from_quad;
    return turns[first + at.y * CHUNK_SIDE + at.x];
}

// A corner of a facet: lattice place, eye-relative place, value.
struct Turn {
    at: vec2<u32>,
    place: vec3<f32>,
    g: f32,
}

// Where an edge turns, from its corner that faces the eye on, so that both facets beside it find the same place.
fn crossing(p: Turn, q: Turn) -> f32 {
    let share = select(q.g / (q.g - p.g), p.g / (p.g - q.g), p.g > 0.0);
    return select(1.0 - share, share, p.g > 0.0);
}

@compute @workgroup_size(64)
fn segments(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let k = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if k >= min(atomicLoad(&out_tally.crossed), arrayLength(&crossed)) {
        return;
    }
    let id = crossed[k];
    let slot = id / CHUNK_FACETS;
    let quad = local_quad(id % CHUNK_FACETS);
    let half = id & 1u;
    let chunk = chunks[slot];
    let f = chunk_facet(chunk, quad, half);
    if slot < batch.first_slot || slot - batch.first_slot >= BATCH_CHUNKS || is_collapsed(f) {
        return;
    }
    let first = (slot - batch.first_slot) * CHUNK_VERTICES;
    let t = corners_of(chunk, f);
    let a = Turn(f.a, t.p, turn_at(first, quad, vec2<u32>(0u)));
    let b = Turn(f.b, t.p + t.edge_1, turn_at(first, quad, corner(half, 1u)));
    let c = Turn(f.c, t.p + t.edge_2, turn_at(first, quad, corner(half, 2u)));
    let toward = vec3<bool>(a.g > 0.0, b.g > 0.0, c.g > 0.0);
    // The corner that faces the other way, and the two that follow counter-clockwise.
    let odd = select(select(0u, 1u, toward.x == toward.z), 2u, toward.x == toward.y);
    var p = a;
    var q = b;
    var r = c;
    if odd == 1u {
        p = b;
        q = c;
        r = a;
    } else if odd == 2u {
        p = c;
        q = a;
        r = b;
    }
    let to_q = crossing(p, q);
    let to_r = crossing(p, r);
    let origin = vec2<f32>(vec2<i32>(p.at) - vec2<i32>(f.a)) * f32(UNITS);
    let place_q = mix(p.place, q.place, to_q);
    let place_r = mix(p.place, r.place, to_r);
    let at_q = origin + vec2<f32>(vec2<i32>(q.at) - vec2<i32>(p.at)) * (f32(UNITS) * to_q);
    let at_r = origin + vec2<f32>(vec2<i32>(r.at) - vec2<i32>(p.at)) * (f32(UNITS) * to_r);
    // The side that faces the eye lies on the left, seen from above.
    let is_away = p.g <= 0.0;
    let start = select(place_q, place_r, is_away);
    let end = select(place_r, place_q, is_away);
    let normal = cross(t.edge_1, t.edge_2);
    let left = cross(normal, end - start);
    let fall = -dot(left, start) / max(length(left) * length(start), 1e-30);
    let code = odd | select(0u, AWAY_CORNER, is_away);
    list_line(FacetLine(id, code, fall, start, end, select(at_q, at_r, is_away), select(at_r, at_q, is_away)));
}
