//! Small holes in a layer, filled with what lies beneath, raised or lowered to meet their rims.
//!
//! A hole is small where no disk of one coarse cell's radius fits into it: blended as a seam it would cost the detail of all
//! land around it, bare it would be a spike. Method: the difference between the layers is carried from the rim into the
//! hole, weighted by the inverse square of the distance (delta surface fill: Grohman, Kroenung, Strebeck 2006,
//! Photogrammetric Engineering and Remote Sensing 72), and added to the coarse one. Cost: two distances a sample of the
//! layer, and for each sample of a hole a visit of those around it. Not handled: holes beneath which there is nothing.

use rayon::prelude::*;

use super::distance::distances;

/// Samples beyond the rim of a hole from which the difference is taken.
const RIM: f64 = 2.0;

/// Fills the small holes of `metres`, `size` samples (columns, rows) `step` metres apart, NaN at voids. `beneath` are the
/// heights below them, NaN likewise; `reach` metres are the cell of those.
pub(super) fn fill(
    metres: &mut [f32],
    size: [usize; 2],
    step: [f64; 2],
    reach: f64,
    beneath: &(impl Fn(usize) -> f32 + Sync),
) {
    let Some(to_land) = distances(size, step, reach, |i| !metres[i].is_nan()) else { return };
    let edge = |i: usize| {
        let at = [i % size[0], i / size[0]];
        (0..2).any(|i| at[i] == 0 || at[i] + 1 == size[i])
    };
    let is_wide = |i: usize| to_land[i] >= reach as f32 || (to_land[i] > 0.0 && edge(i));
    let to_wide = distances(size, step, reach, is_wide);
    let is_small = |i: &usize| to_land[*i] > 0.0 && to_wide.as_ref().is_none_or(|wide| wide[*i] >= reach as f32);
    let holes = (0..metres.len()).into_par_iter().filter(is_small);
    let filled: Vec<_> = holes
        .filter_map(|i| Some((i, beneath(i) + difference(metres, size, step, i, f64::from(to_land[i]), beneath)?)))
        .collect();
    filled.into_iter().for_each(|(i, height)| metres[i] = height);
}

/// How much higher the layer lies around sample `i` of a hole, `to_land` metres from its rim, than what is beneath.
fn difference(
    metres: &[f32],
    size: [usize; 2],
    step: [f64; 2],
    i: usize,
    to_land: f64,
    beneath: &impl Fn(usize) -> f32,
) -> Option<f32> {
    let at = [i % size[0], i / size[0]];
    let reach = [0, 1].map(|i| (to_land / step[i] + RIM).ceil() as usize);
    let range = |i: usize| at[i].saturating_sub(reach[i])..=(at[i] + reach[i]).min(size[i] - 1);
    let (mut sum, mut weights) = (0.0, 0.0);
    for (c, r) in range(1).flat_map(|r| range(0).map(move |c| (c, r))) {
        let higher = f64::from(metres[r * size[0] + c]) - f64::from(beneath(r * size[0] + c));
        if higher.is_finite() {
            let [x, y] = [at[0].abs_diff(c) as f64 * step[0], at[1].abs_diff(r) as f64 * step[1]];
            let weight = 1.0 / (x * x + y * y);
            sum += weight * higher;
            weights += weight;
        }
    }
    (weights > 0.0).then(|| (sum / weights) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_holes_meet_their_rims_and_wide_ones_stay() {
        let (columns, step) = (60, [10.0, 10.0]);
        let plane = |i: usize| (i % columns) as f32 * 2.0 - (i / columns) as f32;
        let small = |i: usize| (10..14).contains(&(i % columns)) && (10..13).contains(&(i / columns));
        let wide = |i: usize| (25..50).contains(&(i % columns)) && (25..50).contains(&(i / columns));
        let land = |i: usize| if small(i) || wide(i) { f32::NAN } else { plane(i) + 7.0 };
        let mut metres: Vec<f32> = (0..columns * columns).map(land).collect();
        fill(&mut metres, [columns, columns], step, 90.0, &plane);
        for (i, height) in metres.iter().enumerate().filter(|(i, _)| small(*i)) {
            assert!((height - plane(i) - 7.0).abs() < 1e-4, "{i}: {height}");
        }
        // Its corners are narrow.
        let middle = 37 * columns + 37;
        assert!(metres[middle].is_nan() && metres[middle - 10].is_nan() && metres[middle + 10 * columns].is_nan());
    }
}
