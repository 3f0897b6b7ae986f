//! Which samples hold an elevation, block by block: small where voids are few, wherever the samples themselves are.
//!
//! Method: blocks of 64 x 64 samples. One word a block says that all its samples are valid, that none is, or where its bits
//! lie; only mixed blocks have bits. Made in one look at the samples, from bands; a row of 64 samples is one number, so that
//! rims are found some dozens of samples at a time. Memory: a byte a thousand samples, and a bit for each of mixed blocks.
//! It does not squeeze mixed blocks: single voids all over a DEM take a bit for every sample.

use std::ops::Range;

use super::{Dem, Samples};
use crate::error::Result;

/// Samples along a block's edge: as many as a number has bits.
pub const BLOCK_SIDE: usize = u64::BITS as usize;
/// The word of a block without any elevation.
const NONE: u32 = 0;
/// The word of a block without voids.
const ALL: u32 = u32::MAX;
/// Words of the bits of a block, two for each of its rows.
const BLOCK_WORDS: usize = 2 * BLOCK_SIDE;

/// Of each sample of a DEM, whether it holds an elevation.
#[derive(Debug, Clone, PartialEq)]
pub struct Validity {
    blocks: Blocks,
    words: Vec<u32>,
}

/// Validity in the making.
pub(super) struct ValidityBuilder {
    blocks: Blocks,
    /// Of the rows that fill no row of blocks yet, block by block.
    rows: Vec<u64>,
    made: usize,
    words: Vec<u32>,
}

/// How the samples of a DEM lie in blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Blocks {
    /// Columns and rows of the DEM.
    samples: [usize; 2],
}

impl Blocks {
    fn across(self) -> usize {
        self.samples[0].div_ceil(BLOCK_SIDE)
    }

    fn count(self) -> usize {
        self.across() * self.samples[1].div_ceil(BLOCK_SIDE)
    }

    /// A set bit for each sample that a row has in a column of blocks.
    fn inside(self, x: usize) -> u64 {
        let left = self.samples[0].saturating_sub(x * BLOCK_SIDE);
        if left < BLOCK_SIDE { (1 << left) - 1 } else { u64::MAX }
    }
}

impl Validity {
    /// Of a DEM, from the words that were kept of it; `None` where they are none of such a DEM.
    pub fn from_words(dem: &Dem, words: Vec<u32>) -> Option<Self> {
        let blocks = Blocks { samples: [dem.columns(), dem.rows()] };
        let (index, bits) = words.split_at_checked(blocks.count())?;
        let mut places = (index.len()..).step_by(BLOCK_WORDS);
        let mixed = index.iter().filter(|word| **word != NONE && **word != ALL);
        let in_order = mixed.clone().all(|word| places.next() == Some(*word as usize));
        (in_order && bits.len() == mixed.count() * BLOCK_WORDS).then_some(Self { blocks, words })
    }

    /// As shaders read it: a word a block, row by row (0: none of its samples is valid, all bits set: all are), else the
    /// place of its bits, which follow: two words for each row of a mixed block, lowest bit first.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// Columns and rows of the DEM.
    pub fn samples(&self) -> [usize; 2] {
        self.blocks.samples
    }

    /// Whether sample (c, r) holds an elevation; not outside.
    pub fn is_valid(&self, c: usize, r: usize) -> bool {
        self.row(c / BLOCK_SIDE, r) >> (c % BLOCK_SIDE) & 1 == 1
    }

    /// Whether patch 0 (NW, SW, SE) or 1 (NW, SE, NE) of cell (c, r) has all its corners.
    pub fn has_patch(&self, c: usize, r: usize, half: usize) -> bool {
        let third = if half == 0 { [c, r + 1] } else { [c + 1, r] };
        self.is_valid(c, r) && self.is_valid(c + 1, r + 1) && self.is_valid(third[0], third[1])
    }

