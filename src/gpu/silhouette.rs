//! Stage 3, the silhouettes: the passes of a method, compiled by the names its entry in the registry has for them.

use super::buffers::Room;
use super::{Extent, Gpu, Pass, adjacency, candidates, pairs, toward_away, walk, walk_rest};
use crate::error::{Error, Result};
use crate::plan::Method;

/// Compiles the passes of a method in their order, for pages of `size` pixels and buffers with so much room, each with
/// how far it reaches.
///
/// # Errors
/// See [`pass`].
pub fn passes(
    gpu: &Gpu,
    method: Method,
    room: Room,
    size: [u32; 2],
    constants: &[(&str, f64)],
) -> Result<Vec<(Pass, Extent)>> {
    let names = method.entry().passes.iter();
    names.map(|name| pass(gpu, name, room.keeps_vertices(), size, constants)).collect()
}

/// Compiles the pass of this name, for pages of `size` pixels and frames whose vertices are all at hand or not.
///
/// # Errors
/// [`Error::Mistake`] where no pass has the name; see [`Pass::new`].
pub fn pass(
    gpu: &Gpu,
    name: &str,
    keeps_vertices: bool,
    size: [u32; 2],
    constants: &[(&str, f64)],
) -> Result<(Pass, Extent)> {
    Ok(match name {
        "adjacency" => (adjacency::pass(gpu, constants)?, adjacency::extent(size)),
        "toward_away" => (toward_away::pass(gpu, constants)?, toward_away::extent(size)),
        "candidates" => (candidates::pass(gpu, constants)?, candidates::extent(size)),
        "pairs" => (pairs::pass(gpu, constants)?, pairs::EXTENT),
        "walk" => (walk::pass(gpu, keeps_vertices, constants)?, walk::EXTENT),
        "walk_rest" => (walk_rest::pass(gpu, keeps_vertices, constants)?, walk_rest::EXTENT),
        _ => return Err(Error::Mistake { what: format!("no pass is named {name}") }),
    })
}
