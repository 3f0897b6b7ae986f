// Visibility without 64-bit atomics, two words a pixel: first the depth, then the highest ID + 1 at that depth, by one
// pipeline, so that both passes compute the same depth bits.

@group(0) @binding(20) var<storage, read_write> out_pixels: array<atomic<u32>>;

fn emit(pixel: u32, depth: f32, id: u32, away: bool, centre: bool) {
    if batch.round == 0u {
        atomicMax(&out_pixels[2u * pixel + 1u], bitcast<u32>(depth));
    } else if atomicLoad(&out_pixels[2u * pixel + 1u]) == bitcast<u32>(depth) {
        atomicMax(&out_pixels[2u * pixel], id + 1u);
    }
}

// Facing bits from a facet on, as far as `emit` asks for them.
fn emitted_bits(id: u32) -> u32 {
    return 0u;
}
