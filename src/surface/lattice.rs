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
//! A chunk is 16 x 16 lattice quads at its level, in 2 x 2 blocks of 8 x 8 quads. Facet `local` of a chunk is
//! `block * 128 + quad in block * 2 + facet of quad`, blocks row by row, quads of a block column by column: a block's
//! facing bits are four words in a row, and a column of 8 quads is what one invocation works off, vertex by vertex. A
//! facet's ID in a frame is `slot * 512 + local`.

use std::ops::Range;

use rayon::prelude::*;

use super::quadtree::{Quadtree, Splits};
use crate::dem::{Dem, LARGEST_SIDE, Validity};
use crate::error::{Error, Result, Setting};
use crate::message;

/// Lattice steps along a cell's edge: the finest level.
pub const CELL_STEPS: u32 = 64;
/// Lattice quads along a chunk's edge, whatever its level.
pub const CHUNK_QUADS: u32 = 16;
/// Blocks of 8 x 8 quads along a chunk's edge.
pub const CHUNK_BLOCKS: u32 = CHUNK_QUADS / 8;
/// Facets of a chunk.
pub const CHUNK_FACETS: u32 = 2 * CHUNK_QUADS * CHUNK_QUADS;
/// Lattice vertices along a chunk's edge.
pub const CHUNK_SIDE: u32 = CHUNK_QUADS + 1;
/// Lattice vertices of a chunk, its border shared with its neighbours.
pub const CHUNK_VERTICES: u32 = CHUNK_SIDE * CHUNK_SIDE;
/// Words of facing bits of a chunk.
pub const CHUNK_WORDS: u32 = CHUNK_FACETS / 32;
/// Chunks that have IDs: a pixel holds ID + 1 in 32 bits, so the last ID cannot be used.
pub const MOST_CHUNKS: u64 = (1 << 32) / CHUNK_FACETS as u64 - 1;

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
    /// Sixteen subdivisions of a cell's edge.
    pub const SIXTEEN: Self = Self(16);
    /// Thirty-two subdivisions of a cell's edge.
    pub const THIRTY_TWO: Self = Self(32);
    /// As many as there are.
    pub const FINEST: Self = Self(CELL_STEPS);

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

/// 16 x 16 lattice quads at one level. Laid out as the shaders read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Chunk {
    /// Lattice place of its north-west vertex, (X, Y).
    pub origin: [u32; 2],
    /// Lattice units between its vertices.
    pub step: u32,
    /// Sides beyond which a chunk of twice the step lies: [`NORTH`] | [`EAST`] | [`SOUTH`] | [`WEST`].
    pub coarser: u32,
}

/// A side of a chunk; see [`Chunk::coarser`].
pub const NORTH: u32 = 1;
/// A side of a chunk.
pub const EAST: u32 = 2;
/// A side of a chunk.
pub const SOUTH: u32 = 4;
/// A side of a chunk.
pub const WEST: u32 = 8;

impl Chunk {
    /// Lattice units along its edge.
    pub fn size(&self) -> u32 {
        CHUNK_QUADS * self.step
    }

    /// The vertex of the lattice at column and row `at` of the chunk. Beside a coarser chunk every other one is the one
    /// before it, so that both chunks have the same vertices on the side they share.
    pub fn vertex(&self, [column, row]: [u32; 2]) -> LatticePoint {
        let shared =
            |first, last, at| self.coarser & first != 0 && at == 0 || self.coarser & last != 0 && at == CHUNK_QUADS;
        let x = if shared(NORTH, SOUTH, row) { column & !1 } else { column };
        let y = if shared(WEST, EAST, column) { row & !1 } else { row };
        LatticePoint { x: self.origin[0] + x * self.step, y: self.origin[1] + y * self.step }
    }

    /// The three vertices of its facet `local`, counter-clockwise seen from above; two are the same where it has collapsed
    /// beside a coarser chunk.
    pub fn facet(&self, local: u32) -> [LatticePoint; 3] {
        let (block, quad) = (local / 128, local % 128 / 2);
        let column = block % CHUNK_BLOCKS * 8 + quad / 8;
        let row = block / CHUNK_BLOCKS * 8 + quad % 8;
        let at = |dx: u32, dy: u32| self.vertex([column + dx, row + dy]);
        if local.is_multiple_of(2) { [at(0, 0), at(0, 1), at(1, 1)] } else { [at(0, 0), at(1, 1), at(1, 0)] }
    }

    /// Its facets by their vertices, those that have not collapsed.
    pub(super) fn facets(&self) -> impl Iterator<Item = [LatticePoint; 3]> {
        (0..CHUNK_FACETS).map(|local| self.facet(local)).filter(|[a, b, c]| a != b && b != c && c != a)
    }
}

