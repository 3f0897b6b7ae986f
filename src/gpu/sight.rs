//! Pass `sight`: which segments of curves the eye sees, and what lies behind them.

use std::sync::Arc;

use super::{Gpu, Pass, segments};
use crate::error::Result;

/// The composed shader.
pub fn source(keeps_vertices: bool) -> String {
    [segments::listing(keeps_vertices).as_str(), crate::shader!("sight")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("sight", source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
