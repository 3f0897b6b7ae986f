//! Pages of any size: drawn and read back piece by piece.

use super::{Drawn, Renderer};
use crate::error::Result;
use crate::gpu::uniforms::Segment;
use crate::line::{Chain, Economy, Laid, Line, Lines, Mark, Marks, link, marks, one_pixel_wide, rest, toned, visible};
use crate::plan::{Curves, Frame, PagePiece, Plan, Yields};
use crate::view::{Camera, Perspective};

/// The ink of a frame on a page of any size, and its curves.
#[derive(Debug, Clone)]
pub struct Page {
    /// Ink, kind, sub-pixel place and depth.
    pub marks: Marks,
    /// What the eye sees of curves; none where the plan has none.
    pub chains: Vec<Chain>,
    /// What nearer land hides of curves; none where the plan does not have [all](crate::plan::Curves::All).
    pub hidden: Vec<Chain>,
    /// What the eye sees of lines on the land.
    pub land: Vec<Chain>,
    /// How far from the eye, metres, land goes that is too near for hachures, which stays bare; none where there is none.
    pub bare: Option<f64>,
    /// How many pixels show land, inked or not.
    pub covered: u64,
    /// Nodes the longest walk visited, or facets of the longest cut; 0 for other methods.
    pub longest_walk: u32,
    /// What was drawn.
    pub frame: Frame,
    /// How its camera sees.
    pub perspective: Perspective,
}

impl Page {
    /// Its lines: curves, drawn as sparingly as `economy` says, and what of its ink no curve accounts for, traced and smoothed
    /// within `tolerance` px; of a plan without curves all its ink, traced.
    pub fn lines(&self, economy: &Economy, tolerance: f64) -> Lines {
        let Self { marks, hidden, land, perspective, .. } = self;
        if !self.frame.plan.has_curves() {
            return Lines::of(marks, perspective, tolerance);
        }
        let mut lines = Lines::sparing(&self.competing(economy, tolerance), hidden, perspective, economy);
        if let Some(look) = &self.frame.plan.hachures {
            let strokes = land.iter().filter(|chain| is_hachure(chain)).cloned().collect();
            let strokes = toned(strokes, &lines.chains, look);
            lines.chains.extend(strokes);
        }
        lines
    }

    /// The lines of a plan with curves among which economy chooses, before it does: those that [`Self::lines`] begins with, in its
    /// order.
    pub(crate) fn competing(&self, economy: &Economy, tolerance: f64) -> Vec<Chain> {
        let Self { marks, chains, land, perspective, .. } = self;
        let rest = rest(chains, marks, perspective, economy, tolerance);
        let land = land.iter().filter(|chain| !is_hachure(chain));
        chains.iter().chain(&rest).chain(land).cloned().collect()
    }
}

fn is_hachure(chain: &Chain) -> bool {
    chain.line() == Line::Hachure
}

/// What the device has found of a page: all that is left is done without it, by whatever thread.
pub struct PageFindings {
    seen: Listed,
    /// With hidden curves.
    all: Option<Listed>,
}

/// What passes listed of a frame.
struct Listed {
    marks: Vec<Mark>,
    segments: Vec<Segment>,
    laid: Laid,
    covered: u64,
    longest_walk: u32,
    frame: Frame,
    perspective: Perspective,
}

impl PageFindings {
    /// The page: curves linked, and what of them is seen.
    pub fn page(self) -> Page {
        let hidden = self.all.map(|all| all.page().hidden);
        let page = self.seen.page();
        Page { hidden: hidden.unwrap_or(page.hidden), ..page }
    }
}

impl Listed {
    fn page(self) -> Page {
        let Self { marks, segments, laid, covered, longest_walk, frame, perspective } = self;
        let (size, bare) = (frame.pieces.page(), laid.bare);
        let land = laid.curves(&segments, &perspective);
        let curves = [link(segments, &frame.lattice, &perspective), land].concat();
        let (chains, hidden) = match frame.plan.curves {
            Curves::All => visible::seen_and_hidden(curves, size),
            Curves::On | Curves::Off => (visible::chains(curves, size), Vec::new()),
        };
        let (land, chains): (Vec<Chain>, _) = chains.into_iter().partition(|chain| chain.line().is_of_land());
        let marks = match frame.plan.method.entry().yields {
            Yields::Ink => Marks::new(size, marks),
            Yields::Curves => one_pixel_wide(&chains, size),
        };
        Page { marks, chains, hidden, land, bare, covered, longest_walk, frame, perspective }
    }
}

