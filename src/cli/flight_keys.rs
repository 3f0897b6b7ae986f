//! Flights that people write: TOML with a table `[[key]]` for each place on the way.
//!
//! ```toml
//! crs = "EPSG:4326"                  # of `place` and `look`; by default that of the DEM
//! north = "true"                     # what azimuths are counted from: "grid" or "true"
//!
//! [[key]]
//! place = [547500, 4183300, "+300"]  # easting, northing, exaggerated metres of height or "+H" above the ground;
//!                                    # or lonlat = [longitude, latitude, height], degrees
//! look = [541000, 4190000]           # what the page's middle shows, in the coordinates of the place, and a height;
//!                                    # or azimuth = 318 and altitude = -6, degrees
//! fov = 50                           # degrees across the page
//! time = 0                           # seconds, rising from key to key
//! ```
//!
//! All but the place may be left out, of all keys alike: a flight looks at places or in directions, is timed or not, all the
//! way. Not handled: flights that look where they go on one stretch and at a place on the next.

use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::values::{self, LookAt, Standpoint};
use crate::dem::North;
use crate::error::{Error, Result};
use crate::files::typed;

/// What to do about what is wrong in general.
const SEE: &str = "see the keys in `hachure fly --help`";

/// The keys of a flight.
#[derive(Debug, Clone)]
pub(crate) struct Keys {
    /// The number of the system of places.
    pub crs: Option<u32>,
    /// What azimuths are counted from.
    pub north: Option<North>,
    /// In order, two at least.
    pub keys: Vec<Key>,
}

/// A place on the way.
#[derive(Debug, Clone)]
pub(crate) struct Key {
    /// Where the eye is.
    pub place: Standpoint,
    /// Whether that, and what is looked at, are degrees of longitude and latitude.
    pub lonlat: bool,
    /// What is looked at.
    pub look: Option<LookAt>,
    /// Degrees clockwise from north.
    pub azimuth: Option<f64>,
    /// Degrees above the horizon.
    pub altitude: Option<f64>,
    /// Degrees across the page.
    pub fov: Option<f64>,
    /// Seconds.
    pub time: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    crs: Option<Spanned<String>>,
    north: Option<North>,
    #[serde(default)]
    key: Vec<Spanned<KeyEntry>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyEntry {
    place: Option<Vec<Coordinate>>,
    lonlat: Option<Vec<Coordinate>>,
    look: Option<Vec<f64>>,
    azimuth: Option<f64>,
    altitude: Option<f64>,
    fov: Option<f64>,
    time: Option<f64>,
}

/// A number, or a height above the ground.
#[derive(Deserialize)]
#[serde(untagged, expecting = "want numbers, of which a height may be text: \"+300\" above the ground")]
enum Coordinate {
    Number(f64),
    Text(String),
}

/// The keys of a file.
///
/// # Errors
/// [`Error::Input`] where it cannot be read, or is none: where in it, what, and what was meant.
pub(crate) fn read(path: &Path) -> Result<Keys> {
    let text = typed::text(path, "TOML")?;
    let file: File = toml::from_str(&text).map_err(|e| typed::mistake(&text, path, &e, SEE))?;
    let wrong = |span: std::ops::Range<usize>, what: String, remedy: &str| {
        Error::input(path, format!("{}{what}", typed::place(&text, &span)), remedy.to_owned())
    };
    let crs = file.crs.map(|crs| {
        values::epsg(crs.get_ref())
            .map_err(|want| wrong(crs.span(), format!("`{}` is no system", crs.get_ref()), &want))
    });
    let spans: Vec<_> = file.key.iter().map(Spanned::span).collect();
    let keys = file.key.into_iter().map(|entry| {
        let span = entry.span();
        entry.into_inner().key().map_err(|what| wrong(span, what, SEE))
    });
    let keys: Vec<Key> = keys.collect::<Result<_>>()?;
    if keys.len() < 2 {
        let what = if keys.is_empty() { "holds no key" } else { "holds one key" };
        return Err(Error::input(path, what, "write a table [[key]] for each of two places at least"));
    }
    for (key, span) in keys.iter().zip(&spans) {
        for (first, (name, given)) in keys[0].optional().into_iter().zip(key.optional()) {
            if first.1 != given {
                let has = if given { "has" } else { "lacks" };
                let what = format!("this key {has} `{name}`, unlike the first");
                return Err(wrong(span.clone(), what, &format!("give `{name}` to all keys or to none")));
            }
        }
    }
    for (pair, span) in keys.windows(2).zip(&spans[1..]) {
        let [before, key] = pair else { continue };
        match (before.time, key.time) {
            (Some(before), Some(time)) if time <= before => {
                let what = format!("time {time} does not come after {before}, that of the key before");
                return Err(wrong(span.clone(), what, "let times rise from key to key"));
            }
            (None, _) if before.place.place == key.place.place => {
                let what = "stands where the key before does".to_owned();
                return Err(wrong(span.clone(), what, "leave one of them out, or give all keys a time"));
            }
            _ => (),
        }
    }
    Ok(Keys { crs: crs.transpose()?, north: file.north, keys })
}

impl KeyEntry {
    fn key(self) -> std::result::Result<Key, String> {
        let joined = |parts: Vec<Coordinate>| parts.into_iter().map(Coordinate::text).collect::<Vec<_>>().join(",");
        let (place, lonlat) = match (self.place, self.lonlat) {
            (Some(place), None) => (values::eye(&joined(place)).map_err(|want| format!("`place`: {want}"))?, false),
            (None, Some(place)) => (values::lonlat(&joined(place)).map_err(|want| format!("`lonlat`: {want}"))?, true),
            _ => return Err("want either `place` or `lonlat`".into()),
        };
        let look = self.look.map(|look| {
            let text = look.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
            values::look_at(&text).map_err(|want| format!("`look`: {want}"))
        });
        let number = |name: &str, number: Option<f64>, parse: fn(&str) -> std::result::Result<f64, String>| {
            let parsed = number.map(|number| parse(&number.to_string()));
            parsed.transpose().map_err(|want| format!("`{name}`: {want}"))
        };
        let key = Key {
            place,
            lonlat,
            look: look.transpose()?,
            azimuth: number("azimuth", self.azimuth, values::azimuth)?,
            altitude: number("altitude", self.altitude, values::altitude)?,
            fov: number("fov", self.fov, values::fov)?,
            time: number("time", self.time, values::number)?,
        };
        match key.look {
            Some(_) if key.azimuth.is_some() => Err("`look` and `azimuth` both say where to look".into()),
            Some(_) if key.altitude.is_some() => Err("`look` and `altitude` both say where to look".into()),
            _ => Ok(key),
        }
    }
}

impl Key {
    /// What may be left out, and whether it is there.
    fn optional(&self) -> [(&'static str, bool); 5] {
        [
            ("look", self.look.is_some()),
            ("azimuth", self.azimuth.is_some()),
            ("altitude", self.altitude.is_some()),
            ("fov", self.fov.is_some()),
            ("time", self.time.is_some()),
        ]
    }
}

impl Coordinate {
    fn text(self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text,
        }
    }
}
