//! The gaps between layers that stand side by side: what lies beyond their outermost samples.
//!
//! A file's cells reach half a cell beyond its outermost samples, and a warp gives them the height of those: between two
//! neighbours that is a stair. So the rim of a layer is laid only where no other knows the land, and where both rims meet,
//! a [`membrane`] is stretched from the samples of one to those of the other. The rim of all layers stays as it was.
//! Cost: a distance a sample of a layer that is warped, and two around its rim where others end there. Not
//! handled: rims around voids inside a layer.

use rayon::prelude::*;

use super::crs::CrsPath;
use super::distance::distances;
use super::grid::GeoGrid;
use super::membrane;

/// Places carried at once.
const PLACES: usize = 1 << 14;

/// Which samples of a layer, `metres` on `grid`, NaN at voids, lie beyond the outermost ones of `own`, whose cells are of
/// `cell` metres.
pub(super) fn rim(own: &GeoGrid, grid: &GeoGrid, metres: &[f32], cell: f64) -> Vec<bool> {
    let (size, step) = ([grid.columns, grid.rows], grid.step());
    let mut rim = vec![false; metres.len()];
    let reach = cell + step[0].max(step[1]);
    let Some(inward) = distances(size, step, 2.0 * reach, |i| metres[i].is_nan()) else { return rim };
    let near: Vec<_> =
        (0..metres.len()).into_par_iter().filter(|i| !metres[*i].is_nan() && inward[*i] <= reach as f32).collect();
    let beyond = |samples: &[usize]| {
        let mut places: Vec<_> =
            samples.iter().map(|i| grid.sample((i % size[0]) as f64, (i / size[0]) as f64)).collect();
        let Some(way) = CrsPath::between(&grid.crs, &own.crs) else { return Vec::new() };
        way.carry(&mut places);
        own.pixels(&mut places);
        let end = [own.columns as f64 - 0.5, own.rows as f64 - 0.5];
        let is_beyond = |at: [f64; 2]| (0..2).any(|i| at[i] < 0.5 || at[i] > end[i]);
        samples.iter().zip(places).filter(|(_, place)| is_beyond(place.to_array())).map(|(i, _)| *i).collect()
    };
    let found: Vec<Vec<usize>> = near.par_chunks(PLACES).map(beyond).collect();
    found.into_iter().flatten().for_each(|i| rim[i] = true);
    rim
}

/// Fills the samples of a rim, `is_rim` of `metres`, that lie within `reach` metres of both one layer and another:
/// `sides` tells what is known of each. Returns them.
pub(super) fn fill(
    metres: &mut [f32],
    size: [usize; 2],
    step: [f64; 2],
    reach: f64,
    is_rim: impl Fn(usize) -> bool + Sync,
    sides: [&(dyn Fn(usize) -> bool + Sync); 2],
) -> Vec<usize> {
    let mut gap: Vec<_> = (0..metres.len()).into_par_iter().filter(|i| is_rim(*i)).collect();
    for side in sides {
        if gap.is_empty() {
            return gap;
        }
        let Some(to_side) = distances(size, step, 2.0 * reach, side) else { return Vec::new() };
        gap.retain(|i| to_side[*i] <= reach as f32);
    }
    gap.iter().for_each(|i| metres[*i] = f32::NAN);
    membrane::stretch(metres, size, &gap);
    gap
}
