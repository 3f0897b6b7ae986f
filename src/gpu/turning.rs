//! Pass `turning`: through which chunks contours may run.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "cull", "curve", "turning");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("turning", SOURCE, constants)
}
