//! Tiles: the samples below a chunk, 17 x 17, as the device holds them.
//!
//! A chunk of level 1 or coarser than the grid has a tile of its own vertices, heights alone. Finer chunks share the tile of
//! the chunk of level 1 that they lie in, for their patches need its samples with their gradients.

use std::borrow::Cow;

use super::Surface;
use super::lattice::{CELL_STEPS, CHUNK_QUADS, CHUNK_SIDE, Chunk};
use crate::error::Result;

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
    /// Whether patches are made of it.
    has_gradients: bool,
}

/// The samples of a tile, row by row; where the DEM has none, and at voids, all are 0.
#[derive(Debug, Clone, PartialEq)]
pub struct TileSamples {
    /// Exaggerated metres.
    pub heights: Vec<f32>,
    /// dz/d east and dz/d north; empty where facets are planes between samples.
    pub gradients: [Vec<f32>; 2],
}

impl Tile {
    /// The tile of a chunk.
    pub fn of(chunk: &Chunk) -> Self {
        let spacing = chunk.step.div_ceil(CELL_STEPS);
        let size = CHUNK_QUADS * spacing;
        let first = chunk.origin.map(|at| at / CELL_STEPS / size * size);
        Self { first, spacing, has_gradients: chunk.step < CELL_STEPS }
    }

    /// Whether the gradients of its samples are needed too: by patches, which chunks finer than the grid have.
    pub fn has_gradients(&self) -> bool {
        self.has_gradients
    }

    /// Reads its samples.
    ///
    /// # Errors
    /// As [`Surface::part`] and [`Dem::spaced`](crate::dem::Dem::spaced).
    pub fn read(&self, surface: &Surface) -> Result<TileSamples> {
        let (first, spacing) = (self.first.map(|at| at as usize), self.spacing as usize);
        if !self.has_gradients {
            let mut heights = surface.dem().spaced(first, spacing, [TILE_SIDE as usize; 2])?;
            heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = 0.0);
            return Ok(TileSamples { heights, gradients: [Vec::new(), Vec::new()] });
        }
        let part = if surface.dem().is_filed() {
            Cow::Owned(surface.part(first, [TILE_SIDE as usize; 2])?)
        } else {
            Cow::Borrowed(surface)
        };
        let dem = part.dem();
        let none = || vec![0.0; TILE_SAMPLES as usize];
        let [mut heights, mut east, mut north] = [none(), none(), none()];
        let places = (0..TILE_SAMPLES as usize).map(|i| [i % TILE_SIDE as usize, i / TILE_SIDE as usize]);
        for (i, [c, r]) in places.map(|at| [first[0] + at[0], first[1] + at[1]]).enumerate() {
            if c < dem.columns() && r < dem.rows() {
                heights[i] = dem.height(c, r).unwrap_or(0.0);
                let gradient = part.gradient(c, r);
                (east[i], north[i]) = (gradient.x as f32, gradient.y as f32);
            }
        }
        Ok(TileSamples { heights, gradients: [east, north] })
    }
}
