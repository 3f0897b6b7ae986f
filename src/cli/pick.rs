//! `hachure pick`: what a pixel of a drawing shows and which line runs there or why none does; or where a place stands on it.

mod at;
mod cause;
mod found;
mod left_out;
mod of;
mod place;
mod remedy;
mod station;
mod trial;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use glam::DVec2;
use serde::Serialize;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::drawing::DrawingArguments;
use super::talk::Talk;
use super::terrain::TerrainArguments;
use super::values;
use super::viewpoint::ViewArguments;
use crate::error::{Result, Setting};
use crate::files::{Output, Taken};
use crate::geo::Reading;

/// The end of `hachure pick --help`.
const EXAMPLES: &str = "\
Pixels are those of the frame (--size), as in the mask; a picture with --dpi has others. Heights, distances, angles and slopes are
the land's own, whatever the exaggeration. Give the flags of the drawing that is asked about. There is no pick
for plans (--plan): their scale tells what lies where.

Examples:
  What lies there, and why no line is drawn:
  hachure pick dem/golden-gate.tif --eye 547500,4183300,+300 --azimuth 318 --size 1600x700 --at 800,350

  Where a place of the globe stands on the page, or what hides it, as JSON:
  hachure pick dem/golden-gate.tif --eye 547500,4183300,+300 --azimuth 318 --of -122.5,37.83 --json -";

/// Flags of `hachure pick`, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = EXAMPLES, group(clap::ArgGroup::new("asked").args(["at", "of"]).required(true)))]
pub(crate) struct PickArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
    /// The pixel that is asked about: its column and row in the frame, counted from 0,0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = values::pixel, allow_hyphen_values = true)]
    at: Option<[u32; 2]>,
    /// The place that is asked about: easting, northing in the CRS of the DEM, or of --crs; where the DEM is not there, longitude,
    /// latitude in degrees
    #[arg(long, value_name = "E,N|LON,LAT", value_parser = values::place, allow_hyphen_values = true)]
    of: Option<DVec2>,
    /// The answer as JSON, to a file beside the text, or to standard output in its place
    #[arg(long, value_name = "OUT.json|-")]
    json: Option<PathBuf>,

    #[command(flatten)]
    view: ViewArguments,
    #[command(flatten)]
    drawing: DrawingArguments,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

/// An answer, in words and as data.
trait Answer: Serialize {
    /// What each thing is called, and what it is.
    fn rows(&self) -> Vec<(&'static str, String)>;
}

/// Answers.
///
/// # Errors
/// Whatever went wrong; [`Error::Setting`](crate::error::Error::Setting) for a pixel beside the page and a place without land.
pub(crate) fn run(arguments: &PickArguments, talk: &Talk) -> Result<()> {
    match arguments.of {
        // It may be given in --crs alone.
        Some(_) => arguments.view.crs().map(drop)?,
        None => arguments.view.check()?,
    }
    let cache = arguments.cache.cache();
    let reading = arguments.terrain.open(&arguments.terrain.dems, arguments.drawing.exaggeration, cache.clone())?;
    let json = arguments.json.as_ref().map(|path| arguments.open_json(path, &reading)).transpose()?;
    match (arguments.at, arguments.of) {
        (Some(pixel), _) => tell(&at::answer(arguments, pixel, reading, &cache, talk)?, json, talk),
        (None, Some(place)) => tell(&of::answer(arguments, place, reading, &cache, talk)?, json, talk),
        (None, None) => Ok(()),
    }
}

impl PickArguments {
    /// The file of the answer, which may be none that is read.
    fn open_json(&self, path: &Path, reading: &Reading) -> Result<Output> {
        let lines = self.drawing.land.lines.files();
        let mut taken = Taken::inputs(reading.files().chain(lines.iter().map(PathBuf::as_path)));
        if path.as_os_str() == "-" {
            taken.take_stdout(Setting::Json)?;
            return Ok(Output::stdout());
        }
        taken.take(Setting::Json, path)?;
        Output::create(path)
    }
}

/// Says an answer in words, unless standard output is to hold it as data, and writes that where it is asked for.
fn tell(answer: &impl Answer, json: Option<Output>, talk: &Talk) -> Result<()> {
    let to_stdout = json.as_ref().is_some_and(|json| json.target().is_none());
    if let Some(mut json) = json {
        json.write(|out| {
            serde_json::to_writer_pretty(&mut *out, answer)?;
            writeln!(out)
        })?;
        json.publish()?;
    }
    if to_stdout {
        return Ok(());
    }
    let mut text = String::new();
    for (name, words) in answer.rows() {
        let line = if text.is_empty() { "" } else { "\n" };
        // A string takes all that is written.
        let _ = write!(text, "{line}{name:<10} {words}");
    }
    talk.answer(&text)
}
