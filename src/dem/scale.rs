//! A scale at which heights are smoothed, as work on windows.

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_128;

use super::focal::Focal;
use super::generalise::{generalise, halo};
use super::in_bands::in_bands;
use super::window::Window;
use crate::error::Result;

/// Raise it when the same heights come out otherwise.
const FORMAT: u32 = 1;

/// A scale at which heights are smoothed, and the grid on which they lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    /// Of what is smoothed away.
    pub metres: f64,
    /// Metres between columns and between rows.
    pub cell: DVec2,
}

impl Scale {
    /// Smooths all heights of a held grid of so many columns and rows, see [`generalise`], on every core.
    ///
    /// # Errors
    /// None: those of work that has none.
    pub(crate) fn smooth(&self, heights: &mut [f32], size: [usize; 2]) -> Result<()> {
        in_bands(heights, size, self.halo(), |heights, window| {
            generalise(heights, window, self.cell, self.metres, true);
            Ok(())
        })
    }
}

impl Focal for Scale {
    fn halo(&self) -> usize {
        halo(self.metres, self.cell)
    }

    fn apply(&self, heights: &mut [f32], window: Window) -> Result<()> {
        generalise(heights, window, self.cell, self.metres, false);
        Ok(())
    }

    fn stamp(&self) -> u128 {
        xxh3_128(format!("{FORMAT} {self:?}").as_bytes())
    }
}
