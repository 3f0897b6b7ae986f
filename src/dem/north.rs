//! Where north is on a map: the bearings of grid north and of true north at a place, and how far they are apart.
//!
//! Grid north is where the second coordinate of the file's own system grows, true north where latitude does. Both are
//! found from the 2 x 2 derivative of those coordinates in the world, by differences over two metres, so that they hold for
//! any projection, sheared ones too. Their error: some 1e-7 degrees from the noise of the projection, and within a
//! kilometre of a pole up to the square of 1 m over the distance to it. Cost: five places carried for each. Not handled:
//! magnetic north, and places within 100 m of a pole, which have none.

use std::fmt::{self, Display, Formatter};

use glam::{DMat2, DVec2};
use serde::{Deserialize, Serialize};

use super::Georeference;
use crate::error::Result;

/// Half the way over which differences are taken, metres.
const STEP: f64 = 1.0;
/// Nearer to a pole north is nowhere: metres.
const POLE: f64 = 100.0;
/// Norths no farther apart are one to those who look at a picture: degrees.
const SMALL: f64 = 1.0;
/// By how much of a unit axes that are the world's may seem to leave them.
const SAME_AXES: f64 = 1e-6;

/// What azimuths are counted from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum North {
    /// Of the grid lines of the file's own system; in degrees, of the meridian.
    #[default]
    Grid,
    /// Of the meridian.
    True,
}

/// What other stages and tests look into.
#[doc(hidden)]
impl North {
    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Grid => Self::True,
            Self::True => Self::Grid,
        }
    }
}

/// As typed.
impl Display for North {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(match self {
            Self::Grid => "grid",
            Self::True => "true",
        })
    }
}

/// Where the norths are at a place, degrees clockwise from the world's y axis; `None` where nobody knows, or within 100 m
/// of a pole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearings {
    /// Of grid north: 0 to the last bit where the grid of the file is the world's.
    pub grid: Option<f64>,
    /// Of true north.
    pub true_north: Option<f64>,
}

impl Bearings {
    /// Of one of them.
    pub fn of(&self, north: North) -> Option<f64> {
        match north {
            North::Grid => self.grid,
            North::True => self.true_north,
        }
    }

    /// Degrees from true north clockwise to grid north, -180 to 180.
    pub fn convergence(&self) -> Option<f64> {
        Some(wrapped(self.grid? - self.true_north?, 360.0))
    }
}

impl Georeference {
    /// The bearings of both norths at a place of the world, metres.
    ///
    /// # Errors
    /// Those of [`Self::lonlat`].
    pub fn bearings(&self, world: DVec2) -> Result<Bearings> {
        Ok(Bearings { grid: self.grid_north(world), true_north: self.true_north(world)? })
    }

    fn grid_north(&self, world: DVec2) -> Option<f64> {
        let file = self.file();
        if file == self.world() {
            return Some(0.0);
        }
        let place = |at| self.place_in(file, at);
        let axes = Axes::of(&place, world, place(world)?, file.turn())?;
        Some(if axes.are_the_worlds(file.metres_per_unit()) { 0.0 } else { axes.bearing() })
    }

    fn true_north(&self, world: DVec2) -> Result<Option<f64>> {
        let Some(here) = self.lonlat(world)? else { return Ok(None) };
        let lonlat = |at| self.lonlat(at).ok().flatten();
        Ok(Axes::of(&lonlat, world, here, Some(360.0)).map(|axes| axes.bearing()))
    }
}

/// How grid north lies to true north, where it is worth a line: off by over 1 degree.
pub(crate) fn convergence_in_words(degrees: f64) -> Option<String> {
    let side = if degrees > 0.0 { "east" } else { "west" };
    (degrees.abs() > SMALL).then(|| format!("grid north lies {:.1} degrees {side} of true north", degrees.abs()))
}

/// The axes of coordinates as they run through the world at a place: metres for a step of each coordinate.
struct Axes {
    first: DVec2,
    second: DVec2,
}

impl Axes {
    /// Of the coordinates that `place` gives, `here` at a place of the world: longitude and latitude where there is a full
    /// `turn` of them.
    fn of(place: &dyn Fn(DVec2) -> Option<DVec2>, world: DVec2, here: DVec2, turn: Option<f64>) -> Option<Self> {
        let slope = |axis: DVec2| {
            let way = place(world + axis * STEP)? - place(world - axis * STEP)?;
            // Over the meridian of 180 degrees longitude leaps.
            let first = turn.map_or(way.x, |turn| wrapped(way.x, turn));
            Some(DVec2::new(first, way.y) / (2.0 * STEP))
        };
        let steps = DMat2::from_cols(slope(DVec2::X)?, slope(DVec2::Y)?).inverse();
        let [first, second] = [steps.x_axis, steps.y_axis];
        if !(steps.is_finite() && second.length() > 0.0) {
            return None;
        }
        let from_pole = turn.map_or(f64::INFINITY, |turn| (turn / 4.0 - here.y.abs()) * second.length());
        (from_pole > POLE).then_some(Self { first, second })
    }

    /// Of the second axis, degrees clockwise from the world's.
    fn bearing(&self) -> f64 {
        // No -0 is printed.
        self.second.x.atan2(self.second.y).to_degrees() + 0.0
    }

    /// Whether they are the axes of the world, but for their order and their signs: those of a file that was flipped, not
    /// warped.
    fn are_the_worlds(&self, metres_per_unit: Option<f64>) -> bool {
        let Some(unit) = metres_per_unit else { return false };
        let near = |x: f64, y: f64| (x.abs() - unit).abs() <= SAME_AXES * unit && y.abs() <= SAME_AXES * unit;
        let along = |axis: DVec2| near(axis.x, axis.y) || near(axis.y, axis.x);
        along(self.first) && along(self.second)
    }
}

/// A difference of angles to within half a turn.
fn wrapped(difference: f64, turn: f64) -> f64 {
    difference - turn * (difference / turn).round()
}
