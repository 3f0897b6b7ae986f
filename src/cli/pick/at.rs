//! What a pixel of a drawing shows, and which line runs there or why none does.

use std::sync::Arc;

use glam::DVec2;
use serde::Serialize;

use super::cause::LineAnswer;
use super::found::{self, PickedPage};
use super::place::{Located, Sighting, Slope, above_horizon, bearing};
use super::station::Station;
use super::trial::Trials;
use super::{Answer, PickArguments, left_out};
use crate::cache::Cache;
use crate::cli::device::DeviceArguments;
use crate::cli::drawing::Wanted;
use crate::cli::scene;
use crate::cli::talk::Talk;
use crate::cli::view_report::ViewReport;
use crate::error::{Error, Result, Setting};
use crate::geo::Reading;
use crate::message;
use crate::plan::{Curves, Plan};
use crate::render::{Illustration, Renderer};
use crate::surface::Met;

/// What is told of a pixel.
#[derive(Serialize)]
pub(super) struct AtAnswer {
    version: &'static str,
    pixel: [u32; 2],
    size: [u32; 2],
    shows: Shows,
    /// Whether the mask has ink there.
    inked: bool,
    crs: String,
    #[serde(flatten)]
    land: Option<LandAnswer>,
    /// How the middle of the pixel is seen, where no land is.
    sky: Option<Sky>,
    /// At most some pixels off, what is drawn there first, then what is left out, the nearest first.
    lines: Vec<LineAnswer>,
    view: ViewReport,
}

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Shows {
    Land,
    /// Of land that is seen from below: bare paper.
    Underside,
    Sky,
}

/// The land that a pixel shows in its middle.
#[derive(Serialize)]
struct LandAnswer {
    #[serde(flatten)]
    located: Located,
    #[serde(flatten)]
    sighting: Sighting,
    #[serde(flatten)]
    slope: Slope,
}

/// A direction in which no land lies.
#[derive(Serialize)]
struct Sky {
    true_bearing: Option<f64>,
    grid_bearing: Option<f64>,
    vertical_angle: f64,
}

/// The answer of a pixel.
///
/// # Errors
/// Whatever went wrong; [`Error::Setting`] for a pixel beside the page.
pub(super) fn answer(
    arguments: &PickArguments,
    pixel: [u32; 2],
    reading: Reading,
    cache: &Cache,
    talk: &Talk,
) -> Result<AtAnswer> {
    let drawing = &arguments.drawing;
    let remote = arguments.terrain.allows_remote();
    let illustration = drawing.illustration(arguments.view.typed_size(), Wanted::Drawing, false, remote)?;
    check_pixel(pixel, illustration.frame)?;
    let surface = Arc::new(scene::surface(&arguments.terrain, reading, cache, talk)?);
    let gpu = scene::prepare_and_open(&surface, cache, &arguments.device, talk)?;
    let view = scene::look(&arguments.view, drawing, &surface, illustration.frame, talk)?;
    let land = scene::land(drawing, &illustration.land, &arguments.terrain, &surface, cache, talk)?;
    let gpu = Arc::new(gpu?);
    DeviceArguments::tell(&gpu, talk)?;
    let mut renderer = Renderer::new(gpu, surface.clone())?;
    renderer.set_land(land);
    let plan = with_hidden(&illustration);
    let mut page = renderer.page(&plan, &view.camera, |share| talk.progress("drawing", 0.3 + 0.6 * share))?;
    // What is drawn is what would be drawn without the question.
    let hidden = if drawing.style.draws_hidden() { page.hidden.clone() } else { std::mem::take(&mut page.hidden) };
    let (lines, drawn) = illustration.drawing(&page)?;
    let station = Station::new(&surface, &view, drawing.exaggeration, drawing.level.told());
    let middle = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + 0.5;
    let met = station.behind(middle)?;
    let shown =
        PickedPage { illustration: &illustration, page: &page, lines: &lines, hidden: &hidden, drawn: &drawn, middle };
    let mut found = found::lines(&shown, &station)?;
    let mut trials = Trials {
        arguments,
        illustration: &illustration,
        renderer,
        station: &station,
        surface: &surface,
        cache,
        talk,
        middle,
    };
    found.extend(left_out::lines(&shown, &station, met.as_ref(), &mut trials)?);
    surface.dem().check()?;
    talk.progress("drawing", 1.0);
    let toward = met.filter(|met| met.is_toward);
    let land = |met: &Met| {
        let (located, sighting) = (station.located(met.place)?, station.sighting(met.place));
        Ok(LandAnswer { located, sighting, slope: station.slope(met)? })
    };
    let sighting = station.sighting(view.camera.eye + view.camera.ray(middle));
    let Sighting { true_bearing, grid_bearing, vertical_angle, .. } = sighting;
    let mark = page.marks.at(pixel[0].into(), pixel[1].into());
    Ok(AtAnswer {
        version: env!("CARGO_PKG_VERSION"),
        pixel,
        size: illustration.frame,
        shows: match (&met, &toward) {
            (None, _) => Shows::Sky,
            (_, None) => Shows::Underside,
            (_, Some(_)) => Shows::Land,
        },
        inked: mark.is_some_and(|mark| mark.pixel.is_ink()),
        crs: surface.dem().georeference().file().label(),
        land: toward.as_ref().map(land).transpose()?,
        sky: toward.is_none().then_some(Sky { true_bearing, grid_bearing, vertical_angle }),
        lines: found::told(found, &shown, &station, toward.as_ref())?,
        view: station.view_report(),
    })
}

/// The plan of a drawing that finds what is hidden too, if it finds curves.
fn with_hidden(illustration: &Illustration) -> Plan {
    let curves = if illustration.plan.has_curves() { Curves::All } else { Curves::Off };
    Plan { curves, ..illustration.plan }
}

fn check_pixel([x, y]: [u32; 2], [width, height]: [u32; 2]) -> Result<()> {
    if x < width && y < height {
        return Ok(());
    }
    let what = format!("there is no pixel {x},{y} on a page of {width}x{height}");
    let remedy = message![format!("give one from 0,0 to {},{}, or another ", width - 1, height - 1), Setting::Size];
    Err(Error::setting(Setting::At, what, remedy))
}

impl Answer for AtAnswer {
    fn rows(&self) -> Vec<(&'static str, String)> {
        let ([x, y], [width, height]) = (self.pixel, self.size);
        let shows = match self.shows {
            Shows::Land => "land",
            Shows::Underside => "the underside of land, bare paper: the eye is below it or beside the DEM",
            Shows::Sky => "sky, no land of the DEM lies there",
        };
        let ink = if self.inked { "; ink of the mask" } else { "" };
        let mut rows = vec![("pixel", format!("{x},{y} of {width}x{height}: {shows}{ink}"))];
        if let Some(LandAnswer { located, sighting, slope }) = &self.land {
            rows.extend([("place", located.words()), ("elevation", located.elevation())]);
            rows.extend(sighting.rows());
            rows.push(("slope", slope.words()));
        }
        if let Some(Sky { true_bearing, grid_bearing, vertical_angle }) = self.sky {
            rows.push(("bearing", bearing(true_bearing, grid_bearing)));
            rows.push(("angle", above_horizon(vertical_angle)));
        }
        rows.extend(self.lines.iter().map(|line| ("line", line.words.clone())));
        rows
    }
}
