//! A branch of samples as a smooth curve in the bottom of its valley, or on its crest.
//!
//! Twice: each place is moved across the way to the lowest place of the smoothed surface there, then all are smoothed along the
//! way by a Gaussian. What is no valley across the way is only smoothed. Both ends stay. Places come half a cell apart. Cost: some 30
//! heights a place. Not handled: bends narrower than two cells, which are cut by a part of a cell.

use glam::DVec2;

use super::grid::Grid;

/// What a line follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follows {
    /// The lowest places across it.
    Valley,
    /// The highest.
    Crest,
}

/// A place of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Column and row, fractional.
    pub at: DVec2,
    /// How many nodes of the branch lie before it, fractional.
    pub node: f64,
}

/// Cells between places.
pub const SPACING: f64 = 0.5;
/// How far a node may be moved across its way, cells, and in how many steps to each side.
const REACH: [f64; 2] = [1.0, 0.5];
const STEPS: i32 = 6;
/// Standard deviations of the smoothing, places.
const DEVIATIONS: [f64; 2] = [3.0, 2.0];
/// How far smoothing may move a place, cells.
const HOLD: f64 = 0.4;
/// Over how many places before and after one its direction is taken.
const AHEAD: usize = 4;

/// The curve of at least two nodes.
pub fn trace(grid: &Grid, nodes: &[DVec2], follows: Follows) -> Vec<Place> {
    let nodes = nodes.iter().enumerate().map(|(k, at)| Place { at: *at, node: k as f64 });
    let mut places: Vec<Place> = nodes.collect();
    for (reach, deviation) in REACH.into_iter().zip(DEVIATIONS) {
        places = resampled(&places);
        let rough: Vec<DVec2> = smoothed(&places.iter().map(|place| place.at).collect::<Vec<_>>(), deviation);
        let snapped: Vec<DVec2> =
            (0..places.len()).map(|k| snapped(grid, &rough, places[k].at, k, reach, follows)).collect();
        let smooth = smoothed(&snapped, deviation);
        for ((place, snapped), smooth) in places.iter_mut().zip(&snapped).zip(smooth) {
            place.at = *snapped + (smooth - *snapped).clamp_length_max(HOLD);
        }
    }
    resampled(&places)
}

/// The place across the way at `k` that is lowest, or highest.
fn snapped(grid: &Grid, way: &[DVec2], at: DVec2, k: usize, reach: f64, follows: Follows) -> DVec2 {
    if k == 0 || k + 1 == way.len() {
        return at;
    }
    let along = (way[(k + AHEAD).min(way.len() - 1)] - way[k.saturating_sub(AHEAD)]) * grid.frame.cell;
    // Across on the ground, and one cell long.
    let Some(across) = (along.perp() / grid.frame.cell).try_normalize() else { return at };
    let sign = if follows == Follows::Valley { 1.0 } else { -1.0 };
    let place = |step: f64| at + across * (step * reach / f64::from(STEPS));
    let height = |step: i32| sign * grid.smooth(place(f64::from(step)));
    // Down on the side that falls, as long as it does.
    let turn = if height(1) < height(-1) { 1 } else { -1 };
    let [mut before, mut here] = [height(-turn), height(0)];
    for step in 1..=STEPS {
        let next = height(step * turn);
        if next < here {
            [before, here] = [here, next];
            continue;
        }
        // The bottom of the parabola through the three; none where one of them is a void, or all are one flat.
        let bend = f64::from(before - 2.0 * here + next);
        let is_bottom = before > here && next >= here;
        let off = f64::from(before - next) / (2.0 * bend);
        return if is_bottom { place(f64::from(turn) * (f64::from(step - 1) + off)) } else { at };
    }
    // It falls all the way: no valley here.
    at
}

/// Places half a cell apart, about, on the polyline.
fn resampled(places: &[Place]) -> Vec<Place> {
    let lengths = places.windows(2).map(|pair| pair[0].at.distance(pair[1].at));
    let total: f64 = lengths.clone().sum();
    let count = (total / SPACING).round().max(1.0);
    let (mut out, mut done, mut next) = (Vec::with_capacity(count as usize + 1), 0.0, 0.0_f64);
    for (pair, length) in places.windows(2).zip(lengths) {
        while next * total < (done + length) * count {
            let share = if length > 0.0 { (next * total / count - done) / length } else { 0.0 };
            let node = pair[0].node + (pair[1].node - pair[0].node) * share;
            out.push(Place { at: pair[0].at.lerp(pair[1].at, share), node });
            next += 1.0;
        }
        done += length;
    }
    out.truncate(count as usize);
    out.extend(places.last());
    out
}

/// The places smoothed along the way; beyond its ends it goes on as its mirror image, so they stay.
fn smoothed(places: &[DVec2], deviation: f64) -> Vec<DVec2> {
    let reach = (2.0 * deviation) as isize;
    let weights: Vec<f64> = (-reach..=reach).map(|k| (-(k as f64 / deviation).powi(2) / 2.0).exp()).collect();
    let sum: f64 = weights.iter().sum();
    let last = places.len() as isize - 1;
    let at = |k: isize| match k {
        k if k < 0 => places[0] * 2.0 - places[(-k).min(last) as usize],
        k if k > last => places[last as usize] * 2.0 - places[(2 * last - k).max(0) as usize],
        k => places[k as usize],
    };
    let one = |k: isize| (-reach..=reach).zip(&weights).map(|(off, weight)| at(k + off) * *weight).sum::<DVec2>() / sum;
    (0..=last).map(one).collect()
}
