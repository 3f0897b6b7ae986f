// 17 invocations a chunk whose values are wanted, each a column of vertices from north to south: of each vertex g = n . (eye - p),
// where n is the sum of the normals of the chunk's own facets around it, as long as twice their areas (Hertzmann, Zorin
// 2000). Above 0 the surface faces the eye. What other chunks add on a side adds `meet`.

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
    let is_made = batch.passing == 0u || in_wedge(bounds_of(slot));
    let number = invocation.y * CHUNK_VERTICES + column;
    let side = around[slot * AROUND + SIDES_AT] * SIDE_VERTICES;
    var sum = 0.0;
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
        let g = sum + of_west.y + (of_east.x + of_east.y);
        sum = (of_west.x + of_west.y) + of_east.x;
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
}
