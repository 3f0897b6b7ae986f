// 32 invocations a chunk, vertex after vertex: where each lies on the page, and its depth.

@group(0) @binding(20) var<storage, read_write> out_screens: array<vec4<i32>>;

fn view_flags(q: vec3<f32>) -> i32 {
    let p = vec2<f32>(q.x, -q.y) * camera.focal;
    let low = drawn_from() * q.z;
    let high = drawn_to() * q.z;
    return select(0, LEFT, p.x < low.x) | select(0, RIGHT, p.x > high.x)
        | select(0, ABOVE, p.y < low.y) | select(0, BELOW, p.y > high.y)
        | select(0, BEHIND, q.z < scene.near)
        | select(0, BEYOND_GUARD, any(abs(p) > vec2<f32>(GUARD * q.z)));
}

fn screen_of(at: vec2<u32>, place: vec4<f32>) -> vec4<i32> {
    let q = camera_space(eye_relative(at / CELL_STEPS, place));
    let flags = view_flags(q) | select(0, MISSING, place.w >= NO_HEIGHT);
    if (flags & (CLIPPED | MISSING)) == 0 {
        return vec4<i32>(snapped(q), bitcast<i32>(depth_of(q)), flags);
    }
    return vec4<i32>(NO_PLACE, 0, 0, flags);
}

@compute @workgroup_size(32, 2)
fn project(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = batch.first_slot + invocation.y;
    if slot >= camera.seen || !in_frustum(bounds_of(slot)) {
        return;
    }
    let chunk = chunks[slot];
    let from_vertex = chunk.block * CHUNK_VERTICES;
    let to_vertex = invocation.y * CHUNK_VERTICES;
    var at = vec2<u32>(invocation.x % CHUNK_SIDE, invocation.x / CHUNK_SIDE);
    for (var v = invocation.x; v < CHUNK_VERTICES; v += 32u) {
        let lattice_place = chunk.origin + shared_vertex(chunk.coarser, at) * chunk.step;
        out_screens[to_vertex + v] = screen_of(lattice_place, places[from_vertex + v]);
        at += vec2<u32>(32u - CHUNK_SIDE, 1u);
        if at.x >= CHUNK_SIDE {
            at = vec2<u32>(at.x - CHUNK_SIDE, at.y + 1u);
        }
    }
}
