//! Pass `tessellate`: the vertices of a batch, on the surface and on the page.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Batch;
use crate::surface::lattice::CHUNK_VERTICES;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "tessellate");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "tessellate", SOURCE, constants)
}

/// Vertices of a column that one invocation works off.
pub const STRIP: u32 = 11;

/// One invocation a third of a column, one row a chunk.
pub fn invocations(batch: &Batch) -> [u32; 2] {
    [CHUNK_VERTICES / STRIP, batch.chunks]
}
