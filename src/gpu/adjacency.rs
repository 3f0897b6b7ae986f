//! Pass `adjacency`: silhouettes where neighbouring pixels show facets that are no neighbours.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "ink", "adjacency");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("adjacency", SOURCE, constants)
}

/// One invocation a pixel.
pub fn invocations(size: [u32; 2]) -> [u32; 2] {
    size
}
