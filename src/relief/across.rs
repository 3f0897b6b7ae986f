//! How deep a valley is, or how high a ridge, at places of a line.
//!
//! Heights as they are, linear between samples, at three distances to both sides; the side that rises less counts. Cost: seven
//! heights a place.

use glam::DVec2;

use super::grid::Grid;
use super::trace::Follows;

/// How far to both sides is looked, cells.
const DISTANCES: [f64; 3] = [3.0, 6.0, 12.0];
/// Over how many places before and after one its direction is taken.
const AHEAD: usize = 4;

/// Of each place of a line, metres at the three distances; 0 where a side has no height: what lies along
/// the rim is not known to be a valley.
pub(super) fn across(grid: &Grid, line: &[DVec2], follows: Follows) -> Vec<[f32; 3]> {
    let side = grid.frame.side();
    let one = |k: usize| {
        let along = (line[(k + AHEAD).min(line.len() - 1)] - line[k.saturating_sub(AHEAD)]) * grid.frame.cell;
        let across = along.perp().normalize_or_zero() * side / grid.frame.cell;
        let here = grid.height(line[k]);
        DISTANCES.map(|distance| {
            let rise = |to: f64| follows.sign() * (grid.height(line[k] + across * to * distance) - here);
            let [left, right] = [rise(-1.0), rise(1.0)];
            if left.is_nan() || right.is_nan() { 0.0 } else { left.min(right) }
        })
    };
    (0..line.len()).map(one).collect()
}
