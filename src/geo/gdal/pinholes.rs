//! Small holes in a layer, filled with what lies beneath, raised or lowered to meet their rims.
//!
//! A hole is small where no disk of one coarse cell's radius fits into it: blended as a seam it would cost the detail of all
//! land around it, bare it would be a spike. Method: the difference between the layers is stretched over the hole from its
//! rim, a [`membrane`], and added to the coarse one (delta surface fill: Grohman, Kroenung, Strebeck 2006, Photogrammetric
//! Engineering and Remote Sensing 72). Cost: two distances a sample of the layer and, where there are holes, the
//! membrane. Not handled: holes beneath which there is nothing.

use rayon::prelude::*;

use super::distance::distances;
use super::membrane;

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
    let holes: Vec<_> = (0..metres.len()).into_par_iter().filter(|i| is_small(i) && !beneath(*i).is_nan()).collect();
    if holes.is_empty() {
        return;
    }
    drop((to_land, to_wide));
    let mut higher: Vec<_> = metres.par_iter().enumerate().map(|(i, metres)| metres - beneath(i)).collect();
    membrane::stretch(&mut higher, size, &holes);
    holes.into_iter().for_each(|i| metres[i] = beneath(i) + higher[i]);
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

    #[test]
    fn a_wide_river_costs_no_more_than_a_brook() {
        // 100 000 samples of a hole, each up to 100 from its rim.
        let (columns, rows) = (400, 560);
        let plane = |i: usize| (i % columns) as f32 * 0.2;
        let river = |i: usize| (100..300).contains(&(i % columns)) && (30..530).contains(&(i / columns));
        let land = |i: usize| if river(i) { f32::NAN } else { plane(i) + 3.0 };
        let mut metres: Vec<f32> = (0..columns * rows).map(land).collect();
        let started = std::time::Instant::now();
        fill(&mut metres, [columns, rows], [1.0, 1.0], 150.0, &plane);
        let seconds = started.elapsed().as_secs_f64();
        assert!(metres.iter().enumerate().all(|(i, metres)| (metres - plane(i) - 3.0).abs() < 1e-3));
        assert!(seconds < 2.0, "{seconds} s");
    }
}
