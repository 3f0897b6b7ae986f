//! Identity by integers: the lattice all levels share, its chunks, and the IDs of facets.
//!
//! ```text
//!   NW----NE        level 2:   o--o--o      lattice X = column * 64 + sub, east
//!    |\  2 |                   |\ |\ |      lattice Y = row * 64 + sub,    south
//!    | \   |                   o--o--o
//!    |  \  |                   |\ |\ |      facet 0 of a quad: NW, SW, SE
//!    | 1 \ |                   o--o--o      facet 1 of a quad: NW, SE, NE
//!   SW----SE
//! ```
//!
//! A chunk is 32 x 32 lattice quads at its level, in 4 x 4 blocks of 8 x 8 quads. Facet `local` of a chunk is
//! `block * 128 + quad in block * 2 + facet of quad`, blocks row by row, quads of a block column by column: a block's
//! facing bits are four words in a row, and a column of 8 quads is what one invocation works off, vertex by vertex. A
//! facet's ID in a frame is `slot * 2048 + local`.

use crate::dem::{Dem, LARGEST_SIDE};
use crate::error::{Error, Result};

/// Lattice steps along a cell's edge: the finest level.
pub const CELL_STEPS: u32 = 64;
/// Lattice quads along a chunk's edge, whatever its level.
pub const CHUNK_QUADS: u32 = 32;
/// Facets of a chunk.
pub const CHUNK_FACETS: u32 = 2 * CHUNK_QUADS * CHUNK_QUADS;
/// Lattice vertices along a chunk's edge.
pub const CHUNK_SIDE: u32 = CHUNK_QUADS + 1;
/// Lattice vertices of a chunk, its border shared with its neighbours.
pub const CHUNK_VERTICES: u32 = CHUNK_SIDE * CHUNK_SIDE;
/// Words of facing bits of a chunk.
pub const CHUNK_WORDS: u32 = CHUNK_FACETS / 32;
/// No chunk has this slot.
pub const NO_SLOT: u32 = u32::MAX;

/// Subdivisions of a cell's edge: 1, 2, 4 ... 64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Level(u32);

/// Four subdivisions of a cell's edge.
impl Default for Level {
    fn default() -> Self {
        Self(4)
    }
}

impl Level {
    /// Eight subdivisions of a cell's edge.
    pub const EIGHT: Self = Self(8);

    /// The level with `n` subdivisions, `None` unless `n` is 1, 2, 4, 8, 16, 32 or 64.
    pub fn new(n: u32) -> Option<Self> {
        (n.is_power_of_two() && n <= CELL_STEPS).then_some(Self(n))
    }

    /// Subdivisions of a cell's edge.
    pub fn subdivisions(self) -> u32 {
        self.0
    }

    /// Lattice units between neighbouring vertices of this level.
    pub fn step(self) -> u32 {
        CELL_STEPS / self.0
    }
}

/// A vertex of the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LatticePoint {
    /// South of the north-west sample, in 1/64 cell. First, so that order is row by row.
    pub y: u32,
    /// East of the north-west sample, in 1/64 cell.
    pub x: u32,
}

/// 32 x 32 lattice quads at one level. Laid out as the shaders read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Chunk {
    /// Lattice place of its north-west vertex, (X, Y).
    pub origin: [u32; 2],
    /// Lattice units between its vertices.
    pub step: u32,
    /// Fills the struct to 16 bytes.
    pub pad: u32,
}

/// All chunks of a DEM, each in its slot: row by row from the north-west, chunks of voids alone left out.
#[derive(Debug, Clone)]
pub struct Lattice {
    level: Level,
    grid: [u32; 2],
    chunks: Vec<Chunk>,
    slots: Vec<u32>,
}

