//! Coordinate reference systems: what files and the register say of them, and the way from one to another.
//!
//! PROJ does the mathematics, through GDAL. Coordinates always stand x first, east or longitude, whatever order the
//! system's register gives. Not handled: heights, epochs, datum grids that are not on the machine.

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use gdal_sys::OGRAxisOrientation as Axis;
use glam::{DMat2, DVec2};

use super::register;
use super::source::heard;
use crate::dem::{Crs, Transform, Unit};
use crate::error::{Error, Result, Setting, plain};

/// Longitude and latitude, in the register of EPSG.
const WGS84: u32 = 4326;
/// Metres from the middle of the Earth to its equator, and how much another ellipsoid of the Earth may differ: PROJ leads
/// from no body to another, and knows them by this.
const EARTH_RADIUS: f64 = 6_378_137.0;
const EARTH_SHARE: f64 = 0.005;

impl Crs {
    /// Longitude and latitude in degrees, WGS 84.
    ///
    /// # Errors
    /// [`Error::Limit`] when PROJ cannot find its register of coordinate systems.
    pub fn lonlat() -> Result<Self> {
        Self::from_epsg(WGS84)
    }

    /// The system that the register of EPSG gives this number.
    ///
    /// # Errors
    /// [`Error::Setting`] when there is none, or none of places on a map or the globe; [`Error::Limit`] when PROJ cannot
    /// find the register.
    pub fn from_epsg(code: u32) -> Result<Self> {
        let wrong = |what: String| {
            let remedy = "give the number of a system of map coordinates, for instance EPSG:32611 or EPSG:4326";
            Error::setting(Setting::Crs, what, remedy)
        };
        let (found, words) = heard(|| SpatialRef::from_epsg(code));
        let Ok(found) = found else {
            // Without a register every code is unknown; one that has WGS 84 is whole.
            let whole = code != WGS84 && heard(|| SpatialRef::from_epsg(WGS84)).0.is_ok();
            return Err(if whole { wrong(format!("EPSG:{code} is unknown")) } else { register::error(words) });
        };
        Self::of(found).ok_or_else(|| wrong(format!("EPSG:{code} is no system of places on a map")))
    }

    /// Of GDAL's handle; `None` for systems that are neither a map nor longitude and latitude.
    pub(super) fn of(mut reference: SpatialRef) -> Option<Self> {
        if reference.is_geocentric() || (reference.is_vertical() && !reference.is_compound()) {
            return None;
        }
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        let geographic = reference.is_geographic() || reference.is_derived_geographic();
        let unit = if geographic {
            Unit::Angle(reference.angular_units())
        } else {
            let metres = reference.linear_units();
            Unit::Length(metres, plain(reference.linear_units_name().unwrap_or_else(|| format!("{metres} m"))))
        };
        let wkt = heard(|| reference.to_wkt()).0.ok()?;
        let (name, epsg) = identity(reference);
        Some(Self::new(wkt, plain(name), epsg, unit))
    }

    /// Whether its ellipsoid has about the size of the Earth's, or nobody names one.
    pub(super) fn is_of_earth(&self) -> bool {
        let radius = self.reference().and_then(|reference| heard(|| reference.semi_major()).0.ok());
        radius.is_none_or(|radius| (radius / EARTH_RADIUS - 1.0).abs() < EARTH_SHARE)
    }

    /// Longitude and latitude on its own ellipsoid, without a change of datum; itself where it is such a system, `None`
    /// where it is of no globe.
    pub(super) fn geographic(&self) -> Option<Self> {
        if self.is_geographic() {
            return Some(self.clone());
        }
        let reference = self.reference().filter(|reference| !reference.is_local())?;
        Self::of(heard(|| reference.geog_cs()).0.ok()?)
    }

    /// Metres from the middle of its body to the equator and to a pole.
    pub(super) fn radii(&self) -> Option<[f64; 2]> {
        let reference = self.reference()?;
        let (radii, _) = heard(|| Some([reference.semi_major().ok()?, reference.semi_minor().ok()?]));
        radii
    }

    /// How it is typed for GDAL's tools.
    pub(super) fn typed(&self) -> String {
        let words = || heard(|| self.reference()?.to_proj4().ok()).0;
        match self.epsg() {
            Some(code) => format!("EPSG:{code}"),
            None => words().map_or("EPSG:CODE".into(), |words| format!("'{}'", words.trim())),
        }
    }

    /// What its coordinates grow by east and north, as its definition says, where one of them grows west or south; `None`
    /// for all others and for maps of a pole, whose axes both run north or both south.
    pub(super) fn west_or_south(&self) -> Option<DMat2> {
        let reference = self.reference()?;
        let (axes, _) = heard(|| [0, 1].map(|axis| reference.axis_orientation("PROJCS", axis).ok()));
        let [Some(x), Some(y)] = axes.map(|axis| axis.and_then(east_north)) else { return None };
        let derivative = DMat2::from_cols(x, y).transpose();
        (x.dot(y) == 0.0 && (x + y).min_element() < 0.0).then_some(derivative)
    }

