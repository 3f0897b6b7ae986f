//! Pass `rasterize_large`: the queued facets of a batch, clipped, shared out by tiles.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Visibility;

/// An empty queue: workgroups along x, one row of them along y for each share of the largest facet, z, and the count.
pub const EMPTY_QUEUE: [u32; 4] = [0, 1, 1, 0];

/// The composed shader that keeps what `visibility` says.
pub fn source(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Key64 => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_u64", "triangle", "rasterize_large")
        }
        Visibility::Key32 => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_u32", "triangle", "rasterize_large")
        }
        Visibility::TwoDepths => {
            crate::shader!("scene", "lattice", "surface", "wide", "emit_two_depths", "triangle", "rasterize_large")
        }
    }
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, visibility: Visibility, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("rasterize_large", source(visibility), constants)
}
