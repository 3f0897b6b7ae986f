//! A flight that was asked for and read, before its DEM is there; and its place in the DEM's world.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use super::flight::FlightArguments;
use super::flight_keys::{Key, Keys};
use super::norths::Norths;
use super::values::{GivenHeight, LookAt};
use super::viewpoint::{FOV, above, world};
use crate::dem::{Crs, Dem, North, Whereabouts};
use crate::error::{Error, Result, Setting, shown};
use crate::geo::Track;
use crate::message;
use crate::surface::{Level, Surface};
use crate::view::flight::{self, Course, Flight, Look, Stop, Way};

/// The clearance unless told otherwise, in cells and in shares of a height above the ground.
const CLEARANCE_CELLS: f64 = 2.0;
const CLEARANCE_SHARE: f64 = 0.5;
/// The height of a circle above the ground in its middle, in radii.
const ORBIT_HEIGHT: f64 = 0.5;

/// Where a flight comes from.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    /// A circle; in the CRS of the flags, metres.
    Orbit { centre: DVec2, radius: f64 },
    /// A vector file.
    Track(PathBuf, Track),
    /// A file of keys.
    Keys(PathBuf, Keys),
}

/// A flight before its DEM.
#[derive(Debug, Clone)]
pub struct FlightPlan {
    pub(super) arguments: FlightArguments,
    pub(super) origin: Origin,
    pub(super) count: u32,
    pub(super) fps: f64,
}

impl Keys {
    /// Seconds from the first key to the last, where they are timed.
    pub(super) fn seconds(&self) -> Option<f64> {
        Some(self.keys.last()?.time? - self.keys.first()?.time?)
    }
}

impl FlightPlan {
    /// Frames in all.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Frames a second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// Where it leads, in words.
    pub fn described(&self) -> String {
        match &self.origin {
            Origin::Orbit { centre, .. } => format!("around {},{}", centre.x, centre.y),
            Origin::Track(path, _) | Origin::Keys(path, _) => format!("along {}", shown(path)),
        }
    }

    /// What was taken of a vector file, in words.
    pub fn taken(&self) -> Option<&str> {
        if let Origin::Track(_, track) = &self.origin { Some(&track.taken) } else { None }
    }

    /// The flight in the world of a DEM whose elevations are multiplied by `exaggeration`, over its surface at a level.
    ///
    /// # Errors
    /// [`Error::Input`] where the path is not over the DEM, [`Error::Setting`] for places that its map does not have, and
    /// those of [`Flight::new`].
    pub fn flight(&self, surface: &Surface, level: Level, exaggeration: f64) -> Result<Flight> {
        let way = self.way(surface, exaggeration)?;
        let look = self.look(surface, level, &way)?;
        self.check_place(surface.dem(), &way, &look)?;
        let keys = self.keys();
        let of_keys = |number: fn(&Key) -> Option<f64>| keys.iter().map(number).collect::<Option<Vec<f64>>>();
        let of_keys = |number| of_keys(number).filter(|numbers| !numbers.is_empty());
        let fov = self.arguments.fov.unwrap_or(FOV);
        let size = self.arguments.size();
        let course = Course {
            clearance: self.clearance(surface.dem(), &way),
            altitudes: self.arguments.altitude.map(|altitude| vec![altitude]).or_else(|| of_keys(|key| key.altitude)),
            fovs: of_keys(|key| key.fov).unwrap_or_else(|| vec![fov]),
            size: [size.width, size.height],
            count: self.count,
            ahead: self.arguments.look_ahead,
            way,
            look,
        };
        let flight = Flight::new(&course, surface, level)?;
        if course.look == Look::Ahead && !flight.is_over_land() {
            return Err(self.outside(surface.dem()));
        }
        surface.dem().check()?;
        Ok(flight)
    }

    fn keys(&self) -> &[Key] {
        if let Origin::Keys(_, keys) = &self.origin { &keys.keys } else { &[] }
    }

    fn way(&self, surface: &Surface, exaggeration: f64) -> Result<Way> {
        let dem = surface.dem();
        let typed = self.arguments.height.map(height);
        match &self.origin {
            Origin::Orbit { centre, radius } => {
                let crs = self.arguments.crs.map(Crs::from_epsg).transpose()?;
                let centre = world(dem, crs.as_ref(), *centre, Setting::Orbit)?;
                let height = typed.unwrap_or(flight::Height::AboveGround(ORBIT_HEIGHT * radius));
                Ok(Way::Around { centre, radius: *radius, height })
            }
            Origin::Track(path, track) => {
                let own = |i: usize| match track.heights.as_ref().and_then(|heights| heights.get(i)) {
                    Some(h) if track.above_ground => flight::Height::AboveGround(*h),
                    Some(z) => flight::Height::Absolute(z * exaggeration),
                    None => flight::Height::AboveGround(0.0),
                };
                let places = placed(path, dem, track.crs.as_ref(), &track.places)?;
                let stop = |(i, place)| Stop { place, height: typed.unwrap_or_else(|| own(i)), time: None };
                Ok(Way::Through(places.into_iter().enumerate().map(stop).collect()))
            }
            Origin::Keys(path, keys) => {
                let stop = |key: &Key| {
                    let place = placed(path, dem, system(keys, key, dem)?.as_ref(), &[key.place.place])?;
                    Ok(Stop { place: place[0], height: height(key.place.height), time: key.time })
                };
                Ok(Way::Through(keys.keys.iter().map(stop).collect::<Result<_>>()?))
            }
        }
    }

