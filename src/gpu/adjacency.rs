//! Pass `adjacency`: silhouettes where neighbouring pixels show facets that are no neighbours.

use super::{Extent, Gpu, Pass};
use crate::error::Result;
use crate::plan::Share;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "ink", "adjacency");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, share: Share, constants: &[(&str, f64)]) -> Result<Pass> {
    let shared = if share == Share::Edge { 2.0 } else { 1.0 };
    Pass::new(gpu, "adjacency", SOURCE, &[constants, &[("shared_vertices", shared)]].concat())
}

/// One invocation a pixel.
pub fn extent([width, height]: [u32; 2]) -> Extent {
    Extent::Invocations([width, height])
}
