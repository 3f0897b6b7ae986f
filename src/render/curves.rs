//! The curves of a frame: found piece by piece, linked once all are in.

use super::Renderer;
use crate::error::Result;
use crate::gpu::clock::Timer;
use crate::gpu::uniforms::Segment;
use crate::gpu::work::FrameWork;
use crate::line::cover::Cover;
use crate::line::detail::From;
use crate::line::hachures::{self, Viewer};
use crate::line::{Chain, Curve, InkRaster, Laid, link, visible};
use crate::plan::{Frame, LandLines, PagePiece};

impl Renderer {
    /// Finds the curves of the last frame and brings them back.
    ///
    /// # Errors
    /// As [`Self::read`]; [`Error::Limit`](crate::error::Error::Limit) where there are more than a device binds,
    /// [`Error::Mistake`](crate::error::Error::Mistake) for a frame without curves.
    pub fn curves(&mut self) -> Result<Vec<Curve>> {
        let (frame, piece) = self.last_whole()?;
        let segments = self.segments(&frame, piece)?;
        Ok(link(segments, &frame.lattice, &self.perspective(&frame)))
    }

    /// Lays lines on the land over a frame that has room for them: those that its page shows, and not what its pixels, where they
    /// are known, are known to hide.
    pub(super) fn lay(&mut self, frame: &Frame, pixels: Option<&InkRaster>) -> Result<Laid> {
        let Some(land) = self.land.clone().filter(|_| frame.plan.has_curves() && frame.plan.land == LandLines::On)
        else {
            return Ok(Laid::default());
        };
        let perspective = self.perspective(frame);
        let mut ways = land.ways(From::Eye(perspective.eye(), perspective.focal()));
        let mut bare = None;
        if let (Some(slopes), Some(look)) = (land.slopes(), &frame.plan.hachures) {
            let cover = pixels.map(Cover::new);
            let seen = Viewer::By(&perspective, frame.camera.azimuth, cover.as_ref());
            let hatched = hachures::hatched(slopes, look, seen)?;
            ways.extend(hatched.ways);
            bare = hatched.bare;
        }
        let mut laid = Laid::new(&ways, &perspective)?;
        laid.bare = bare;
        self.curves.lay(&self.gpu, &laid.places)?;
        self.stages.fit(&self.gpu, frame, &self.scene, &self.page, &self.curves)?;
        Ok(laid)
    }

    /// The segments of curves whose middles lie in a piece that was drawn.
    pub(super) fn segments(&mut self, frame: &Frame, piece: PagePiece) -> Result<Vec<Segment>> {
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
    pub(super) fn find_segments(&self, frame: &Frame, piece: PagePiece, timer: Option<&mut Timer>) -> Result<()> {
        let mut work = FrameWork::new(self.on_device(), frame, piece, timer);
        work.clear(&["turning", "tally"])?;
        frame.of_curves().into_iter().try_for_each(|(pass, batch)| work.run(pass, [batch, 0]))?;
        work.wait()
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Renderer {
    /// What the eye sees of the curves of the last frame.
    ///
    /// # Errors
    /// As [`Self::curves`].
    pub fn chains(&mut self) -> Result<Vec<Chain>> {
        let curves = self.curves()?;
        let size = self.last().map_or([0; 2], |frame| frame.pieces.page());
        Ok(visible::chains(curves, size))
    }
}
