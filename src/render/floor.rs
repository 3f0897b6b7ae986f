//! What a frame costs, and the two limits beside which its time stands: a bare copy of as many bytes, and a hardware
//! depth draw of its facets.

use super::{Frame, Renderer};
use crate::error::Result;
use crate::gpu::clock::time_of;
use crate::gpu::sizes::LIST_HEADER;
use crate::gpu::{BareCopy, DepthDraw};
use crate::line::Kind;
use crate::plan::Thrift;
use crate::plan::cost::{PassCost, Quantities};
use crate::plan::detail::across;
use crate::view::Camera;

impl Renderer<'_> {
    /// What each pass of the last frame, that of `camera`, had to move and compute; `frame` is what it left. Of a page in
    /// pieces, the last one.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn costs(&self, camera: &Camera, frame: &Frame) -> Result<Vec<PassCost>> {
        let loaded = self.loaded.borrow();
        let (seen, made) = (self.seen(&loaded), loaded.buffers.made());
        let of_lattice = Quantities::of(&self.plan, self.surface, &loaded.lattice, seen, made, camera)?;
        // The last word of a header counts the items.
        let count = |list| {
            let header = self.gpu.read(loaded.buffers.get(list)?, LIST_HEADER)?;
            let words: Vec<u32> = bytemuck::pod_collect_to_vec(&header);
            Ok(words.last().copied().unwrap_or_default().into())
        };
        let quantities = Quantities {
            pixels: frame.raster.pixels.len() as u64,
            land: frame.raster.pixels.iter().filter(|pixel| pixel.kind() != Kind::Sky).count() as u64,
            batches: loaded.batches.len() as u64,
            queued: count("queue")?,
            listed: [count("candidates")?, count("pairs")?, count("rest")?],
            rim: self.rim.len() as u64,
            ..of_lattice
        };
        Ok(quantities.passes(self.plan.method, self.visibility))
    }
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
        let draw = DepthDraw::new(renderer.gpu, renderer.pieces.largest())?;
        let floor = Self { renderer, copy: BareCopy::new(renderer.gpu, bytes)?, draw };
        // Memory that was never touched is slow the first time.
        floor.copy_ms()?;
        Ok(floor)
    }

    /// How long the bare copy takes, ms; `None` where the driver stamps none.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn copy_ms(&self) -> Result<Option<f64>> {
        time_of(self.renderer.gpu, |encoder| {
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
        let Renderer { gpu, surface, plan, loaded, .. } = self.renderer;
        let loaded = loaded.borrow();
        // Chunks beside the page have the vertices of an earlier frame.
        let across = across(surface, &loaded.lattice, camera)?;
        let slots = (0..self.renderer.seen(&loaded)).zip(across);
        let drawn = slots.filter(|(_, across)| *across || plan.thrift == Thrift::Nothing).map(|(slot, _)| slot);
        self.draw.load(gpu, &loaded.lattice, drawn)?;
        time_of(gpu, |encoder| self.draw.record(gpu, &loaded.buffers, encoder))
    }

    /// Whether the last frame had several vertex batches, of which the device holds the last alone.
    pub fn lacks_vertices(&self) -> bool {
        self.renderer.loaded.borrow().batches.len() > 1
    }

    /// ID + 1 of the facet that each pixel of the last draw shows; see [`DepthDraw::ids`].
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn ids(&self) -> Result<Vec<u32>> {
        self.draw.ids(self.renderer.gpu)
    }
}
