//! Frames of one plan, and what they leave in the buffers.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use hachure::door::plan::batches::BATCH_CHUNKS;
use hachure::door::plan::{Frame, Pieces, Yields};
use hachure::door::surface::Lattice;
use hachure::door::surface::lattice::CHUNK_VERTICES;
use hachure::error::Result;
use hachure::gpu::Gpu;
use hachure::line::InkRaster;
use hachure::plan::{Border, Method, Plan, SharedVertices};
use hachure::render::{Drawn, FrameTime, Page, Renderer};
use hachure::surface::{Level, Surface};
use hachure::truth::Mask;
use hachure::view::Camera;

use crate::judged::mask;
use crate::scenes::{gpu, level};

/// Flags of a screen vertex, as `shaders/scene.wgsl` has them; `reflection` compares.
pub const BESIDE: i32 = 31;
pub const CLIPPED: i32 = 48;
pub const MISSING: i32 = 64;

/// Every method that inks pixels, with its name: all but the one that yields curves.
pub const METHODS: [(&str, Method); Method::ALL.len() - 1] = {
    let mut named = [("", Method::Walk); Method::ALL.len() - 1];
    let (mut i, mut n) = (0, 0);
    while i < Method::ALL.len() {
        if let Yields::Ink = Method::ALL[i].entry().yields {
            named[n] = (Method::ALL[i].entry().name, Method::ALL[i]);
            n += 1;
        }
        i += 1;
    }
    named
};

/// The method of tests that look at facets: its raster keeps depth and ID.
pub const BY_ID: Method = Method::Adjacency { share: SharedVertices::Edge };

/// A renderer that draws one plan.
pub struct Planned {
    renderer: Renderer,
    pub plan: Plan,
}

impl Planned {
    /// A new renderer of a surface.
    pub fn new(gpu: &Arc<Gpu>, surface: &Arc<Surface>, plan: Plan) -> Self {
        Self { renderer: Renderer::new(gpu.clone(), surface.clone()).expect("a renderer"), plan }
    }

    /// A renderer of facets of level `n`, by their IDs and without border lines.
    pub fn by_id(gpu: &Arc<Gpu>, surface: &Arc<Surface>, n: u32) -> Self {
        Self::new(gpu, surface, Plan::new(level(n), BY_ID, Border::Off))
    }

    /// A frame on a page that is cut in a way of its own.
    pub fn plan_in(&mut self, camera: &Camera, pieces: Pieces) -> Frame {
        self.renderer.plan(&self.plan, camera).and_then(|frame| frame.cut(pieces)).expect("a frame")
    }

    pub fn frame(&mut self, camera: &Camera) -> Result<Frame> {
        self.renderer.frame(&self.plan, camera)
    }

    pub fn draw(&mut self, camera: &Camera) -> Result<Drawn> {
        self.renderer.draw(&self.plan, camera)
    }

    pub fn page(&mut self, camera: &Camera) -> Result<Page> {
        self.renderer.page(&self.plan, camera, |_| ())
    }

    pub fn timed_frame(&mut self, camera: &Camera) -> Result<FrameTime> {
        self.renderer.timed_frame(&self.plan, camera)
    }

    pub fn time_of_frame(&mut self, camera: &Camera) -> Result<f64> {
        self.renderer.time_of_frame(&self.plan, camera)
    }

    /// The page of a frame as packed for reading.
    pub fn bytes(&mut self, camera: &Camera) -> Vec<u8> {
        bytemuck::cast_slice(&self.draw(camera).expect("a frame").raster.pixels).to_vec()
    }

    /// The lattice of the last frame.
    pub fn lattice(&self) -> Arc<Lattice> {
        self.renderer.last().expect("a frame").lattice.clone()
    }

    /// The buffer of this name.
    pub fn buffer(&self, name: &str) -> wgpu::Buffer {
        self.renderer.on_device().buffer(name).expect(name).clone()
    }

    /// The first values of a buffer.
    pub fn values<T: bytemuck::Pod>(&self, name: &str, count: usize) -> Vec<T> {
        self.renderer.gpu().read(&self.buffer(name), count).expect("a copy of the buffer")
    }

    /// Draws a frame from a clean slate, and reads it.
    pub fn shoot(&mut self, camera: &Camera) -> Shot {
        self.renderer.prepare(&self.plan, camera).expect("room for a frame");
        let gpu = self.renderer.gpu().clone();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&self.buffer("screens"), 0, None);
        gpu.queue.submit([encoder.finish()]);
        let lattice = self.frame(camera).expect("a frame").lattice;
        let chunks = lattice.chunks().len();
        assert!(chunks <= BATCH_CHUNKS as usize, "{chunks} chunks share the vertex buffer, the first are overwritten");
        let screens = self.values("screens", chunks * CHUNK_VERTICES as usize);
        let pixels = self.values("pixels", camera.width as usize * camera.height as usize);
        Shot { lattice, screens, pixels }
    }
}

impl Deref for Planned {
    type Target = Renderer;

    fn deref(&self) -> &Renderer {
        &self.renderer
    }
}

impl DerefMut for Planned {
    fn deref_mut(&mut self) -> &mut Renderer {
        &mut self.renderer
    }
}

/// What a frame left: its lattice, the vertices, and depth and ID of each pixel.
pub struct Shot {
    pub lattice: Arc<Lattice>,
    /// 289 a chunk: x and y in 1/256 px, depth bits, flags; all zero where the chunk was left out.
    pub screens: Vec<[i32; 4]>,
    /// Row by row: ID + 1 and depth bits.
    pub pixels: Vec<[u32; 2]>,
}

/// One frame.
pub fn draw(surface: &Arc<Surface>, camera: &Camera, level: Level, method: Method, border: Border) -> Drawn {
    Planned::new(gpu(), surface, Plan::new(level, method, border)).draw(camera).expect("a frame")
}

/// The ink of one frame.
pub fn draw_mask(surface: &Arc<Surface>, camera: &Camera, level: Level, method: Method, border: Border) -> Mask {
    let mut renderer = Planned::new(gpu(), surface, Plan::new(level, method, border));
    mask(&renderer.draw(camera).expect("a frame").raster, renderer.near())
}

/// How many pixels are ink.
pub fn count_ink(raster: &InkRaster) -> usize {
    raster.pixels.iter().filter(|p| p.is_ink()).count()
}