/// The chunks of a frame, each in its slot, and a quadtree that finds them by their place.
#[derive(Debug, Clone)]
pub struct Lattice {
    chunks: Vec<Chunk>,
    /// How many of them, the first ones, may appear.
    seen: u32,
    tree: Quadtree,
}

/// What a frame needs a chunk for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// It may appear on the page.
    Seen,
    /// It is hidden or beside the page, but walks may cross it.
    Crossed,
}

impl Lattice {
    /// The chunks of `dem` at one level, row by row from the north-west; chunks of voids alone are left out.
    ///
    /// # Errors
    /// [`Error::Limit`] when facets outnumber 32-bit IDs or a side has more than [`LARGEST_SIDE`] samples.
    pub fn uniform(dem: &Dem, level: Level) -> Result<Self> {
        check_sides(dem)?;
        let quads = |samples: usize| (samples as u64 - 1) * u64::from(level.subdivisions());
        let across = |samples: usize| quads(samples).div_ceil(u64::from(CHUNK_QUADS));
        let (columns, rows) = (across(dem.columns()), across(dem.rows()));
        if columns * rows > MOST_CHUNKS {
            let what = format!(
                "level {} gives {} facets in {} chunks, at most {MOST_CHUNKS} chunks of {CHUNK_FACETS} have IDs",
                level.subdivisions(),
                2 * quads(dem.columns()) * quads(dem.rows()),
                columns * rows,
            );
            let auto = Setting::Level.at("auto");
            let remedy = message!["use ", auto, ", a lower ", Setting::Level, " or a ", Setting::Crop];
            return Err(Error::limit(what, remedy));
        }
        let mut tree = Quadtree::new([columns as u32, rows as u32], CHUNK_QUADS * level.step());
        let chunk = |origin| Chunk { origin, step: level.step(), coarser: 0 };
        let validity = dem.validity()?;
        let chunks = tree.number(|origin, _| (!is_void(validity, &chunk(origin))).then_some(Role::Seen));
        let seen = chunks.len() as u32;
        Ok(Self { chunks: chunks.into_iter().map(|(_, (origin, _))| chunk(origin)).collect(), seen, tree })
    }

    /// A quadtree of chunks at levels of their own: from the coarsest on, each is split into four as `growth` says, seen
    /// from lattice place `from`, and further until neighbours, across corners too, differ by one level at most.
    ///
    /// # Errors
    /// As [`Self::uniform`].
    pub fn grow(dem: &Dem, coarsest_step: u32, from: [f64; 2], growth: &mut impl Splits) -> Result<Quadtree> {
        let mut tree = Self::empty(dem, coarsest_step)?.tree;
        tree.grow(from, growth);
        tree.balance(growth);
        Ok(tree)
    }

    /// The chunks of such a tree that have a `role`, by their origin and step: the seen ones first, each in the order of
    /// the quadtree.
    ///
    /// # Errors
    /// As [`Self::uniform`].
    pub fn adaptive(dem: &Dem, mut tree: Quadtree, role: impl Fn([u32; 2], u32) -> Option<Role>) -> Result<Self> {
        let step = |size: u32| size / CHUNK_QUADS;
        let end = [dem.columns(), dem.rows()].map(|samples| (samples as u32 - 1) * CELL_STEPS);
        let kept = tree.number(|origin, size| role(origin, step(size)));
        if kept.len() as u64 > MOST_CHUNKS {
            let what = format!("the page needs {} chunks of facets, at most {MOST_CHUNKS} have IDs", kept.len());
            return Err(Error::limit(what, message!["use a larger ", Setting::ErrorPx, " or a ", Setting::Crop]));
        }
        let seen = kept.iter().filter(|(role, _)| *role == Role::Seen).count() as u32;
        let chunk = |(_, (origin, size))| {
            let coarser = tree.larger_neighbours(origin, size, end);
            Chunk { origin, step: step(size), coarser }
        };
        Ok(Self { chunks: kept.into_iter().map(chunk).collect(), seen, tree })
    }

    /// No chunks yet, of a DEM whose coarsest ones have this step.
    ///
    /// # Errors
    /// As [`Self::uniform`].
    pub fn empty(dem: &Dem, coarsest_step: u32) -> Result<Self> {
        check_sides(dem)?;
        let size = CHUNK_QUADS * coarsest_step;
        let across = |samples: usize| ((samples as u32 - 1) * CELL_STEPS).div_ceil(size);
        Ok(Self { chunks: Vec::new(), seen: 0, tree: Quadtree::new([across(dem.columns()), across(dem.rows())], size) })
    }

    /// The chunks by slot.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }

    /// How many chunks may appear: those in the first slots.
    pub fn seen(&self) -> u32 {
        self.seen
    }

