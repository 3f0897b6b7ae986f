//! Heights without the noise of single samples: a Gaussian of .8 cell, in one pass along rows and one across.
//!
//! Voids have no weight, and what is left of the weights is brought to 1 by a division. Cost: some 30 multiplications a sample, in
//! loops that the compiler turns into vectors; memory of a few rows.

use super::frame::FramedGrid;

/// Standard deviation, cells.
const DEVIATION: f64 = 0.8;
/// Cells to either side that still have weight: 1/1 000 of that in the middle.
const REACH: usize = 3;
const TAPS: usize = 2 * REACH + 1;

/// The framed heights smoothed, NaN where they are.
pub(super) fn smoothed(frame: FramedGrid, heights: &[f32]) -> Vec<f32> {
    let weights: [f32; TAPS] =
        std::array::from_fn(|k| (-((k as f64 - REACH as f64) / DEVIATION).powi(2) / 2.0).exp() as f32);
    let [columns, rows] = frame.size;
    let mut out = vec![f32::NAN; frame.samples()];
    // Rows smoothed along, with what weighs in them, those of `TAPS` rows in turn; none beyond the grid.
    let mut along = vec![[vec![0.0; columns], vec![0.0; columns]]; TAPS];
    let mut padded = [vec![0.0; columns + 2 * REACH], vec![0.0; columns + 2 * REACH]];
    let mut sums = [vec![0.0; columns], vec![0.0; columns]];
    for next in 0..rows + REACH {
        let onto = &mut along[next % TAPS];
        if next < rows {
            for (k, height) in heights[frame.row(next)].iter().enumerate() {
                let is_void = height.is_nan();
                padded[0][REACH + k] = if is_void { 0.0 } else { *height };
                padded[1][REACH + k] = if is_void { 0.0 } else { 1.0 };
            }
        }
        for (padded, onto) in padded.iter().zip(onto) {
            onto.fill(0.0);
            for (k, weight) in weights.iter().enumerate().filter(|_| next < rows) {
                onto.iter_mut().zip(&padded[k..]).for_each(|(onto, value)| *onto += weight * value);
            }
        }
        let Some(r) = next.checked_sub(REACH) else { continue };
        for (which, sum) in sums.iter_mut().enumerate() {
            sum.fill(0.0);
            for (k, weight) in weights.iter().enumerate().filter(|(k, _)| r + k >= REACH) {
                let row = &along[(r + k - REACH) % TAPS][which];
                sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        let [values, weights] = &sums;
        let row = out[frame.row(r)].iter_mut().zip(&heights[frame.row(r)]);
        for ((onto, height), (value, weight)) in row.zip(values.iter().zip(weights)) {
            *onto = if height.is_nan() { f32::NAN } else { value / weight };
        }
    }
    out
}
