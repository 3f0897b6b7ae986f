//! `hachure info`: what a DEM holds.

use super::say;
use super::terrain::TerrainArguments;
use crate::dem;
use crate::error::Result;

/// Flags of `hachure info`.
#[derive(Debug, clap::Args)]
pub struct InfoArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
}

/// Prints size, CRS, extent, cell, range, voids, and what was converted and assumed.
///
/// # Errors
/// As [`dem::info()`].
pub fn run(arguments: &InfoArguments) -> Result<()> {
    let terrain = &arguments.terrain;
    say(&format!("{}\n", dem::info(&terrain.dems, &terrain.options(1.0), &|_, _| ())?))
}
