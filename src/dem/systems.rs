//! Systems of coordinates, and the way from one to another as a DEM asks for it.

use std::fmt::Debug;

use glam::{DMat2, DVec2};

use crate::error::Result;

/// Relative difference of a linear unit to the metre that is still a metre.
const METRE_EPSILON: f64 = 1e-9;

/// A coordinate reference system: a name for people, a definition in the well-known text of OGC, and a unit. Coordinates
/// stand x first, east or longitude. Those of a map whose axes run elsewhere may be turned and flipped: see [`Crs::axes`].
#[derive(Debug, Clone, PartialEq)]
pub struct Crs {
    wkt: String,
    name: String,
    epsg: Option<u32>,
    unit: Unit,
    axes: DMat2,
}

/// What one step of a coordinate is.
#[derive(Debug, Clone, PartialEq)]
pub enum Unit {
    /// So many radians.
    Angle(f64),
    /// So many metres, and the unit's name.
    Length(f64, String),
}

/// Carries places from one system of coordinates to another.
pub trait Transform: Debug + Send + Sync {
    /// The place in `to` of a place in `from`; `None` where there is no such place, no way from one to the other is known,
    /// or one of the two is unknown.
    fn place(&self, from: &Crs, to: &Crs, place: DVec2) -> Option<DVec2>;

    /// The same of many places, `None` as for one.
    fn places(&self, from: &Crs, to: &Crs, places: &[DVec2]) -> Vec<Option<DVec2>> {
        places.iter().map(|place| self.place(from, to, *place)).collect()
    }

    /// Longitude and latitude on the body that `of` maps: degrees of WGS 84 on Earth, elsewhere those on the system's own
    /// ellipsoid; `None` where `of` is of no globe.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) where it cannot be looked up.
    fn lonlat(&self, of: &Crs) -> Result<Option<Crs>>;
}

impl Crs {
    /// Of a definition, a name, its number in the register of EPSG and the unit of its coordinates.
    pub fn new(wkt: String, name: String, epsg: Option<u32>, unit: Unit) -> Self {
        Self { wkt, name, epsg, unit, axes: DMat2::IDENTITY }
    }

    /// The same with coordinates turned and flipped: `axes` holds 0, 1 and -1, each row and column one that is not 0.
    pub(crate) fn with_axes(self, axes: DMat2) -> Self {
        // No -0 is written.
        Self { axes: axes + DMat2::ZERO, ..self }
    }

    /// The same with the coordinates of its definition.
    pub(crate) fn as_defined(&self) -> Self {
        self.clone().with_axes(DMat2::IDENTITY)
    }

    /// Of a place that nobody named: metres from somewhere.
    pub fn unknown() -> Self {
        Self::new(String::new(), String::new(), None, Unit::Length(1.0, "metre".into()))
    }

    /// Its name, empty when unknown.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its number in the register of EPSG, where it is known.
    pub fn epsg(&self) -> Option<u32> {
        self.epsg
    }

    /// Its definition in the well-known text of OGC, empty when unknown.
    pub fn wkt(&self) -> &str {
        &self.wkt
    }

    /// Name and number, empty when unknown: `WGS 84 / UTM zone 10N (EPSG:32610)`.
    pub fn label(&self) -> String {
        match self.epsg {
            Some(code) => format!("{} (EPSG:{code})", self.name),
            None => self.name.clone(),
        }
    }

    /// Whether its coordinates are longitude and latitude.
    pub fn is_geographic(&self) -> bool {
        matches!(self.unit, Unit::Angle(_))
    }

    /// Metres a step of a coordinate; `None` for angles.
    pub fn metres_per_unit(&self) -> Option<f64> {
        match self.unit {
            Unit::Angle(_) => None,
            Unit::Length(metres, _) if (metres - 1.0).abs() <= METRE_EPSILON => Some(1.0),
            Unit::Length(metres, _) => Some(metres),
        }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Crs {
    /// What leads from the coordinates of the definition to these: one by default, another where the map's own axes run
    /// west or south, so that x is east and y north.
    pub fn axes(&self) -> DMat2 {
        self.axes
    }

    /// The unit of its coordinates in words, plural: `degrees`, `metres`, or as the file calls it.
    pub fn units(&self) -> &str {
        match &self.unit {
            Unit::Angle(_) => "degrees",
            Unit::Length(..) if self.metres_per_unit() == Some(1.0) => "metres",
            Unit::Length(_, name) => name,
        }
    }

    /// Steps of a full turn, for longitudes.
    pub fn turn(&self) -> Option<f64> {
        match self.unit {
            Unit::Angle(radians) => Some(std::f64::consts::TAU / radians),
            Unit::Length(..) => None,
        }
    }
}
