// 17 invocations a chunk whose values are wanted, each a column of vertices from north to south: of each vertex g = n . (eye - p),
// where n is the sum of the normals of the chunk's own facets around it, as long as twice their areas (Hertzmann, Zorin
// 2000). Above 0 the surface faces the eye. What other chunks add on a side adds `meet`. Inside, not on sides, where these
// facets do not all face one way, n is that of the surface nearer to the vertex: the mean of whole facets smooths away folds
// that are narrower than two of them. There g leaps when the first of the facets turns.

@group(0) @binding(20) var<storage, read_write> out_turns: array<f32>;
@group(0) @binding(21) var<storage, read> turning: array<u32>;
@group(0) @binding(22) var<storage, read> around: array<u32>;
@group(0) @binding(23) var<storage, read_write> out_sides: array<f32>;

fn vertex_in(chunk: Chunk, at: vec2<u32>) -> Vertex {
    return vertex_of(chunk, at, vertex_index(chunk, at));
}

// How the two facets of a quad face the eye, as long as six times the volume between eye and facet; 0 where there is none.
fn facing_of(nw: Vertex, ne: Vertex, sw: Vertex, se: Vertex) -> vec2<f32> {
    let from_eye = eye_relative(nw.at / CELL_STEPS, nw.place);
    let to_se = edge_of(nw, se);
    let below = dot(cross(edge_of(nw, sw), to_se), from_eye);
    let above = dot(cross(to_se, edge_of(nw, ne)), from_eye);
    return select(vec2<f32>(-below, -above), vec2<f32>(0.0), lacking(nw, ne, sw, se));
}

// Whether of the facets about a vertex, all of them there, some face the eye and some away.
fn is_mixed(north: vec3<f32>, south: vec3<f32>) -> bool {
    return all(north != vec3<f32>(0.0)) && all(south != vec3<f32>(0.0))
        && any(min(north, south) < vec3<f32>(0.0)) && any(max(north, south) > vec3<f32>(0.0));
}

// Normal of a patch, to scale of its cell, at (u, v) of the cell as in `patch_point`: up from its surface.
fn patch_normal(p: Patch, at: vec2<f32>, above: bool) -> vec3<f32> {
    let a = 1.0 - max(at.x, at.y);
    let b = min(at.x, at.y);
    let c = abs(at.x - at.y);
    // De Casteljau: what is left when one step to each corner is still to be made.
    let to_a = p.ba * (b * b) + p.ca * (c * c) + (p.ab * (a * b) + p.ac * (a * c) + p.centre * (b * c)) * 2.0;
    let to_b = p.ab * (a * a) + p.b * (b * b) + p.cb * (c * c) + (p.ba * (a * b) + p.centre * (a * c) + p.bc * (b * c)) * 2.0;
    let to_c = p.ac * (a * a) + p.bc * (b * b) + p.c * (c * c) + (p.centre * (a * b) + p.ca * (a * c) + p.cb * (b * c)) * 2.0;
    let normal = cross(to_b - to_a, to_c - to_a);
    return select(-normal, normal, above);
}

// How the surface at a vertex inside a chunk faces the eye, as much as whole facets would add up to: by the normals of the
// patches that meet there.
fn turn_near(chunk: Chunk, here: Vertex) -> f32 {
    let sub = here.at % CELL_STEPS;
    let place = tile_place(chunk, here.at);
    let share = vec2<f32>(sub) / f32(CELL_STEPS);
    let on_column = sub.x == 0u;
    let on_row = sub.y == 0u;
    var normal = vec3<f32>(0.0);
    if on_column && on_row {
        normal = normal_of(sample_of(chunk.tile, place)) * (scene.cell.x * scene.cell.y / 9.0);
    } else {
        let above = sub.x > sub.y;
        normal = patch_normal(patch_of(chunk.tile, place, above), share, above);
        if on_column || on_row || sub.x == sub.y {
            // Across the edge: west of a column, north of a row, above a diagonal.
            let beyond = place - select(vec2<u32>(0u), vec2<u32>(1u), vec2<bool>(on_column, on_row));
            let from_beyond = select(share, vec2<f32>(1.0), vec2<bool>(on_column, on_row));
            normal = (normal + patch_normal(patch_of(chunk.tile, beyond, !above), from_beyond, !above)) * 0.5;
        }
    }
    let quads = f32(chunk.step) / f32(CELL_STEPS);
    return -dot(normal, eye_relative(here.at / CELL_STEPS, here.place)) * (54.0 * quads * quads);
}

