//! Pass `toward_away`: silhouettes where an away surface lies between the toward surfaces of neighbouring pixels.

use super::sizes::BLOCK;
use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "ink", "toward_away");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "toward_away", SOURCE, constants)
}

/// One invocation a block of pixels.
pub fn extent([width, height]: [u32; 2]) -> Extent {
    Extent::Invocations([width.div_ceil(BLOCK[0]), height.div_ceil(BLOCK[1])])
}
