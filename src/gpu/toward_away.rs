//! Pass `toward_away`: silhouettes where an away surface lies between the toward surfaces of neighbouring pixels.

use std::sync::Arc;

use super::sizes::BLOCK;
use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "ink", "toward_away");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("toward_away", SOURCE, constants)
}

/// One invocation a block of pixels.
pub fn invocations([width, height]: [u32; 2]) -> [u32; 2] {
    [width.div_ceil(BLOCK[0]), height.div_ceil(BLOCK[1])]
}
