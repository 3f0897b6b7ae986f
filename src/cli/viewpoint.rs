//! Flags of the view: where the eye stands, in whatever coordinates, and where it looks.
//!
//! Every eye ends as a place in the DEM's file with few decimals, so that the flags printed for it repeat the picture.

use glam::{DVec2, DVec3};

use super::choices;
use super::norths::Norths;
use super::talk::Talk;
use super::values::{self, GivenHeight, LookAt, Size, Standpoint};
use super::words::flag;
use crate::dem::{Crs, Dem, Georeference, North, Whereabouts};
use crate::error::{Error, Result, Setting};
use crate::surface::{Level, Surface};
use crate::view::{Camera, Fixed, choose, direction};

/// Horizontal field of view unless told otherwise, degrees.
pub const FOV: f64 = 60.0;
/// Decimals of printed degrees of longitude and latitude: a millimetre.
const DEGREE_DECIMALS: i32 = 8;
/// Decimals of an eye on the globe: the least that bring it to the same millimetre nearly everywhere, and the most that f64
/// has.
const LONLAT_DECIMALS: std::ops::RangeInclusive<i32> = 9..=13;
/// Decimals of other printed coordinates.
const METRE_DECIMALS: i32 = 3;
/// Longitude and latitude on Earth, in the register of EPSG.
const WGS84: u32 = 4326;
/// By how much an eye that is printed with them may be off, and a little more for what f32 rounds: metres.
const ROUNDED: f64 = 0.001;

/// Pixels of a page unless told otherwise.
pub const SIZE: Size = Size { width: 1920, height: 1080 };

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "View")]
pub(crate) struct ViewArguments {
    /// Eye: easting, northing (x first, degrees too) in the CRS of the first DEM; exaggerated height in metres, or +H above the ground
    #[arg(long, value_name = "E,N,Z|E,N,+H", value_parser = values::eye, allow_hyphen_values = true, group = "standpoint")]
    eye: Option<Standpoint>,
    /// Eye: longitude, latitude in degrees (WGS 84; elsewhere than on Earth those of the DEM); exaggerated height in metres, or +H above the ground
    #[arg(long, value_name = "LON,LAT,Z|+H", value_parser = values::lonlat, allow_hyphen_values = true, group = "standpoint")]
    lonlat: Option<Standpoint>,
    /// What the middle of the page shows: easting, northing in the CRS of the DEM; exaggerated metres [default: ground]
    #[arg(
        long, value_name = "E,N[,Z]", value_parser = values::look_at, allow_hyphen_values = true,
        requires = "standpoint", conflicts_with_all = ["azimuth", "altitude"]
    )]
    look_at: Option<LookAt>,
    /// The CRS in which --eye and --look-at are given [default: the CRS of the DEM]
    #[arg(long, value_name = "EPSG:N", value_parser = values::epsg)]
    crs: Option<u32>,
    /// What azimuths are counted from [default: true with --lonlat and for DEMs in degrees, else grid]
    ///
    /// Where the two are over 1 degree apart, `draw` and `info` say so. Within 100 m of a pole there is no true north.
    #[arg(long, value_parser = choices::north())]
    north: Option<North>,
    /// Direction of view, degrees clockwise from north [default: towards the middle of the DEM]
    #[arg(long, value_name = "DEG", value_parser = values::azimuth, allow_hyphen_values = true)]
    azimuth: Option<f64>,
    /// Direction of view, degrees above the horizon, -90 to 90 [default: level, from a given eye]
    #[arg(long, value_name = "DEG", value_parser = values::altitude, allow_hyphen_values = true)]
    altitude: Option<f64>,
    /// Horizontal field of view, degrees
    #[arg(long, value_name = "DEG", value_parser = values::fov, allow_hyphen_values = true, default_value_t = FOV)]
    fov: f64,
    #[arg(long, value_name = "WxH", value_parser = values::size, help = values::size_help(SIZE))]
    size: Option<Size>,
}

/// A view found, with its eye in the coordinates of the DEM's file and on the globe.
pub(crate) struct View {
    /// In the world.
    pub camera: Camera,
    /// Of the camera, from the north in use.
    pub azimuth: f64,
    /// What that azimuth is counted from.
    pub norths: Norths,
    /// The eye's map place in units of the file's CRS.
    pub file: DVec2,
    /// Degrees of longitude and latitude, where the DEM's CRS is of a globe.
    pub lonlat: Option<DVec2>,
    /// The same with few decimals, where typing them leads to the same eye.
    typed: Option<DVec2>,
    /// Whether that is the Earth.
    on_earth: bool,
}