    /// Where chunks lie; its leaves are their slots.
    pub fn tree(&self) -> &Quadtree {
        &self.tree
    }

    /// Whether chunks of different levels meet.
    pub fn has_seams(&self) -> bool {
        self.chunks.iter().any(|chunk| chunk.coarser != 0)
    }

    /// How many facets exist, of the patches of `dem` and not collapsed. Cost: a look at each of chunks that may lack
    /// some for voids or the DEM's edge.
    pub fn facets(&self, dem: &Dem) -> u64 {
        let last = [dem.columns(), dem.rows()].map(|samples| (samples as u32 - 1) * CELL_STEPS);
        let voids = dem.known_validity().filter(|_| dem.voids() > 0);
        let complete = |chunk: &Chunk| {
            let inside = (0..2).all(|axis| chunk.origin[axis] + chunk.size() <= last[axis]);
            inside && voids.is_none_or(|validity| is_whole(validity, chunk))
        };
        let exists = |facet: &[LatticePoint; 3]| {
            let inside = facet.iter().all(|v| v.x <= last[0] && v.y <= last[1]);
            inside && voids.is_none_or(|validity| lies_on_patch(validity, *facet))
        };
        let count = |chunk: &Chunk| chunk.facets().filter(exists).count() as u64;
        // Of complete ones their sides decide: they are counted once for all with the same.
        let mut complete_ones = [0_u64; 16];
        let mut others = Vec::new();
        for chunk in &self.chunks {
            if complete(chunk) { complete_ones[chunk.coarser as usize] += 1 } else { others.push(chunk) }
        }
        let of_sides = |(coarser, chunks): (u32, u64)| match chunks {
            0 => 0,
            _ => chunks * Chunk { origin: [0; 2], step: 1, coarser }.facets().count() as u64,
        };
        (0..).zip(complete_ones).map(of_sides).sum::<u64>() + others.into_par_iter().map(count).sum::<u64>()
    }

    /// The three vertices of a facet, see [`Chunk::facet`].
    pub fn facet(&self, id: u32) -> [LatticePoint; 3] {
        self.chunks[(id / CHUNK_FACETS) as usize].facet(id % CHUNK_FACETS)
    }
}

fn check_sides(dem: &Dem) -> Result<()> {
    if dem.columns().max(dem.rows()) <= LARGEST_SIDE {
        return Ok(());
    }
    let [columns, rows] = [dem.columns(), dem.rows()];
    let what = format!("{columns} x {rows} samples are longer than the {LARGEST_SIDE} a side holds");
    Err(Error::limit(what, message!["use a ", Setting::Crop]))
}

/// Whether no patch under `chunk` has all its corners.
fn is_void(validity: &Validity, chunk: &Chunk) -> bool {
    let [columns, rows] = cells(chunk, validity.samples().map(|samples| samples - 1));
    let exists = |c, r| validity.has_patch(c, r, 0) || validity.has_patch(c, r, 1);
    !is_whole(validity, chunk) && !rows.into_iter().any(|r| columns.clone().any(|c| exists(c, r)))
}

/// Whether all samples under `chunk` are in the DEM and hold an elevation.
fn is_whole(validity: &Validity, chunk: &Chunk) -> bool {
    let [columns, rows] = cells(chunk, validity.samples());
    validity.is_whole(columns.start..columns.end + 1, rows.start..rows.end + 1)
}

/// Columns and rows of the cells under `chunk`, cut to as many as there are.
fn cells(chunk: &Chunk, there_are: [usize; 2]) -> [Range<usize>; 2] {
    [0, 1].map(|axis| {
        let end = (chunk.origin[axis] + chunk.size()).div_ceil(CELL_STEPS) as usize;
        (chunk.origin[axis] / CELL_STEPS) as usize..end.min(there_are[axis])
    })
}

/// Whether patch 0 (NW, SW, SE) or 1 (NW, SE, NE) of cell (c, r) has all its corners.
pub fn patch_exists(dem: &Dem, c: usize, r: usize, patch: usize) -> bool {
    let third = if patch == 0 { dem.height(c, r + 1) } else { dem.height(c + 1, r) };
    dem.height(c, r).and(dem.height(c + 1, r + 1)).and(third).is_some()
}

/// Whether the patch in which the middle of a facet lies exists.
fn lies_on_patch(validity: &Validity, vertices: [LatticePoint; 3]) -> bool {
    let sum = |of: fn(LatticePoint) -> u32| vertices.map(of).iter().map(|at| *at as usize).sum::<usize>();
    let (x, y) = (sum(|v| v.x), sum(|v| v.y));
    let cell = 3 * CELL_STEPS as usize;
    validity.has_patch(x / cell, y / cell, usize::from(x % cell > y % cell))
}
