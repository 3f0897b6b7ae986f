//! Frames by the clock.

use std::time::Instant;

use super::Renderer;
use crate::error::Result;
use crate::gpu::Clock;
use crate::gpu::clock::{FrameTime, Timer};
use crate::plan::{Frame, Plan, Yields};
use crate::view::Camera;

impl Renderer {
    /// Draws a frame and says how long each pass took, over all pieces, by the [`Clock`] of the device. By the wall clock
    /// the whole is more than an undisturbed frame takes: see [`Self::time_of_frame`].
    ///
    /// # Errors
    /// As [`Self::frame`]; [`Error::Gpu`](crate::error::Error::Gpu) when the driver's timestamps make no sense.
    pub fn timed_frame(&mut self, plan: &Plan, camera: &Camera) -> Result<FrameTime> {
        let frame = self.plan(plan, camera)?;
        self.upload(&frame)?;
        // Which hachures there are is told by the pixels.
        let pixels = match (frame.plan.hachures.is_some(), frame.pieces.iter().next()) {
            (true, Some(piece)) if frame.pieces.iter().len() == 1 => {
                self.passes(&frame, piece, None)?;
                Some(self.read_piece(&frame, piece)?.raster)
            }
            _ => None,
        };
        self.lay(&frame, pixels.as_ref())?;
        let time = frame.pieces.iter().try_fold(FrameTime::default(), |time, piece| {
            let mut timer = Timer::new(&self.gpu);
            self.passes(&frame, piece, Some(&mut timer))?;
            if plan.has_curves() {
                self.find_segments(&frame, piece, Some(&mut timer))?;
            }
            let times = timer.read(&self.gpu).inspect_err(|_| self.last = None)?;
            Ok(time.and(&times))
        })?;
        Ok(time)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Renderer {
    /// Makes ready for frames of a plan on pages of the camera's size, so that the first one takes no longer than others:
    /// compiles its passes, makes room, uploads the lattice of a uniform level.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn prepare(&mut self, plan: &Plan, camera: &Camera) -> Result<()> {
        let frame = Frame::before_any(plan, &self.surface, camera, self.gpu.int64, &mut self.kept)?;
        self.upload(&frame)?;
        self.surface.dem().check()
    }

    /// Draws a frame and says how long it took, ms: by the wall clock around [`Self::frame`], or by the device's
    /// timestamps from its first command to its last pass. A method that yields curves is timed until they are chains, by the
    /// wall clock.
    ///
    /// # Errors
    /// As [`Self::timed_frame`].
    pub fn time_of_frame(&mut self, plan: &Plan, camera: &Camera) -> Result<f64> {
        let inks = plan.method.entry().yields == Yields::Ink;
        if inks && self.gpu.clock == Clock::Timestamps {
            return Ok(self.timed_frame(plan, camera)?.ms);
        }
        let start = Instant::now();
        self.frame(plan, camera)?;
        if !inks {
            self.chains()?;
        }
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }
}
