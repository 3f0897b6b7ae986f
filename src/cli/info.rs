//! `hachure info`: what a DEM holds, or which adapters there are.

use super::talk::Talk;
use super::terrain::{TerrainArguments, words};
use super::words::told;
use super::{channels, folds, peaks, reference, values};
use crate::cache::Cache;
use crate::dem::Dem;
use crate::error::Result;
use crate::geo;
use crate::gpu::Adapter;
use crate::surface::Surface;

/// The end of `hachure info --help`.
const EXAMPLES: &str = "\
Examples:
  hachure info dem/golden-gate.tif
  hachure info dem/golden-gate.tif --peaks 5
  hachure info dem/golden-gate.tif --channels

  The adapters, for --adapter N:
  hachure info --adapters";

/// Peaks that are listed where nobody says how many.
pub const PEAKS: &str = "20";
/// What is said of peaks beside that.
const PROMINENCE: &str = "\
Prominence is metres above the saddle that parts a peak from higher ground; of the highest above the lowest sample, or the sea where \
that lies below 0. A peak at the edge of the DEM or of a void is marked: the land may rise beyond. DEMs that stay in their files \
need a --crop.";
/// Bytes of a GiB.
const GIB: f64 = (1u64 << 30) as f64;

/// Flags of `hachure info`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::READ, EXAMPLES]))]
pub struct InfoArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
    #[arg(
        long, value_name = "N", value_parser = values::peaks, num_args = 0..=1, default_missing_value = PEAKS,
        help = peaks_help(), long_help = format!("{}\n\n{PROMINENCE}", peaks_help())
    )]
    peaks: Option<usize>,
    /// Also count patches of the surface that fold over, and with --limit-folds tell what that moves: a look at the whole DEM
    #[arg(long)]
    folds: bool,
    /// Factor on every elevation, for --folds: those of a drawing with as much
    #[arg(
        long, value_name = "X", value_parser = values::exaggeration, allow_hyphen_values = true, default_value = "1",
        requires = "folds"
    )]
    exaggeration: f64,
    /// Also list from how much land on water was tried to run in channels, how streams fall with each, and which --channel-area
    /// auto takes; DEMs that stay in their files need a --crop
    #[arg(long)]
    channels: bool,
    /// List the adapters of this machine instead, of which --adapter takes the numbers: where each is plugged in, and how much
    /// memory it has
    #[arg(long, exclusive = true)]
    adapters: bool,
}

fn peaks_help() -> String {
    format!(
        "Also list the N most prominent peaks, with the saddles that part them from higher ground [default: {PEAKS}]"
    )
}

/// Prints size, CRS, extent, cell, range, voids, what was converted and assumed, peaks and areas of channels, folds; or the adapters.
///
/// # Errors
/// As [`geo::info()`] and [`Adapter::all`]; for peaks and channels of a DEM that stays in its files [`Error::Limit`](crate::error::Error::Limit).
pub fn run(arguments: &InfoArguments, talk: &Talk) -> Result<()> {
    if arguments.adapters {
        return talk.answer(&table(&Adapter::all()?));
    }
    let terrain = &arguments.terrain;
    let options = terrain.options(1.0, Cache::none());
    let (info, dem) = geo::info_and_dem(&terrain.dems, &options, &|stage, share| talk.progress(words(stage), share))?;
    // These first: where they cannot be told, nothing is.
    let peaks = arguments.peaks.map(|count| peaks::told(&dem, count)).transpose()?;
    let channels = arguments.channels.then(|| channels::told(&dem)).transpose()?;
    let folds = (arguments.folds || terrain.limits_folds()).then(|| folds(arguments, dem, talk)).transpose()?;
    talk.answer(&[Some(info.told(told)), folds, peaks, channels].into_iter().flatten().collect::<Vec<_>>().join("\n"))
}

/// What is told of folds of the surface of `dem`, read anew where heights are exaggerated.
fn folds(InfoArguments { terrain, exaggeration, .. }: &InfoArguments, dem: Dem, talk: &Talk) -> Result<String> {
    let dem = match *exaggeration {
        1.0 => dem,
        factor => terrain
            .open(&terrain.dems, factor, Cache::none())?
            .finish(&|stage, share| talk.progress(words(stage), share))?,
    };
    folds::told(Surface::new(dem), *exaggeration, terrain.limits_folds())
}

/// Adapters, a row each: names last, which hold spaces.
fn table(adapters: &[Adapter]) -> String {
    let row = |[number, bus, memory, name]: [&str; 4]| format!("{number:<6}  {bus:<12}  {memory:>10}  {name}");
    let told = |adapter: &Adapter| {
        let memory = adapter.memory.map_or("-".to_owned(), |bytes| format!("{:.1} GiB", bytes as f64 / GIB));
        row([&adapter.number.to_string(), adapter.bus.as_deref().unwrap_or("-"), &memory, &adapter.name])
    };
    std::iter::once(row(["number", "bus", "memory", "name"]))
        .chain(adapters.iter().map(told))
        .collect::<Vec<_>>()
        .join("\n")
}
