//! Stage 3, the silhouettes: which passes a method takes, in their order, and how far each reaches.

use super::buffers::Room;
use super::{Extent, Gpu, Pass, adjacency, candidates, pairs, toward_away, walk, walk_rest};
use crate::error::Result;
use crate::plan::Method;

/// Compiles the passes of a method for pages of `size` pixels and buffers with so much room.
///
/// # Errors
/// See [`Pass::new`].
pub fn passes(
    gpu: &Gpu,
    method: Method,
    room: Room,
    size: [u32; 2],
    constants: &[(&str, f64)],
) -> Result<Vec<(Pass, Extent)>> {
    Ok(match method {
        Method::Adjacency { share } => vec![(adjacency::pass(gpu, share, constants)?, adjacency::extent(size))],
        Method::TowardAway { wide } => vec![(toward_away::pass(gpu, wide, constants)?, toward_away::extent(size))],
        Method::Walk => vec![
            (candidates::pass(gpu, constants)?, candidates::extent(size)),
            (pairs::pass(gpu, constants)?, pairs::EXTENT),
            (walk::pass(gpu, room.keeps_vertices(), constants)?, walk::EXTENT),
            (walk_rest::pass(gpu, room.keeps_vertices(), constants)?, walk_rest::EXTENT),
        ],
    })
}
