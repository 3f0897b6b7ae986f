//! Heights of a DEM that stays in its file, block by block: the lowest of each for water, the highest for crests.
//!
//! Every k-th sample, which coarse facets need, would jump over narrow valleys; lowest and highest samples of blocks keep them. A
//! block depends on its own samples alone. Memory: 8 bytes a block, and a band of the DEM. Cost: a look at every sample. Not
//! handled: lines closer to each other than a few blocks.

use glam::DVec2;
use rayon::prelude::*;

use super::SurfaceLine;
use super::frame::FramedGrid;
use super::grid::Grid;
use crate::dem::{Band, Dem};
use crate::error::Result;

/// Most blocks.
const MOST: usize = 1 << 23;

/// Samples along the side of a block on which lines of a DEM are found: 1 of a held one.
pub(crate) fn spacing(dem: &Dem) -> usize {
    let blocks = |side: usize| dem.columns().div_ceil(side) * dem.rows().div_ceil(side);
    let mut side = 1;
    while dem.is_filed() && blocks(side) > MOST {
        side *= 2;
    }
    side
}

/// The lowest and the highest samples of the blocks of `side` x `side` samples of a DEM whose heights are exaggerated by a factor;
/// `side` is a power of two up to 64. Tells `progress` the share done.
///
/// # Errors
/// As [`Dem::window`] and [`Dem::check`].
pub fn lowest_and_highest(dem: &Dem, exaggeration: f64, side: usize, progress: &dyn Fn(f64)) -> Result<[Grid; 2]> {
    let size = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(side));
    let frame = FramedGrid { size, cell: dem.cell() * side as f64 };
    let mut blocks = [f32::min, f32::max].map(|of| (of, vec![f32::NAN; frame.samples()]));
    for band in dem.bands(0) {
        let Band { rows, samples } = band?;
        for (of, heights) in &mut blocks {
            // Bands begin where blocks do.
            let rows_of_blocks = rows.start / side..rows.end.div_ceil(side);
            let first = frame.row(rows_of_blocks.start).start - 1;
            let end = frame.row(rows_of_blocks.end - 1).end + 1;
            let onto = heights[first..end].par_chunks_mut(frame.stride()).zip(rows_of_blocks);
            onto.for_each(|(onto, block)| {
                for r in block * side..((block + 1) * side).min(rows.end) {
                    for (c, height) in samples.row_from(0, r).enumerate() {
                        let height = height.map_or(f32::NAN, |height| (f64::from(height) / exaggeration) as f32);
                        // NaN gives way.
                        onto[c / side + 1] = of(onto[c / side + 1], height);
                    }
                }
            });
        }
        progress(rows.end as f64 / dem.rows() as f64);
    }
    // What was read of files that changed meanwhile is of neither state.
    dem.check()?;
    Ok(blocks.map(|(_, heights)| Grid::new(frame, heights)))
}

/// Moves lines that were found on blocks of `side` x `side` samples of a DEM to its samples.
pub fn on_samples(lines: &mut [SurfaceLine], dem: &Dem, side: usize) {
    let (side, last) = (side as f64, DVec2::new(dem.columns() as f64, dem.rows() as f64) - 1.0);
    let points = lines.iter_mut().flat_map(|line| &mut line.points);
    points.for_each(|point| point.at = ((point.at + 0.5) * side - 0.5).clamp(DVec2::ZERO, last));
}
