//! Where a curve is convex, so that the eye may see it, and where it is a fold that hides itself.
//!
//! Method: walked with the toward surface on the left, a convex stretch leads one way on the page and a concave one back:
//! at a cusp the curve turns round. The length on the page, counted up along convex stretches and down along concave ones,
//! rises and falls once between cusps; facets make it tremble about them. Turns back of less than [`TREMBLE`] are none:
//! what is left are the cusps. Runs of contour are judged each by itself: where the rim begins nothing is carried over.
//! Cost: one look at each stretch. Does not handle: true folds that are smaller on the page than the tremble, which are
//! drawn as their surroundings.

use super::{Bound, Curve};

/// Length on the page that a curve must run back before it counts as turned round, px.
const TREMBLE: f64 = 1.0;

/// Whether each stretch is convex; the rim always is.
pub(super) fn convex(curve: &Curve) -> Vec<bool> {
    let mut convex = vec![true; curve.stretches.len()];
    let mut start = 0;
    for run in curve.stretches.chunk_by(|a, b| a.bound == b.bound) {
        let range = start..start + run.len();
        start = range.end;
        if run[0].bound == Bound::Contour {
            let steps = range.clone().map(|i| curve.length(i).copysign(curve.stretches[i].fall.into()));
            rising(&steps.collect::<Vec<_>>(), &mut convex[range]);
        }
    }
    convex
}

/// Whether the sum of the steps rises there, trembling left out.
fn rising(steps: &[f64], rises: &mut [bool]) {
    // The sum's extremes since the last turn: value, and how many steps lead there.
    let (mut low, mut high) = ((0.0, 0), (0.0, 0));
    let (mut sum, mut up, mut turn) = (0.0, None, 0);
    for (i, step) in steps.iter().enumerate() {
        sum += step;
        if sum < low.0 {
            low = (sum, i + 1);
        }
        if sum > high.0 {
            high = (sum, i + 1);
        }
        let turned = match up {
            Some(true) => high.0 - sum >= TREMBLE,
            Some(false) => sum - low.0 >= TREMBLE,
            None => (high.0 - sum).max(sum - low.0) >= TREMBLE,
        };
        if turned {
            let rose = up.unwrap_or(high.0 - sum >= TREMBLE);
            let end = if rose { high.1 } else { low.1 };
            rises[turn..end].fill(rose);
            (up, turn) = (Some(!rose), end);
            (low, high) = ((sum, i + 1), (sum, i + 1));
        }
    }
    rises[turn..].fill(up.unwrap_or(sum >= 0.0));
}