impl Lattice {
    /// The chunks of `dem` at one level.
    ///
    /// # Errors
    /// [`Error::Limit`] when facets outnumber 32-bit IDs or a side has more than [`LARGEST_SIDE`] samples.
    pub fn uniform(dem: &Dem, level: Level) -> Result<Self> {
        if dem.columns().max(dem.rows()) > LARGEST_SIDE {
            return Err(Error::Limit {
                what: format!(
                    "{} x {} samples are longer than the {LARGEST_SIDE} a side holds",
                    dem.columns(),
                    dem.rows()
                ),
                remedy: "use a --crop".into(),
            });
        }
        let quads = |samples: usize| (samples as u64 - 1) * u64::from(level.subdivisions());
        let across = |samples: usize| quads(samples).div_ceil(u64::from(CHUNK_QUADS));
        let (columns, rows) = (across(dem.columns()), across(dem.rows()));
        // A pixel holds ID + 1 in 32 bits: the last ID cannot be used.
        if columns * rows * u64::from(CHUNK_FACETS) >= 1 << 32 {
            return Err(Error::Limit {
                what: format!(
                    "level {} gives {} facets in {} chunks, fewer than {} chunks of {CHUNK_FACETS} have IDs",
                    level.subdivisions(),
                    2 * quads(dem.columns()) * quads(dem.rows()),
                    columns * rows,
                    (1_u64 << 32) / u64::from(CHUNK_FACETS)
                ),
                remedy: "use a lower --level or a --crop".into(),
            });
        }
        let mut lattice = Self { level, grid: [columns as u32, rows as u32], chunks: Vec::new(), slots: Vec::new() };
        let size = CHUNK_QUADS * level.step();
        for y in 0..lattice.grid[1] {
            for x in 0..lattice.grid[0] {
                let chunk = Chunk { origin: [x * size, y * size], step: level.step(), pad: 0 };
                let kept = !is_void(dem, &chunk);
                lattice.slots.push(if kept { lattice.chunks.len() as u32 } else { NO_SLOT });
                lattice.chunks.extend(kept.then_some(chunk));
            }
        }
        Ok(lattice)
    }

    /// The level of every chunk.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Chunks across and down.
    pub fn grid(&self) -> [u32; 2] {
        self.grid
    }

    /// The chunks by slot.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }

    /// Slot of each place of `grid`, row by row; [`NO_SLOT`] where there is no chunk.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// The three vertices of a facet, counter-clockwise seen from above.
    pub fn facet(&self, id: u32) -> [LatticePoint; 3] {
        let chunk = self.chunks[(id / CHUNK_FACETS) as usize];
        let (block, quad) = (id % CHUNK_FACETS / 128, id % 128 / 2);
        let column = block % 4 * 8 + quad / 8;
        let row = block / 4 * 8 + quad % 8;
        let at = |dx: u32, dy: u32| LatticePoint {
            x: chunk.origin[0] + (column + dx) * chunk.step,
            y: chunk.origin[1] + (row + dy) * chunk.step,
        };
        if id.is_multiple_of(2) { [at(0, 0), at(0, 1), at(1, 1)] } else { [at(0, 0), at(1, 1), at(1, 0)] }
    }
}

/// Whether no patch under `chunk` has all its corners.
fn is_void(dem: &Dem, chunk: &Chunk) -> bool {
    let cells = |axis: usize, samples: usize| {
        let first = chunk.origin[axis] / CELL_STEPS;
        let end = (chunk.origin[axis] + CHUNK_QUADS * chunk.step).div_ceil(CELL_STEPS);
        first as usize..(end as usize).min(samples - 1)
    };
    !cells(1, dem.rows())
        .any(|r| cells(0, dem.columns()).any(|c| patch_exists(dem, c, r, 0) || patch_exists(dem, c, r, 1)))
}

/// Whether patch 0 (NW, SW, SE) or 1 (NW, SE, NE) of cell (c, r) has all its corners.
pub fn patch_exists(dem: &Dem, c: usize, r: usize, patch: usize) -> bool {
    let third = if patch == 0 { dem.height(c, r + 1) } else { dem.height(c + 1, r) };
    dem.height(c, r).and(dem.height(c + 1, r + 1)).and(third).is_some()
}

/// Which of its two patches each cell of row `r` has, from the west; see [`patch_exists`].
pub fn patches_of_row(dem: &Dem, r: usize) -> impl Iterator<Item = [bool; 2]> {
    (0..dem.columns() - 1).map(move |c| [0, 1].map(|half| patch_exists(dem, c, r, half)))
}
