//! Shores of a DEM that stays in its file, found on blocks of its samples.
//!
//! Method: a block is as high as most of its samples, where so many are equal, as water is; else as its lowest, as for flow. Water is
//! found on blocks as it is on samples. Samples as low as their block tell how much of it is water; what is less than half water is
//! land, unless all about it is water, and a shore runs where the share comes down to half between the middles of two blocks, as
//! fluids do that fill their cells in part (Hirt, Nichols 1981). Memory: 20 bytes a block, and a band of the DEM. Cost: a look at
//! every sample. Not handled: lakes under 64 blocks, islands under 8, arms of water narrower than a block; at the shores of water
//! that is not level to the last bit a shore may lie a block off.

use rayon::prelude::*;

use super::{Shores, rims};
use crate::dem::{Band, Dem};
use crate::error::Result;
use crate::relief::FlatWater;
use crate::relief::coarse::on_samples;

/// Share of a block from which on it is water.
const HALF: f32 = 0.5;

/// Of each block its height, NaN where all of it is void, and the share of its samples that are as low.
struct Levels {
    heights: Vec<f32>,
    shares: Vec<f32>,
}

impl Shores {
    /// Of a DEM whose heights are multiplied by `exaggeration`, on blocks of `side` x `side` samples, a power of two up to 64: on
    /// blocks of one sample those [of](Self::of) a held one. Tells `progress` the share done.
    ///
    /// # Errors
    /// As [`Dem::window`] and [`Dem::check`].
    ///
    /// # Panics
    /// With fewer than two columns or rows of blocks.
    pub fn on_blocks(dem: &Dem, exaggeration: f64, side: usize, progress: &dyn Fn(f64)) -> Result<Self> {
        let Levels { heights, shares } = levels(dem, side, progress)?;
        let [columns, rows] = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(side));
        let corner = dem.position(0, 0).truncate();
        let blocks = Dem::from_heights(columns, dem.cell() * side as f64, corner, heights);
        if side == 1 {
            return Self::of(&blocks, exaggeration);
        }
        let mut water = FlatWater::of(&blocks, exaggeration)?;
        let all = water.clone();
        let is_surrounded = |block: usize| {
            let [c, r] = [block % columns, block / columns];
            let mut about = (r.saturating_sub(1)..(r + 2).min(rows))
                .flat_map(|r| (c.saturating_sub(1)..(c + 2).min(columns)).map(move |c| [c, r]));
            about.all(|[c, r]| all.is_water(c, r))
        };
        water.retain(|block| shares[block] >= HALF || is_surrounded(block));
        let mut lines = rims(&blocks, &water, Some(&shares))?;
        on_samples(&mut lines, dem, side);
        Ok(Self { water: water.of_blocks(side), lines })
    }
}

fn levels(dem: &Dem, side: usize, progress: &dyn Fn(f64)) -> Result<Levels> {
    let [columns, rows] = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(side));
    let (mut heights, mut shares) = (vec![f32::NAN; columns * rows], vec![0.0; columns * rows]);
    for band in dem.bands(0) {
        let Band { rows, samples } = band?;
        // Bands begin where blocks do.
        let of_blocks = rows.start / side..rows.end.div_ceil(side);
        let span = of_blocks.start * columns..of_blocks.end * columns;
        let onto = heights[span.clone()].par_chunks_mut(columns).zip(shares[span].par_chunks_mut(columns));
        onto.zip(of_blocks).for_each(|((heights, shares), block)| {
            let mut of_block = vec![Vec::with_capacity(side * side); columns];
            for r in block * side..((block + 1) * side).min(rows.end) {
                let row = samples.row_from(0, r).enumerate();
                row.for_each(|(c, height)| of_block[c / side].extend(height));
            }
            for ((height, share), samples) in heights.iter_mut().zip(shares).zip(&mut of_block) {
                (*height, *share) = level(samples);
            }
        });
        progress(rows.end as f64 / dem.rows() as f64);
    }
    // What was read of files that changed meanwhile is of neither state.
    dem.check()?;
    Ok(Levels { heights, shares })
}

/// The height of a block of these samples, and the share of them that are as low.
fn level(samples: &mut [f32]) -> (f32, f32) {
    samples.sort_unstable_by(f32::total_cmp);
    let runs = || samples.chunk_by(|a, b| a == b);
    let (lowest, most) = (runs().next(), runs().max_by_key(|run| run.len()));
    let run = most.filter(|run| 2 * run.len() >= samples.len()).or(lowest);
    let Some(height) = run.and_then(|run| run.first()) else { return (f32::NAN, 0.0) };
    let low = samples.partition_point(|sample| sample <= height);
    (*height, low as f32 / samples.len() as f32)
}
