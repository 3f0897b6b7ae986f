//! The mesh a frame should show, with rays through pixels as [`tolerances`](crate::tolerances) has them.

use hachure::door::stress::watertight;
use hachure::view::Camera;

use crate::tolerances::raster::RAY_PX;

pub use hachure::door::stress::watertight::{Facet, distance, facets};

/// Column and row of each pinhole, and how many uncovered pixels were tried: see [`watertight::pinholes`].
pub fn pinholes(facets: &[Facet], camera: &Camera, near: f64, depths: &[u32]) -> (Vec<[u32; 2]>, usize) {
    watertight::pinholes(facets, camera, near, depths, RAY_PX)
}
