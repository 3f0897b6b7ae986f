//! Pass `walk_rest`: the pairs that `walk` leaves, with pixels without surface and past facets beside coarser chunks.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str =
    crate::shader!("scene", "lattice", "surface", "wide", "ink", "list", "levels", "walk", "walk_rest");
/// One invocation a pixel with such pairs.
pub const EXTENT: Extent = Extent::List("rest");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "walk_rest", SOURCE, &[constants, &[("defers", 0.0)]].concat())
}
