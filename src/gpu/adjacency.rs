//! Pass `adjacency`: silhouettes where neighbouring pixels show facets that are no neighbours.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "ink", "adjacency");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "adjacency", SOURCE, constants)
}

/// One invocation a pixel.
pub fn extent([width, height]: [u32; 2]) -> Extent {
    Extent::Invocations([width, height])
}
