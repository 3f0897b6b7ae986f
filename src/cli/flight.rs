//! Flags of a flight: its way, its frames, its heights and where the camera looks.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::flight_keys;
pub use super::flight_plan::FlightPlan;
use super::flight_plan::Origin;
use super::values::{self, GivenHeight, LookAt, MOST_FRAMES, Size};
use super::viewpoint::{FOV, SIZE};
use crate::dem::Crs;
use crate::error::{Error, Message, Result, Setting};
use crate::geo;
use crate::message;

/// Frames a second unless told otherwise.
const FPS: f64 = 25.0;
/// Seconds of a flight that nobody says.
pub const DURATION: f64 = 10.0;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Flight")]
pub struct FlightArguments {
    /// The way, at constant speed: the line of a file (GeoJSON, KML, GPX, GeoPackage …), FILE:LAYER of one of its layers; its
    /// heights are the land's own, in metres, and multiplied by --exaggeration. Or keys in a .toml, a table each:
    /// [[key]] place = [E, N, Z or "+H"], Z in exaggerated metres, or lonlat = […]; and of all keys or none
    /// look = [E, N] or [E, N, Z], azimuth, altitude, fov = DEG, time = seconds. Once: crs = "EPSG:N", north = "true"
    #[arg(long, value_name = "FILE")]
    pub(super) path: Option<PathBuf>,
    /// Circle clockwise around a place instead, from its south: easting, northing in the CRS of the DEM
    #[arg(long, value_name = "E,N", value_parser = values::place, allow_hyphen_values = true)]
    pub(super) orbit: Option<DVec2>,
    /// Metres from the place of --orbit
    #[arg(long, value_name = "M", value_parser = values::metres, allow_hyphen_values = true)]
    pub(super) radius: Option<f64>,

    /// Frames in all [default: --fps times --duration]
    #[arg(long, value_name = "N", value_parser = values::frames)]
    count: Option<u32>,
    #[arg(
        long, value_name = "S", value_parser = values::seconds, allow_hyphen_values = true,
        help = format!("Seconds from start to end; times of keys are stretched to them [default: those times, else {DURATION}]")
    )]
    duration: Option<f64>,
    /// Frames a second
    #[arg(long, value_name = "N", value_parser = values::fps, default_value_t = FPS)]
    fps: f64,

    /// +H: metres above the ground, smoothed, instead of the path's own heights; with --orbit above the ground in its middle
    /// [default there: half the radius]. Z: exaggerated metres, the same all the way
    #[arg(long, value_name = "+H|Z", value_parser = values::height, allow_hyphen_values = true)]
    pub(super) height: Option<GivenHeight>,
    /// Exaggerated metres that the eye keeps above the drawn surface everywhere, smoothly lifted where the way is lower
    /// [default: two cells, at most half of +H]
    #[arg(long, value_name = "M", value_parser = values::clearance, allow_hyphen_values = true)]
    pub(super) clearance: Option<f64>,

    /// What the page's middle shows all the way: easting, northing in the CRS of the DEM; exaggerated metres [default: ground]
    /// [default: where the way leads; with --orbit its middle]
    #[arg(long, value_name = "E,N[,Z]", value_parser = values::look_at, allow_hyphen_values = true)]
    pub(super) look_at: Option<LookAt>,
    /// Metres of the way ahead whose mean direction the camera takes, so that it turns before bends and never jerks [default: a
    /// twelfth of the way]
    #[arg(long, value_name = "M", value_parser = values::metres, allow_hyphen_values = true, conflicts_with_all = ["orbit", "look_at"])]
    pub(super) look_ahead: Option<f64>,
    /// Direction of view, degrees above the horizon, -90 to 90 [default: that of what is looked at; else a little down, so that
    /// the horizon stands three tenths of the page below its top]
    #[arg(long, value_name = "DEG", value_parser = values::altitude, allow_hyphen_values = true)]
    pub(super) altitude: Option<f64>,
    #[arg(
        long, value_name = "DEG", value_parser = values::fov, allow_hyphen_values = true,
        help = format!("Horizontal field of view, degrees [default: {FOV}]")
    )]
    pub(super) fov: Option<f64>,
    #[arg(long, value_name = "WxH", value_parser = values::size, help = values::size_help(SIZE))]
    size: Option<Size>,
    /// The CRS in which --orbit and --look-at are given [default: the CRS of the DEM]
    #[arg(long, value_name = "EPSG:N", value_parser = values::epsg)]
    pub(super) crs: Option<u32>,
}

impl FlightArguments {
    /// The flags of a path that is followed at these heights, on pages of this size.
    pub fn along(path: &Path, height: Option<GivenHeight>, fov: f64, size: Size) -> Self {
        Self {
            path: Some(path.to_owned()),
            orbit: None,
            radius: None,
            count: Some(1),
            duration: None,
            fps: FPS,
            height,
            clearance: None,
            look_at: None,
            look_ahead: None,
            altitude: None,
            fov: Some(fov),
            size: Some(size),
            crs: None,
        }
    }

    /// Pixels across and down, as typed.
    pub fn typed_size(&self) -> Option<Size> {
        self.size
    }

