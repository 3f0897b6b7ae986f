//! Pass `project`: where the vertices of the chunks that may appear lie on the page.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "project");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("project", SOURCE, constants)
}

/// 32 invocations a chunk, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [32, chunks]
}
