//! A DEM band by band, from the north: for work that looks at all samples.

use std::borrow::Cow;
use std::ops::Range;

use super::{Dem, Samples, Store};
use crate::error::Result;

/// Bands of a filed DEM begin at multiples of so many rows.
const ROWS: usize = 64;
/// Share of the budget that a band takes, unless [`ROWS`] rows take more.
const SHARE: usize = 4;

/// Rows of a DEM with their samples, and some rows around them.
#[derive(Debug)]
pub struct Band<'a> {
    /// The rows it is about.
    pub rows: Range<usize>,
    /// Their samples, and those of the halo's rows that the DEM has.
    pub samples: Cow<'a, Samples>,
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Dem {
    /// All rows once, in order, with `halo` rows above and below each band. A held DEM is one band; those of a filed one
    /// are read as the iterator comes to them, on several threads where that is faster, each of its rows unpacked once.
    ///
    /// # Errors
    /// Each band may fail as [`Dem::window`].
    pub fn bands(&self, halo: usize) -> impl Iterator<Item = Result<Band<'_>>> {
        let height = match &self.store {
            Store::Held(_) => self.rows(),
            Store::Filed(filed) => {
                let most = filed.budget() / SHARE / (self.columns() * size_of::<f32>());
                filed.tile_rows().next_multiple_of(ROWS).min(most / ROWS * ROWS).max(ROWS)
            }
        };
        (0..self.rows()).step_by(height).map(move |first| {
            let rows = first..(first + height).min(self.rows());
            let (above, end) = (first.saturating_sub(halo), (rows.end + halo).min(self.rows()));
            let samples = match &self.store {
                Store::Held(samples) => Cow::Borrowed(samples),
                Store::Filed(_) => Cow::Owned(self.window([0, above], [self.columns(), end - above])?),
            };
            Ok(Band { rows, samples })
        })
    }
}
