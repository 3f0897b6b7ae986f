// Visibility in one word a pixel: depth above, ID + 1 below.

@group(0) @binding(20) var<storage, read_write> out_pixels: array<atomic<u64>>;

fn emit(pixel: u32, depth: f32, id: u32, away: bool, centre: bool) {
    atomicMax(&out_pixels[pixel], (u64(bitcast<u32>(depth)) << 32u) | u64(id + 1u));
}

// Facing bits from a facet on, as far as `emit` asks for them.
fn emitted_bits(id: u32) -> u32 {
    return 0u;
}
