//! Every 2nd, 4th, 8th ... 64th sample of a DEM that stays in its file, kept in a file of their own: what facets coarser
//! than the grid need, without a look at the samples between them.
//!
//! Overviews in GDAL's sense, but exact subsets: nothing is averaged. The file holds blocks of 256 x 256 samples of one
//! spacing, metres without exaggeration, NaN at voids; an index says where each lies, with a hash of its bytes, and a
//! block is checked when it is read. Size: 4/3 bytes a sample of the DEM. Memory: the index; while they are made, the
//! rows of a row of blocks.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::tiling::Tiling;
use super::window::Window;
use super::{Dem, Samples, Store};
use crate::error::{Error, Result};

/// Samples from one that is kept to the next: those of every level coarser than the grid.
const SPACINGS: [usize; 6] = [2, 4, 8, 16, 32, 64];
/// Columns and rows of a block: 256 KiB.
const SIDE: usize = 256;

/// Blocks in their file.
#[derive(Debug)]
pub(crate) struct Overviews {
    path: PathBuf,
    file: Mutex<File>,
    grid: Blocks,
    index: Vec<OverviewEntry>,
    damaged: AtomicBool,
}

/// Where a block lies in the file, and the hash of its bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct OverviewEntry {
    offset: u64,
    hash: u64,
}

/// Makes the blocks of a DEM from its bands.
pub(crate) struct OverviewBuilder {
    grid: Blocks,
    /// Of each spacing the rows that fill no row of blocks yet.
    rows: [Vec<f32>; SPACINGS.len()],
    /// Of each spacing how many blocks are made.
    made: [usize; SPACINGS.len()],
    index: Vec<OverviewEntry>,
    end: u64,
}

/// How the samples of a DEM lie in blocks.
#[derive(Debug, Clone, Copy)]
struct Blocks {
    /// Columns and rows of the DEM.
    samples: [usize; 2],
}

impl Blocks {
    /// Columns and rows of the samples of the `k`-th spacing.
    fn size(self, k: usize) -> [usize; 2] {
        self.samples.map(|n| n.div_ceil(SPACINGS[k]))
    }

    /// How many blocks the spacings before the `k`-th have.
    fn before(self, k: usize) -> usize {
        (0..k).map(|k| self.size(k).map(|n| n.div_ceil(SIDE)).iter().product::<usize>()).sum()
    }
}

impl Overviews {
    /// Of a DEM, from blocks in the file at `path`; `None` where there are not as many as it has.
    pub(crate) fn new(dem: &Dem, path: &Path, file: File, index: Vec<OverviewEntry>) -> Option<Self> {
        let (grid, damaged) = (Blocks { samples: [dem.columns(), dem.rows()] }, AtomicBool::new(false));
        let whole = index.len() == grid.before(SPACINGS.len());
        whole.then(|| Self { path: path.to_owned(), file: Mutex::new(file), grid, index, damaged })
    }

    /// How many blocks those of a DEM are.
    pub(crate) fn blocks(dem: &Dem) -> usize {
        Blocks { samples: [dem.columns(), dem.rows()] }.before(SPACINGS.len())
    }

    /// The blocks of a spacing, as tiles of its samples; `None` where it has none, and from the first damaged one on.
    pub(super) fn tiling(&self, spacing: usize) -> Option<Tiling> {
        let k = SPACINGS.iter().position(|known| *known == spacing)?;
        (!self.is_damaged()).then(|| Tiling::whole([SIDE; 2], self.grid.size(k)))
    }

    /// Reads a block, metres without exaggeration.
    pub(super) fn read(&self, spacing: usize, block: Window) -> Result<Vec<f32>> {
        self.try_read(spacing, block).map_err(|error| {
            self.damaged.store(true, Ordering::Relaxed);
            Error::input(&self.path, format!("is damaged ({error})"), "remove it, it is made anew")
        })
    }

    fn try_read(&self, spacing: usize, block: Window) -> io::Result<Vec<f32>> {
        let k = SPACINGS.iter().position(|known| *known == spacing).ok_or(io::ErrorKind::NotFound)?;
        let [x, y] = block.first.map(|at| at / SIDE);
        let place = self.grid.before(k) + y * self.grid.size(k)[0].div_ceil(SIDE) + x;
        let OverviewEntry { offset, hash } = *self.index.get(place).ok_or(io::ErrorKind::NotFound)?;
        let mut samples = vec![0.0_f32; block.samples() as usize];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut samples);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        file.read_exact(bytes)?;
        drop(file);
        if xxh3_64(bytes) == hash { Ok(samples) } else { Err(io::ErrorKind::InvalidData.into()) }
    }

    fn is_damaged(&self) -> bool {
        self.damaged.load(Ordering::Relaxed)
    }
}

