//! Seeded random terrain, cameras over it, and what a frame leaves in the buffers.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::gpu::Gpu;
use hachure::plan::batches::BATCH_CHUNKS;
use hachure::plan::{Border, Method, Plan, Share};
use hachure::render::Renderer;
use hachure::surface::lattice::CHUNK_VERTICES;
use hachure::surface::{LatticePoint, Surface};
use hachure::view::Camera;

use crate::scenes::level;

/// Flags of a screen vertex, as `shaders/scene.wgsl` has them; `reflection` compares.
pub const BESIDE: i32 = 31;
pub const CLIPPED: i32 = 48;
pub const MISSING: i32 = 64;

/// A north-west sample far from the origin, as UTM has them.
pub const ORIGIN: DVec2 = DVec2::new(325_249.3, 4_117_889.7);

/// The method of tests that look at facets: its raster keeps depth and ID.
pub const BY_ID: Method = Method::Adjacency { share: Share::Edge };

/// Splitmix64 (Steele, Lea, Flood 2014): the same numbers from the same seed everywhere.
pub struct Random(pub u64);

impl Random {
    /// Uniform in `low..high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }
}

/// White noise of `relief` metres around 1500 m: every slope at every cell.
pub fn noise(seed: u64, samples: [usize; 2], cell: f64, relief: f64) -> Vec<f32> {
    let mut random = Random(seed ^ (cell as u64) << 32);
    (0..samples[0] * samples[1]).map(|_| (1500.0 + random.between(-0.5, 0.5) * relief) as f32).collect()
}

/// The surface of such heights, square cells of `cell` metres, far from the origin.
pub fn surface(columns: usize, cell: f64, heights: Vec<f32>) -> Surface {
    Surface::new(Dem::from_heights(columns, DVec2::splat(cell), ORIGIN, heights))
}

/// A surface of [`noise`].
pub fn rough(seed: u64, samples: [usize; 2], cell: f64, relief: f64) -> Surface {
    surface(samples[0], cell, noise(seed, samples, cell, relief))
}

/// The point `above` metres over the surface at a place in columns and rows, to the nearest 1/64 cell.
pub fn over(surface: &Surface, column: f64, row: f64, above: f64) -> DVec3 {
    let at = LatticePoint { x: (column * 64.0) as u32, y: (row * 64.0) as u32 };
    surface.position(at).expect("a place on the surface") + DVec3::Z * above
}

/// A camera at `eye`, 60 degrees across.
pub fn look(eye: DVec3, azimuth: f64, altitude: f64, [width, height]: [u32; 2]) -> Camera {
    Camera { eye, azimuth, altitude, fov: 60.0, width, height }
}

/// What a frame left: the vertices, and depth and ID of each pixel.
pub struct Shot {
    /// 289 a chunk: x and y in 1/256 px, depth bits, flags; all zero where the chunk was left out.
    pub screens: Vec<[i32; 4]>,
    /// Row by row: ID + 1 and depth bits.
    pub pixels: Vec<[u32; 2]>,
}

/// Draws a frame from a clean slate, and reads it.
pub fn shoot(gpu: &Gpu, renderer: &Renderer<'_>, camera: &Camera) -> Shot {
    let chunks = renderer.lattice().chunks().len();
    assert!(chunks <= BATCH_CHUNKS as usize, "{chunks} chunks share the vertex buffer, the first are overwritten");
    let buffer = |name| renderer.buffers().get(name).expect("a buffer of this name").clone();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.clear_buffer(&buffer("screens"), 0, None);
    gpu.queue.submit([encoder.finish()]);
    renderer.frame(camera).expect("a frame");
    let read = |name, size| gpu.read(&buffer(name), size).expect("a copy of the buffer");
    let screens = read("screens", chunks as u64 * u64::from(CHUNK_VERTICES) * 16);
    let pixels = read("pixels", u64::from(camera.width) * u64::from(camera.height) * 8);
    Shot { screens: bytemuck::pod_collect_to_vec(&screens), pixels: bytemuck::pod_collect_to_vec(&pixels) }
}

/// Renderer for [`shoot`].
pub fn renderer<'a>(gpu: &'a Gpu, surface: &'a Surface, n: u32, method: Method, size: [u32; 2]) -> Renderer<'a> {
    Renderer::new(gpu, surface, Plan::new(level(n), method, Border::Off), size).expect("a renderer")
}
