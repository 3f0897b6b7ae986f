//! Land as it is, beside which the hard cases stand.

use glam::DVec2;

use super::{CELL, Make, hills};
use crate::dem::{Dem, fractal};
use crate::stress::lands::ORIGIN;
use crate::stress::{Case, Group};

pub(super) const CASES: &[Make] = &[rolling_hills, mountains];

/// Hills beyond hills.
fn rolling_hills() -> Case {
    Case::new(Group::Ordinary, "hills", "rolling hills", hills(129, 1, 1.0))
        .seen("across", [64.0, 124.0, 64.0], [60.0, 40.0, 0.0])
        .seen("above", [10.0, 118.0, 800.0], [70.0, 50.0, 0.0])
        .exact()
        .flown()
        .in_short()
}

/// Ridges of every width, down to four cells.
fn mountains() -> Case {
    let heights = (0..129).flat_map(|r| fractal::row(129, r)).collect();
    let dem = Dem::from_heights(129, DVec2::splat(CELL), ORIGIN, heights);
    Case::new(Group::Ordinary, "mountains", "fractal ridges", dem)
        .seen("valley", [64.0, 126.0, 200.0], [60.0, 40.0, 0.0])
        .exact()
        .flown()
}
