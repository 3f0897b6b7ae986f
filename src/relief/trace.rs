//! A branch of samples as a smooth curve in the bottom of its valley, or on its crest.
//!
//! Directions of eight neighbours run askew on wide valleys, by cells. So, a few times: across the way the smoothed surface is
//! followed down as long as it falls; places move there, those without a bottom across as their neighbours do; and all are
//! smoothed along the way. At last they are put on the bottom itself, and smoothed by a Gaussian that moves none far. Both ends
//! are free. Places come half a cell apart. Cost: some 50 heights a place, more in wide
//! valleys. Not handled: bends narrower than two cells, which are cut by a part of a cell.

use glam::DVec2;

use super::grid::Grid;

/// What a line follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Follows {
    /// The lowest places across it.
    Valley,
    /// The highest.
    Crest,
}

impl Follows {
    /// What makes of heights those of which the lowest are followed.
    pub(super) fn sign(self) -> f32 {
        match self {
            Self::Valley => 1.0,
            Self::Crest => -1.0,
        }
    }
}

/// A place of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CurvePlace {
    /// Column and row, fractional.
    pub at: DVec2,
    /// How many nodes of the branch lie before it, fractional.
    pub node: f64,
    /// Whether the land rises, or falls, from it to both sides.
    pub is_lowest: bool,
}

/// Cells between places.
pub(super) const SPACING: f64 = 0.5;
/// How far across the bottom is looked for each time, cells, and in how many steps to each side.
const REACH: [f64; 6] = [6.0, 6.0, 4.0, 2.0, 1.0, 0.5];
const STEPS: i32 = 8;
/// How far a place moves at a time, cells; the widest looks are left out where none moves half as far.
const MOVE: f64 = 2.0;
/// Standard deviation of how moves spread along the way, places a cell of reach, and of the smoothing after it, places: wide moves
/// are those of long stretches, or lines would bulge into hollows beside them.
const SPREAD: f64 = 2.0;
const SMOOTH: f64 = 2.0;
/// What a place without a bottom across weighs when moves spread.
const STAYS: f64 = 0.5;
/// Standard deviation of the last smoothing, places, and how far that may move a place, cells.
const LAST: f64 = 2.5;
const HOLD: f64 = 0.4;
/// Standard deviation of the smoothing after which a direction is taken, places, and over how many before and after one: where
/// the bed is steep and wide, the lowest place across a way that is askew is not that of the valley.
const DIRECTION: f64 = 5.0;
const AHEAD: usize = 6;

/// The curve of at least two nodes; one place, where they are at one corner of the grid.
pub(super) fn trace(grid: &Grid, nodes: &[DVec2], follows: Follows) -> Vec<CurvePlace> {
    let nodes = nodes.iter().enumerate().map(|(k, at)| CurvePlace { at: *at, node: k as f64, is_lowest: false });
    let mut places: Vec<CurvePlace> = nodes.collect();
    let mut farthest = f64::INFINITY;
    for reach in REACH {
        if reach > MOVE && farthest < MOVE / 2.0 {
            continue;
        }
        places = resampled(&places);
        let moves = moves(grid, &places, reach, follows);
        farthest = moves.iter().flatten().map(|by| by.length()).fold(0.0, f64::max);
        let height = |at: DVec2| follows.sign() * grid.smooth(at);
        // Taken along, but not over a crest, or out of the valley that a crest stands over.
        let moved = |((place, by), own): ((&CurvePlace, DVec2), &Option<DVec2>)| {
            let is_up = own.is_none() && height(place.at + by) > height(place.at);
            if is_up { place.at } else { place.at + by }
        };
        let moved: Vec<DVec2> = places.iter().zip(spread(&moves, reach)).zip(&moves).map(moved).collect();
        places.iter_mut().zip(smoothed(&moved, SMOOTH)).for_each(|(place, at)| place.at = at);
    }
    places = resampled(&places);
    let moves = moves(grid, &places, MOVE / 2.0, follows);
    let bottom: Vec<DVec2> =
        places.iter().zip(&moves).map(|(place, by)| place.at + by.unwrap_or_default().clamp_length_max(HOLD)).collect();
    for (((place, bottom), smooth), by) in places.iter_mut().zip(&bottom).zip(smoothed(&bottom, LAST)).zip(&moves) {
        place.at = *bottom + (smooth - *bottom).clamp_length_max(HOLD);
        place.is_lowest = by.is_some();
    }
    places = resampled(&places);
    for place in &mut places {
        place.at = grid.frame.within(place.at);
        // Beside a void there is no surface but at the sample.
        if grid.height(place.at).is_nan() {
            place.at = place.at.round();
        }
    }
    places.dedup_by_key(|place| place.at);
    places
}

