//! The curves of a frame: found piece by piece, linked once all are in.

use super::Renderer;
use crate::error::{Error, Result, Setting};
use crate::gpu::clock::Timer;
use crate::gpu::uniforms::Segment;
use crate::gpu::work::Work;
use crate::line::{Chain, Curve, link, visible};
use crate::message;
use crate::plan::{Frame, Piece};

impl Renderer {
    /// Finds the curves of the last frame and brings them back.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Limit`] where there are more than a device binds, or the page takes several
    /// pieces, of which the device holds the last alone; [`Error::Mistake`] where there was no frame, or one without curves.
    pub fn curves(&mut self) -> Result<Vec<Curve>> {
        let (frame, piece) = self.last.clone().ok_or_else(|| Error::mistake("there is no frame to read"))?;
        if frame.pieces.iter().len() > 1 {
            let what = format!("the page takes {} pieces, one can be read", frame.pieces.iter().len());
            return Err(Error::limit(what, message!["draw it piece by piece, or use a smaller ", Setting::Size]));
        }
        let segments = self.segments(&frame, piece)?;
        Ok(self.linked(&frame, segments))
    }

    /// What the eye sees of the curves of the last frame.
    ///
    /// # Errors
    /// As [`Self::curves`].
    pub fn chains(&mut self) -> Result<Vec<Chain>> {
        let curves = self.curves()?;
        let size = self.last().map_or([0; 2], |frame| frame.pieces.page());
        Ok(visible::chains(curves, size))
    }

    /// The curves of all segments of a frame.
    pub(super) fn linked(&self, frame: &Frame, segments: Vec<Segment>) -> Vec<Curve> {
        link(segments, &frame.lattice, &self.perspective(frame))
    }

    /// The segments of curves whose middles lie in a piece that was drawn.
    pub(super) fn segments(&mut self, frame: &Frame, piece: Piece) -> Result<Vec<Segment>> {
        self.last = None;
        let found = loop {
            self.find_segments(frame, piece, None)?;
            if let Some(segments) = self.curves.read(&self.gpu)? {
                break segments;
            }
            self.stages.fit(&self.gpu, frame, &self.scene, &self.page, &self.curves)?;
        };
        self.surface.dem().check()?;
        self.last = Some((frame.clone(), piece));
        let inside = |segment: &Segment| {
            let at = [segment.pixel & 0xffff, segment.pixel >> 16];
            (0..2).all(|axis| {
                let from = piece.kept.origin[axis] - piece.drawn.origin[axis];
                (from..from + piece.kept.size[axis]).contains(&at[axis])
            })
        };
        Ok(found.into_iter().filter(inside).collect())
    }

    /// The passes that list segments, over a piece that was drawn.
    pub(super) fn find_segments(&self, frame: &Frame, piece: Piece, timer: Option<&mut Timer>) -> Result<()> {
        let mut work = Work::new(self.on_device(), frame, piece, timer);
        work.clear(&["turning", "tally"])?;
        frame.of_curves().into_iter().try_for_each(|(pass, batch)| work.run(pass, [batch, 0]))?;
        work.finish()
    }
}
