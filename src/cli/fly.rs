//! `hachure fly`: to be replaced by what draws.

use super::flight::FlightArguments;
use super::terrain::TerrainArguments;

/// Flags of `hachure fly`, as typed.
#[derive(Debug, clap::Args)]
pub struct FlyArguments {
    #[command(flatten)]
    pub(super) terrain: TerrainArguments,
    #[command(flatten)]
    pub(super) flight: FlightArguments,
}
