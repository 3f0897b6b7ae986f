// One invocation a block of vertices, some columns and rows, of a chunk whose vertices are not there yet: of each the
// offset from its sample, and the sample's height. Whatever the camera, but for chunks beside the page where batches share
// the buffer.
// Chunks that share a vertex evaluate it from the same cell in the same way: they agree to the bit.

@group(0) @binding(20) var<storage, read_write> out_places: array<vec4<f32>>;
@group(0) @binding(21) var<storage, read> fresh: array<u32>;

fn store(chunk: Chunk, column_row: vec2<u32>, place: vec4<f32>, missing: bool) {
    let at = chunk.origin + column_row * chunk.step;
    let none = missing || any(at > (scene.samples - 1u) * CELL_STEPS);
    out_places[vertex_index(chunk, column_row)] = select(place, vec4<f32>(0.0, 0.0, 0.0, NO_HEIGHT), none);
}

// Two neighbouring samples of a row, and whether they are void.
struct Pair {
    west: Sample,
    east: Sample,
    void_west: bool,
    void_east: bool,
}

fn is_void(at: vec2<u32>) -> bool {
    let inside = min(at, scene.samples - 1u);
    return has_voids && !is_valid(inside.x, inside.y);
}

// The samples at the north-west of a cell and east of it, by their place in a tile and in the DEM.
fn pair_of(tile: u32, place: vec2<u32>, cell: vec2<u32>) -> Pair {
    let east = vec2<u32>(1u, 0u);
    return Pair(sample_of(tile, place), sample_of(tile, place + east), is_void(cell), is_void(cell + east));
}

// Columns that one invocation works off, so that they lie in one cell; and rows: at level 2 they share more cells.
fn block_columns(step: u32) -> u32 {
    return select(4u, 2u, step == CELL_STEPS / 2u);
}

fn block_rows(step: u32) -> u32 {
    return select(6u, CHUNK_SIDE, step == CELL_STEPS / 2u);
}

@compute @workgroup_size(16, 4)
fn tessellate(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let number = batch.first_slot + invocation.y;
    let slot = fresh[min(number, camera.fresh - 1u)];
    let chunk = chunks[slot];
    let columns = block_columns(chunk.step);
    let across = CHUNK_QUADS / columns + 1u;
    let first = vec2<u32>(invocation.x % across * columns, invocation.x / across * block_rows(chunk.step));
    if number >= camera.fresh || first.y >= CHUNK_SIDE || (batch.passing == 1u && !in_frustum(bounds_of(slot))) {
        return;
    }
    let end = min(first + vec2<u32>(columns, block_rows(chunk.step)), vec2<u32>(CHUNK_SIDE));
    if chunk.step >= CELL_STEPS {
        // Every vertex is a sample.
        for (var row = first.y; row < end.y; row++) {
            for (var column = first.x; column < end.x; column++) {
                let column_row = vec2<u32>(column, row);
                let height = heights[tile_sample(chunk.tile, column_row)];
                let void_here = is_void((chunk.origin + column_row * chunk.step) / CELL_STEPS);
                store(chunk, column_row, vec4<f32>(0.0, 0.0, 0.0, height), void_here);
            }
        }
        return;
    }
    // One cell after the other: its two patches serve all its vertices of these columns.
    var row = first.y;
    let corner_place = chunk.origin + first * chunk.step;
    var cell = corner_place / CELL_STEPS;
    var place = tile_place(chunk, corner_place);
    var north = pair_of(chunk.tile, place, cell);
    while row < end.y {
        let south = pair_of(chunk.tile, place + vec2<u32>(0u, 1u), cell + vec2<u32>(0u, 1u));
        let below = patch_over(north.west, south.east, south.west, false);
        let above = patch_over(north.west, south.east, north.east, true);
        let next_cell = min(end.y, ((cell.y + 1u) * CELL_STEPS - chunk.origin.y) / chunk.step);
        for (; row < next_cell; row++) {
            for (var column = first.x; column < end.x; column++) {
                let column_row = vec2<u32>(column, row);
                let sub = (chunk.origin + column_row * chunk.step) % CELL_STEPS;
                var p = below;
                if sub.x > sub.y {
                    p = above;
                }
                // Of its cell's samples a vertex depends on those whose weight is not 0.
                let missing = north.void_west || (min(sub.x, sub.y) > 0u && south.void_east)
                    || (sub.x > sub.y && north.void_east) || (sub.y > sub.x && south.void_west);
                let offset = patch_point(p, vec2<f32>(sub) / f32(CELL_STEPS));
                store(chunk, column_row, vec4<f32>(offset, p.height), missing);
            }
        }
        north = south;
        cell.y += 1u;
        place.y += 1u;
    }
}
