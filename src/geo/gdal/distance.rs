//! How far each sample of a grid lies from the nearest of some of them.
//!
//! Method: exact Euclidean distances, first down the columns, then along the rows by the lower envelope of parabolas
//! (Felzenszwalb, Huttenlocher 2012, Distance Transforms of Sampled Functions, Theory of Computing 8), on every core.
//! Cost: about three visits a sample and 4 bytes. Distances beyond a limit are cut there.

use rayon::prelude::*;

/// Metres from each of `size` samples (columns, rows), `step` metres apart along rows and down columns, to the nearest
/// that `is_seed` holds for, `most` at most; `None` where there is none.
pub(super) fn distances(
    size: [usize; 2],
    step: [f64; 2],
    most: f64,
    is_seed: impl Fn(usize) -> bool + Sync,
) -> Option<Vec<f32>> {
    let [columns, rows] = size;
    let cut = most as f32;
    let mut metres: Vec<f32> =
        (0..columns * rows).into_par_iter().map(|i| if is_seed(i) { 0.0 } else { cut }).collect();
    if metres.par_iter().all(|d| *d > 0.0) {
        return None;
    }
    let mut spread = |r: usize, from: usize| {
        let (above, below) = metres.split_at_mut(r.max(from) * columns);
        let (near, own) =
            if from < r { (&above[from * columns..], below) } else { (&*below, &mut above[r * columns..]) };
        own.iter_mut().zip(near).take(columns).for_each(|(own, near)| *own = own.min(near + step[1] as f32));
    };
    (1..rows).for_each(|r| spread(r, r - 1));
    (1..rows).rev().for_each(|r| spread(r - 1, r));
    metres.par_chunks_mut(columns).for_each_init(Envelope::default, |envelope, row| envelope.along(row, step[0], cut));
    Some(metres)
}

/// The lowest of parabolas over a row, each around a sample, from left to right.
#[derive(Default)]
struct Envelope {
    /// Column and squared height of each, and from where on, in columns, it is the lowest.
    parabolas: Vec<(f64, f64, f64)>,
}

impl Envelope {
    /// Turns distances within columns into those within the plane; `step` metres between the samples of `row`.
    fn along(&mut self, row: &mut [f32], step: f64, cut: f32) {
        self.parabolas.clear();
        for (c, height) in row.iter().enumerate().filter(|(_, height)| **height < cut) {
            self.add(c as f64, (f64::from(*height) / step).powi(2));
        }
        let mut lowest = 0;
        for (c, height) in row.iter_mut().enumerate().take_while(|_| !self.parabolas.is_empty()) {
            let c = c as f64;
            while self.parabolas.get(lowest + 1).is_some_and(|(_, _, from)| *from <= c) {
                lowest += 1;
            }
            let (middle, least, _) = self.parabolas[lowest];
            *height = cut.min((((c - middle).powi(2) + least).sqrt() * step) as f32);
        }
    }

    /// One more parabola, right of all others.
    fn add(&mut self, middle: f64, least: f64) {
        while let Some((other, low, from)) = self.parabolas.last().copied() {
            let cross = (least + middle * middle - low - other * other) / (2.0 * (middle - other));
            if cross > from {
                self.parabolas.push((middle, least, cross));
                return;
            }
            self.parabolas.pop();
        }
        self.parabolas.push((middle, least, f64::NEG_INFINITY));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_to_the_nearest_seed() {
        let ([columns, rows], step, most) = ([37, 29], [10.0, 7.0], 45.0);
        let is_seed = |i: usize| (i * 7919) % 53 == 3;
        let seeds: Vec<usize> = (0..columns * rows).filter(|i| is_seed(*i)).collect();
        assert!(seeds.len() > 3, "{seeds:?}");
        let found = distances([columns, rows], step, most, is_seed).unwrap_or_default();
        for (i, found) in found.iter().enumerate() {
            let to = |seed: &usize| {
                let [c, r] = [(i % columns).abs_diff(seed % columns), (i / columns).abs_diff(seed / columns)];
                (c as f64 * step[0]).hypot(r as f64 * step[1])
            };
            let true_one = seeds.iter().map(to).fold(most, f64::min);
            assert!((f64::from(*found) - true_one).abs() < 1e-4, "{i}: {found} for {true_one}");
        }
        assert_eq!(distances([5, 4], step, most, |_| false), None);
    }
}