    /// Whether all samples of a rectangle are in the DEM and hold an elevation.
    pub fn is_whole(&self, columns: Range<usize>, rows: Range<usize>) -> bool {
        let inside = columns.end <= self.blocks.samples[0] && rows.end <= self.blocks.samples[1];
        let mut across = columns.start / BLOCK_SIDE..columns.end.div_ceil(BLOCK_SIDE);
        let of_columns = |x: usize| {
            let wanted = bits_between(columns.start, columns.end, x);
            // A block without voids stands for the rest of its rows.
            let mut left = rows.clone();
            while let Some(r) = left.next() {
                if self.row(x, r) & wanted != wanted {
                    return false;
                }
                if self.word(x, r) == ALL {
                    left.start = ((r / BLOCK_SIDE + 1) * BLOCK_SIDE).min(left.end);
                }
            }
            true
        };
        inside && across.all(of_columns)
    }

    /// Of the 64 samples of row `r` in the `x`-th column of blocks those that are valid, the westernmost in the lowest bit;
    /// none outside.
    pub fn row(&self, x: usize, r: usize) -> u64 {
        match self.word(x, r) {
            NONE => 0,
            ALL => self.blocks.inside(x),
            place => {
                let at = place as usize + 2 * (r % BLOCK_SIDE);
                u64::from(self.words[at]) | u64::from(self.words[at + 1]) << 32
            }
        }
    }

    /// Whether all samples in and around a block are valid, the DEM's border being none of theirs.
    pub fn is_inside(&self, x: usize, y: usize) -> bool {
        let around = |at: usize, samples: usize| {
            let all = at > 0 && (at + 1) * BLOCK_SIDE < samples;
            all.then(|| [at - 1, at, at + 1])
        };
        let [columns, rows] = self.blocks.samples;
        let (Some(columns), Some(rows)) = (around(x, columns), around(y, rows)) else { return false };
        rows.into_iter().all(|y| columns.into_iter().all(|x| self.word(x, y * BLOCK_SIDE) == ALL))
    }

    /// The word of the block that has row `r` in the `x`-th column of blocks.
    fn word(&self, x: usize, r: usize) -> u32 {
        let inside = x < self.blocks.across() && r < self.blocks.samples[1];
        if inside { self.words[r / BLOCK_SIDE * self.blocks.across() + x] } else { NONE }
    }
}

/// A set bit for each column from `start` to `end` that lies in the `x`-th column of blocks.
fn bits_between(start: usize, end: usize, x: usize) -> u64 {
    let below = |at: usize| match at.saturating_sub(x * BLOCK_SIDE) {
        bits if bits < BLOCK_SIDE => (1 << bits) - 1,
        _ => u64::MAX,
    };
    below(end) & !below(start)
}

impl ValidityBuilder {
    /// Of a DEM, no row seen yet.
    pub(super) fn new(dem: &Dem) -> Self {
        let blocks = Blocks { samples: [dem.columns(), dem.rows()] };
        Self { blocks, rows: Vec::new(), made: 0, words: vec![NONE; blocks.count()] }
    }

    /// Takes the next rows, which `samples` holds.
    pub(super) fn take(&mut self, samples: &Samples, rows: Range<usize>) {
        for r in rows {
            self.rows.extend((0..self.blocks.across()).map(|x| samples.valid_from(x * BLOCK_SIDE, r)));
            if (r + 1).is_multiple_of(BLOCK_SIDE) || r + 1 == self.blocks.samples[1] {
                self.make();
            }
        }
    }

    /// Validity, when all rows have been taken.
    pub(super) fn finish(self) -> Validity {
        Validity { blocks: self.blocks, words: self.words }
    }

    /// The blocks of a row of them.
    fn make(&mut self) {
        let across = self.blocks.across();
        for x in 0..across {
            let rows = self.rows.iter().skip(x).step_by(across);
            self.words[self.made] = if rows.clone().all(|row| *row == self.blocks.inside(x)) {
                ALL
            } else if rows.clone().all(|row| *row == 0) {
                NONE
            } else {
                let place = self.words.len();
                self.words.extend(rows.flat_map(|row| [*row as u32, (*row >> 32) as u32]));
                self.words.resize(place + BLOCK_WORDS, 0);
                place as u32
            };
            self.made += 1;
        }
        self.rows.clear();
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Dem {
    /// Which samples hold an elevation.
    ///
    /// # Errors
    /// As [`Dem::survey`].
    pub fn validity(&self) -> Result<&Validity> {
        Ok(&self.survey(&|_| ())?.validity)
    }
}