impl Renderer {
    /// Draws a frame and brings back its ink, piece by piece; tells `progress` what share is done. Hidden curves take a frame
    /// of their own.
    ///
    /// # Errors
    /// As [`Self::frame`] and [`Self::read`].
    pub fn page(&mut self, plan: &Plan, camera: &Camera, progress: impl Fn(f64)) -> Result<Page> {
        self.find(plan, camera, progress).map(PageFindings::page)
    }

    fn list(&mut self, frame: Frame, progress: impl Fn(f64)) -> Result<Listed> {
        let (mut list, mut segments, mut covered, mut longest_walk) = (Vec::new(), Vec::new(), 0, 0);
        let (count, yields) = (frame.pieces.iter().len() as f64, frame.plan.method.entry().yields);
        self.upload(&frame)?;
        // Hachures are laid when pixels tell what they hide, if one piece tells it all.
        let waits = frame.plan.hachures.is_some() && frame.pieces.iter().len() == 1;
        let mut laid = if waits { None } else { Some(self.lay(&frame, None)?) };
        for (done, piece) in (1..).zip(frame.pieces.iter()) {
            self.passes(&frame, piece, None)?;
            let drawn = self.read_piece(&frame, piece)?;
            if yields == Yields::Ink {
                list.append(&mut marks::of_piece(&drawn.raster, piece));
            }
            covered += marks::covered(&drawn.raster, piece);
            longest_walk = longest_walk.max(drawn.longest_walk);
            if laid.is_none() {
                laid = Some(self.lay(&frame, Some(&drawn.raster))?);
            }
            if frame.plan.has_curves() {
                segments.append(&mut self.segments(&frame, piece)?);
            }
            progress(f64::from(done) / count);
        }
        let perspective = self.perspective(&frame);
        let laid = laid.unwrap_or_default();
        Ok(Listed { marks: list, segments, laid, covered, longest_walk, frame, perspective })
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Renderer {
    /// The part of it that needs the device.
    ///
    /// # Errors
    /// As [`Self::page`].
    pub fn find(&mut self, plan: &Plan, camera: &Camera, progress: impl Fn(f64)) -> Result<PageFindings> {
        if plan.curves != Curves::All {
            let frame = self.plan(plan, camera)?;
            return Ok(PageFindings { seen: self.list(frame, progress)?, all: None });
        }
        // Land behind the horizon is as fine as before it, which may make that finer too: what is seen is not to change.
        // Of what it finds hidden curves alone are kept, and hachures are none.
        let all = self.plan(&Plan { hachures: None, ..*plan }, camera)?;
        let all = self.list(all, |share| progress(share / 2.0))?;
        let seen = self.plan(&Plan { curves: Curves::On, ..*plan }, camera)?;
        let seen = self.list(seen, |share| progress(0.5 + share / 2.0))?;
        Ok(PageFindings { seen, all: Some(all) })
    }

    /// A page of a frame that is planned, which may be [cut](Frame::cut) in a way of its own.
    ///
    /// # Errors
    /// As [`Self::page`].
    pub fn page_of(&mut self, frame: Frame, progress: impl Fn(f64)) -> Result<Page> {
        self.list(frame, progress).map(Listed::page)
    }

    /// Draws a piece of a frame and brings it back, halo and all: `piece.drawn` of the page.
    ///
    /// # Errors
    /// As [`Self::page`].
    pub fn draw_piece(&mut self, frame: &Frame, piece: PagePiece) -> Result<Drawn> {
        self.upload(frame)?;
        self.passes(frame, piece, None)?;
        self.read_piece(frame, piece)
    }
}
