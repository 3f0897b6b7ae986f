//! Pass `facing`: one bit a facet, decided once, and which blocks of facets hold an away one.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::surface::lattice::CHUNK_WORDS;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "vertex", "facing");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("facing", SOURCE, constants)
}

/// One invocation a word of 32 facets, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [CHUNK_WORDS, chunks]
}
