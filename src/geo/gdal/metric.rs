//! The map in metres that is true around a place: a zone of UTM, beyond it the polar stereographic of UPS.
//!
//! Both are within a percent of the ground where they are meant to be used. On Earth they are those of WGS 84; on another
//! body the same formulas on the DEM's own ellipsoid, in zones that lie as on Earth. Not handled: bodies of three axes.

use gdal::spatial_ref::SpatialRef;
use glam::DVec2;

use super::crs::CrsPath;
use super::source::heard;
use crate::dem::Crs;

/// Latitude where UTM ends in the north and in the south, degrees.
const UTM_NORTH: f64 = 84.0;
const UTM_SOUTH: f64 = -80.0;
/// Degrees of longitude of a zone.
const ZONE: f64 = 6.0;

/// Degrees of longitude and latitude of a place in `crs`, on its own ellipsoid; on Earth of WGS 84.
pub(super) fn degrees(crs: &Crs, place: DVec2) -> Option<DVec2> {
    let own = crs.geographic()?;
    let globe = if own.is_of_earth() { Crs::lonlat().ok()? } else { own };
    let degrees = 360.0 / globe.turn()?;
    Some(CrsPath::between(crs, &globe)?.place(place)? * degrees)
}

/// Whether a latitude in degrees is beyond UTM.
pub(super) fn is_polar(latitude: f64) -> bool {
    !(UTM_SOUTH..=UTM_NORTH).contains(&latitude)
}

/// The map of the body of `crs` that is true around `middle`, a place in it.
pub(super) fn metric(crs: &Crs, middle: DVec2) -> Option<Crs> {
    let place = degrees(crs, middle)?;
    match crs.is_of_earth() {
        true => Crs::from_epsg(epsg(place)).ok(),
        false => of_body(&crs.geographic()?, place),
    }
}

/// EPSG code of the map of a place on Earth in degrees.
fn epsg(DVec2 { x: longitude, y: latitude }: DVec2) -> u32 {
    let zone = ((longitude + 180.0).rem_euclid(360.0) / ZONE).floor().clamp(0.0, 59.0) as u32 + 1;
    match latitude {
        _ if latitude > UTM_NORTH => 5041,
        _ if latitude < UTM_SOUTH => 5042,
        _ if latitude < 0.0 => 32700 + zone,
        _ => 32600 + zone,
    }
}

/// The map of a place in degrees on the body of `globe`.
fn of_body(globe: &Crs, DVec2 { x: longitude, y: latitude }: DVec2) -> Option<Crs> {
    let unit = 360.0 / globe.turn()?;
    let (name, method, parameters) = if is_polar(latitude) {
        let pole = if latitude > 0.0 { 90.0 } else { -90.0 };
        let name = format!("polar stereographic about latitude {pole}");
        let middle = [pole / unit, 0.0];
        (name, "Polar_Stereographic", parameters(middle, 0.994))
    } else {
        let meridian = ((longitude / ZONE).floor() + 0.5) * ZONE;
        let name = format!("transverse Mercator about longitude {meridian}");
        (name, "Transverse_Mercator", parameters([0.0, meridian / unit], 0.9996))
    };
    let base = globe.wkt();
    let wkt = format!("PROJCS[\"{name}\",{base},PROJECTION[\"{method}\"],{parameters},UNIT[\"metre\",1]]");
    Crs::of(heard(|| SpatialRef::from_wkt(&wkt)).0.ok()?)
}

/// Latitude and longitude of the origin in units of the globe, and the scale there. Coordinates count from it: with the
/// false eastings of UTM and UPS PROJ takes the map for one of them, which have no spheres.
fn parameters([latitude, longitude]: [f64; 2], scale: f64) -> String {
    [
        ("latitude_of_origin", latitude),
        ("central_meridian", longitude),
        ("scale_factor", scale),
        ("false_easting", 0.0),
        ("false_northing", 0.0),
    ]
    .map(|(name, value)| format!("PARAMETER[\"{name}\",{value}]"))
    .join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_and_poles() {
        let zone = |x, y| epsg(DVec2::new(x, y));
        assert_eq!(zone(-119.53, 37.7), 32611);
        assert_eq!(zone(174.0, -41.0), 32760);
        assert_eq!(zone(180.0, 10.0), 32601);
        assert_eq!(zone(241.0, 37.0), 32611);
        assert_eq!(zone(0.0, 85.0), 5041);
        assert_eq!(zone(0.0, -85.0), 5042);
    }
}
