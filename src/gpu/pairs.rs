//! Pass `pairs`: keeps of the candidates the pairs of pixels between which the facets themselves leave it open.
//! One invocation a candidate.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "list", "pairs");

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("pairs", SOURCE, constants)
}
