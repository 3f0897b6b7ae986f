// Two depths a pixel, no ID: nearest away surface, then nearest toward surface. Where coverage is conservative, also the
// nearest away depth of all facets that touch the pixel.

@group(0) @binding(20) var<storage, read_write> out_pixels: array<atomic<u32>>;
@group(0) @binding(24) var<storage, read_write> out_touched: array<atomic<u32>>;

fn emit(pixel: u32, depth: f32, id: u32, away: bool, centre: bool) {
    if centre {
        atomicMax(&out_pixels[2u * pixel + select(1u, 0u, away)], bitcast<u32>(depth));
    }
    if conservative && away {
        atomicMax(&out_touched[pixel], bitcast<u32>(depth));
    }
}

// Facing bits from a facet on, as far as `emit` asks for them.
fn emitted_bits(id: u32) -> u32 {
    return away_bits(id);
}