impl ViewArguments {
    /// The flags of a view that a file gives.
    pub(crate) fn of_file(
        eye: Option<Standpoint>,
        lonlat: Option<Standpoint>,
        north: North,
        [azimuth, altitude]: [Option<f64>; 2],
        fov: f64,
        size: Size,
    ) -> Self {
        Self { eye, lonlat, look_at: None, crs: None, north: Some(north), azimuth, altitude, fov, size: Some(size) }
    }

    /// Pixels across and down, as typed.
    pub(crate) fn typed_size(&self) -> Option<Size> {
        self.size
    }

    /// The same flags with a page of this size.
    pub(crate) fn sized(&self, size: Size) -> Self {
        Self { size: Some(size), ..self.clone() }
    }

    /// Pixels across and down.
    pub(crate) fn size(&self) -> Size {
        self.size.unwrap_or(SIZE)
    }

    /// What says where the eye is or looks, if anything is given.
    pub(crate) fn given(&self) -> Option<Setting> {
        let given = [
            (Setting::Eye, self.eye.is_some()),
            (Setting::LonLat, self.lonlat.is_some()),
            (Setting::North, self.north.is_some()),
            (Setting::Azimuth, self.azimuth.is_some()),
            (Setting::Altitude, self.altitude.is_some()),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(setting, _)| setting)
    }

    /// Horizontal field of view, degrees.
    pub(crate) fn fov(&self) -> f64 {
        self.fov
    }

    /// The CRS in which places are given, where it is not the DEM's.
    ///
    /// # Errors
    /// As [`Crs::from_epsg`].
    pub(crate) fn crs(&self) -> Result<Option<Crs>> {
        self.crs.map(Crs::from_epsg).transpose()
    }

    /// Checks what can be checked before the DEM is read.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn check(&self) -> Result<()> {
        if self.crs.is_some() && self.eye.is_none() && self.look_at.is_none() {
            return Err(Error::setting(
                Setting::Crs,
                "says in which CRS --eye or --look-at is given",
                "add --eye or leave it out",
            ));
        }
        self.crs.map_or(Ok(()), |code| Crs::from_epsg(code).map(drop))
    }

    /// The view as asked, or as chosen; `level` is that of the drawn surface, for heights above it.
    ///
    /// # Errors
    /// [`Error::Setting`] for a place that the DEM's map does not have, or without ground where a height above it is asked.
    pub(crate) fn view(&self, surface: &Surface, level: Level) -> Result<View> {
        let georeference = surface.dem().georeference();
        let place = self.standpoint(surface.dem())?;
        let eye = match (place, self.eye.or(self.lonlat)) {
            (Some((world, _)), Some(standpoint)) => {
                let setting = if self.eye.is_some() { Setting::Eye } else { Setting::LonLat };
                Some(above(surface, level, world, standpoint.height, setting)?)
            }
            _ => None,
        };
        let fixed = self.fixed(surface, level, eye)?;
        let mut camera = choose(surface.dem(), fixed, self.fov, self.size().width, self.size().height)?;
        let file = match place {
            Some((_, file)) => file,
            None => {
                let (world, file) = settled(georeference, camera.eye.truncate())?;
                camera.eye = world.extend(camera.eye.z);
                file
            }
        };
        let norths = Norths::at(georeference, self.north(georeference), camera.eye.truncate())?;
        let azimuth = self.azimuth.unwrap_or_else(|| norths.counted(camera.azimuth));
        camera.azimuth = norths.in_world(azimuth);
        let lonlat = georeference.lonlat(camera.eye.truncate())?;
        let globe = georeference.globe()?;
        let eye = (camera.eye.truncate(), file);
        let typed = lonlat.zip(globe.as_ref()).and_then(|(lonlat, globe)| repeating(georeference, globe, lonlat, eye));
        let on_earth = globe.is_some_and(|globe| globe.epsg() == Some(WGS84));
        surface.dem().check()?;
        Ok(View { camera, azimuth, norths, file, lonlat, typed, on_earth })
    }

    /// What azimuths are counted from: people who think in degrees know no grid.
    fn north(&self, georeference: &Georeference) -> North {
        let in_degrees = self.lonlat.is_some() || georeference.file().is_geographic();
        self.north.unwrap_or(if in_degrees { North::True } else { North::Grid })
    }

    /// What is fixed of the view, in the world. An azimuth without an eye is brought there at the middle of the DEM.
    fn fixed(&self, surface: &Surface, level: Level, eye: Option<DVec3>) -> Result<Fixed> {
        if let (Some(eye), Some(look_at)) = (eye, self.look_at) {
            let towards = self.towards(surface, level, look_at)?;
            let (azimuth, altitude) = direction(towards - eye).ok_or_else(|| {
                Error::setting(
                    Setting::LookAt,
                    "is where the eye stands",
                    "give another place, or --azimuth and --altitude",
                )
            })?;
            return Ok(Fixed { eye: Some(eye), azimuth: Some(azimuth), altitude: Some(altitude) });
        }
        let turn = match (eye, self.azimuth) {
            (None, Some(_)) => {
                let [west, south, east, north] = surface.dem().extent();
                let georeference = surface.dem().georeference();
                georeference.bearings(DVec2::new(west + east, south + north) / 2.0)?.of(self.north(georeference))
            }
            _ => None,
        };
        Ok(Fixed { eye, azimuth: self.azimuth.map(|a| a + turn.unwrap_or(0.0)), altitude: self.altitude })
    }

    /// The eye's place in the world and in the file.
    fn standpoint(&self, dem: &Dem) -> Result<Option<(DVec2, DVec2)>> {
        let georeference = dem.georeference();
        if let Some(eye) = self.eye {
            let crs = self.crs()?;
            let world = world(dem, crs.as_ref(), eye.place, Setting::Eye)?;
            return match crs {
                None => Ok(Some((world, eye.place))),
                Some(_) => settled(georeference, world).map(Some),
            };
        }
        let Some(eye) = self.lonlat else { return Ok(None) };
        let globe = georeference.globe()?.ok_or_else(|| no_globe(dem, Setting::LonLat))?;
        let world = world(dem, Some(&globe), eye.place, Setting::LonLat)?;
        settled(georeference, world).map(Some)
    }

    fn towards(&self, surface: &Surface, level: Level, look_at: LookAt) -> Result<DVec3> {
        let crs = self.crs()?;
        let place = world(surface.dem(), crs.as_ref(), look_at.place, Setting::LookAt)?;
        let height = look_at.height.map_or(GivenHeight::AboveGround(0.0), GivenHeight::Absolute);
        above(surface, level, place, height, Setting::LookAt)
    }
}

