//! Pass 3, the silhouettes: `adjacency`, `toward_away`, or `candidates`, `pairs` and `walk`.

use super::{Extent, Gpu, Pass};
use crate::error::Result;
use crate::plan::{Method, Share};
use crate::view::Camera;

/// The composed shader of adjacency.
pub const ADJACENCY: &str = crate::shader!("scene", "lattice", "ink", "adjacency");
/// The composed shader of toward-away.
pub const TOWARD_AWAY: &str = crate::shader!("scene", "ink", "toward_away");
/// The composed shader that lists where a walk is needed.
pub const CANDIDATES: &str = crate::shader!("scene", "lattice", "candidates");
/// The composed shader that keeps of that list what a walk can tell.
pub const PAIRS: &str = crate::shader!("scene", "lattice", "pairs");
/// The composed shader of the walk.
pub const WALK: &str = crate::shader!("scene", "lattice", "surface", "wide", "ink", "walk");

/// An empty list of pixels: workgroups of the next pass along x, y and z, and the count.
pub const NO_PIXELS: [u32; 4] = [0, 1, 1, 0];

/// Compiles the passes of a method, in their order.
///
/// # Errors
/// See [`Pass::new`].
pub fn passes(gpu: &Gpu, method: Method, constants: &[(&str, f64)]) -> Result<Vec<Pass>> {
    let with = |name, value| [constants, &[(name, value)]].concat();
    match method {
        Method::Adjacency { share } => {
            let shared = if share == Share::Edge { 2.0 } else { 1.0 };
            Ok(vec![Pass::new(gpu, "adjacency", ADJACENCY, &with("shared_vertices", shared))?])
        }
        Method::TowardAway { wide } => {
            let wide = f64::from(u8::from(wide));
            Ok(vec![Pass::new(gpu, "toward_away", TOWARD_AWAY, &with("wide_block", wide))?])
        }
        Method::Walk => Ok(vec![
            Pass::new(gpu, "candidates", CANDIDATES, constants)?,
            Pass::new(gpu, "pairs", PAIRS, constants)?,
            Pass::new(gpu, "walk", WALK, constants)?,
        ]),
    }
}

/// Pixels across and down that one invocation works off.
const BLOCK: [u32; 2] = [4, 8];

/// One invocation a pixel, a block of pixels, or a candidate.
pub fn extent(pass: &Pass, camera: &Camera) -> Extent {
    match pass.name {
        "pairs" => Extent::List("candidates"),
        "walk" => Extent::List("pairs"),
        "adjacency" => Extent::Invocations([camera.width, camera.height]),
        _ => Extent::Invocations([camera.width.div_ceil(BLOCK[0]), camera.height.div_ceil(BLOCK[1])]),
    }
}
