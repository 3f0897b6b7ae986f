//! Pass `seam`: vertices on sides shared with coarser chunks become theirs.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::surface::lattice::CHUNK_QUADS;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "seam");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("seam", SOURCE, constants)
}

/// One invocation a vertex that may move, half of those on four sides; one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [2 * CHUNK_QUADS, chunks]
}
