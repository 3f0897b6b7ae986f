//! How a view becomes a drawing: what is found, how it is stroked, on which sheet.

use super::Page;
use crate::error::Result;
use crate::ink::{self, Drawing, Sheet, Style};
use crate::line::{Economy, Lines};
use crate::plan::{Curves, LandLines, Plan};
use crate::relief::LandWanted;

/// All that a drawing is made by, but what it shows and from where.
#[derive(Debug, Clone)]
pub(crate) struct Illustration {
    /// What is found.
    pub plan: Plan,
    /// How it is stroked.
    pub style: Style,
    /// Which lines of the land are drawn.
    pub land: LandWanted,
    /// How sparing it is with curves.
    pub economy: Economy,
    /// Distances that part layers, metres.
    pub split: Vec<f64>,
    /// What it stands on.
    pub sheet: Sheet,
    /// Pixels that lines are found in, across and down.
    pub frame: [u32; 2],
    /// Pixels of pictures for each millimetre.
    pub px_per_mm: f64,
}

impl Illustration {
    /// What of it the mask depends on, in words: neither style nor sheet.
    pub(crate) fn of_mask(&self) -> String {
        format!(
            "{:?} {:?}",
            Plan { curves: Curves::Off, land: LandLines::Off, hachures: None, ..self.plan },
            self.frame
        )
    }

    /// How far smoothing may move a line, px.
    pub(crate) fn tolerance(&self) -> f64 {
        self.style.tolerance * self.sheet.placement(self.frame).px_per_mm
    }

    /// The lines of a page, and their drawing.
    ///
    /// # Errors
    /// As [`ink::draw`].
    pub(crate) fn drawing(&self, page: &Page) -> Result<(Lines, Drawing)> {
        let own = self.land.own_layers.clone();
        let lines = Lines { own, ..page.lines(&self.economy, self.tolerance()) };
        let drawing = ink::draw(&lines, &self.sheet, &self.style, &self.split)?;
        Ok((lines, drawing))
    }
}
