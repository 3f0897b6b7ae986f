//! Pass `rasterize_large`: the queued facets of a batch, clipped, shared out by tiles.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Visibility;

/// Workgroups that share the queue, however long it is.
const WORKGROUPS: u32 = 256;

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
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, visibility: Visibility, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "rasterize_large", source(visibility), constants)
}

/// A fixed number of workgroups.
pub fn invocations(pass: &Pass) -> [u32; 2] {
    [WORKGROUPS * pass.workgroup[0], 1]
}
