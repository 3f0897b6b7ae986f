//! Pass `walk`: silhouettes where the way between the surface points of two pixels crosses an away facet.
//! One invocation a pixel with open pairs.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;

/// The composed shader, for frames whose vertices are all at hand, or those of one batch at a time.
pub fn source(keeps_vertices: bool) -> String {
    let walk = crate::shader!("scene", "lattice", "surface", "wide", "ink", "list", "levels", "walk_between", "walk");
    [walk, vertices(keeps_vertices)].concat()
}

/// Where passes find the vertex of any chunk.
pub(super) fn vertices(keeps_vertices: bool) -> &'static str {
    if keeps_vertices { crate::shader!("vertex_kept") } else { crate::shader!("vertex_anew") }
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("walk", source(keeps_vertices), constants)
}
