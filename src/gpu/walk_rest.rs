//! Pass `walk_rest`: the pairs that `walk` leaves, with pixels without surface and past facets beside coarser chunks.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader, for frames whose vertices are all at hand, or those of one batch at a time.
pub fn source(keeps_vertices: bool) -> &'static str {
    if keeps_vertices {
        crate::shader!(
            "scene",
            "lattice",
            "surface",
            "vertex_kept",
            "wide",
            "ink",
            "list",
            "levels",
            "walk",
            "walk_rest"
        )
    } else {
        crate::shader!(
            "scene",
            "lattice",
            "surface",
            "vertex_anew",
            "wide",
            "ink",
            "list",
            "levels",
            "walk",
            "walk_rest"
        )
    }
}

/// One invocation a pixel with such pairs.
pub const EXTENT: Extent = Extent::List("rest");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "walk_rest", source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