    /// `x` taken round the globe, where it is a longitude, to within half a turn of `middle`.
    pub(super) fn near(&self, x: f64, middle: f64) -> f64 {
        self.turn().map_or(x, |turn| x + turn * ((middle - x) / turn).round())
    }

    /// West, south, east and north of the area that it is made for, degrees, where the register tells.
    pub(super) fn area(&self) -> Option<[f64; 4]> {
        let (area, _) = heard(|| SpatialRef::from_epsg(self.epsg()?).ok()?.area_of_use());
        let area = area?;
        Some([area.west_lon_degree, area.south_lat_degree, area.east_lon_degree, area.north_lat_degree])
    }

    /// GDAL's handle, x first; `None` when unknown.
    pub(super) fn reference(&self) -> Option<SpatialRef> {
        if self.wkt().is_empty() {
            return None;
        }
        let mut reference = heard(|| SpatialRef::from_wkt(self.wkt())).0.ok()?;
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        Some(reference)
    }
}

/// What leads from one system to another: PROJ.
#[derive(Debug)]
pub(super) struct Proj;

impl Transform for Proj {
    fn place(&self, from: &Crs, to: &Crs, place: DVec2) -> Option<DVec2> {
        CrsPath::between(from, to)?.place(place)
    }

    fn places(&self, from: &Crs, to: &Crs, places: &[DVec2]) -> Vec<Option<DVec2>> {
        let Some(way) = CrsPath::between(from, to) else { return vec![None; places.len()] };
        let mut places = places.to_vec();
        way.carry(&mut places);
        places.into_iter().map(|place| Some(place).filter(|place| place.is_finite())).collect()
    }

    fn lonlat(&self, of: &Crs) -> Result<Option<Crs>> {
        match of.geographic() {
            Some(_) if of.is_of_earth() => Crs::lonlat().map(Some),
            own => Ok(own),
        }
    }
}

/// Fails where PROJ has no register of coordinate systems: then files seem to name none.
pub(super) fn check_register() -> Result<()> {
    Crs::lonlat().map(drop)
}

/// The way from the coordinates of one system to those of another.
pub(super) struct CrsPath {
    /// From the axes of the first to its definition, and from the definition of the second to its axes.
    axes: [DMat2; 2],
    /// Nothing where both have one definition.
    transform: Option<CoordTransform>,
}

impl CrsPath {
    /// `None` where PROJ knows none, or one of the two is unknown.
    pub(super) fn between(from: &Crs, to: &Crs) -> Option<Self> {
        let axes = [from.axes().transpose(), to.axes()];
        if from.as_defined() == to.as_defined() {
            return Some(Self { axes, transform: None });
        }
        let (from, to) = (from.reference()?, to.reference()?);
        let transform = heard(|| CoordTransform::new(&from, &to)).0.ok()?;
        Some(Self { axes, transform: Some(transform) })
    }

    /// Carries all places over; NaN where there is no such place.
    pub(super) fn carry(&self, places: &mut [DVec2]) {
        let [back, on] = self.axes;
        places.iter_mut().for_each(|place| *place = back * *place);
        if let Some(transform) = &self.transform {
            let (mut x, mut y): (Vec<_>, Vec<_>) = places.iter().map(|p| (p.x, p.y)).unzip();
            // It fails as a whole where a single place fails, and marks those that do as infinite.
            let _ = heard(|| transform.transform_coords(&mut x, &mut y, &mut []));
            for (place, (x, y)) in places.iter_mut().zip(x.into_iter().zip(y)) {
                *place = if x.is_finite() && y.is_finite() { DVec2::new(x, y) } else { DVec2::NAN };
            }
        }
        places.iter_mut().for_each(|place| *place = on * *place);
    }

    /// One place, `None` where there is no such place.
    pub(super) fn place(&self, place: DVec2) -> Option<DVec2> {
        let mut places = [place];
        self.carry(&mut places);
        places[0].is_finite().then_some(places[0])
    }
}

/// Where an axis runs, east and north.
fn east_north(axis: Axis::Type) -> Option<DVec2> {
    match axis {
        Axis::OAO_East => Some(DVec2::X),
        Axis::OAO_North => Some(DVec2::Y),
        Axis::OAO_West => Some(-DVec2::X),
        Axis::OAO_South => Some(-DVec2::Y),
        _ => None,
    }
}

/// Name and EPSG code of a CRS. Old formats give its parameters alone; those of UTM are recognised.
fn identity(mut reference: SpatialRef) -> (String, Option<u32>) {
    let name = reference.name().unwrap_or_default();
    if let Some(code) = epsg(&reference) {
        return (name, Some(code));
    }
    let (recognised, _) = heard(|| reference.auto_identify_epsg());
    let code = recognised.ok().and_then(|()| epsg(&reference));
    let (registered, _) = heard(|| code.and_then(|code| SpatialRef::from_epsg(code).ok()?.name()));
    (registered.unwrap_or(name), code)
}

fn epsg(reference: &SpatialRef) -> Option<u32> {
    let known = reference.auth_name().is_some_and(|name| name == "EPSG");
    known.then(|| reference.auth_code().ok()?.try_into().ok()).flatten()
}
