//! Pass `wanted`: which chunks' vertices count for the curves of a frame.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "cull", "curve", "tally", "wanted");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("wanted", SOURCE, constants)
}
