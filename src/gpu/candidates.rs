//! Pass `candidates`: lists the pixels between which a walk could meet an away facet, as far as chunks tell.

use std::sync::Arc;

use super::sizes::BLOCK;
use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "list", "candidates");
/// An empty list of pixels: workgroups of the pass that reads it along x, y and z, and the count.
pub const NO_PIXELS: [u32; 4] = [0, 1, 1, 0];

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("candidates", SOURCE, constants)
}

/// One invocation a block of pixels.
pub fn invocations([width, height]: [u32; 2]) -> [u32; 2] {
    [width.div_ceil(BLOCK[0]), height.div_ceil(BLOCK[1])]
}
