// Which chunks a frame can do without.

// A box around a chunk: eye-relative middle, and half its sides, metres.
struct Bounds {
    middle: vec3<f32>,
    reach: vec3<f32>,
}

// Room for rounding: of the box, and of a cell.
const SLACK: f32 = 0.01;

fn bounds_of(slot: u32) -> Bounds {
    let chunk = chunks[slot];
    let end = min(chunk.origin + CHUNK_QUADS * chunk.step, (scene.samples - 1u) * CELL_STEPS);
    let half = vec2<f32>(end - min(chunk.origin, end)) * (0.5 / f32(CELL_STEPS)) * scene.cell;
    let corner = vec2<f32>(vec2<i32>(chunk.origin / CELL_STEPS) - camera.eye_cell)
        + vec2<f32>(chunk.origin % CELL_STEPS) / f32(CELL_STEPS);
    let middle = (corner * scene.cell + half) * vec2<f32>(1.0, -1.0) - camera.eye_offset;
    let low = (chunk.low - camera.eye_height.x) - camera.eye_height.y;
    let high = (chunk.high - camera.eye_height.x) - camera.eye_height.y;
    let reach = vec3<f32>(half + chunk.beyond, (high - low) * 0.5);
    return Bounds(vec3<f32>(middle, (low + high) * 0.5), reach * (1.0 + SLACK) + max(scene.cell.x, scene.cell.y) * SLACK);
}

// Whether some ray of the page passes over or under the chunk: only such chunks can be seen or be crossed by a walk,
// since a segment between two points of a frustum stays in it.
fn in_frustum(box: Bounds) -> bool {
    let left = dot(camera.frustum.xy, box.middle.xy) + dot(abs(camera.frustum.xy), box.reach.xy);
    let right = dot(camera.frustum.zw, box.middle.xy) + dot(abs(camera.frustum.zw), box.reach.xy);
    return !culls || (left >= 0.0 && right >= 0.0);
}

// Whether some of a box lies on the inner side of a plane through the eye.
fn reaches(box: Bounds, inward: vec3<f32>) -> bool {
    return dot(inward, box.middle) + dot(abs(inward), box.reach) >= 0.0;
}

// Whether the chunk can be seen.
fn in_view(box: Bounds) -> bool {
    if !culls {
        return true;
    }
    let forward = camera.forward.xyz;
    let side = camera.right.xyz * camera.focal;
    let rise = camera.up.xyz * camera.focal;
    let low = drawn_from();
    let high = drawn_to();
    return in_frustum(box)
        && dot(forward, box.middle) + dot(abs(forward), box.reach) >= scene.near
        && reaches(box, side - forward * low.x) && reaches(box, forward * high.x - side)
        && reaches(box, -rise - forward * low.y) && reaches(box, forward * high.y + rise);
}
