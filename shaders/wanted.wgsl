// One invocation a chunk: where a contour may run through it and it may appear, notes that its lines are drawn and the values of its
// vertices wanted, and those of all chunks that share one; and finds room for the values of their sides.

@group(0) @binding(20) var<storage, read_write> out_turning: array<atomic<u32>>;
@group(0) @binding(21) var<storage, read_write> out_around: array<u32>;
@group(0) @binding(22) var<storage, read_write> out_tally: Tally;

fn want(slot: u32) {
    if (atomicOr(&out_turning[slot], WANTED) & WANTED) == 0u {
        out_around[slot * AROUND + SIDES_AT] = atomicAdd(&out_tally.wanted, 1u);
    }
}

// So many pixels are looked at before a chunk counts as seen.
const MOST_PIXELS: i32 = 1024;

// Whether all pixels that a box may touch, and two about them, show surface that is certainly nearer: then so it is about
// each of its segments, a pixel to either side.
fn lies_buried(box: Bounds) -> bool {
    let middle = camera_space(box.middle);
    let reach = vec3<f32>(
        dot(abs(camera.right.xyz), box.reach),
        dot(abs(camera.up.xyz), box.reach),
        dot(abs(camera.forward.xyz), box.reach),
    );
    let nearest = middle.z - reach.z;
    if nearest < scene.near {
        return false;
    }
    let low = vec2<f32>(middle.x, -middle.y) - reach.xy;
    let high = vec2<f32>(middle.x, -middle.y) + reach.xy;
    let farthest = middle.z + reach.z;
    let from_px = low * camera.focal / select(vec2<f32>(farthest), vec2<f32>(nearest), low < vec2<f32>(0.0)) + camera.centre;
    let to_px = high * camera.focal / select(vec2<f32>(nearest), vec2<f32>(farthest), high < vec2<f32>(0.0)) + camera.centre;
    let page = 2.0 * camera.centre;
    let first = max(vec2<i32>(floor(clamp(from_px, vec2<f32>(0.0), page))) - camera.origin - 2, vec2<i32>(0));
    let last = min(vec2<i32>(floor(clamp(to_px, vec2<f32>(0.0), page))) - camera.origin + 2, vec2<i32>(camera.size) - 1);
    let across = last - first + 1;
    if any(across <= vec2<i32>(0)) || across.x > MOST_PIXELS || across.y > MOST_PIXELS || across.x * across.y > MOST_PIXELS {
        return false;
    }
    let depth = scene.near / nearest * NEARER;
    for (var y = first.y; y <= last.y; y++) {
        for (var x = first.x; x <= last.x; x++) {
            if bitcast<f32>(pixel_depth(pixels[pixel_index(vec2<i32>(x, y))])) <= depth {
                return false;
            }
        }
    }
    return true;
}

@compute @workgroup_size(64)
fn wanted(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let slot = invocation.y * MOST_GROUPS * 64u + invocation.x;
    if slot >= camera.seen || (atomicLoad(&out_turning[slot]) & BOTH) != BOTH {
        return;
    }
    let box = bounds_of(slot);
    if !in_view(box) || (culls && !all_curves && lies_buried(box)) {
        return;
    }
    atomicOr(&out_turning[slot], DRAWN);
    want(slot);
    for (var k = 0u; k < AROUND; k++) {
        let at = vec2<u32>(k & 3u, k >> 2u);
        if any(at == vec2<u32>(0u)) || any(at == vec2<u32>(3u)) {
            let beside = out_around[slot * AROUND + k];
            if beside != NO_SLOT {
                want(beside);
            }
        }
    }
}
