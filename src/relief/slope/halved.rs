//! The land at half the scale, for lines that stand so far apart that they would follow what no page shows of it.
//!
//! Method: a Gaussian pyramid (Burt, Adelson 1983): heights are averaged by binomial weights, 1 4 6 4 1, along rows and columns, and
//! every other one stays, of even sides one more beyond the edge. After n times they are those of a Gaussian of about .58 of the new cells.
//! Voids have no weight: they are filled from what is about them, so who goes on the land looks at the land itself. Cost: some 20 multiplications a sample that stays, on every core.

use rayon::prelude::*;

use crate::dem::{Dem, Samples};
use crate::error::Result;

/// Weights of a sample and those beside it.
const WEIGHTS: [f32; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
/// How far they reach.
const REACH: usize = WEIGHTS.len() / 2;
/// Fewest columns and rows that are halved.
const FEWEST: usize = 32;

/// A held DEM of every other column and row, averaged; none of one that has few.
///
/// # Errors
/// As [`Dem::held`].
pub(super) fn halved(dem: &Dem) -> Result<Option<Dem>> {
    let size = [dem.columns(), dem.rows()];
    if size.iter().any(|side| *side < FEWEST) {
        return Ok(None);
    }
    let samples = dem.held()?;
    let halves = size.map(|side| side / 2 + 1);
    let heights: Vec<f32> =
        (0..halves[1]).into_par_iter().flat_map_iter(|row| halved_row(samples, 2 * row, halves[0])).collect();
    Ok(Some(Dem::from_heights(halves[0], dem.cell() * 2.0, dem.position(0, 0).truncate(), heights)))
}

/// So many samples about a row, every other one, averaged; not a number where all about one are voids.
fn halved_row(samples: &Samples, row: usize, halves: usize) -> Vec<f32> {
    let [columns, rows] = samples.size();
    // Heights by their weights down the columns, and these: 0 of voids.
    let [mut sums, mut weights] = [0, 1].map(|_| vec![0.0_f32; columns]);
    for (at, weight) in around(row, rows) {
        for c in 0..columns {
            let height = samples.height(c, at);
            sums[c] += weight * height.unwrap_or(0.0);
            weights[c] += if height.is_some() { weight } else { 0.0 };
        }
    }
    let middle = |c: usize| {
        let add =
            |[sum, all]: [f32; 2], (at, weight): (usize, f32)| [sum + weight * sums[at], all + weight * weights[at]];
        let [sum, all] = around(c, columns).fold([0.0; 2], add);
        if all > 0.0 { sum / all } else { f32::NAN }
    };
    (0..halves).map(|half| middle(2 * half)).collect()
}

/// Those of so many samples that count at one, with their weights.
fn around(at: usize, count: usize) -> impl Iterator<Item = (usize, f32)> {
    (at.saturating_sub(REACH)..count.min(at + REACH + 1)).map(move |k| (k, WEIGHTS[k + REACH - at]))
}
