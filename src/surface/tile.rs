//! Tiles: the samples below a chunk, 33 x 33, as the device holds them.
//!
//! A chunk coarser than the grid has a tile of its own vertices. Finer chunks share the tile of the chunk of level 1 that
//! they lie in, for their patches need its samples with their gradients.

use super::Surface;
use super::lattice::{CELL_STEPS, CHUNK_QUADS, CHUNK_SIDE, Chunk};

/// Samples along a tile's edge.
pub const TILE_SIDE: u32 = CHUNK_SIDE;
/// Samples of a tile.
pub const TILE_SAMPLES: u32 = TILE_SIDE * TILE_SIDE;

/// Which samples a tile holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Tile {
    /// Column and row of its north-west sample.
    first: [u32; 2],
    /// Columns between its samples.
    spacing: u32,
}

/// The samples of a tile, row by row; where the DEM has none, and at voids, all are 0.
#[derive(Debug, Clone, PartialEq)]
pub struct TileSamples {
    /// Exaggerated metres.
    pub heights: Vec<f32>,
    /// dz/d east and dz/d north.
    pub gradients: [Vec<f32>; 2],
}

impl Tile {
    /// The tile of a chunk.
    pub fn of(chunk: &Chunk) -> Self {
        let spacing = chunk.step.div_ceil(CELL_STEPS);
        let size = CHUNK_QUADS * spacing;
        Self { first: chunk.origin.map(|at| at / CELL_STEPS / size * size), spacing }
    }

    /// Reads its samples.
    pub fn read(&self, surface: &Surface) -> TileSamples {
        let dem = surface.dem();
        let [mut heights, mut east, mut north] = [(); 3].map(|()| vec![0.0; TILE_SAMPLES as usize]);
        let [c, r] = self.first.map(|at| at as usize);
        let spacing = self.spacing as usize;
        let rows = (r..dem.rows()).step_by(spacing).take(TILE_SIDE as usize);
        for (row, at) in rows.zip((0..).step_by(TILE_SIDE as usize)) {
            let first = row * dem.columns() + c.min(dem.columns());
            let end = (row + 1) * dem.columns();
            let sources = [dem.heights(), surface.gradients()[0], surface.gradients()[1]];
            for (samples, source) in [&mut heights, &mut east, &mut north].into_iter().zip(sources) {
                let row = samples[at..].iter_mut().take(TILE_SIDE as usize);
                row.zip(source[first..end].iter().step_by(spacing)).for_each(|(to, from)| *to = *from);
            }
        }
        TileSamples { heights, gradients: [east, north] }
    }
}
