//! Pass `border`: the visible rim, one pixel wide.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "ink", "border", "rim");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("border", SOURCE, constants)
}

/// One invocation a patch edge of the rim.
pub fn invocations(pass: &Pass, rim_edges: usize) -> [u32; 2] {
    pass.folded(rim_edges as u64)
}