impl View {
    /// The flags that repeat it.
    pub(crate) fn flags(&self) -> String {
        let DVec2 { x, y } = self.file;
        self.flags_from(&format!("--eye {x},{y},{}", self.camera.eye.z))
    }

    /// The same with the eye on the globe, where the DEM's CRS is known and some degrees lead to the very eye.
    pub(crate) fn lonlat_flags(&self) -> Option<String> {
        let DVec2 { x, y } = self.typed?;
        Some(self.flags_from(&format!("--lonlat {x},{y},{}", self.camera.eye.z)))
    }

    /// The flags with those of the eye.
    fn flags_from(&self, eye: &str) -> String {
        let Camera { altitude, fov, width, height, .. } = self.camera;
        let Self { azimuth, norths: Norths { north, .. }, .. } = self;
        format!("{eye} --north {north} --azimuth {azimuth} --altitude {altitude} --fov {fov} --size {width}x{height}")
    }

    /// The same eye, looking elsewhere: to an azimuth of the world.
    pub(crate) fn turned(&self, azimuth: f64, altitude: f64) -> Self {
        let counted = self.norths.counted(azimuth);
        let camera = Camera { azimuth: self.norths.in_world(counted), altitude, ..self.camera };
        Self { camera, azimuth: counted, ..*self }
    }

    /// Warns where the eye is below the ground of that level, by more than eyes are rounded.
    pub(crate) fn warn_below_ground(&self, surface: &Surface, level: Level, talk: &Talk) {
        let eye = self.camera.eye;
        let below = surface.height_below(eye.truncate(), level).map(|ground| ground - eye.z);
        if let Some(depth) = below.filter(|depth| *depth > ROUNDED) {
            let decimals = if depth < 0.1 { METRE_DECIMALS as usize } else { 1 };
            let depth = format!("{depth:.decimals$}");
            talk.warn(&format!("the eye is {depth} m below the ground; give --eye E,N,+H to stand above it"));
        }
    }

    /// Whether the DEM's CRS says where on Earth it lies.
    pub(crate) fn is_on_earth(&self) -> bool {
        self.on_earth && self.lonlat.is_some()
    }
}

/// World place of one given in `crs`, else in the file's own.
pub(super) fn world(dem: &Dem, crs: Option<&Crs>, place: DVec2, setting: Setting) -> Result<DVec2> {
    let georeference = dem.georeference();
    let given = crs.unwrap_or(georeference.file());
    if given != georeference.file() && georeference.globe()?.is_none() {
        return Err(no_globe(dem, setting));
    }
    georeference.world_place(given, place).ok_or_else(|| {
        let Whereabouts { named, within } = Whereabouts::of(dem);
        let what = format!(
            "no place {},{} of {} is on the map of the DEM, which lies in {named}",
            place.x,
            place.y,
            given.label()
        );
        Error::setting(
            setting,
            what,
            format!("check the order, x first, or give {} E,N without --crs {within}", typed(setting)),
        )
    })
}

