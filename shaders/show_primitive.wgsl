// A pixel of the depth draw shows the number + 1 of its facet in the draw. Stands behind `enable primitive_index;`.

@fragment
fn show(@builtin(primitive_index) id: u32) -> @location(0) u32 {
    return id + 1u;
}
