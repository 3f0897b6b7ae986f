// Signed 64-bit integers as two u32, low word first: for devices without them, and the same bits on all.

fn wide_mul_u32(a: u32, b: u32) -> vec2<u32> {
    let a0 = a & 0xffffu;
    let a1 = a >> 16u;
    let b0 = b & 0xffffu;
    let b1 = b >> 16u;
    let low = a0 * b0;
    let middle = a1 * b0 + (low >> 16u);
    let cross_term = a0 * b1 + (middle & 0xffffu);
    return vec2<u32>(a * b, a1 * b1 + (middle >> 16u) + (cross_term >> 16u));
}

fn wide_mul(a: i32, b: i32) -> vec2<u32> {
    let p = wide_mul_u32(u32(a), u32(b));
    return vec2<u32>(p.x, p.y - select(0u, u32(b), a < 0) - select(0u, u32(a), b < 0));
}

fn wide_add(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn wide_sub(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}

// a times a small non-negative factor.
fn wide_scale(a: vec2<u32>, factor: u32) -> vec2<u32> {
    let low = wide_mul_u32(a.x, factor);
    return vec2<u32>(low.x, low.y + a.y * factor);
}

fn wide_sign(a: vec2<u32>) -> i32 {
    return select(select(0, 1, (a.x | a.y) != 0u), -1, (a.y >> 31u) == 1u);
}

// Nearest f32, for values whose sign is decided elsewhere.
fn wide_f32(a: vec2<u32>) -> f32 {
    return f32(bitcast<i32>(a.y)) * 4294967296.0 + f32(a.x);
}