/// The error for a place of the globe where the DEM is on none.
fn no_globe(dem: &Dem, setting: Setting) -> Error {
    let Whereabouts { named, within } = Whereabouts::of(dem);
    let what = match dem.georeference().file().label().is_empty() {
        true => "the DEM names no coordinate system, so other coordinates mean nothing in it".to_owned(),
        false => format!("the DEM lies in the local system {named}, which does not say where on the globe it is"),
    };
    Error::setting(
        setting,
        what,
        format!("give {} E,N in the DEM's own coordinates, without --crs, {within}", typed(setting)),
    )
}

/// The flag by which a place is given in the DEM's own coordinates.
fn typed(setting: Setting) -> &'static str {
    flag(if setting == Setting::LonLat { Setting::Eye } else { setting })
}

/// A world place moved by less than a millimetre to where its coordinates in the file have few decimals, and these.
fn settled(georeference: &Georeference, world: DVec2) -> Result<(DVec2, DVec2)> {
    let file = georeference.file();
    let decimals = match file.metres_per_unit() {
        None => DEGREE_DECIMALS,
        Some(metres) => METRE_DECIMALS + metres.log10().ceil().max(0.0) as i32,
    };
    let place = georeference.place_in(file, world).map(|place| rounded(place, decimals));
    let settled = place.and_then(|place| Some((georeference.world_place(file, place)?, place)));
    settled.ok_or_else(|| {
        let what = format!("there is no place {},{} m in the DEM's coordinate system", world.x, world.y);
        Error::setting(Setting::Eye, what, "give a place on the map of the DEM")
    })
}

/// Degrees near `lonlat` that lead to an eye in the world and in the file, when they are typed: of some maps, Krovak's for
/// one, PROJ's way back is a millimetre off, and what that makes is taken off.
fn repeating(georeference: &Georeference, globe: &Crs, lonlat: DVec2, eye: (DVec2, DVec2)) -> Option<DVec2> {
    let again = |lonlat: DVec2| georeference.place_in(globe, georeference.world_place(globe, lonlat)?);
    let righted = again(lonlat).map(|off| lonlat + (lonlat - off));
    let candidates = [Some(lonlat), righted].into_iter().flatten();
    let mut typed = candidates.flat_map(|place| LONLAT_DECIMALS.map(move |decimals| rounded(place, decimals)));
    let leads = |place: &DVec2| {
        let world = georeference.world_place(globe, *place);
        world.and_then(|world| settled(georeference, world).ok()) == Some(eye)
    };
    typed.find(leads)
}

fn rounded(place: DVec2, decimals: i32) -> DVec2 {
    let scale = 10f64.powi(decimals);
    // No -0 is printed.
    (place * scale).round() / scale + DVec2::ZERO
}

/// A map place at a height.
pub(super) fn above(
    surface: &Surface,
    level: Level,
    place: DVec2,
    height: GivenHeight,
    setting: Setting,
) -> Result<DVec3> {
    match height {
        GivenHeight::Absolute(z) => Ok(place.extend(z)),
        GivenHeight::AboveGround(h) => match surface.height_below(place, level) {
            Some(ground) => Ok(place.extend(to_millimetre(ground, h))),
            None => Err(no_ground(surface, place, setting)),
        },
    }
}

/// Metres `h` above the ground, to the millimetre, so that it prints short; never below the ground unless that was asked.
fn to_millimetre(ground: f64, h: f64) -> f64 {
    let millimetres = (ground + h) * 1e3;
    let rounded = millimetres.round() / 1e3;
    if h >= 0.0 && rounded < ground { millimetres.ceil() / 1e3 } else { rounded }
}

pub(super) fn no_ground(surface: &Surface, place: DVec2, setting: Setting) -> Error {
    let georeference = surface.dem().georeference();
    let [west, south, east, north] = surface.dem().extent();
    let corner = |x, y| georeference.place_in(georeference.file(), DVec2::new(x, y)).unwrap_or(DVec2::new(x, y));
    let (one, other, at) = (corner(west, south), corner(east, north), corner(place.x, place.y));
    let [low, high] = [one.min(other), one.max(other)];
    let height = match setting {
        Setting::LookAt => "add a height Z",
        Setting::Orbit => "add --look-at E,N,Z",
        Setting::Of => "give another place",
        _ => "give a height without +",
    };
    Error::setting(
        setting,
        format!("there is no ground at {},{} {} of the DEM", at.x, at.y, georeference.file().units()),
        format!("{height}, or a place with data between {},{} and {},{}", low.x, low.y, high.x, high.y),
    )
}
