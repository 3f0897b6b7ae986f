//! How lines recede from the near to the far ink of a page.
//!
//! Method: near ink is what lies beyond the mean of all ln depths on one side, far ink on the other; where each is, is a mean too,
//! in which ink counts by the square of its way to the middle (Lehmer's mean of the third order). Every line of a page is as wide
//! as this says: such means go with all ink, little by little, where the depth of the nearest few hundredths leaps when the eye
//! moves and a line comes or goes. Cost: two rounds of sums.

use super::ChainPoint;

/// Least ratio of the farthest to the nearest ink that uses the whole range.
const LEAST_RANGE: f64 = 2.0;

/// The depths between which the lines of a page recede.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recession {
    /// ln depth of the near ink.
    near: f64,
    /// ln depth of the far ink.
    far: f64,
}

impl Recession {
    /// From near to far ink, given as depths and how much ink has each; at least from one distance to twice that. Ink without
    /// a depth, 0, does not count.
    pub fn of(inked: impl Iterator<Item = (f32, f64)>) -> Self {
        let inked = inked.filter(|(depth, ink)| *depth > 0.0 && *ink > 0.0);
        let logs: Vec<(f64, f64)> = inked.map(|(depth, ink)| (f64::from(depth).ln(), ink)).collect();
        let (sum, all) = logs.iter().fold((0.0, 0.0), |(sum, all), (log, ink)| (sum + log * ink, all + ink));
        let middle = if all > 0.0 { sum / all } else { 0.0 };
        let end = |side: f64| {
            let ways = logs.iter().map(|(log, ink)| (((log - middle) * side).max(0.0), ink));
            let sums = ways.fold((0.0, 0.0), |(cubes, squares), (way, ink)| {
                (cubes + ink * way.powi(3), squares + ink * way.powi(2))
            });
            // Ink of one depth has neither side.
            middle + if sums.1 > 0.0 { side * sums.0 / sums.1 } else { 0.0 }
        };
        let near = end(1.0);
        Self { near, far: end(-1.0).min(near - LEAST_RANGE.ln()) }
    }

    /// 0 for near ink, 1 for far ink, even in ln distance.
    pub fn share(&self, point: &ChainPoint) -> f64 {
        ((self.near - point.log_depth()) / (self.near - self.far)).clamp(0.0, 1.0)
    }
}
