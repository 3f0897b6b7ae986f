//! Pass `rasterize`: every facet of a batch into the raster; large and clipped ones into the queue.

use std::sync::Arc;

use super::{Gpu, Pass};
use crate::error::Result;
use crate::plan::Visibility;
use crate::surface::lattice::CHUNK_FACETS;

/// The composed shader that keeps what `visibility` says.
pub fn source(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Key64 => crate::shader!("scene", "lattice", "emit_u64", "triangle", "cull", "rasterize"),
        Visibility::Key32 => crate::shader!("scene", "lattice", "emit_u32", "triangle", "cull", "rasterize"),
        Visibility::TwoDepths => crate::shader!("scene", "lattice", "emit_two_depths", "triangle", "cull", "rasterize"),
    }
}

/// Compiles the pass.
///
/// # Errors
/// See [`Gpu::pass`].
pub fn pass(gpu: &Gpu, visibility: Visibility, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    gpu.pass("rasterize", source(visibility), constants)
}

/// Facets of a column of eight quads.
pub const STRIP_FACETS: u32 = 16;

/// One invocation a column of eight quads, one row a chunk.
pub fn invocations(chunks: u32) -> [u32; 2] {
    [CHUNK_FACETS / STRIP_FACETS, chunks]
}