@compute @workgroup_size(17, 4)
fn turn(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.chunks || (turning[slot] & WANTED) == 0u {
        return;
    }
    let chunk = chunks[slot];
    let column = invocation.x;
    // Beside the chunk the nearest vertex will do: the facets there do not count.
    let west_column = max(column, 1u) - 1u;
    let east_column = min(column + 1u, CHUNK_QUADS);
    let counts = vec2<bool>(column > 0u, column < CHUNK_QUADS);
    // What batches overwrite is not made beside the page's map projection.
    let is_made = batch.passing == 0u || in_frustum(bounds_of(slot));
    let number = invocation.y * CHUNK_VERTICES + column;
    let side = around[slot * AROUND + SIDES_AT] * SIDE_VERTICES;
    // Of what is not drawn the sides alone count. Beside a coarser chunk, where facets have collapsed, whole ones do.
    let low = select(vec2<u32>(1u), vec2<u32>(2u), (vec2<u32>(chunk.coarser) & vec2<u32>(WEST, NORTH)) != vec2<u32>(0u));
    let margin = select(vec2<u32>(1u), vec2<u32>(2u), (vec2<u32>(chunk.coarser) & vec2<u32>(EAST, SOUTH)) != vec2<u32>(0u));
    let high = CHUNK_QUADS - margin;
    let is_near = chunk.step < CELL_STEPS && (turning[slot] & DRAWN) != 0u && column >= low.x && column <= high.x;
    // The vertices that want a closer look, as bits.
    var mixed = 0u;
    // Of the three facets north of a vertex.
    var north = vec3<f32>(0.0);
    var west = vertex_in(chunk, vec2<u32>(west_column, 0u));
    var here = vertex_in(chunk, vec2<u32>(column, 0u));
    var east = vertex_in(chunk, vec2<u32>(east_column, 0u));
    for (var y = 0u; y < CHUNK_SIDE; y++) {
        let south = min(y + 1u, CHUNK_QUADS);
        let south_west = vertex_in(chunk, vec2<u32>(west_column, south));
        let south_here = vertex_in(chunk, vec2<u32>(column, south));
        let south_east = vertex_in(chunk, vec2<u32>(east_column, south));
        let counts_here = counts & vec2<bool>(y < CHUNK_QUADS);
        let of_west = select(vec2<f32>(0.0), facing_of(west, here, south_west, south_here), counts_here.x);
        let of_east = select(vec2<f32>(0.0), facing_of(here, east, south_here, south_east), counts_here.y);
        let of_south = vec3<f32>(of_west.y, of_east);
        let g = (north.x + north.y + north.z) + of_south.x + (of_south.y + of_south.z);
        mixed |= select(0u, 1u << y, is_near && y >= low.y && y <= high.y && is_mixed(north, of_south));
        north = vec3<f32>(of_west, of_east.x);
        let value = select(0.0, select(g, NO_HEIGHT, here.place.w >= NO_HEIGHT), is_made);
        out_turns[number + y * CHUNK_SIDE] = value;
        let at = vec2<u32>(column, y);
        if any(at == vec2<u32>(0u)) || any(at == vec2<u32>(CHUNK_QUADS)) {
            let of_side = side + side_number(at);
            if of_side < arrayLength(&out_sides) {
                out_sides[of_side] = value;
            }
        }
        west = south_west;
        here = south_here;
        east = south_east;
    }
    for (; mixed != 0u; mixed &= mixed - 1u) {
        let y = firstTrailingBit(mixed);
        out_turns[number + y * CHUNK_SIDE] = turn_near(chunk, vertex_in(chunk, vec2<u32>(column, y)));
    }
}
