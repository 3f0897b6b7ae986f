//! How lines recede from the near to the far ink of a page.

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
    /// From the nearest to the farthest ink of these depths, 5 % left out at either end; at least from one distance to twice
    /// that. Ink without a depth, 0, does not count.
    pub fn of(depths: impl Iterator<Item = f32>) -> Self {
        let mut depths: Vec<f32> = depths.filter(|&depth| depth > 0.0).collect();
        depths.sort_unstable_by(f32::total_cmp);
        let quantile = |percent: usize| {
            let depth = depths.get(depths.len() * percent / 100).or(depths.last());
            f64::from(depth.copied().unwrap_or(1.0)).ln()
        };
        let near = quantile(95);
        Self { near, far: quantile(5).min(near - LEAST_RANGE.ln()) }
    }

    /// 0 for near ink, 1 for far ink, even in ln distance.
    pub fn share(&self, point: &ChainPoint) -> f64 {
        ((self.near - point.log_depth()) / (self.near - self.far)).clamp(0.0, 1.0)
    }
}
