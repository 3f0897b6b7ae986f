//! Pass `turn`: how the vertices face the eye of the chunks through which contours may run.

use std::sync::Arc;

use super::{Gpu, Pass, walk};
use crate::error::Result;

/// The composed shader, for frames whose vertices are all at hand, or those of one batch at a time.
pub fn source(keeps_vertices: bool) -> String {
    [crate::shader!("scene", "lattice", "surface", "cull", "curve", "turn"), walk::vertices(keeps_vertices)].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("turn", source(keeps_vertices), constants)
}

/// 32 invocations a chunk, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [32, chunks]
}