impl OverviewBuilder {
    /// Of a DEM, nothing made yet. Its blocks will be the first in their file.
    pub(crate) fn new(dem: &Dem) -> Self {
        let grid = Blocks { samples: [dem.columns(), dem.rows()] };
        let index = vec![OverviewEntry::zeroed(); grid.before(SPACINGS.len())];
        Self { grid, rows: Default::default(), made: [0; SPACINGS.len()], index, end: 0 }
    }

    /// Takes the next rows, which `samples` holds, and gives `write` the bytes of each block that is whole, in the order of
    /// the file.
    pub(crate) fn take(&mut self, samples: &Samples, rows: Range<usize>, write: &mut impl FnMut(&[u8])) {
        for (k, spacing) in SPACINGS.into_iter().enumerate() {
            let taken = rows.clone().into_par_iter().filter(|r| r.is_multiple_of(spacing));
            let thinned = |r| samples.row_from(0, r).step_by(spacing).map(|height| height.unwrap_or(f32::NAN));
            self.rows[k].par_extend(taken.flat_map_iter(thinned));
            let row_of_blocks = self.grid.size(k)[0] * SIDE;
            let all = rows.end == self.grid.samples[1];
            while self.rows[k].len() >= row_of_blocks || all && !self.rows[k].is_empty() {
                let rest = self.rows[k].split_off(row_of_blocks.min(self.rows[k].len()));
                let whole = std::mem::replace(&mut self.rows[k], rest);
                self.make(k, &whole, write);
            }
        }
    }

    /// Where the blocks lie, when all rows have been taken.
    pub(crate) fn into_index(self) -> Vec<OverviewEntry> {
        self.index
    }

    /// The blocks of a row of them.
    fn make(&mut self, k: usize, rows: &[f32], write: &mut impl FnMut(&[u8])) {
        let width = self.grid.size(k)[0];
        for first in (0..width).step_by(SIDE) {
            let end = (first + SIDE).min(width);
            let block: Vec<f32> = rows.chunks_exact(width).flat_map(|row| &row[first..end]).copied().collect();
            let bytes: &[u8] = bytemuck::cast_slice(&block);
            write(bytes);
            self.index[self.grid.before(k) + self.made[k]] = OverviewEntry { offset: self.end, hash: xxh3_64(bytes) };
            self.made[k] += 1;
            self.end += bytes.len() as u64;
        }
    }
}

impl Dem {
    /// Gives a filed DEM the overviews that were made of it, as [`Dem::stamp`] tells, unless it has some.
    pub(crate) fn remember_overviews(&self, overviews: Overviews) {
        if let Store::Filed(filed) = &self.store {
            filed.remember(overviews);
        }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Dem {
    /// Exaggerated metres of every `spacing`-th sample of every `spacing`-th row, `size` of them from sample `first` on,
    /// whose column and row are multiples of the spacing; row-major, NaN at voids and outside.
    ///
    /// # Errors
    /// As [`Dem::window`].
    pub fn spaced(&self, first: [usize; 2], spacing: usize, [width, height]: [usize; 2]) -> Result<Vec<f32>> {
        let whole = [self.columns(), self.rows()];
        let left = [0, 1].map(|i| whole[i].saturating_sub(first[i]).div_ceil(spacing));
        let inside = [width.min(left[0]), height.min(left[1])];
        let thinning = self.thinning();
        let mut spaced = vec![f32::NAN; width * height];
        if inside.contains(&0) {
            return Ok(spaced);
        }
        let mut fill = |at: &dyn Fn(usize, usize) -> f32| {
            for (j, row) in spaced.chunks_exact_mut(width.max(1)).take(inside[1]).enumerate() {
                row[..inside[0]].iter_mut().enumerate().for_each(|(i, height)| *height = at(i, j));
            }
        };
        let of = |samples: &Samples, i: usize, j: usize| {
            samples.height(first[0] + i * spacing, first[1] + j * spacing).unwrap_or(f32::NAN)
        };
        match &self.store {
            Store::Held(samples) => fill(&|i, j| of(samples, i, j)),
            Store::Filed(filed) => {
                let window = Window { first: first.map(|at| at / spacing), size: inside };
                if let Some(kept) = filed.overview(spacing, window) {
                    fill(&|i, j| kept[j * inside[0] + i]);
                } else if thinning > 1 && spacing.is_multiple_of(thinning) {
                    let (thinned, times) = (&self.survey(&|_| ())?.thinned, spacing / thinning);
                    let ([c, r], columns) = (first.map(|at| at / thinning), whole[0].div_ceil(thinning));
                    fill(&|i, j| thinned[(r + j * times) * columns + c + i * times]);
                } else {
                    let samples = self.window(first, inside.map(|n| (n - 1) * spacing + 1))?;
                    fill(&|i, j| of(&samples, i, j));
                }
            }
        }
        Ok(spaced)
    }

    /// Whether a block of its overviews was found damaged; samples come from the DEM's own files since.
    pub fn has_damaged_overviews(&self) -> bool {
        matches!(&self.store, Store::Filed(filed) if filed.overviews().is_some_and(Overviews::is_damaged))
    }
}
