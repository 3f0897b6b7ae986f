//! Pass `lay`: points of lines on the land, on the facets that are drawn.
//!
//! Every line of the world goes this way, so that what is seen of it is decided as for contours, by `sight`. Cost: a look-up of
//! the facet, and a look at the nine pixels about it. Not handled: points on the very edge of a facet.

use std::sync::Arc;

use super::{Gpu, Pass, segments};
use crate::error::Result;

/// The composed shader.
pub fn source(keeps_vertices: bool) -> String {
    [segments::listing(keeps_vertices).as_str(), crate::shader!("section", "lay")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    // Nothing is left to another pass.
    gpu.pass("lay", source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
