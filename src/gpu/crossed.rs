//! Pass `crossed`: the facets through which contours run.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::surface::lattice::CHUNK_QUADS;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "curve", "tally", "crossed");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("crossed", SOURCE, constants)
}

/// One invocation a row of quads, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [CHUNK_QUADS, chunks]
}
