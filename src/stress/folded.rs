//! What folds of a surface: patches, and facets of a lattice.

use crate::error::Result;
use crate::surface::{Lattice, Surface};

/// How many patches and how many facets of a lattice fold.
///
/// # Errors
/// As [`Surface::folds`].
pub fn folded(surface: &Surface, lattice: &Lattice) -> Result<[u64; 2]> {
    Ok([surface.folds()?.len() as u64, surface.folding_facets(lattice)?])
}

/// What folds of a surface with tangents limited; in words what did before.
///
/// # Errors
/// As [`folded`] and [`Surface::limited`].
pub(super) fn unfolded(surface: Surface, lattice: &Lattice) -> Result<(u64, String)> {
    let before = folded(&surface, lattice)?;
    let left = folded(&surface.limited()?, lattice)?;
    let words = |[patches, facets]: [u64; 2]| format!("{patches} patches and {facets} facets");
    Ok((left[0] + left[1], format!("{}, without limits {}", words(left), words(before))))
}
