// What every pass knows: the DEM on the device, the camera, and the bindings more than one pass reads.

struct Scene {
    cell: vec2<f32>,        // metres between columns and rows
    samples: vec2<u32>,     // columns, rows
    roots: vec2<u32>,       // of the quadtree of chunks, across, down
    root_size: u32,         // lattice units along a root's side, a power of two
    near: f32,              // metres along the view axis
}

struct Camera {
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    eye_cell: vec2<i32>,    // the sample north-west of the eye
    eye_offset: vec2<f32>,  // metres east and north from that sample to the eye
    eye_height: vec2<f32>,  // metres, high part and remainder
    centre: vec2<f32>,      // half the page in pixels
    focal: f32,             // pixels per unit of tangent
    chunks: u32,            // of the frame
    size: vec2<u32>,        // pixels across, down, of what is drawn: the page or a piece of it
    frustum: vec4<f32>,       // inward normals of the two sides of its map projection; 0 where it is no frustum
    origin: vec2<i32>,      // the page's column and row of its top left pixel
    seen: u32,              // chunks in the first slots that are drawn
    fresh: u32,             // chunks whose vertices are not there yet
}

struct Batch {
    first_slot: u32,        // of the batch
    part_slot: u32,         // the same, within its part of the facing bits
    round: u32,             // 1: IDs where the depth is equal, 0: everything else
    passing: u32,           // 1: its vertices make way for those of the next batch, 0: they stay
}

struct Chunk {
    origin: vec2<u32>,      // lattice place of the north-west vertex
    step: u32,              // lattice units between vertices
    coarser: u32,           // sides beyond which a chunk of twice the step lies: NORTH | EAST | SOUTH | WEST
    low: f32,               // metres, below all its surface
    high: f32,
    beyond: f32,            // metres that its surface reaches beyond its square on the map
    tile: u32,              // which tile holds its samples
    block: u32,             // which block of `places` holds its vertices
    pad: u32,
}

override has_voids: bool = false;
override facing_parts: u32 = 1u;
override two_depths: bool = false;
// Away facets are noted in every pixel they touch, not only where they cover the centre.
override conservative: bool = false;
// Whether what cannot change the picture is left out.
override culls: bool = true;
// Whether curves are listed that nearer land certainly hides.
override all_curves: bool = false;

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var<uniform> camera: Camera;
@group(0) @binding(2) var<uniform> batch: Batch;
@group(0) @binding(3) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(4) var<storage, read> nodes: array<u32>;
// Tiles of 17 x 17 samples, row by row.
@group(0) @binding(5) var<storage, read> heights: array<f32>;
@group(0) @binding(6) var<storage, read> gradients_east: array<f32>;
@group(0) @binding(7) var<storage, read> gradients_north: array<f32>;
// A word a block of 64 x 64 samples, row by row: whether all of them, or none, hold an elevation, or where its bits lie.
@group(0) @binding(8) var<storage, read> valid: array<u32>;
@group(0) @binding(9) var<storage, read> facing_0: array<u32>;
@group(0) @binding(10) var<storage, read> facing_1: array<u32>;
@group(0) @binding(13) var<storage, read> summaries: array<u32>;
@group(0) @binding(14) var<storage, read> places: array<vec4<f32>>;
@group(0) @binding(15) var<storage, read> screens: array<vec4<i32>>;
@group(0) @binding(16) var<storage, read> pixels: array<vec2<u32>>;

const CELL_STEPS: u32 = 64u;
const CHUNK_QUADS: u32 = 16u;
// Blocks of 8 x 8 quads along a chunk's edge.
const CHUNK_BLOCKS: u32 = 2u;
const CHUNK_FACETS: u32 = 512u;
const CHUNK_SIDE: u32 = 17u;
const CHUNK_VERTICES: u32 = 289u;
const CHUNK_WORDS: u32 = 16u;
// Workgroups along one dimension.
const MOST_GROUPS: u32 = 65535u;
const NO_SLOT: u32 = 0xffffffffu;
// Bit of a node that has children: the rest is the index of the first of four.
const INNER: u32 = 0x80000000u;

const NORTH: u32 = 1u;
const EAST: u32 = 2u;
const SOUTH: u32 = 4u;
const WEST: u32 = 8u;
// Facing words of one part: 128 MiB.
const PART_WORDS_LOG2: u32 = 25u;

// Flags of a screen vertex. The first six say on which side of the view it lies: a facet with all its
// vertices on one such side is not seen.
const LEFT: i32 = 1;
const RIGHT: i32 = 2;
const ABOVE: i32 = 4;
const BELOW: i32 = 8;
const BEHIND: i32 = 16;
const BESIDE: i32 = 31;
const BEYOND_GUARD: i32 = 32;
const CLIPPED: i32 = 48;
const MISSING: i32 = 64;
// Least height of a vertex that is missing.
const NO_HEIGHT: f32 = 3e38;
// X of a clipped or missing vertex: look at its flags.
const NO_PLACE: i32 = -0x7fffffff - 1;

// Index in `places` of the vertex at a column and row of a chunk.
fn vertex_index(chunk: Chunk, at: vec2<u32>) -> u32 {
    return chunk.block * CHUNK_VERTICES + at.y * CHUNK_SIDE + at.x;
}

// Nearer depth of the pixel; 0 is sky.
fn pixel_depth(pixel: vec2<u32>) -> u32 {
    return select(pixel.y, max(pixel.x, pixel.y), two_depths);
}

// Whether sample (c, r) holds an elevation.
fn is_valid(c: u32, r: u32) -> bool {
    let across = (scene.samples.x + 63u) >> 6u;
    var word = valid[(r >> 6u) * across + (c >> 6u)];
    if word != 0u && word != 0xffffffffu {
        word = valid[word + (r & 63u) * 2u + ((c >> 5u) & 1u)];
    }
    return ((word >> (c & 31u)) & 1u) == 1u;
}

// Facing bits from facet `id` on to the end of its word, a set bit is away. Decided once, in the facing pass.
fn away_bits(id: u32) -> u32 {
    let word = id >> 5u;
    var bits = 0u;
    if facing_parts == 1u || (word >> PART_WORDS_LOG2) == 0u {
        bits = facing_0[word];
    } else {
        bits = facing_1[word - (1u << PART_WORDS_LOG2)];
    }
    return bits >> (id & 31u);
}

// Whether a facet faces away.
fn is_away(id: u32) -> bool {
    return (away_bits(id) & 1u) == 1u;
}

// Index of a page place.
fn pixel_index(at: vec2<i32>) -> u32 {
    return u32(at.y) * camera.size.x + u32(at.x);
}

fn on_page(at: vec2<i32>) -> bool {
    return all(at >= vec2<i32>(0)) && all(at < vec2<i32>(camera.size));
}

// Where what is drawn begins and ends, in pixels from the page's centre, right and down. A pixel of margin.
fn drawn_from() -> vec2<f32> {
    return vec2<f32>(camera.origin) - camera.centre - 1.0;
}

fn drawn_to() -> vec2<f32> {
    return vec2<f32>(camera.origin + vec2<i32>(camera.size)) - camera.centre + 1.0;
}

// The eight neighbours, clockwise from the north-west.
fn neighbour(k: u32) -> vec2<i32> {
    let i = k + select(0u, 1u, k >= 4u);
    return vec2<i32>(i32(i % 3u) - 1, i32(i / 3u) - 1);
}