    fn look(&self, surface: &Surface, level: Level, way: &Way) -> Result<Look> {
        let dem = surface.dem();
        let at = |crs: Option<&Crs>, at: LookAt, setting| {
            let height = at.height.map_or(GivenHeight::AboveGround(0.0), GivenHeight::Absolute);
            above(surface, level, world(dem, crs, at.place, setting)?, height, setting)
        };
        if let Some(typed) = self.arguments.look_at {
            let crs = self.arguments.crs.map(Crs::from_epsg).transpose()?;
            return Ok(Look::At(vec![at(crs.as_ref(), typed, Setting::LookAt)?]));
        }
        match (&self.origin, way) {
            (Origin::Orbit { .. }, Way::Around { centre, .. }) => {
                Ok(Look::At(vec![above(surface, level, *centre, GivenHeight::AboveGround(0.0), Setting::Orbit)?]))
            }
            (Origin::Keys(path, keys), Way::Through(stops)) => {
                let looked = keys.keys.iter().filter_map(|key| Some((key, key.look?)));
                let targets: Vec<DVec3> = looked
                    .map(|(key, look)| {
                        let crs = system(keys, key, dem)?;
                        at(crs.as_ref(), look, Setting::LookAt).map_err(|error| of_file(path, error))
                    })
                    .collect::<Result<_>>()?;
                let azimuths: Vec<f64> = keys
                    .keys
                    .iter()
                    .zip(stops)
                    .filter_map(|(key, stop)| Some((key, key.azimuth?, stop.place)))
                    .map(|(key, azimuth, eye)| {
                        let in_degrees = key.lonlat || dem.georeference().file().is_geographic();
                        let north = keys.north.unwrap_or(if in_degrees { North::True } else { North::Grid });
                        Ok(Norths::at(dem.georeference(), north, eye)?.in_world(azimuth))
                    })
                    .collect::<Result<_>>()?;
                Ok(match (targets.is_empty(), azimuths.is_empty()) {
                    (false, _) => Look::At(targets),
                    (_, false) => Look::Towards(azimuths),
                    _ => Look::Ahead,
                })
            }
            _ => Ok(Look::Ahead),
        }
    }

    /// Exaggerated metres above the ground.
    fn clearance(&self, dem: &Dem, way: &Way) -> f64 {
        let heights: Vec<flight::Height> = match way {
            Way::Around { height, .. } => vec![*height],
            Way::Through(stops) => stops.iter().map(|stop| stop.height).collect(),
        };
        let above = heights.into_iter().filter_map(|height| match height {
            flight::Height::AboveGround(h) => Some(h),
            flight::Height::Absolute(_) => None,
        });
        let cells = CLEARANCE_CELLS * dem.cell().element_product().sqrt();
        let lowest = above.fold(f64::INFINITY, f64::min);
        self.arguments.clearance.unwrap_or_else(|| (CLEARANCE_SHARE * lowest).min(cells).max(0.0))
    }

    /// Fails where a path that looks ahead, or is above the ground, has no place over the DEM.
    fn check_place(&self, dem: &Dem, way: &Way, look: &Look) -> Result<()> {
        let Way::Through(stops) = way else { return Ok(()) };
        let [west, south, east, north] = dem.extent();
        let places = || stops.iter().map(|stop| stop.place);
        let low = places().reduce(DVec2::min).unwrap_or_default();
        let high = places().reduce(DVec2::max).unwrap_or_default();
        let beside = low.x > east || high.x < west || low.y > north || high.y < south;
        let above = stops.iter().any(|stop| matches!(stop.height, flight::Height::AboveGround(_)));
        if beside && (above || *look == Look::Ahead) { Err(self.outside(dem)) } else { Ok(()) }
    }

    /// The error for a path that is nowhere over the DEM.
    fn outside(&self, dem: &Dem) -> Error {
        let Whereabouts { named, within } = Whereabouts::of(dem);
        let (path, places, crs) = match &self.origin {
            Origin::Track(path, track) => (path.as_path(), track.places.clone(), track.crs.as_ref().map(Crs::label)),
            Origin::Keys(path, keys) => (path.as_path(), keys.keys.iter().map(|key| key.place.place).collect(), None),
            Origin::Orbit { .. } => (Path::new("orbit"), Vec::new(), None),
        };
        let low = places.iter().copied().reduce(DVec2::min).unwrap_or_default();
        let high = places.iter().copied().reduce(DVec2::max).unwrap_or_default();
        let system = crs.map_or_else(String::new, |label| format!(" of {label}"));
        let what = format!(
            "lies outside the DEM: between {},{} and {},{}{system}, and the DEM {within} of {named}",
            low.x, low.y, high.x, high.y
        );
        let remedy = message![
            "give a path over the DEM, x first, or what to look at from beside it: ",
            Setting::LookAt.with_value()
        ];
        Error::input(path, what, remedy)
    }

