//! Samples that stay in their files, as a DEM asks for them: whoever can read a grid window by window gives it tiles.

use std::fmt::Debug;

use super::tiling::Tiling;
use super::window::Window;
use crate::error::{Error, Message, Result};

/// A grid that is read a window at a time. Windows count from its north-west sample.
///
/// Any number of threads may read at once, and nothing in a reading may be parallel itself: others wait for it.
pub trait Tiles: Debug + Send + Sync {
    /// Columns and rows, at least 2 of each.
    fn size(&self) -> [usize; 2];

    /// The tiles in which all of it is best read.
    fn tiling(&self) -> Tiling;

    /// Whether several threads gain by reading at once.
    fn is_parallel(&self) -> bool;

    /// Metres of the samples of `window`, row-major from the north-west; not finite at voids.
    ///
    /// # Errors
    /// [`Error::Input`] when they cannot be read.
    fn read(&self, window: Window) -> Result<Vec<f32>>;

    /// What tells these samples from any others: as long as it stays the same, so do they. `None` where nothing does.
    /// Asked for once.
    fn stamp(&self) -> Option<u128>;

    /// Whether the samples are still those that were opened.
    ///
    /// # Errors
    /// [`Error::Input`] where they are not.
    fn check(&self) -> Result<()>;

    /// Of the samples read so far, those that are void by their impossible value alone.
    fn marks(&self) -> usize;

    /// What had to be assumed of the samples read so far, in words as those of a [`History`](super::History).
    fn assumed(&self) -> Vec<Message>;

    /// The error for samples that are all void.
    fn all_void(&self) -> Error;
}
