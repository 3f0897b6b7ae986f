//! Where a place of the land stands on the page, or what hides it.

use glam::DVec2;
use serde::Serialize;

use super::place::{HiddenBy, Located, Sighting, Slope};
use super::station::Station;
use super::{Answer, PickArguments};
use crate::cache::Cache;
use crate::cli::drawing::Wanted;
use crate::cli::scene;
use crate::cli::talk::Talk;
use crate::cli::view_report::ViewReport;
use crate::cli::viewpoint;
use crate::dem::{Crs, Dem, Whereabouts};
use crate::error::{Error, Result, Setting};
use crate::geo::Reading;
use crate::surface::Met;
use crate::view::direction;

/// What is told of a place.
#[derive(Serialize)]
pub(super) struct OfAnswer {
    version: &'static str,
    crs: String,
    #[serde(flatten)]
    located: Located,
    #[serde(flatten)]
    sighting: Sighting,
    #[serde(flatten)]
    slope: Slope,
    /// Whether the page shows it.
    seen: bool,
    /// Why it does not.
    why_not: Option<WhyNot>,
    /// Where it stands on the page, pixels of the frame from its top left corner; `None` behind the eye.
    page_px: Option<[f64; 2]>,
    /// Column and row of the pixel, where it is one of the page's.
    pixel: Option<[u32; 2]>,
    /// What hides it, on the page or beside it.
    hidden_by: Option<HiddenBy>,
    /// The direction of view that has it in the middle of the page: azimuth and altitude.
    look: Option<[f64; 2]>,
    view: ViewReport,
}

/// Why a page does not show a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum WhyNot {
    BehindTheEye,
    BesideThePage,
    Hidden,
}

/// The answer of a place.
///
/// # Errors
/// Whatever went wrong; [`Error::Setting`] for a place without land.
pub(super) fn answer(
    arguments: &PickArguments,
    place: DVec2,
    reading: Reading,
    cache: &Cache,
    talk: &Talk,
) -> Result<OfAnswer> {
    let drawing = &arguments.drawing;
    let remote = arguments.terrain.allows_remote();
    let illustration = drawing.illustration(arguments.view.typed_size(), Wanted::Drawing, false, remote)?;
    let surface = scene::surface(&arguments.terrain, reading, cache, talk)?;
    scene::prepare(&surface, cache, talk)?;
    let view = scene::look(&arguments.view, drawing, &surface, illustration.frame, talk)?;
    let station = Station::new(&surface, &view, drawing.exaggeration, drawing.level.told());
    let ground = ground(&station, place, arguments.view.crs()?.as_ref())?;
    let answer = told(&station, &ground)?;
    surface.dem().check()?;
    Ok(answer)
}

/// The land at a place given in `crs`, else in the DEM's own, else in degrees.
fn ground(station: &Station, place: DVec2, crs: Option<&Crs>) -> Result<Met> {
    let (dem, georeference) = (station.surface.dem(), station.surface.dem().georeference());
    if crs.is_some() {
        let world = viewpoint::world(dem, crs, place, Setting::Of)?;
        return station.below(world)?.ok_or_else(|| viewpoint::no_ground(station.surface, world, Setting::Of));
    }
    let own = georeference.world_place(georeference.file(), place);
    if let Some(met) = own.map(|world| station.below(world)).transpose()?.flatten() {
        return Ok(met);
    }
    let may_be_degrees = place.x.abs() <= 360.0 && place.y.abs() <= 90.0;
    let globe = if may_be_degrees { georeference.globe()? } else { None };
    let world = globe.and_then(|globe| georeference.world_place(&globe, place));
    match world.map(|world| station.below(world)).transpose()?.flatten() {
        Some(met) => Ok(met),
        None => Err(nothing_there(dem, place, own)),
    }
}

/// What is told of the land at a place.
fn told(station: &Station, ground: &Met) -> Result<OfAnswer> {
    let (place, perspective) = (ground.place, &station.perspective);
    let is_before = perspective.distance(place) > perspective.near();
    let page = is_before.then(|| perspective.project(place).0);
    let pixel = page.and_then(|page| {
        let is_on = page.cmpge(DVec2::ZERO).all() && page.cmplt(perspective.size()).all();
        is_on.then(|| page.to_array().map(|px| px as u32))
    });
    let hidden_by = station.hides(place)?.map(|met| station.hidden_by(&met, place)).transpose()?;
    let why_not = match (page, pixel, &hidden_by) {
        (None, ..) => Some(WhyNot::BehindTheEye),
        (_, None, _) => Some(WhyNot::BesideThePage),
        (.., Some(_)) => Some(WhyNot::Hidden),
        _ => None,
    };
    let look = direction(place - perspective.eye());
    Ok(OfAnswer {
        version: env!("CARGO_PKG_VERSION"),
        crs: station.surface.dem().georeference().file().label(),
        located: station.located(place)?,
        sighting: station.sighting(place),
        slope: station.slope(ground)?,
        seen: why_not.is_none(),
        why_not,
        page_px: page.map(|page| page.to_array()),
        pixel,
        hidden_by,
        look: look.map(|(azimuth, altitude)| [station.view.norths.counted(azimuth), altitude]),
        view: station.view_report(),
    })
}

/// The error for a place that is not on the land.
fn nothing_there(dem: &Dem, place: DVec2, own: Option<DVec2>) -> Error {
    let Whereabouts { named, within } = Whereabouts::of(dem);
    let inside = own.is_some_and(|own| {
        let [west, south, east, north] = dem.extent();
        (west..=east).contains(&own.x) && (south..=north).contains(&own.y)
    });
    let what = match inside {
        true => format!("the DEM has no data at {},{}", place.x, place.y),
        false => format!("{},{} is no place of the DEM", place.x, place.y),
    };
    let on_globe = format!(" in {named}, or its longitude and latitude");
    let on_globe = if dem.georeference().globe().is_ok_and(|globe| globe.is_some()) { on_globe } else { String::new() };
    Error::setting(Setting::Of, what, format!("give one with data {within}{on_globe}"))
}

impl Answer for OfAnswer {
    fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("place", self.located.words()), ("elevation", self.located.elevation())];
        rows.extend(self.sighting.rows());
        rows.extend([("slope", self.slope.words()), ("page", self.on_page()), ("seen", self.seen_words())]);
        rows
    }
}

impl OfAnswer {
    fn on_page(&self) -> String {
        match (self.page_px, self.pixel) {
            (None, _) => "none: it lies behind the eye".to_owned(),
            (Some([x, y]), Some([column, row])) => format!("pixel {column},{row}, at {x:.2},{y:.2} px"),
            (Some([x, y]), None) => format!("none: {x:.2},{y:.2} px lies beside it"),
        }
    }

    fn seen_words(&self) -> String {
        let turned = self.look.map(|[azimuth, altitude]| format!("--azimuth {azimuth} --altitude {altitude}"));
        let turned = turned.map_or(String::new(), |flags| format!("; {flags} looks at it"));
        let hidden = self.hidden_by.as_ref().map(|hidden| format!("hidden by land {}", hidden.words()));
        match (self.why_not, hidden) {
            (None, _) => "yes".to_owned(),
            (Some(WhyNot::Hidden), Some(hidden)) => format!("no: {hidden}"),
            (Some(WhyNot::BehindTheEye), hidden) => format!("no: behind the eye{}{turned}", also(hidden)),
            (Some(_), hidden) => format!("no: beside the page{}{turned}", also(hidden)),
        }
    }
}

fn also(hidden: Option<String>) -> String {
    hidden.map_or(String::new(), |hidden| format!(", and {hidden}"))
}
