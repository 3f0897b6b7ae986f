//! `hachure info`: what a DEM holds.

use super::talk::Talk;
use super::terrain::{TerrainArguments, words};
use super::words::told;
use crate::cache::Cache;
use crate::error::Result;
use crate::geo;

/// The end of `hachure info --help`.
const EXAMPLES: &str = "\
Examples:
  hachure info dem/golden-gate.tif";

/// Flags of `hachure info`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct InfoArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
}

/// Prints size, CRS, extent, cell, range, voids, and what was converted and assumed.
///
/// # Errors
/// As [`geo::info()`].
pub fn run(arguments: &InfoArguments, talk: &Talk) -> Result<()> {
    let terrain = &arguments.terrain;
    let options = terrain.options(1.0, Cache::none());
    let info = geo::info(&terrain.dems, &options, &|stage, share| talk.progress(words(stage), share))?;
    talk.answer(&info.told(told))
}
