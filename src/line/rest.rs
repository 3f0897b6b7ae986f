//! Lines of the mask that no curve accounts for: folds so narrow that the surface's normals do not follow them.
//!
//! Method: sets of ink in which and beside which no chain runs are traced and smoothed as those of the mask methods are. What
//! lies behind such a line is known where it is sky; elsewhere it counts as one that economy just leaves whole. Cost: that of
//! [strays](super::strays), and of tracing what is left.

use super::strays::unchained;
use super::{Chain, ChainPoint, Economy, Line, Marks, smooth, trace};
use crate::view::Perspective;

/// The chains of that ink, smoothed within `tolerance` px.
pub(crate) fn rest(
    chains: &[Chain],
    mask: &Marks,
    perspective: &Perspective,
    economy: &Economy,
    tolerance: f64,
) -> Vec<Chain> {
    let traced = smooth(&trace(&unchained(chains, mask), perspective), perspective, tolerance);
    let weakest = |point: ChainPoint| match point.line {
        Line::Skyline => point,
        _ => ChainPoint { behind: (f64::from(point.depth) / (1.0 + 2.0 * economy.min_jump)) as f32, ..point },
    };
    let lines = traced.into_iter().filter(|chain| chain.points.len() > 1);
    lines.map(|chain| Chain { points: chain.points.into_iter().map(weakest).collect(), ..chain }).collect()
}
