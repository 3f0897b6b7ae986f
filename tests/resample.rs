//! The same terrain on grids of other sizes.

use rayon::prelude::*;

/// Heights of a square grid of `from` samples a side, at least 2, on one of `to` over the same ground: both have their
/// outermost samples in the same places.
///
/// Cubic convolution (Keys 1981, a = -1/2) along rows, then down columns: through every sample, exact for planes, which
/// go on beyond the edge. Cost: 4 multiplications a sample of the finer grid.
pub fn resampled(heights: &[f32], from: usize, to: usize) -> Vec<f32> {
    let along: Vec<_> = (0..to).map(|i| taps(i, from, to)).collect();
    let row = |row: &[f32]| {
        let row: Vec<_> = row.iter().copied().map(f64::from).collect();
        let row = extended(row, |near, far| 2.0 * near - far);
        along.iter().map(|(first, weights)| (0..4).map(|k| row[first + k] * weights[k]).sum()).collect::<Vec<f64>>()
    };
    let beyond = |near: &Vec<f64>, far: &Vec<f64>| near.iter().zip(far).map(|(near, far)| 2.0 * near - far).collect();
    let rows = extended(heights.chunks_exact(from).map(row).collect(), |near, far| beyond(&near, &far));
    let mut onto = vec![0.0; to * to];
    onto.par_chunks_exact_mut(to).zip(&along).for_each(|(onto, (first, weights))| {
        for (c, onto) in onto.iter_mut().enumerate() {
            *onto = (0..4).map(|k| rows[first + k][c] * weights[k]).sum::<f64>() as f32;
        }
    });
    onto
}

/// Where the four samples around sample `i` of `to` begin among `from`, one more on either side, and their weights.
fn taps(i: usize, from: usize, to: usize) -> (usize, [f64; 4]) {
    let at = i * (from - 1);
    let cell = (at / (to - 1)).min(from - 2);
    let t = (at - cell * (to - 1)) as f64 / (to - 1) as f64;
    let (t2, t3) = (t * t, t * t * t);
    let weights = [2.0 * t2 - t - t3, 3.0 * t3 - 5.0 * t2 + 2.0, t + 4.0 * t2 - 3.0 * t3, t3 - t2];
    (cell, weights.map(|weight| weight / 2.0))
}

/// A line with one more value at either end, from the two next to it, the nearer one first.
fn extended<T: Clone>(mut line: Vec<T>, beyond: impl Fn(T, T) -> T) -> Vec<T> {
    let last = line.len() - 1;
    line.push(beyond(line[last].clone(), line[last - 1].clone()));
    line.insert(0, beyond(line[0].clone(), line[1].clone()));
    line
}
