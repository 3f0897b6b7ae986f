// Lists of pixels from one pass to another.

// A list being written: the workgroups of 64 that a pass over it takes along x, as far as they go, and the pixels, each with
// eight bits that say which of its neighbours are meant.
struct List {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
    pixels: array<u32>,
}

// The same to read.
struct ListRead {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    pixels: array<u32>,
}

fn listed(pixel: u32, neighbours: u32) -> u32 {
    return pixel | (neighbours << 24u);
}

fn listed_pixel(item: u32) -> u32 {
    return item & 0xffffffu;
}

fn listed_neighbours(item: u32) -> u32 {
    return item >> 24u;
}

// Place on the page of a listed pixel.
fn listed_place(item: u32) -> vec2<i32> {
    let i = listed_pixel(item);
    return vec2<i32>(vec2<u32>(i % camera.size.x, i / camera.size.x));
}
