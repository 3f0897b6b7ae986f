//! Pass `turn`: how the vertices of a chunk face the eye, as far as its own facets and patches tell.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::surface::lattice::CHUNK_SIDE;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "curve", "vertex", "turn");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("turn", SOURCE, constants)
}

/// One invocation a column of vertices, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [CHUNK_SIDE, chunks]
}
