//! A place of the land in the coordinates that people use, and how it is seen from an eye.

use serde::Serialize;

use crate::dem::Dem;

/// Decimals of metres, degrees of direction and degrees of longitude where a cell is a metre or more.
const METRES: usize = 2;
const DIRECTION: usize = 2;
const COORDINATES: usize = 3;
const LONLAT: usize = 8;

/// Where something lies: in the system of the DEM's file, on the globe, and how high. Heights are without exaggeration.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Located {
    /// In the CRS of the DEM's file; `None` where that has no such place.
    pub place: Option<[f64; 2]>,
    pub lonlat: Option<[f64; 2]>,
    pub elevation_m: f64,
    #[serde(skip)]
    pub decimals: Decimals,
}

/// How it lies from the eye, on a flat Earth.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Sighting {
    pub distance_m: f64,
    /// On the map.
    pub map_distance_m: f64,
    /// Degrees clockwise from true north and from grid north at the eye; `None` straight above or below it, and where nobody
    /// knows that north.
    pub true_bearing: Option<f64>,
    pub grid_bearing: Option<f64>,
    /// Degrees above the horizon.
    pub vertical_angle: f64,
    #[serde(skip)]
    pub decimals: Decimals,
}

/// How the land lies there.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Slope {
    /// Degrees from level.
    pub slope: f64,
    /// Where it falls to, degrees clockwise from true north, or from grid north where that is all that is known; `None` where it is
    /// level.
    pub falls_towards: Option<f64>,
    #[serde(skip)]
    pub north: &'static str,
}

/// The land that hides a place.
#[derive(Serialize)]
pub(super) struct HiddenBy {
    #[serde(flatten)]
    pub located: Located,
    #[serde(flatten)]
    pub sighting: Sighting,
    /// So many metres above its ground the place is seen; `None` where it never is.
    pub seen_from_m: Option<f64>,
}

/// Decimals of metres and of degrees that tell a hundredth of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decimals {
    more: usize,
    is_geographic: bool,
}

impl Decimals {
    /// Of places of a DEM.
    pub(super) fn of(dem: &Dem) -> Self {
        let smallest = dem.cell().min_element().log10().floor();
        let is_geographic = dem.georeference().file().is_geographic();
        Self { more: (-smallest).clamp(0.0, 6.0) as usize, is_geographic }
    }

    fn metres(self, metres: f64) -> String {
        unsigned(metres, METRES + self.more)
    }

    fn pair(self, [x, y]: [f64; 2], decimals: usize) -> String {
        format!("{x:.0$},{y:.0$}", decimals + self.more)
    }
}

impl Located {
    /// Its coordinates.
    pub(super) fn words(&self) -> String {
        let lonlat = self.lonlat.map(|place| self.decimals.pair(place, LONLAT));
        let decimals = if self.decimals.is_geographic { LONLAT } else { COORDINATES };
        let place = self.place.map(|place| self.decimals.pair(place, decimals));
        match (place, lonlat) {
            (Some(place), Some(lonlat)) if !self.decimals.is_geographic => {
                format!("{place} (longitude, latitude {lonlat})")
            }
            (Some(place), _) | (None, Some(place)) => place,
            (None, None) => "nowhere on the map of the file".to_owned(),
        }
    }

    pub(super) fn elevation(&self) -> String {
        format!("{} m", self.decimals.metres(self.elevation_m))
    }
}

impl Sighting {
    pub(super) fn rows(&self) -> [(&'static str, String); 3] {
        let [slant, map] = [self.distance_m, self.map_distance_m].map(|metres| self.decimals.metres(metres));
        [
            ("distance", format!("{slant} m, on the map {map} m")),
            ("bearing", bearing(self.true_bearing, self.grid_bearing)),
            ("angle", above_horizon(self.vertical_angle)),
        ]
    }

    /// How far it is.
    pub(super) fn distance(&self) -> String {
        format!("{} m", self.decimals.metres(self.distance_m))
    }
}

impl Slope {
    pub(super) fn words(&self) -> String {
        let Self { slope, falls_towards, north } = self;
        let towards = falls_towards.map(|to| format!(", falling towards {} degrees from {north} north", direction(to)));
        format!("{slope:.DIRECTION$} degrees{}", towards.unwrap_or_default())
    }
}

impl HiddenBy {
    /// How far that lies, where, and how high.
    pub(super) fn words(&self) -> String {
        let from = self.seen_from_m.map(|metres| format!("; from {metres:.1} m above its ground on it is seen"));
        let (away, at, high) = (self.sighting.distance(), self.located.words(), self.located.elevation());
        format!("{away} away at {at}, {high} high{}", from.unwrap_or_default())
    }
}

/// A direction that is known from one north, from both, or from none.
pub(super) fn bearing(true_bearing: Option<f64>, grid_bearing: Option<f64>) -> String {
    match (true_bearing.map(direction), grid_bearing.map(direction)) {
        (Some(of_true), Some(of_grid)) => format!("{of_true} degrees from true north, {of_grid} from grid north"),
        (Some(of_true), None) => format!("{of_true} degrees from true north"),
        (None, Some(of_grid)) => format!("{of_grid} degrees from grid north; true north is unknown"),
        (None, None) => "none: straight above or below the eye, or no north is known".to_owned(),
    }
}

/// A bearing to its decimals, below 360.
fn direction(degrees: f64) -> String {
    let text = format!("{degrees:.DIRECTION$}");
    if text == "360.00" { "0.00".to_owned() } else { text }
}

/// A vertical angle, degrees.
pub(super) fn above_horizon(degrees: f64) -> String {
    format!("{} degrees above the horizon", unsigned(degrees, DIRECTION))
}

/// A number to so many decimals; no -0 is printed.
fn unsigned(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { text.trim_start_matches('-').to_owned() } else { text }
}
