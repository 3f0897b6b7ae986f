//! Pass `meet`: what several chunks tell of the vertices of their sides.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::surface::lattice::CHUNK_QUADS;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "curve", "meet");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("meet", SOURCE, constants)
}

/// One invocation a vertex of a side, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [4 * CHUNK_QUADS, chunks]
}
