//! What a frame costs, and the two limits beside which its time stands: a bare copy of as many bytes, and a hardware
//! depth draw of its facets.

use std::sync::Arc;

use super::cost::{PassCost, Quantities};
use super::{BareCopy, DepthDraw};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::clock::time_of;
use crate::line::Kind;
use crate::plan::Frame;
use crate::render::{Drawn, Renderer};

/// What each pass of the last frame had to move and compute; `drawn` is what it left. Of a page in pieces, the last one.
///
/// # Errors
/// Whatever the driver reports; [`Error::Mistake`] when there was no frame.
pub fn costs(renderer: &Renderer, drawn: &Drawn) -> Result<Vec<PassCost>> {
    let frame = last(renderer)?;
    let on_device = renderer.on_device();
    let of_chunks = Quantities::of(frame, renderer.surface(), on_device.scene.made())?;
    let count = |list| {
        // The last word of a header counts the items.
        let header: Vec<u32> = renderer.gpu().read(on_device.buffer(list)?, 4)?;
        Ok(header.last().copied().unwrap_or_default().into())
    };
    // Lists of other methods hold what their frames left.
    let listed = |list| if frame.lists().any(|of_frame| of_frame == list) { count(list) } else { Ok(0) };
    let pixels = &drawn.raster.pixels;
    let quantities = Quantities {
        pixels: pixels.len() as u64,
        land: pixels.iter().filter(|pixel| pixel.kind() != Kind::Sky).count() as u64,
        queued: count("queue")?,
        listed: [listed("candidates")?, listed("pairs")?, listed("rest")?],
        rim: on_device.scene.rim_edges() as u64,
        ..of_chunks
    };
    Ok(quantities.passes(frame))
}

/// The frame that lies on the device.
fn last(renderer: &Renderer) -> Result<&Frame> {
    renderer.last().ok_or_else(|| Error::mistake("there is no frame to measure"))
}

/// The limits, measured in turn with the frames of a renderer.
pub struct Floor {
    gpu: Arc<Gpu>,
    copy: BareCopy,
    draw: DepthDraw,
}

impl Floor {
    /// Makes ready to copy so many bytes, read and written ones together, and to draw facets on pages of so many pixels
    /// across and down.
    ///
    /// # Errors
    /// As [`BareCopy::new`] and [`DepthDraw::new`].
    pub fn new(gpu: Arc<Gpu>, page: [u32; 2], bytes: u64) -> Result<Self> {
        let (copy, draw) = (BareCopy::new(&gpu, bytes)?, DepthDraw::new(&gpu, page)?);
        let floor = Self { gpu, copy, draw };
        // Memory that was never touched is slow the first time.
        floor.copy_ms()?;
        Ok(floor)
    }

    /// How long the bare copy takes, ms; `None` where the driver stamps none.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn copy_ms(&self) -> Result<Option<f64>> {
        time_of(&self.gpu, |encoder| {
            self.copy.record(encoder);
            Ok(())
        })
    }

    /// How long one draw takes of the facets that the last frame of a renderer rasterized, from the vertices it left, ms;
    /// `None` where the driver stamps none, or where several batches shared the vertex buffer, which holds the last alone.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Mistake`] when there was no frame.
    pub fn draw_ms(&mut self, renderer: &Renderer) -> Result<Option<f64>> {
        let frame = last(renderer)?;
        if !frame.keeps_vertices() {
            return Ok(None);
        }
        // Chunks beside the page have the vertices of an earlier frame.
        let slots = (0..frame.seen).zip(frame.across(renderer.surface())?);
        let drawn = slots.filter(|(_, across)| *across).map(|(slot, _)| slot);
        self.draw.load(&self.gpu, &frame.lattice, drawn)?;
        time_of(&self.gpu, |encoder| self.draw.record(renderer.on_device(), encoder))
    }

    /// ID + 1 of the facet that each pixel of the last draw shows; see [`DepthDraw::ids`].
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn ids(&self) -> Result<Vec<u32>> {
        self.draw.ids(&self.gpu)
    }
}
