//! `hachure info`: what a DEM holds.

use std::path::PathBuf;

use super::say;
use crate::dem;
use crate::error::Result;

/// Flags of `hachure info`.
#[derive(Debug, clap::Args)]
pub struct InfoArguments {
    /// The DEM: any raster in projected metres, north up
    dem: PathBuf,
}

/// Prints size, CRS, extent, cell, range and voids.
///
/// # Errors
/// As [`dem::info()`].
pub fn run(arguments: &InfoArguments) -> Result<()> {
    say(&format!("{}\n", dem::info(&arguments.dem)?))
}
