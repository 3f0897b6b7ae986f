//! Samples filled by a membrane stretched between those around them.
//!
//! Method: Laplace's equation, the values around held; started from a pyramid of means (Gortler, Grzeszczuk, Szeliski, Cohen
//! 1996, The Lumigraph) and relaxed at each of its levels from coarse to fine (Bornemann, Deuflhard 1996, The cascadic
//! multigrid method), by red-black successive over-relaxation: the same bits whatever thread does what. Linear land is
//! met within some hundredths of a sample's step. Cost: a visit a sample and a fixed number for each that is filled. Not
//! handled: samples wider one way than the other, which are taken for squares.

use rayon::prelude::*;

/// Rounds at each level, and how far each goes beyond the mean of the neighbours.
const ROUNDS: usize = 24;
const RELAXATION: f32 = 1.6;

/// Fills the samples `wanted`, which are NaN, of `values`, `size` (columns, rows). Others that are NaN stay outside. What
/// is wanted and touches no value stays NaN.
pub(super) fn stretch(values: &mut [f32], size: [usize; 2], wanted: &[usize]) {
    if wanted.is_empty() {
        return;
    }
    if size != [1, 1] {
        let half = size.map(|samples| samples.div_ceil(2));
        let mut means = means(values, size, half);
        let place = |i: &usize| i / size[0] / 2 * half[0] + i % size[0] / 2;
        let mut above: Vec<_> = wanted.iter().map(place).filter(|i| means[*i].is_nan()).collect();
        above.sort_unstable();
        above.dedup();
        stretch(&mut means, half, &above);
        let started: Vec<_> = wanted.par_iter().map(|i| between(&means, half, [i % size[0], i / size[0]])).collect();
        wanted.iter().zip(started).for_each(|(i, value)| values[*i] = value);
    }
    let colours: [Vec<usize>; 2] =
        [0, 1].map(|colour| wanted.iter().copied().filter(|i| (i % size[0] + i / size[0]) % 2 == colour).collect());
    for colour in colours.iter().cycle().take(2 * ROUNDS) {
        let next: Vec<_> = colour.par_iter().map(|i| relaxed(values, size, *i)).collect();
        colour.iter().zip(next).for_each(|(i, value)| values[*i] = value);
    }
}

/// Means of two by two values, of those that are known.
fn means(values: &[f32], size: [usize; 2], half: [usize; 2]) -> Vec<f32> {
    let mean = |i: usize| {
        let [from_c, from_r] = [i % half[0] * 2, i / half[0] * 2];
        let rows = from_r..(from_r + 2).min(size[1]);
        let samples = rows.flat_map(|r| (from_c..(from_c + 2).min(size[0])).map(move |c| r * size[0] + c));
        mean(samples.map(|i| (values[i], 1.0)))
    };
    (0..half[0] * half[1]).into_par_iter().map(mean).collect()
}

/// The value at sample `at` of the finer level, linear between those of the coarser.
fn between(coarse: &[f32], size: [usize; 2], at: [usize; 2]) -> f32 {
    let near = [0, 1].map(|i| {
        let own = at[i] / 2;
        let other =
            if at[i].is_multiple_of(2) { own.checked_sub(1) } else { Some(own + 1).filter(|next| *next < size[i]) };
        [Some((own, 0.75)), other.map(|other| (other, 0.25))]
    });
    let columns = |(r, down): (usize, f32)| {
        near[0].into_iter().flatten().map(move |(c, along)| (coarse[r * size[0] + c], along * down))
    };
    mean(near[1].into_iter().flatten().flat_map(columns))
}

/// What sample `i` becomes in one round.
fn relaxed(values: &[f32], size: [usize; 2], i: usize) -> f32 {
    let [c, r] = [i % size[0], i / size[0]];
    let around = [
        (c > 0).then(|| i - 1),
        (c + 1 < size[0]).then(|| i + 1),
        (r > 0).then(|| i - size[0]),
        (r + 1 < size[1]).then(|| i + size[0]),
    ];
    let mean = mean(around.into_iter().flatten().map(|i| (values[i], 1.0)));
    match values[i] {
        _ if mean.is_nan() => values[i],
        own if own.is_nan() => mean,
        own => own + (mean - own) * RELAXATION,
    }
}

/// The mean of values with their weights, those that are NaN apart; NaN where there is no other.
fn mean(values: impl Iterator<Item = (f32, f32)>) -> f32 {
    let known = values.filter(|(value, _)| !value.is_nan());
    let (sum, weights) =
        known.fold((0.0, 0.0), |(sum, weights), (value, weight)| (sum + value * weight, weights + weight));
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_run_on_over_holes() {
        let size = [90, 70];
        let plane = |i: usize| (i % size[0]) as f32 * 0.9 - (i / size[0]) as f32 * 0.4 + 300.0;
        let is_wanted = |i: usize| {
            let [c, r] = [i % size[0], i / size[0]];
            (30..42).contains(&r) || ((10..35).contains(&c) && (50..64).contains(&r))
        };
        let is_outside = |i: usize| i / size[0] < 10;
        let unknown = |i: usize| is_wanted(i) || is_outside(i);
        let mut values: Vec<_> = (0..size[0] * size[1]).map(|i| if unknown(i) { f32::NAN } else { plane(i) }).collect();
        let wanted: Vec<_> = (0..values.len()).filter(|i| is_wanted(*i)).collect();
        stretch(&mut values, size, &wanted);
        // Nothing holds the ends of the stripe.
        for i in wanted.into_iter().filter(|i| (20..70).contains(&(i % size[0])) || i / size[0] >= 50) {
            assert!((values[i] - plane(i)).abs() < 0.2, "{i}: {} for {}", values[i], plane(i));
        }
        assert!((0..values.len()).all(|i| values[i].is_nan() == is_outside(i)));
    }
}
