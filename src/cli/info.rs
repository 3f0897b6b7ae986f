//! `hachure info`: what a DEM holds.

use std::path::PathBuf;

use super::talk::Talk;
use crate::dem;
use crate::error::Result;

/// The end of `hachure info --help`.
const EXAMPLES: &str = "\
Examples:
  hachure info dem/golden-gate.tif";

/// Flags of `hachure info`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct InfoArguments {
    /// The DEM: any raster in projected metres, north up
    dem: PathBuf,
}

/// Prints size, CRS, extent, cell, range and voids.
///
/// # Errors
/// As [`dem::info()`].
pub fn run(arguments: &InfoArguments, talk: &Talk) -> Result<()> {
    talk.answer(&dem::info(&arguments.dem)?.to_string())
}
