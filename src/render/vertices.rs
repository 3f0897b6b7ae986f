//! The vertices of a frame alone, for callers that draw them by other means.

use super::Renderer;
use crate::error::{Error, Result, Setting};
use crate::message;
use crate::plan::PassName::{Project, Seam, Tessellate};
use crate::plan::{Frame, Plan};
use crate::view::Camera;

/// What other stages and tests look into.
#[doc(hidden)]
impl Renderer {
    /// Uploads the camera and records the vertices of the frame's only batch, for callers that submit them and draw them by
    /// other means. Chunks that cannot appear keep what they had, zeros at first.
    ///
    /// # Errors
    /// As [`Self::frame`]; [`Error::Limit`] when the frame has several batches, which share one vertex buffer, or a page
    /// of several pieces.
    pub fn record_vertices(
        &mut self,
        plan: &Plan,
        camera: &Camera,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Frame> {
        let frame = self.plan(plan, camera)?;
        let (Some(piece), 1) = (frame.pieces.iter().next(), frame.pieces.iter().len()) else {
            let what = format!("the page takes {} pieces, one can be drawn", frame.pieces.iter().len());
            return Err(Error::limit(what, message!["use a smaller ", Setting::Size]));
        };
        if frame.batches.len() != 1 {
            let what = format!("the vertices take {} batches, one can be drawn", frame.batches.len());
            return Err(Error::limit(what, message!["use a lower ", Setting::Level, " or a ", Setting::Crop]));
        }
        self.upload(&frame)?;
        self.scene.write_camera(&self.gpu, &self.surface, &frame, piece)?;
        for planned in [Tessellate, Seam, Project].into_iter().filter_map(|name| frame.pass(name, 0)) {
            if let Some(dispatch) = self.on_device().dispatch(&frame, piece, planned, [0, 0])? {
                dispatch.record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()));
            }
        }
        self.surface.dem().check()?;
        Ok(frame)
    }
}
