//! Pass `rasterize_large`: the queued facets of a batch, clipped, shared out by tiles.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Visibility;

/// Tiles of 32 x 32 px that one workgroup draws of a facet at most: the software driver ends an invocation's loops, all
/// together, after 65 535 turns.
const TILES: u32 = 64;
/// Pixels along a tile.
pub const TILE: u32 = 32;

/// The composed shader that keeps what `visibility` says.
pub fn source(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Key64 => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_u64", "triangle", "rasterize_large")
        }
        Visibility::Key32 => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_u32", "triangle", "rasterize_large")
        }
        Visibility::TwoDepths => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_two_depths", "triangle", "rasterize_large")
        }
    }
}

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, visibility: Visibility, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "rasterize_large", source(visibility), constants)
}

/// An empty queue for a piece of this size: workgroups along x, y and z, one row of them a share, and the count.
pub fn empty_queue([width, height]: [u32; 2]) -> [u32; 4] {
    // The grid of tiles is the page's: a piece of it may begin and end within one.
    let tiles = (width.div_ceil(TILE) + 1) * (height.div_ceil(TILE) + 1);
    [0, tiles.div_ceil(TILES), 1, 0]
}
