//! Pass `pairs`: keeps of the candidates the pairs of pixels between which the facets themselves leave it open.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "lattice", "list", "pairs");
/// One invocation a candidate.
pub const EXTENT: Extent = Extent::List("candidates");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "pairs", SOURCE, constants)
}
