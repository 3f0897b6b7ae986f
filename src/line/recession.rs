//! How lines recede from the near to the far ink of a page.
//!
//! Method: near ink is what lies beyond the mean of all on one side, far ink on the other; lines recede from a little beyond the
//! mean of the one to a little beyond that of the other. Every line of a page is as wide as this says: means go with all ink,
//! little by little, where the depth of the nearest few hundredths leaps when the eye moves and a line comes or goes. Cost:
//! three sums.

use super::ChainPoint;

/// Least ratio of the farthest to the nearest ink that uses the whole range.
const LEAST_RANGE: f64 = 2.0;
/// How far beyond the mean of all ink lines still change, in distances from there to the mean of the nearer or the farther: of
/// ink that is spread evenly over ln depth 5 % lies beyond at either end.
const REACH: f64 = 1.8;

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
        let middle = mean(&logs, |_| true).unwrap_or(0.0);
        let end = |beyond: &dyn Fn(f64) -> bool| {
            let half = mean(&logs, beyond).unwrap_or(middle);
            middle + REACH * (half - middle)
        };
        let near = end(&|log| log > middle);
        Self { near, far: end(&|log| log < middle).min(near - LEAST_RANGE.ln()) }
    }

    /// 0 for near ink, 1 for far ink, even in ln distance.
    pub fn share(&self, point: &ChainPoint) -> f64 {
        ((self.near - point.log_depth()) / (self.near - self.far)).clamp(0.0, 1.0)
    }
}

/// The mean ln depth of the ink that is such; `None` where there is none.
fn mean(logs: &[(f64, f64)], is_such: impl Fn(f64) -> bool) -> Option<f64> {
    let of = logs.iter().filter(|(log, _)| is_such(*log));
    let (sum, all) = of.fold((0.0, 0.0), |(sum, all), (log, ink)| (sum + log * ink, all + ink));
    (all > 0.0).then(|| sum / all)
}
