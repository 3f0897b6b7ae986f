//! Times of the bare copy and the depth draw of one run, and what they say of its frames.

use super::Floor;
use super::figures::FloorFigures;
use super::trial::median;
use crate::error::Result;
use crate::render::Renderer;

/// Times taken in turn with the warm frames.
pub(super) struct Floors {
    bytes: u64,
    copies: Vec<Option<f64>>,
    draws: Vec<Option<f64>>,
    lacks_vertices: bool,
}

impl Floors {
    /// No times yet, of a frame that moves so many bytes.
    pub(super) fn new(bytes: u64) -> Self {
        Self { bytes, copies: Vec::new(), draws: Vec::new(), lacks_vertices: false }
    }

    /// Takes both times once, after a frame of a renderer.
    pub(super) fn add(&mut self, floor: &mut Floor, renderer: &Renderer) -> Result<()> {
        self.copies.push(floor.copy_ms()?);
        self.draws.push(floor.draw_ms(renderer)?);
        self.lacks_vertices |= renderer.last().is_some_and(|frame| !frame.keeps_vertices());
        Ok(())
    }

    /// The medians beside that of the frames.
    pub(super) fn beside(self, frame_ms: f64) -> FloorFigures {
        let [copy_ms, draw_ms] = [self.copies, self.draws].map(of_all);
        let lacking = match (copy_ms, draw_ms) {
            (Some(_), Some(_)) => None,
            _ if self.lacks_vertices => Some("several vertex batches"),
            _ => Some("no stamps of copies and draws"),
        };
        let per = |ms: Option<f64>| ms.map(|ms| frame_ms / ms);
        let (frame_per_copy, frame_per_draw) = (per(copy_ms), per(draw_ms));
        FloorFigures { bytes: self.bytes, copy_ms, draw_ms, lacking, frame_per_copy, frame_per_draw }
    }
}

/// The median; `None` where one is lacking.
fn of_all(times: Vec<Option<f64>>) -> Option<f64> {
    let mut times = times.into_iter().collect::<Option<Vec<f64>>>()?;
    times.sort_by(f64::total_cmp);
    (!times.is_empty()).then(|| median(&times))
}
