//! Tiles: the samples below a chunk, 17 x 17, as the device holds them.
//!
//! A chunk of level 1 or coarser than the grid has a tile of its own vertices, heights alone. Finer chunks share the tile of
//! the chunk of level 1 that they lie in, for their patches need its samples with their gradients.

use std::borrow::Cow;

use rayon::prelude::*;

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

/// The samples of several tiles of one kind, tile by tile and row by row; where the DEM has none, and at voids, all are 0.
#[derive(Debug, Clone, PartialEq)]
pub struct TileSamples {
    /// Exaggerated metres.
    pub heights: Vec<f32>,
    /// dz/d east and dz/d north; empty where facets are planes between samples.
    pub gradients: [Vec<f32>; 2],
}

impl TileSamples {
    /// Reads the samples of tiles that all have gradients or all have none, on every core where the DEM allows it.
    ///
    /// # Errors
    /// As [`Surface::part`] and [`Dem::spaced`](crate::dem::Dem::spaced).
    pub fn read(surface: &Surface, tiles: &[Tile]) -> Result<Self> {
        let zeros = |tiles: usize| vec![0.0; tiles * TILE_SAMPLES as usize];
        debug_assert!(tiles.iter().all(|tile| tile.has_gradients() == tiles[0].has_gradients()), "tiles of one kind");
        let patched = if tiles.first().is_some_and(Tile::has_gradients) { tiles.len() } else { 0 };
        let mut heights = zeros(tiles.len());
        let mut gradients = [zeros(patched), zeros(patched)];
        let [east, north] = &mut gradients;
        let mut places = [&mut heights, east, north].map(|samples| samples.chunks_exact_mut(TILE_SAMPLES as usize));
        let places = tiles.iter().map(|tile| (tile, places.each_mut().map(|places| places.next().unwrap_or_default())));
        let places: Vec<_> = places.collect();
        let read = |(tile, into): (&Tile, _)| tile.read(surface, into);
        match surface.dem().is_parallel() {
            true => places.into_par_iter().try_for_each(read)?,
            false => places.into_iter().try_for_each(read)?,
        }
        Ok(Self { heights, gradients })
    }
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

    /// Reads its samples into zeros: heights, and gradients where it has them.
    fn read(&self, surface: &Surface, [heights, east, north]: [&mut [f32]; 3]) -> Result<()> {
        let (first, spacing) = (self.first.map(|at| at as usize), self.spacing as usize);
        if !self.has_gradients {
            let samples = surface.dem().spaced(first, spacing, [TILE_SIDE as usize; 2])?;
            for (height, sample) in heights.iter_mut().zip(samples) {
                *height = if sample.is_nan() { 0.0 } else { sample };
            }
            return Ok(());
        }
        let part = if surface.dem().is_filed() {
            Cow::Owned(surface.part(first, [TILE_SIDE as usize; 2])?)
        } else {
            Cow::Borrowed(surface)
        };
        let dem = part.dem();
        let places = (0..TILE_SAMPLES as usize).map(|i| [i % TILE_SIDE as usize, i / TILE_SIDE as usize]);
        for (i, [c, r]) in places.map(|at| [first[0] + at[0], first[1] + at[1]]).enumerate() {
            if c < dem.columns() && r < dem.rows() {
                heights[i] = dem.height(c, r).unwrap_or(0.0);
                let gradient = part.gradient(c, r);
                (east[i], north[i]) = (gradient.x as f32, gradient.y as f32);
            }
        }
        Ok(())
    }
}
