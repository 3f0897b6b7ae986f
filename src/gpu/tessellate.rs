//! Pass `tessellate`: the vertices of a batch, on the surface and on the page.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Batch;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "tessellate");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "tessellate", SOURCE, constants)
}

/// At most 16 blocks of vertices, one row a chunk.
pub fn invocations(batch: &Batch) -> [u32; 2] {
    [16, batch.chunks]
}
