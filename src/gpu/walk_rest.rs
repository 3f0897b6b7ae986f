//! Pass `walk_rest`: the pairs that `walk` leaves, with pixels without surface and past facets beside coarser chunks.

use super::{Extent, Gpu, Pass, walk};
use crate::error::Result;

/// The composed shader: that of `walk`, and what is left.
pub fn source(keeps_vertices: bool) -> String {
    [walk::source(keeps_vertices).as_str(), crate::shader!("walk_rest")].concat()
}

/// One invocation a pixel with such pairs.
pub const EXTENT: Extent = Extent::List("rest");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "walk_rest", &source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
