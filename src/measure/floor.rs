//! What a frame costs, and the two limits beside which its time stands: a bare copy of as many bytes, and a hardware
//! depth draw of its facets.

use super::cost::{PassCost, Quantities};
use super::{BareCopy, DepthDraw};
use crate::error::Result;
use crate::gpu::clock::time_of;
use crate::gpu::sizes::LIST_HEADER;
use crate::line::Kind;
use crate::plan::Thrift;
use crate::plan::detail::across;
use crate::render::{Frame, Renderer};
use crate::view::Camera;

/// What each pass of the last frame, that of `camera`, had to move and compute; `frame` is what it left. Of a page in
/// pieces, the last one.
///
/// # Errors
/// Whatever the driver reports.
pub fn costs(renderer: &Renderer<'_>, camera: &Camera, frame: &Frame) -> Result<Vec<PassCost>> {
    let (gpu, plan, buffers) = (renderer.gpu(), renderer.plan(), renderer.buffers());
    let (lattice, seen) = (renderer.lattice(), renderer.seen());
    let of_lattice = Quantities::of(plan, renderer.surface(), &lattice, seen, buffers.made(), camera)?;
    // The last word of a header counts the items.
    let count = |list| {
        let header = gpu.read(buffers.get(list)?, LIST_HEADER)?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&header);
        Ok(words.last().copied().unwrap_or_default().into())
    };
    let quantities = Quantities {
        pixels: frame.raster.pixels.len() as u64,
        land: frame.raster.pixels.iter().filter(|pixel| pixel.kind() != Kind::Sky).count() as u64,
        batches: renderer.batches() as u64,
        queued: count("queue")?,
        listed: [count("candidates")?, count("pairs")?, count("rest")?],
        rim: renderer.rim_edges() as u64,
        ..of_lattice
    };
    Ok(quantities.passes(plan.method, plan.method.visibility(gpu.int64)))
}

/// The limits, measured in turn with the frames of a renderer.
pub struct Floor<'a> {
    renderer: &'a Renderer<'a>,
    copy: BareCopy,
    draw: DepthDraw,
}

impl<'a> Floor<'a> {
    /// Makes ready to copy so many bytes, read and written ones together, and to draw what the renderer draws.
    ///
    /// # Errors
    /// As [`BareCopy::new`] and [`DepthDraw::new`].
    pub fn new(renderer: &'a Renderer<'a>, bytes: u64) -> Result<Self> {
        let draw = DepthDraw::new(renderer.gpu(), renderer.pieces().largest())?;
        let floor = Self { renderer, copy: BareCopy::new(renderer.gpu(), bytes)?, draw };
        // Memory that was never touched is slow the first time.
        floor.copy_ms()?;
        Ok(floor)
    }

    /// How long the bare copy takes, ms; `None` where the driver stamps none.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn copy_ms(&self) -> Result<Option<f64>> {
        time_of(self.renderer.gpu(), |encoder| {
            self.copy.record(encoder);
            Ok(())
        })
    }

    /// How long one draw takes of the facets that the last frame, that of `camera`, rasterized, from the vertices it left,
    /// ms; `None` where the driver stamps none, or where [`Self::lacks_vertices`].
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn draw_ms(&mut self, camera: &Camera) -> Result<Option<f64>> {
        if self.lacks_vertices() {
            return Ok(None);
        }
        let (gpu, lattice, thrift) = (self.renderer.gpu(), self.renderer.lattice(), self.renderer.plan().thrift);
        // Chunks beside the page have the vertices of an earlier frame.
        let across = across(self.renderer.surface(), &lattice, camera)?;
        let slots = (0..self.renderer.seen()).zip(across);
        let drawn = slots.filter(|(_, across)| *across || thrift == Thrift::Nothing).map(|(slot, _)| slot);
        self.draw.load(gpu, &lattice, drawn)?;
        time_of(gpu, |encoder| self.draw.record(gpu, &self.renderer.buffers(), encoder))
    }

    /// Whether the last frame had several vertex batches, of which the device holds the last alone.
    pub fn lacks_vertices(&self) -> bool {
        self.renderer.batches() > 1
    }

    /// ID + 1 of the facet that each pixel of the last draw shows; see [`DepthDraw::ids`].
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn ids(&self) -> Result<Vec<u32>> {
        self.draw.ids(self.renderer.gpu())
    }
}
