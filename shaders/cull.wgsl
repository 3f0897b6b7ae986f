// Which chunks a frame can do without.

// The sphere around a chunk: eye-relative centre and radius, metres.
fn sphere_of(slot: u32) -> vec4<f32> {
    let sphere = spheres[slot];
    let eye = vec2<f32>(camera.eye_cell) * scene.cell * vec2<f32>(1.0, -1.0) + camera.eye_offset;
    let height = (sphere.z - camera.eye_height.x) - camera.eye_height.y;
    return vec4<f32>(sphere.xy - eye, height, sphere.w);
}

// Whether some ray of the page passes over or under the chunk: only such chunks can be seen or be crossed by a walk,
// since a segment between two points of a wedge stays in it.
fn in_wedge(sphere: vec4<f32>) -> bool {
    return !thrifty || (dot(camera.wedge.xy, sphere.xy) >= -sphere.w && dot(camera.wedge.zw, sphere.xy) >= -sphere.w);
}

// Whether the chunk can be seen.
fn in_view(sphere: vec4<f32>) -> bool {
    if !thrifty {
        return true;
    }
    let at = camera.focal * vec2<f32>(dot(sphere.xyz, camera.right.xyz), -dot(sphere.xyz, camera.up.xyz));
    let forward = dot(sphere.xyz, camera.forward.xyz);
    // Distances to the side planes, scaled by the length of their normals.
    let low = drawn_from();
    let high = drawn_to();
    return forward + sphere.w >= scene.near && in_wedge(sphere)
        && all(low * forward - at <= sphere.w * sqrt(camera.focal * camera.focal + low * low))
        && all(at - high * forward <= sphere.w * sqrt(camera.focal * camera.focal + high * high));
}
