// One invocation a patch edge of the rim: where its one facet is toward, draws it one pixel wide over what lies
// farther. A pixel belongs to the line where the edge crosses its central cross: thin, and connected from edge to edge.

@group(0) @binding(22) var<storage, read_write> out_ink: array<atomic<u32>>;

// Whether a pixel shows an underside: two depths are the away and the toward one.
fn shows_underside(pixel: vec2<u32>) -> bool {
    if two_depths {
        return pixel.x > pixel.y;
    }
    return pixel.x != 0u && is_away(pixel.x - 1u);
}

// A rim line is seen where the surface beside it is farther, in the pixel or one of its four neighbours. The rim of an underside
// is none: where that alone shows, nearer than the edge, the surface that ends there lies behind it, by less than a pixel.
fn draw(on_whole_page: vec2<i32>, depth: f32) {
    let at = on_whole_page - camera.origin;
    if !on_page(at) {
        return;
    }
    let edge = bitcast<u32>(depth);
    var farthest = 0xffffffffu;
    var behind_underside = false;
    var shows_top = false;
    for (var k = 0u; k < 5u; k++) {
        let beside = at + cross_place(k);
        if on_page(beside) {
            let pixel = pixels[pixel_index(beside)];
            let away = shows_underside(pixel);
            farthest = min(farthest, pixel_depth(pixel));
            behind_underside |= away && pixel_depth(pixel) > edge;
            shows_top |= !away && pixel_depth(pixel) != 0u;
        }
    }
    if edge >= farthest && (shows_top || !behind_underside) {
        atomicOr(&out_ink[pixel_index(at)], BORDER);
    }
}

// The four neighbours, the odd places of a block of 3 x 3, and last its middle, the pixel itself.
fn cross_place(k: u32) -> vec2<i32> {
    let i = select(2u * k + 1u, 4u, k == 4u);
    return vec2<i32>(i32(i % 3u) - 1, i32(i / 3u) - 1);
}

// Pixels whose centre line of one axis the edge from `p` to `q` crosses; z is depth. `axis` 0: vertical centre lines.
fn draw_crossings(p: vec3<f32>, q: vec3<f32>, axis: u32) {
    let low = min(p[axis], q[axis]);
    let high = max(p[axis], q[axis]);
    let first = i32(max(ceil(low - 0.5), f32(camera.origin[axis])));
    let end = i32(min(ceil(high - 0.5), f32(camera.origin[axis] + i32(camera.size[axis]))));
    for (var k = first; k < end; k++) {
        let t = (f32(k) + 0.5 - p[axis]) / (q[axis] - p[axis]);
        let at = p + (q - p) * clamp(t, 0.0, 1.0);
        let other = i32(floor(at[1u - axis]));
        draw(select(vec2<i32>(other, k), vec2<i32>(k, other), axis == 0u), at.z);
    }
}

// Draws the edge of a facet between two lattice vertices of its chunk.
fn draw_edge(chunk: Chunk, at: vec2<u32>, end: vec2<u32>) {
    var p = camera_space(eye_relative(at / CELL_STEPS, vertex_place(chunk, at)));
    var q = camera_space(eye_relative(end / CELL_STEPS, vertex_place(chunk, end)));
    if p.z < scene.near && q.z < scene.near {
        return;
    }
    if p.z < scene.near {
        p = mix(q, p, (q.z - scene.near) / (q.z - p.z));
    } else if q.z < scene.near {
        q = mix(p, q, (p.z - scene.near) / (p.z - q.z));
    }
    let start = vec3<f32>(on_paper(p), depth_of(p));
    let end_place = vec3<f32>(on_paper(q), depth_of(q));
    draw_crossings(start, end_place, 0u);
    draw_crossings(start, end_place, 1u);
}

// Draws the edge of half a quad between two vertices of its chunk, where its facet faces the eye.
fn at_rim(slot: u32, quad: vec2<u32>, half: u32, from_vertex: vec2<u32>, to_vertex: vec2<u32>, turned: bool) {
    let chunk = chunks[slot];
    let start = chunk.origin + shared_vertex(chunk.coarser, from_vertex) * chunk.step;
    let end = chunk.origin + shared_vertex(chunk.coarser, to_vertex) * chunk.step;
    if !is_away(slot * CHUNK_FACETS + quad_local(quad) + half) && any(start != end) {
        draw_edge(chunk, start, end);
    }
}

@compute @workgroup_size(64)
fn border(@builtin(global_invocation_id) invocation: vec3<u32>) {
    visit_rim(invocation.y * MOST_GROUPS * 64u + invocation.x);
}
