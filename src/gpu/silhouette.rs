//! Stage 3, the silhouettes: which passes a method takes, in their order, and how far each reaches.

use super::{Extent, Gpu, Pass, adjacency, candidates, pairs, toward_away, walk, walk_rest};
use crate::error::Result;
use crate::plan::Method;

/// Compiles the passes of a method for pages of `size` pixels.
///
/// # Errors
/// See [`Pass::new`].
pub fn passes(gpu: &Gpu, method: Method, size: [u32; 2], constants: &[(&str, f64)]) -> Result<Vec<(Pass, Extent)>> {
    Ok(match method {
        Method::Adjacency { share } => vec![(adjacency::pass(gpu, share, constants)?, adjacency::extent(size))],
        Method::TowardAway { wide } => vec![(toward_away::pass(gpu, wide, constants)?, toward_away::extent(size))],
        Method::Walk => vec![
            (candidates::pass(gpu, constants)?, candidates::extent(size)),
            (pairs::pass(gpu, constants)?, pairs::EXTENT),
            (walk::pass(gpu, constants)?, walk::EXTENT),
            (walk_rest::pass(gpu, constants)?, walk_rest::EXTENT),
        ],
    })
}
