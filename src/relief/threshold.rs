//! How much land makes a channel: the least area from which streams of the first order fall as far, on average, as those of
//! higher ones (drop analysis; Tarboton, Bras and Rodriguez-Iturbe 1991).
//!
//! A stream is all of its order in a row. Areas grow by 1.67 from 10 samples on; of each, Student's t of the difference of the mean
//! falls is taken with one variance for both. |t| has to be under 2 twice in a row: t may pass through 0 at the smallest areas, and
//! of many areas that all would do one in twenty has more by chance. Cost: a pass over the channels an area. Not handled: land of
//! several kinds, which has one area all the same.

use super::area::Area;
use super::channels::Channels;
use super::grid::Grid;

/// Samples of the least area that is tried.
pub(crate) const FIRST: u32 = 10;
/// How many times the last the next is.
const GROWTH: f64 = 1.67;
/// |t| from which the means differ.
pub(crate) const LIMIT: f64 = 2.0;
/// Least streams of the first order and of higher ones.
pub(crate) const ENOUGH: [usize; 2] = [20, 5];

/// An area that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaTrial {
    /// Samples.
    pub cells: u32,
    /// Streams of the first order and of higher ones.
    pub streams: [usize; 2],
    /// Student's t: below 0 where streams of the first order fall less.
    pub t: f64,
}

/// All areas with enough streams, the least first.
pub(crate) fn trials(grid: &Grid, channels: &Channels, area: &Area) -> Vec<AreaTrial> {
    let mut least = f64::from(FIRST);
    let trial = || {
        let cells = least.round() as u32;
        least *= GROWTH;
        let [first, higher] = falls(grid, channels, area, cells);
        let streams = [first.len(), higher.len()];
        let t = student(&first, &higher);
        (streams[0] >= ENOUGH[0] && streams[1] >= ENOUGH[1]).then_some(AreaTrial { cells, streams, t })
    };
    std::iter::from_fn(trial).collect()
}

/// The one that they find.
pub fn found(trials: &[AreaTrial]) -> Option<AreaTrial> {
    let stays = |pair: &&[AreaTrial]| pair.iter().all(|trial| trial.t.abs() < LIMIT);
    trials.windows(2).find(stays).map(|pair| pair[0])
}

/// Metres that the streams of the first order and those of higher ones fall.
fn falls(grid: &Grid, channels: &Channels, area: &Area, least: u32) -> [Vec<f64>; 2] {
    let orders = channels.orders(area, least).strahler;
    let height = |node: usize| f64::from(grid.smoothed[channels.samples[node] as usize]);
    let mut falls = [Vec::new(), Vec::new()];
    // Where the stream that a node belongs to began.
    let mut heads: Vec<u32> = (0..channels.samples.len() as u32).collect();
    for node in channels.order.iter().map(|node| *node as usize).filter(|node| orders[*node] > 0) {
        let below = channels.below(node);
        let goes_on = below.is_some_and(|below| orders[below] == orders[node]);
        match below {
            Some(below) if goes_on => heads[below] = heads[node],
            below => {
                // It reaches to the junction.
                let fall = height(heads[node] as usize) - height(below.unwrap_or(node));
                falls[usize::from(orders[node] > 1)].push(fall);
            }
        }
    }
    falls
}

/// Student's t of the difference of two means, one variance for both.
fn student(a: &[f64], b: &[f64]) -> f64 {
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let squares = |of: &[f64], mean: f64| of.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    let [n, m] = [a.len() as f64, b.len() as f64];
    let means = [mean(a), mean(b)];
    let variance = (squares(a, means[0]) + squares(b, means[1])) / (n + m - 2.0);
    (means[0] - means[1]) / (variance * (1.0 / n + 1.0 / m)).sqrt()
}
