//! Pass `border`: the visible rim, one pixel wide.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "surface", "ink", "border");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("border", SOURCE, constants)
}

/// One invocation a patch edge of the rim, folded into rows of 65 535 workgroups.
pub fn invocations(pass: &Pass, rim_edges: usize) -> [u32; 2] {
    let edges = rim_edges as u64;
    let row = 65_535 * u64::from(pass.workgroup[0]);
    [edges.min(row) as u32, edges.div_ceil(row) as u32]
}
