//! Pass `segments`: the lines along which facets turn away.

use std::sync::Arc;

use super::{Gpu, Pass, walk};
use crate::error::Result;

/// The composed shader: `walk`, and what curves are made of.
pub fn source(keeps_vertices: bool) -> String {
    [listing(keeps_vertices).as_str(), crate::shader!("segments")].concat()
}

/// What passes over the list of segments stand on.
pub(super) fn listing(keeps_vertices: bool) -> String {
    [walk::source(keeps_vertices).as_str(), crate::shader!("cull", "curve", "tally", "segment")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("segments", source(keeps_vertices), constants)
}
