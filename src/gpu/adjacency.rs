//! Pass `adjacency`: silhouettes where neighbouring pixels show facets that are no neighbours.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Share;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "ink", "adjacency");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, share: Share, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    let shared = if share == Share::Edge { 2.0 } else { 1.0 };
    gpu.pass("adjacency", SOURCE, &[constants, &[("shared_vertices", shared)]].concat())
}

/// One invocation a pixel.
pub fn invocations(size: [u32; 2]) -> [u32; 2] {
    size
}
