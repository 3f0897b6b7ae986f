// Without `primitive_index` a pixel of the depth draw shows the number + 1 of a vertex: as much work and no use.

@fragment
fn show(corner: Corner) -> @location(0) u32 {
    return corner.index + 1u;
}
