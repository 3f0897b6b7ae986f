//! Pass `tessellate`: the vertices on the surface of chunks that have none yet, whatever the camera, but for chunks beside
//! the page where batches share the buffer.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "tessellate");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("tessellate", SOURCE, constants)
}

/// At most 16 blocks of vertices, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [16, chunks]
}