    /// The same flags with a page of this size.
    pub fn sized(&self, size: Size) -> Self {
        Self { size: Some(size), ..self.clone() }
    }

    /// Pixels across and down.
    pub fn size(&self) -> Size {
        self.size.unwrap_or(SIZE)
    }

    /// The files that are read beside the DEM.
    pub fn files(&self) -> Vec<PathBuf> {
        self.path.iter().map(|path| geo::with_layer(path).0).collect()
    }

    /// Checks what can be checked before anything is read.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub fn check(&self) -> Result<()> {
        let wrong = |setting, what: &str, remedy: Message| Err(Error::setting(setting, what, remedy));
        let orbit = || message![Setting::Orbit.with_value(), " ", Setting::Radius.with_value()];
        match (&self.path, self.orbit, self.radius) {
            (None, None, None) => {
                let remedy = message!["add ", Setting::Path.with_value(), ", or ", orbit()];
                return wrong(Setting::Path, "nothing says where the flight leads", remedy);
            }
            (Some(_), Some(_), _) => {
                return wrong(
                    Setting::Orbit,
                    "a flight takes a path or circles a place",
                    message!["leave out ", Setting::Path, " or ", Setting::Orbit],
                );
            }
            (None, Some(_), None) => {
                return wrong(
                    Setting::Orbit,
                    "nothing says how far from the place",
                    message!["add ", Setting::Radius.with_value()],
                );
            }
            (_, None, Some(_)) => {
                return wrong(
                    Setting::Radius,
                    "goes with a place that is circled",
                    message!["add ", Setting::Orbit.with_value(), ", or leave it out"],
                );
            }
            _ => (),
        }
        if self.count.is_some() && self.duration.is_some() {
            let remedy = message!["leave out ", Setting::Count, " or ", Setting::Duration];
            return wrong(Setting::Duration, "both say how many frames there are", remedy);
        }
        self.frames(None)?;
        if self.crs.is_some() && self.orbit.is_none() && self.look_at.is_none() {
            let remedy = message!["add ", Setting::LookAt.with_value(), " or leave it out; files name their own"];
            return wrong(Setting::Crs, "says in which CRS a place is given, and none is", remedy);
        }
        self.crs.map_or(Ok(()), |code| Crs::from_epsg(code).map(drop))
    }

    /// Frames in all, of a path that may say how many seconds it takes.
    fn frames(&self, seconds: Option<f64>) -> Result<u32> {
        if let Some(count) = self.count {
            return Ok(count);
        }
        let seconds = self.duration.or(seconds).unwrap_or(DURATION);
        let frames = (seconds * self.fps).round();
        if (1.0..=f64::from(MOST_FRAMES)).contains(&frames) {
            return Ok(frames as u32);
        }
        let what = format!("{seconds} s of {} frames each are {frames} frames; want 1 to {MOST_FRAMES}", self.fps);
        Err(Error::setting(
            Setting::Duration,
            what,
            message!["give another ", Setting::Duration, ", or ", Setting::Count.with_value()],
        ))
    }

    /// The flight, with the path that it takes; the DEM is not read. Files on a network only where these are allowed.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is no path, [`Error::Setting`] for flags that do not go with it.
    pub fn plan(&self, allow_remote: bool) -> Result<FlightPlan> {
        self.check()?;
        let origin = match (&self.path, self.orbit.zip(self.radius)) {
            (_, Some((centre, radius))) => Origin::Orbit { centre, radius },
            (Some(path), None) if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml")) => {
                let keys = flight_keys::read(path)?;
                self.check_keys(&keys.keys[0])?;
                Origin::Keys(path.clone(), keys)
            }
            (Some(path), None) => {
                let track = geo::track(path, allow_remote)?;
                if track.heights.is_none() && self.height.is_none() {
                    let remedy = message!["add ", Setting::Height.at("+300"), " for 300 m above the ground"];
                    return Err(Error::input(path, "its points have no heights", remedy));
                }
                Origin::Track(path.clone(), track)
            }
            (None, None) => return Err(Error::mistake("a flight without a way was not refused")),
        };
        let seconds = match &origin {
            Origin::Keys(_, keys) => keys.seconds(),
            Origin::Orbit { .. } | Origin::Track(..) => None,
        };
        Ok(FlightPlan { count: self.frames(seconds)?, fps: self.fps, arguments: self.clone(), origin })
    }

    /// Fails where flags say what keys say.
    fn check_keys(&self, key: &flight_keys::Key) -> Result<()> {
        let looks = key.look.is_some() || key.azimuth.is_some();
        let twice = [
            (Setting::Height, self.height.is_some(), true, "heights"),
            (Setting::LookAt, self.look_at.is_some(), looks || key.altitude.is_some(), "directions"),
            (Setting::Altitude, self.altitude.is_some(), key.altitude.is_some() || key.look.is_some(), "altitudes"),
            (Setting::Fov, self.fov.is_some(), key.fov.is_some(), "fields of view"),
        ];
        match twice.into_iter().find(|(_, typed, keyed, _)| *typed && *keyed) {
            Some((setting, _, _, what)) => {
                let what = format!("the keys of the path have {what} of their own");
                Err(Error::setting(setting, what, "leave it out, or them"))
            }
            None => Ok(()),
        }
    }
}
