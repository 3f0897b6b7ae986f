//! What a frame needs: which method over which facets, in which batches, and in how many pieces of the page.

pub mod batches;
pub mod method;
pub mod pieces;

pub use batches::{Batch, batches};
pub use method::{Border, Method, Share, Thrift, Visibility};
pub use pieces::{Piece, Pieces};

use crate::surface::Level;

/// What is drawn, whatever the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The level of every facet.
    pub level: Level,
    /// How silhouettes are found.
    pub method: Method,
    /// Whether the rim is drawn.
    pub border: Border,
    /// Whether what cannot change the picture is left out.
    pub thrift: Thrift,
}

impl Plan {
    /// Silhouettes and border by `method` at `level`, leaving out what cannot change the picture.
    pub fn new(level: Level, method: Method, border: Border) -> Self {
        Self { level, method, border, thrift: Thrift::LeaveOut }
    }
}

/// The walk at level 4, with border lines.
impl Default for Plan {
    fn default() -> Self {
        Self::new(Level::default(), Method::Walk, Border::On)
    }
}
