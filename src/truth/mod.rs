//! Where the lines really are, and how far ink is from them.
//!
//! [`Terrain::truth`] finds the visible contours and border lines of the PN surface at one uniform level in f64 on the
//! CPU, and [`metrics`] measures ink against them. With the drawing passes truth shares the DEM, its normals and the
//! camera, nothing else. No level is stored: cells are evaluated on demand, between bounds of cells in a quadtree.
//!
//! Method: the edges between toward and away facets are the exact silhouettes of the level's mesh (Markosian et al.
//! 1997); concave ones hide themselves; the others, and the rim, are cut into pieces of a quarter pixel, and each piece
//! is visible if a ray from the eye reaches it, nudged off the surface by a twentieth of its edge. Cost: bounds of all
//! cells once, then the facets of the cells where facing may change, then a ray a piece.
//!
//! Does not handle: facets nearer than the near plane (there are none to be seen from an eye above ground); the length of
//! a contour. Lengths are those of the edges, which run to and fro along it, most where it lies aslant to the grid: on a
//! cone they add up to 1.02 times its length, on a hill to 2.2 times, and finer levels change that little.

mod cell;
mod contour;
mod facing;
mod level;
mod mask;
pub mod metrics;
mod page;
mod sight;
mod terrain;

pub use mask::{Inked, Mask};
pub use page::{TruthLine, TruthPiece};
pub use terrain::Terrain;

use crate::surface::Level;

/// The lines that are to be seen from an eye, on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// The level of the facets that were looked at.
    pub level: Level,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Pieces of line of at most a quarter pixel; those of up to four pixels beyond the page belong to it, for ink at the
    /// page's edge may lie near them.
    pub pieces: Vec<TruthPiece>,
    /// Facets whose facing was computed one by one.
    pub facets: u64,
    /// Rays cast.
    pub rays: u64,
}

impl Truth {
    /// Length of the lines on the page, px.
    pub fn length(&self) -> f64 {
        self.on_page().fold(0.0, |sum, piece| sum + piece.length())
    }

    /// Pieces whose middle is on the page.
    pub fn on_page(&self) -> impl Iterator<Item = &TruthPiece> {
        self.pieces.iter().filter(|piece| piece.is_on(self.size))
    }

    /// The same without border lines.
    pub fn without_border(mut self) -> Self {
        self.pieces.retain(|piece| piece.line == TruthLine::Contour);
        self
    }
}
