//! Pass `compose`: packs ink, kind and depth for readback and tracing.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "ink", "compose");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("compose", SOURCE, constants)
}

/// One invocation a pixel.
pub fn invocations(size: [u32; 2]) -> [u32; 2] {
    size
}
