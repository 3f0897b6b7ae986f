//! Pass `rim_segments`: the parts of the rim where the surface faces the eye.

use std::sync::Arc;

use super::{Gpu, Pass, segments};
use crate::error::Result;

/// The composed shader.
pub fn source(keeps_vertices: bool) -> String {
    [segments::listing(keeps_vertices).as_str(), crate::shader!("rim_segments", "rim")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("rim_segments", source(keeps_vertices), constants)
}
