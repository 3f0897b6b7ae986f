//! Pass `walk_rest`: the pairs that `walk` leaves, with pixels without surface and past facets beside coarser chunks.
//! One invocation a pixel with such pairs.
//!
//! Where the straight way to a pixel without surface meets nothing, the cut of the surface by the plane through the eye and
//! both pixels is followed: land as thin as a pixel turns away beside that way, and a straight way along its flank never
//! rounds it. An away facet on the cut inks the pixel where it lies behind the toward one before it; one that lies before it is
//! an underside, seen through a void or past the border, and hides the edge between the two.
//!
//! Cost: at most 256 facets a pair; in a plain seen edge-on against the sky, all of them. Not handled: land that takes more
//! facets than that to turn away within a pixel, and pairs that both show land, which take the straight way alone, so that
//! the foot of a spire may lack ink for a few pixels before land beside it.

use std::sync::Arc;

use super::{Gpu, Pass, walk};
use crate::error::Result;

/// The composed shader: that of `walk`, and what is left.
pub fn source(keeps_vertices: bool) -> String {
    [walk::source(keeps_vertices).as_str(), crate::shader!("section", "walk_rest")].concat()
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, keeps_vertices: bool, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("walk_rest", source(keeps_vertices), &[constants, &[("defers", 0.0)]].concat())
}
