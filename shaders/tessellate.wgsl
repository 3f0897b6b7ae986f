// One invocation a third of a column of vertices: of each the offset from its sample, the place on the page, the depth.
// Chunks that share a vertex evaluate it from the same cell in the same way: they agree to the bit.

@group(0) @binding(20) var<storage, read_write> out_places: array<vec4<f32>>;
@group(0) @binding(21) var<storage, read_write> out_screens: array<vec4<i32>>;

fn view_flags(q: vec3<f32>) -> i32 {
    let p = vec2<f32>(q.x, -q.y) * camera.focal;
    let low = drawn_from() * q.z;
    let high = drawn_to() * q.z;
    return select(0, LEFT, p.x < low.x) | select(0, RIGHT, p.x > high.x)
        | select(0, ABOVE, p.y < low.y) | select(0, BELOW, p.y > high.y)
        | select(0, BEHIND, q.z < scene.near)
        | select(0, BEYOND_GUARD, any(abs(p) > vec2<f32>(GUARD * q.z)));
}

// Whether a vertex lies outside the DEM or depends on a void: no facet that has it exists.
fn is_missing(at: vec2<u32>) -> bool {
    if any(at > (scene.samples - 1u) * CELL_STEPS) {
        return true;
    }
    if !has_voids {
        return false;
    }
    let cell = at / CELL_STEPS;
    let sub = at % CELL_STEPS;
    let west = cell.x;
    let east = min(cell.x + 1u, scene.samples.x - 1u);
    let north = cell.y;
    let south = min(cell.y + 1u, scene.samples.y - 1u);
    return (max(sub.x, sub.y) < CELL_STEPS && !is_valid(west, north))
        || (min(sub.x, sub.y) > 0u && !is_valid(east, south))
        || (sub.x > sub.y && !is_valid(east, north))
        || (sub.y > sub.x && !is_valid(west, south));
}

// Rows of vertices that one invocation works off, down a column.
const STRIP: u32 = 11u;

fn store(i: u32, at: vec2<u32>, place: vec4<f32>) {
    let q = camera_space(eye_relative(at / CELL_STEPS, place));
    let flags = view_flags(q) | select(0, MISSING, is_missing(at));
    var screen = vec4<i32>(NO_PLACE, 0, 0, flags);
    if (flags & (CLIPPED | MISSING)) == 0 {
        screen = vec4<i32>(snapped(q), bitcast<i32>(depth_of(q)), flags);
    }
    out_places[i] = place;
    out_screens[i] = screen;
}

@compute @workgroup_size(64)
fn tessellate(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let column = invocation.x % CHUNK_SIDE;
    let row = invocation.x / CHUNK_SIDE * STRIP;
    let slot = batch.first_slot + group.y;
    if row >= CHUNK_SIDE || !in_wedge(sphere_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    var at = chunk.origin + vec2<u32>(column, row) * chunk.step;
    var i = group.y * CHUNK_VERTICES + row * CHUNK_SIDE + column;
    let end = i + STRIP * CHUNK_SIDE;
    if chunk.step == CELL_STEPS {
        // Every vertex is a sample.
        for (; i < end; i += CHUNK_SIDE) {
            let sample = min(at / CELL_STEPS, scene.samples - 1u);
            store(i, at, vec4<f32>(0.0, 0.0, 0.0, heights[sample.y * scene.samples.x + sample.x]));
            at.y += chunk.step;
        }
        return;
    }
    while i < end {
        // One cell after the other: its two patches serve all its vertices of this column.
        let cell = at / CELL_STEPS;
        let below = patch_of(cell, false);
        let above = patch_of(cell, true);
        for (; i < end && at.y / CELL_STEPS == cell.y; i += CHUNK_SIDE) {
            let sub = at % CELL_STEPS;
            var p = below;
            if sub.x > sub.y {
                p = above;
            }
            store(i, at, vec4<f32>(patch_point(p, vec2<f32>(sub) / f32(CELL_STEPS)), p.height));
            at.y += chunk.step;
        }
    }
}
