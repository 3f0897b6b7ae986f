//! Land that has no hachures for being too near: what is said of it.

use super::blank::length;

/// Of a plan.
pub(crate) const PLAN: &str = "the scale leaves dark land, or all, without hachures: they would stand closer than an eighth of a \
                        cell; use --scale with a larger N, or a finer DEM";

/// Of a view where it goes so far from the eye, metres.
pub(crate) fn of_view(bare: f64) -> String {
    format!(
        "land nearer than {} has no hachures: they would stand closer than an eighth of a cell; give an eye higher above it, \
         or a finer DEM",
        length(bare)
    )
}

/// Of so many frames.
pub(crate) fn of_frames(count: usize) -> String {
    format!(
        "{count} of the frames drawn show land so near that it has no hachures, for they would stand closer than an eighth \
         of a cell: fly higher above it, or over a finer DEM"
    )
}
