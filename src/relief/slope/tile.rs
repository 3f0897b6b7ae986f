//! A square of places in an order in which the first of them, however many, lie evenly: blue noise.
//!
//! Method: void and cluster (Ulichney 1993) on a torus of 32 x 32 places, with a Gaussian of 1.5 places. Sums are of whole
//! numbers, so that every machine finds the same order. Cost: 3 million additions, once; 2 KiB.

use std::sync::OnceLock;

/// Places along a side.
pub(super) const SIDE: usize = 32;
/// Places.
pub(super) const PLACES: usize = SIDE * SIDE;
/// Standard deviation of the Gaussian by which places crowd, places.
const SIGMA: f64 = 1.5;
/// One, of the Gaussian.
const ONE: f64 = (1 << 20) as f64;
/// Places that are taken before the first is ranked: one in ten.
const FIRST: usize = PLACES / 10;

/// Places row by row, by their ranks.
pub(super) fn order() -> &'static [u16] {
    static ORDER: OnceLock<Vec<u16>> = OnceLock::new();
    ORDER.get_or_init(made)
}

fn made() -> Vec<u16> {
    let mut pattern = Pattern::new();
    // Any places, as long as they are not in order: steps of the golden ratio.
    (0..FIRST).map(|k| k * 2531 % PLACES).for_each(|place| pattern.set(place, true));
    // Their crowds are moved to the voids until that changes nothing.
    loop {
        let crowded = pattern.crowded();
        pattern.set(crowded, false);
        let void = pattern.void();
        pattern.set(void, true);
        if void == crowded {
            break;
        }
    }
    let mut thinned = pattern.clone();
    let mut first: Vec<usize> = (0..FIRST).map(|_| thinned.change(Pattern::crowded, false)).collect();
    first.reverse();
    let rest = (FIRST..PLACES).map(|_| pattern.change(Pattern::void, true));
    first.into_iter().chain(rest).map(|place| place as u16).collect()
}

/// Which places are taken, and how crowded each is by them.
#[derive(Clone)]
struct Pattern {
    kernel: Vec<i32>,
    taken: Vec<bool>,
    crowding: Vec<i32>,
}

impl Pattern {
    fn new() -> Self {
        let away = |at: usize| at.min(SIDE - at) as f64;
        let weight = |i: usize| {
            let squared = away(i % SIDE).powi(2) + away(i / SIDE).powi(2);
            (ONE * (-squared / (2.0 * SIGMA * SIGMA)).exp()).round() as i32
        };
        Self { kernel: (0..PLACES).map(weight).collect(), taken: vec![false; PLACES], crowding: vec![0; PLACES] }
    }

    fn set(&mut self, place: usize, taken: bool) {
        let (column, row) = (place % SIDE, place / SIDE);
        let sign = if taken { 1 } else { -1 };
        self.taken[place] = taken;
        for (r, line) in self.crowding.chunks_exact_mut(SIDE).enumerate() {
            let kernel = &self.kernel[(r + SIDE - row) % SIDE * SIDE..][..SIDE];
            let (before, from) = line.split_at_mut(column);
            let (start, end) = kernel.split_at(SIDE - column);
            from.iter_mut()
                .zip(start)
                .chain(before.iter_mut().zip(end))
                .for_each(|(sum, weight)| *sum += sign * weight);
        }
    }

    /// Sets the place that a rule finds, and returns it.
    fn change(&mut self, find: fn(&Self) -> usize, taken: bool) -> usize {
        let place = find(self);
        self.set(place, taken);
        place
    }

    /// The most crowded place that is taken.
    fn crowded(&self) -> usize {
        (0..PLACES).filter(|i| self.taken[*i]).max_by_key(|i| self.crowding[*i]).unwrap_or(0)
    }

    /// The least crowded place that is not.
    fn void(&self) -> usize {
        (0..PLACES).filter(|i| !self.taken[*i]).min_by_key(|i| self.crowding[*i]).unwrap_or(0)
    }
}
