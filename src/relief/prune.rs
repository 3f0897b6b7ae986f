//! Lines without what nobody would draw: beginnings that are neither in a valley nor on a ridge, stumps, and what runs beside
//! others.
//!
//! A line begins where another joins it, where it is long, or where it begins to show: the land rises, or falls, to both sides at
//! once, and at one of three distances by a hundredth and by a tenth of how much the line does, so contours bend by six
//! degrees. Without that water that runs down a plane side by side would be as many lines. Cost: a pass over the points.

use super::grid::Grid;
use super::trace::SPACING;
use super::{LineKind, SurfaceLine, SurfacePoint};

/// Least slope of the sides, and as a share of that of the line.
const SLOPE: f64 = 0.01;
const SHARE: f64 = 0.1;
/// Distances of [`SurfacePoint::across`], cells.
const DISTANCES: [f64; 3] = [3.0, 6.0, 12.0];
/// Points in a row that show where a line begins, and the least share of its points that does.
const ROW: usize = 4;
const LEAST: f64 = 0.5;
/// Over how many points before and after one the slope of its line is taken.
const AHEAD: usize = 4;
/// Metres of water from which on a line of drainage is drawn wherever it lies.
const LONG: f32 = 3000.0;
/// Least points of a line that no other joins which are not beside others, 4 cells, and their share.
const FREE: usize = 9;
const FREE_SHARE: f64 = 0.4;
const GONE: usize = usize::MAX;

/// How a line lies.
#[derive(Debug, Clone)]
pub(super) struct Lie {
    /// How many of its points are not beside lines that are longer.
    pub free: usize,
    /// Whether the land rises, or falls, from each point to both sides.
    pub lowest: Vec<bool>,
}

/// The lines, each after the one it joins; those left, in the same order.
pub(super) fn pruned(grid: &Grid, lines: Vec<SurfaceLine>, lies: &[Lie]) -> Vec<SurfaceLine> {
    // Of each line the first point that stays.
    let mut begins = vec![GONE; lines.len()];
    for (k, line) in lines.iter().enumerate().rev() {
        let free = lies[k].free;
        let adds = free >= FREE && free as f64 >= FREE_SHARE * line.points.len() as f64;
        let shown = if adds { begin(grid, line, &lies[k].lowest) } else { GONE };
        // Two points at least, though another may join the last.
        begins[k] = if shown.min(begins[k]) == GONE { GONE } else { shown.min(begins[k]).min(line.points.len() - 2) };
        if let (Some([trunk, point]), true) = (line.joins, begins[k] != GONE) {
            begins[trunk as usize] = begins[trunk as usize].min(point as usize);
        }
    }
    let mut stay = 0;
    let mut number = |begin: &usize| {
        stay += u32::from(*begin != GONE);
        stay.saturating_sub(1)
    };
    let numbers: Vec<u32> = begins.iter().map(&mut number).collect();
    let cut = |(mut line, begin): (SurfaceLine, &usize)| {
        line.points.drain(..*begin);
        let onto = |[trunk, point]: [u32; 2]| [numbers[trunk as usize], point - begins[trunk as usize] as u32];
        line.joins = line.joins.map(onto);
        line
    };
    lines.into_iter().zip(&begins).filter(|(_, begin)| **begin != GONE).map(cut).collect()
}

/// The first point of a line that no other joins.
fn begin(grid: &Grid, line: &SurfaceLine, lowest: &[bool]) -> usize {
    let heights: Vec<f64> = line.points.iter().map(|point| f64::from(grid.height(point.at))).collect();
    let cells_long = line.points.len() as f64 * SPACING;
    let shows = |(k, point): (usize, &SurfacePoint)| {
        let [before, after] = [k.saturating_sub(AHEAD), (k + AHEAD).min(heights.len() - 1)];
        let metres = ((line.points[after].at - line.points[before].at) * grid.frame.cell).length();
        // 0 beside a void.
        let slope = ((heights[after] - heights[before]).abs() / metres).max(0.0);
        let least = SLOPE.max(SHARE * slope) * grid.frame.side();
        // What is no longer than wide is a part of what it joins.
        let mut sides = point.across.iter().zip(DISTANCES).filter(|(_, cells)| *cells <= cells_long);
        let stands_out = lowest[k] && sides.any(|(across, cells)| f64::from(*across) >= least * cells);
        match line.kind {
            LineKind::Ridge => stands_out && point.length > 0.0,
            _ => stands_out || point.length >= LONG,
        }
    };
    let shown: Vec<bool> = line.points.iter().enumerate().map(shows).collect();
    let Some(begin) = shown.windows(ROW).position(|row| row.iter().all(|shows| *shows)) else { return GONE };
    let count = shown[begin..].iter().filter(|shows| **shows).count();
    let rest = shown.len() - begin;
    if rest < FREE || (count as f64) < LEAST * rest as f64 { GONE } else { begin }
}
