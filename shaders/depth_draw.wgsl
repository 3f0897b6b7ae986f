// The hardware's own way, beside which the time of a frame stands: one invocation a vertex that `project` left,
// one a covered pixel of a facet. Fixed function does the rest: coverage and the nearest depth.

struct Corner {
    @builtin(position) place: vec4<f32>,
    @location(0) @interpolate(flat, either) index: u32,
}

@vertex
fn depth_draw(@builtin(vertex_index) i: u32) -> Corner {
    let v = screens[i];
    let half_page = vec2<i32>(camera.size) * 128;
    let at = vec2<f32>(v.xy - half_page) / vec2<f32>(half_page);
    // Clipped and missing vertices lie before the near plane.
    let seen = (v.w & (CLIPPED | MISSING)) == 0;
    return Corner(select(vec4<f32>(0.0, 0.0, -1.0, 1.0), vec4<f32>(at.x, -at.y, bitcast<f32>(v.z), 1.0), seen), i);
}
