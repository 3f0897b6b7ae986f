//! Which samples of a DEM are flat water, as it lies in memory.
//!
//! Method: what is nearly level is made level, see `levelled`; then water is told from plains and terraces as it is for the
//! steps of files, by its shores (`dem::water`), and lakes from benches, see `lakes`. Cost: some 100 ns a sample on a core, 12
//! bytes a sample while it works, a bit a sample kept. Not handled: what that does not handle: rivers, lakes as wide as the DEM
//! and those narrower than eight samples along rows and columns alike, and water that no one made level.

mod lakes;
mod levelled;

use crate::dem::Dem;
use crate::dem::water::WaterBuilder;
use crate::error::Result;

/// The flat water of a DEM.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlatWater {
    columns: usize,
    /// A bit a sample, row-major, the lowest first.
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
        Ok(Self { columns, words }.without_benches(&heights, dem.cell().x * exaggeration))
    }

    /// Whether sample (c, r) is water; not outside.
    pub fn is_water(&self, c: usize, r: usize) -> bool {
        let i = r * self.columns + c;
        c < self.columns && self.words.get(i / 64).is_some_and(|word| word >> (i % 64) & 1 == 1)
    }

    /// How many samples are water.
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }
}
