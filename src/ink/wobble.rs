//! A hand that is not quite steady.
//!
//! Method: every place of the sheet swerves by a smooth field of random vectors (value noise on a square grid, Perlin 1985,
//! faded by a cubic): lines that meet before meet after, and what is closed stays so.

use glam::{DVec2, FloatExt};
use xxhash_rust::xxh3::xxh3_64;

use super::style::Wobble;

/// Where a hand goes that means to go somewhere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hand(pub Wobble);

impl Hand {
    /// The place to which it strays, at most `reach` away.
    pub(crate) fn stray(&self, place: DVec2) -> DVec2 {
        let Wobble { reach, length, .. } = self.0;
        let at = place / length;
        let (cell, t) = (at.floor(), at.fract_gl());
        let t = t * t * (3.0 - 2.0 * t);
        let row = |y: f64| self.swerve(cell + DVec2::new(0.0, y)).lerp(self.swerve(cell + DVec2::new(1.0, y)), t.x);
        place + row(0.0).lerp(row(1.0), t.y) * reach
    }

    /// Longest piece of line between two places that stray, mm.
    pub(crate) fn step(&self) -> f64 {
        if self.0.reach > 0.0 { self.0.length / 8.0 } else { f64::INFINITY }
    }

    /// A vector of at most length 1 for a corner of the grid.
    fn swerve(&self, corner: DVec2) -> DVec2 {
        let [x, y] = corner.to_array().map(|v| v as i32);
        let hash = xxh3_64(&[x, y, self.0.seed as i32].map(i32::to_le_bytes).concat());
        let share = |bits: u64| f64::from(bits as u32) / f64::from(u32::MAX);
        DVec2::from_angle(share(hash) * std::f64::consts::TAU) * 0.0_f64.lerp(1.0, share(hash >> 32)).sqrt()
    }
}
