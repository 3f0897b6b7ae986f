//! Which samples of a DEM are flat water: each by itself, or blocks of them.
//!
//! Method: what is nearly level is made level, see `levelled`; then water is told from plains and terraces as it is for the
//! steps of files, by its shores (`dem::water`), and lakes from benches, see `lakes`. Cost: some 100 ns a sample on a core, 12
//! bytes a sample while it works, a bit a sample kept. Not handled: what that does not handle: rivers, lakes as wide as the DEM
//! and those narrower than eight samples along rows and columns alike, and water that no one made level.

mod lakes;
mod levelled;

use xxhash_rust::xxh3::Xxh3;

use crate::dem::Dem;
use crate::dem::water::WaterBuilder;
use crate::error::Result;

/// The flat water of a DEM.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlatWater {
    /// Of blocks.
    columns: usize,
    /// Samples along the side of a block, of which water is known as a whole: 1 of a held DEM.
    side: usize,
    /// A bit a block, row-major, the lowest first.
    words: Vec<u64>,
}

impl FlatWater {
    /// Of a held DEM whose heights are multiplied by `exaggeration`.
    ///
    /// # Errors
    /// As [`Dem::held`].
    pub fn of(dem: &Dem, exaggeration: f64) -> Result<Self> {
        let heights = levelled::levelled(dem.held()?, exaggeration as f32);
        let columns = dem.columns();
        let mut builder = WaterBuilder::new(columns);
        builder.take(&heights);
        let (water, mut words) = (builder.finish(), vec![0_u64; heights.len().div_ceil(64)]);
        for r in 0..dem.rows() {
            for i in water.row(r).iter().flat_map(|[first, end]| *first..*end).map(|c| r * columns + c as usize) {
                words[i / 64] |= 1 << (i % 64);
            }
        }
        Ok(Self { columns, side: 1, words }.without_benches(&heights, dem.cell().x * exaggeration))
    }

    /// Whether sample (c, r) is water; not outside of the blocks.
    pub fn is_water(&self, c: usize, r: usize) -> bool {
        let [c, r] = [c / self.side, r / self.side];
        let i = r * self.columns + c;
        c < self.columns && self.words.get(i / 64).is_some_and(|word| word >> (i % 64) & 1 == 1)
    }

    /// How many blocks are water.
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// As it was kept: a bit a block of `side` x `side` samples of a DEM; `None` where there are more or fewer.
    pub(super) fn from_words(dem: &Dem, side: usize, words: Vec<u64>) -> Option<Self> {
        let [columns, rows] = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(side));
        (words.len() == (columns * rows).div_ceil(64)).then_some(Self { columns, side, words })
    }

    /// Adds it to a hash.
    pub(super) fn identify(&self, hash: &mut Xxh3) {
        hash.update(&(self.side as u64).to_le_bytes());
        hash.update(bytemuck::cast_slice(&self.words));
    }

    /// A bit a block, row-major, the lowest first.
    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }

    /// Without the blocks, by their number row by row, that are not kept.
    pub(super) fn retain(&mut self, keeps: impl Fn(usize) -> bool) {
        for (k, word) in self.words.iter_mut().enumerate() {
            let bits = (0..64).filter(|bit| *word >> bit & 1 == 1 && !keeps(64 * k + bit));
            *word &= bits.fold(u64::MAX, |left, bit| left & !(1 << bit));
        }
    }

    /// The same of blocks of so many samples a side.
    pub(super) fn of_blocks(self, side: usize) -> Self {
        Self { side, ..self }
    }
}
