//! Pass `walk`: silhouettes where the way between the surface points of two pixels crosses an away facet.

use super::{Extent, Gpu, Pass};
use crate::error::Result;

/// The composed shader, for frames whose vertices are all at hand, or those of one batch at a time.
pub fn source(keeps_vertices: bool) -> String {
    let vertices = if keeps_vertices { crate::shader!("vertex_kept") } else { crate::shader!("vertex_anew") };
    [crate::shader!("scene", "lattice", "surface", "wide", "ink", "list", "levels", "walk_between", "walk"), vertices]
        .concat()
}

/// One invocation a pixel with open pairs.
pub const EXTENT: Extent = Extent::List("pairs");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "walk", &source(keeps_vertices), constants)
}