    /// All that the flight depends on beside the DEM and the page, whatever its file is called: equal bytes are equal flights.
    pub fn hashed(&self) -> Vec<u8> {
        let FlightArguments { height, clearance, look_at, look_ahead, altitude, fov, crs, .. } = &self.arguments;
        let mut bytes = Bytes::default();
        [FORMAT, self.count].into_iter().for_each(|number| bytes.number(f64::from(number)));
        bytes.height(*height);
        [*clearance, *look_ahead, *altitude, *fov, crs.map(f64::from)]
            .into_iter()
            .for_each(|number| bytes.perhaps(number));
        bytes.look(*look_at);
        match &self.origin {
            Origin::Orbit { centre, radius } => {
                [0.0, centre.x, centre.y, *radius].into_iter().for_each(|number| bytes.number(number))
            }
            Origin::Track(_, track) => {
                bytes.number(1.0);
                bytes.text(track.crs.as_ref().map_or("", Crs::wkt));
                bytes.number(f64::from(u8::from(track.above_ground)));
                bytes.number(track.places.len() as f64);
                for (i, place) in track.places.iter().enumerate() {
                    place.to_array().into_iter().for_each(|number| bytes.number(number));
                    bytes.perhaps(track.heights.as_ref().and_then(|heights| heights.get(i).copied()));
                }
            }
            Origin::Keys(_, keys) => {
                bytes.number(2.0);
                bytes.perhaps(keys.crs.map(f64::from));
                bytes.text(&keys.north.map_or_else(String::new, |north| north.to_string()));
                for Key { place, lonlat, look, azimuth, altitude, fov, time } in &keys.keys {
                    [f64::from(u8::from(*lonlat)), place.place.x, place.place.y]
                        .into_iter()
                        .for_each(|number| bytes.number(number));
                    bytes.height(Some(place.height));
                    bytes.look(*look);
                    [*azimuth, *altitude, *fov, *time].into_iter().for_each(|number| bytes.perhaps(number));
                }
            }
        }
        bytes.0
    }
}

/// Raise it when the same flags and files lead to other cameras.
const FORMAT: u32 = 1;

/// Numbers and texts one after another, each so that nothing else reads the same.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn number(&mut self, number: f64) {
        // 0 and -0 are one place.
        self.0.extend((number + 0.0).to_bits().to_le_bytes());
    }

    fn perhaps(&mut self, number: Option<f64>) {
        self.0.push(u8::from(number.is_some()));
        number.into_iter().for_each(|number| self.number(number));
    }

    fn text(&mut self, text: &str) {
        self.0.extend((text.len() as u64).to_le_bytes());
        self.0.extend(text.as_bytes());
    }

    fn height(&mut self, height: Option<GivenHeight>) {
        let [absolute, above] = match height {
            Some(GivenHeight::Absolute(z)) => [Some(z), None],
            Some(GivenHeight::AboveGround(h)) => [None, Some(h)],
            None => [None; 2],
        };
        self.perhaps(absolute);
        self.perhaps(above);
    }

    fn look(&mut self, look: Option<LookAt>) {
        [look.map(|look| look.place.x), look.map(|look| look.place.y), look.and_then(|look| look.height)]
            .into_iter()
            .for_each(|number| self.perhaps(number));
    }
}

/// A height as flights have it.
fn height(height: GivenHeight) -> flight::Height {
    match height {
        GivenHeight::Absolute(z) => flight::Height::Absolute(z),
        GivenHeight::AboveGround(h) => flight::Height::AboveGround(h),
    }
}

/// The system of a key's places; `None` for that of the DEM.
fn system(keys: &Keys, key: &Key, dem: &Dem) -> Result<Option<Crs>> {
    if !key.lonlat {
        return keys.crs.map(Crs::from_epsg).transpose();
    }
    match dem.georeference().globe()? {
        Some(globe) => Ok(Some(globe)),
        None => Crs::lonlat().map(Some),
    }
}

/// World places of those of a file.
fn placed(path: &Path, dem: &Dem, crs: Option<&Crs>, places: &[DVec2]) -> Result<Vec<DVec2>> {
    let georeference = dem.georeference();
    let given = crs.unwrap_or(georeference.file());
    let Whereabouts { named, within } = Whereabouts::of(dem);
    Whereabouts::check_way(dem, path, given, "keys")?;
    let carried = georeference.world_places(given, places);
    let lost = carried.iter().position(Option::is_none);
    if let Some(place) = lost.and_then(|lost| places.get(lost)) {
        let what = format!(
            "{},{} of {} is no place on the map of the DEM, which lies in {named}",
            place.x,
            place.y,
            given.label()
        );
        return Err(Error::input(path, what, format!("check the order, x first; the DEM lies {within}")));
    }
    Ok(carried.into_iter().flatten().collect())
}

/// An error about a setting as one about a file that holds it.
fn of_file(path: &Path, error: Error) -> Error {
    match error {
        Error::Setting { what, remedy, .. } => Error::input(path, message!["`look`: ", what], remedy),
        other => other,
    }
}