/// By how much each place lies off the lowest place across the way, or the highest; `None` where there is none within reach.
fn moves(grid: &Grid, places: &[CurvePlace], reach: f64, follows: Follows) -> Vec<Option<DVec2>> {
    let places: Vec<DVec2> = places.iter().map(|place| place.at).collect();
    let way = smoothed(&places, DIRECTION);
    let one = |k: usize| {
        let along = (way[(k + AHEAD).min(way.len() - 1)] - way[k.saturating_sub(AHEAD)]) * grid.frame.cell;
        // Across on the ground, and one cell long.
        let across = (along.perp() / grid.frame.cell).try_normalize()?;
        let height = |cells: f64| follows.sign() * grid.smooth(places[k] + across * cells);
        Some(across * bottom(height, reach)?)
    };
    (0..places.len()).map(one).collect()
}

/// Where a height is least, followed down from 0, no farther than a reach to either side.
fn bottom(height: impl Fn(f64) -> f32, reach: f64) -> Option<f64> {
    let step = reach / f64::from(STEPS);
    let turn = if height(step) < height(-step) { step } else { -step };
    let [mut before, mut here] = [height(-turn), height(0.0)];
    for k in 1..=STEPS {
        let next = height(f64::from(k) * turn);
        if next < here {
            [before, here] = [here, next];
            continue;
        }
        // The bottom of the parabola through the three; none where one of them is a void, or all are one flat.
        let bend = f64::from(before - 2.0 * here + next);
        let off = f64::from(before - next) / (2.0 * bend);
        return (before > here && next >= here).then_some((f64::from(k - 1) + off) * turn);
    }
    // It falls all the way.
    None
}

/// Moves that take along those that have none.
fn spread(moves: &[Option<DVec2>], reach: f64) -> Vec<DVec2> {
    let weights = gaussian(SPREAD * reach.max(1.5));
    let half = weights.len() / 2;
    let one = |k: usize| {
        let first = k.saturating_sub(half);
        let near = moves[first..(k + half + 1).min(moves.len())].iter().zip(&weights[first + half - k..]);
        let add = |(sum, total): (DVec2, f64), (by, weight): (&Option<DVec2>, &f64)| match by {
            Some(by) => (sum + by.clamp_length_max(MOVE) * *weight, total + weight),
            None => (sum, total + weight * STAYS),
        };
        let (sum, total) = near.fold((DVec2::ZERO, 0.0), add);
        sum / total
    };
    (0..moves.len()).map(one).collect()
}

/// Weights about the middle, to twice the deviation.
fn gaussian(deviation: f64) -> Vec<f64> {
    let reach = (2.0 * deviation) as i32;
    (-reach..=reach).map(|k| (-(f64::from(k) / deviation).powi(2) / 2.0).exp()).collect()
}

/// Places half a cell apart, about, on the polyline.
fn resampled(places: &[CurvePlace]) -> Vec<CurvePlace> {
    let lengths = places.windows(2).map(|pair| pair[0].at.distance(pair[1].at));
    let total: f64 = lengths.clone().sum();
    let count = (total / SPACING).round().max(1.0);
    let (mut out, mut done, mut next) = (Vec::with_capacity(count as usize + 1), 0.0, 0.0_f64);
    for (pair, length) in places.windows(2).zip(lengths) {
        while next * total < (done + length) * count {
            let share = if length > 0.0 { (next * total / count - done) / length } else { 0.0 };
            let node = pair[0].node + (pair[1].node - pair[0].node) * share;
            out.push(CurvePlace { at: pair[0].at.lerp(pair[1].at, share), node, is_lowest: pair[0].is_lowest });
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
    let weights = gaussian(deviation);
    let reach = (weights.len() / 2) as isize;
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
