//! Pass `facing`: one bit a facet, decided once, and which blocks of facets hold an away one.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Batch;
use crate::surface::lattice::CHUNK_WORDS;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "facing");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "facing", SOURCE, constants)
}

/// One invocation a word of 32 facets, one row a chunk.
pub fn invocations(batch: &Batch) -> [u32; 2] {
    [CHUNK_WORDS, batch.chunks]
}
