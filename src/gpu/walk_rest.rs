//! Pass `walk_rest`: the pairs that `walk` leaves, with pixels without surface and past facets beside coarser chunks.
//! One invocation a pixel with such pairs.

use std::sync::Arc;

use super::{Gpu, Pass, walk};
use crate::error::Result;

/// The composed shader: that of `walk`, and what is left.
pub fn source(keeps_vertices: bool) -> String {
    [walk::source(keeps_vertices).as_str(), crate::shader!("walk_rest")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("walk_rest", source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
