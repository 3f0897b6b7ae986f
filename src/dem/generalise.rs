//! Heights smoothed at a scale, their crests kept: surface models and dense lidar draw hair where there are trees and walls.
//!
//! Method: `facets`. A plane is fitted to every 4 x 4 blocks of a fifth of the scale each (facet model: Haralick,
//! Watson 1981), and a sample gets the mean of the sixteen planes about it, each weighted by how near it is and by a
//! power of its variance, so that planes on one side of a crest win over those across it (Kuwahara et al. 1976;
//! Papari, Petkov, Campisi 2007). That is done twice: what stands out of the first surface by more than a twenty-fifth
//! of the scale is cut to that, and the second surface, of smoother weights, is that of the rest.
//!
//! Planes stay planes and crests keep their height: a roof nearly all of it, while the top of a cone loses its slope times
//! a fifth of the scale. Blocks are counted from the DEM's first sample and sums are taken in one order: a window with its
//! [`halo`] has the bits of the whole, on any number of threads. Cost: some 300 ns of one core a sample, at any scale.
//!
//! Not handled: scales below two and a half cells change nothing. Voids stay voids, and what lies outside counts for nothing.

mod facets;

use glam::DVec2;
use rayon::prelude::*;

use super::window::Window;
use facets::Facets;

/// Blocks along the scale.
const BLOCKS: f64 = 5.0;
/// Longest side of a block, samples.
const LONGEST: f64 = 4096.0;
/// Blocks that one surface reaches.
const REACH: usize = 4;
/// Powers of the variance that weigh planes: sharp for the first surface, soft for the second.
const POWERS: [i32; 2] = [4, 2];
/// How far a sample may stand out of the first surface, as a share of the scale.
const STANDS_OUT: f64 = 0.04;
/// Standard deviation, as a share of the scale, below which planes fit equally well.
const FLAT: f64 = 1e-3;
/// Shortest side of a tile, samples.
const TILE: usize = 256;

/// Samples around a window on which its generalised heights depend, at a scale of so many metres; `cell`: metres between
/// columns and rows. 0 where the scale changes nothing.
pub fn halo(metres: f64, cell: DVec2) -> usize {
    sides(metres, cell).map_or(0, |sides| POWERS.len() * REACH * sides[0].max(sides[1]))
}

/// Smooths `heights` (metres, row-major, NaN at voids) of a window at a scale of `metres`. `window` counts in samples of
/// the DEM, `cell` is metres between columns and rows; `parallel` says whether all cores may be used. What is not finite is a
/// void, and NaN afterwards where the scale changes anything.
///
/// # Panics
/// When heights and window are not of one shape.
pub fn generalise(heights: &mut [f32], window: Window, cell: DVec2, metres: f64, parallel: bool) {
    assert!(heights.len() as u64 == window.samples());
    let Some(sides) = sides(metres, cell).filter(|_| !heights.is_empty()) else { return };
    let halo = halo(metres, cell);
    let (rough, width, tile) = (heights.to_vec(), window.size[0], TILE.max(4 * halo));
    let task = |(at, rows): (usize, &mut [f32])| {
        let size = [tile, rows.len() / width];
        for column in (0..width).step_by(tile) {
            let part = Window { first: [column, at * tile], size: [size[0].min(width - column), size[1]] };
            let around = part.with_halo(halo, window.size);
            let smooth = smoothed(&cut(&rough, width, around), shifted(around, window.first), sides, metres);
            for (r, row) in rows.chunks_exact_mut(width).enumerate() {
                let from = (part.first[1] + r - around.first[1]) * around.size[0] + column - around.first[0];
                row[column..column + part.size[0]].copy_from_slice(&smooth[from..from + part.size[0]]);
            }
        }
    };
    match parallel {
        true => heights.par_chunks_mut(tile * width).enumerate().for_each(task),
        false => heights.chunks_mut(tile * width).enumerate().for_each(task),
    }
}

/// Columns and rows of a block; `None` where it would have none.
fn sides(metres: f64, cell: DVec2) -> Option<[usize; 2]> {
    let sides = (metres / (BLOCKS * cell)).to_array().map(|side| side.clamp(0.0, LONGEST).round() as usize);
    (sides != [0, 0]).then(|| sides.map(|side| side.max(1)))
}

/// Both surfaces, one after the other; bits are those of the whole but for the halo.
fn smoothed(rough: &[f32], window: Window, sides: [usize; 2], metres: f64) -> Vec<f32> {
    let least = (FLAT * metres).powi(2);
    let surface = |heights: &[f32], power| Facets::fitted(heights, window, sides).surface(heights, power, least);
    let mut first = surface(rough, POWERS[0]);
    let most = (STANDS_OUT * metres) as f32;
    for (smooth, rough) in first.iter_mut().zip(rough) {
        *smooth += (rough - *smooth).clamp(-most, most);
    }
    surface(&first, POWERS[1])
}

/// The samples of a part of a grid of so many columns.
fn cut(samples: &[f32], width: usize, part: Window) -> Vec<f32> {
    let rows = samples.chunks_exact(width).skip(part.first[1]).take(part.size[1]);
    rows.flat_map(|row| &row[part.first[0]..part.first[0] + part.size[0]]).copied().collect()
}

/// A window of a window, counted in the DEM.
fn shifted(part: Window, first: [usize; 2]) -> Window {
    Window { first: [0, 1].map(|i| first[i] + part.first[i]), ..part }
}
