//! What a method of curves yields of a frame, as a trial judges it.

use glam::DVec2;

use super::trial::Yield;
use crate::line::{Chain, ChainPoint, Line, Mark, Marks, one_pixel_wide};
use crate::truth::{Inked, Mask};
use crate::view::Perspective;
use crate::view::cut::steps;

/// The chains of a frame, and their mask: they themselves, one pixel wide.
#[derive(Debug, Clone)]
pub struct MeasuredCurves {
    chains: Vec<Chain>,
    marks: Marks,
    near: f64,
}

impl MeasuredCurves {
    /// Of the visible chains of a frame.
    pub fn new(chains: Vec<Chain>, perspective: &Perspective) -> Self {
        let marks = one_pixel_wide(&chains, perspective.size().as_uvec2().to_array());
        Self { chains, marks, near: perspective.near() }
    }
}

impl Yield for MeasuredCurves {
    fn mask(&self) -> Mask {
        mask_of(&self.marks, self.near)
    }

    fn chains(&self) -> Vec<Chain> {
        self.chains.clone()
    }

    /// Every quarter pixel along the chains; border lines have none.
    fn places(&self) -> Vec<DVec2> {
        let size = [self.marks.width, self.marks.height];
        let silhouettes = self.chains.iter().flat_map(Chain::pairs).filter(|[a, _]| a.line != Line::Border);
        let along = |[a, b]: [&ChainPoint; 2]| {
            let [a, b] = [a.place, b.place];
            steps(size, a, b).map(move |step| a.lerp(b, step.middle))
        };
        silhouettes.flat_map(along).collect()
    }
}

/// The ink of a page, whose near plane lies `near` metres before the eye.
pub(crate) fn mask_of(marks: &Marks, near: f64) -> Mask {
    let inked = |mark: &Mark| Inked { column: mark.column, row: mark.row, distance: mark.pixel.distance(near) };
    Mask { size: [marks.width, marks.height], inked: marks.ink().map(inked).collect() }
}
