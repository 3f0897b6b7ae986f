//! Pass `compose`: packs ink, kind and depth for readback and tracing.

use super::{Gpu, Pass};
use crate::error::Result;
use crate::view::Camera;

/// The composed shader.
pub const SOURCE: &str = crate::shader!("scene", "ink", "compose");

/// Compiles the pass.
///
/// # Errors
/// See [`Pass::new`].
pub fn pass(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Pass> {
    Pass::new(gpu, "compose", SOURCE, constants)
}

/// One invocation a pixel.
pub fn invocations(camera: &Camera) -> [u32; 2] {
    [camera.width, camera.height]
}
