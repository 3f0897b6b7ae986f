//! Pass `walk`: silhouettes where the way between the surface points of two pixels crosses an away facet.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "wide", "ink", "list", "levels", "walk");
/// One invocation a pixel with open pairs.
pub const EXTENT: Extent = Extent::List("pairs");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "walk", SOURCE, constants)
}
