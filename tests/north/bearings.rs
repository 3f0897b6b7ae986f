//! Bearings against closed forms on the sphere, on maps made of formulas alone.

use std::sync::Arc;

use glam::{DMat2, DVec2};
use hachure::dem::{Crs, Georeference, North, Transform, Unit};
use hachure::error::Result;

use crate::tolerances::NORTH_DEGREES;

/// Metres.
const RADIUS: f64 = 6_371_000.0;

/// A map of the sphere, and a file whose coordinates are those of the map turned, stretched or mirrored.
#[derive(Debug)]
struct Map {
    /// Longitude and latitude, degrees, of a place on the map.
    globe: fn(DVec2) -> DVec2,
    /// From the map to the file.
    file: DMat2,
}

impl Transform for Map {
    fn place(&self, _: &Crs, to: &Crs, place: DVec2) -> Option<DVec2> {
        let place = if to.is_geographic() { (self.globe)(place) } else { self.file * place };
        place.is_finite().then_some(place)
    }

    fn lonlat(&self, _: &Crs) -> Result<Option<Crs>> {
        Ok(Some(Crs::new("globe".into(), "globe".into(), None, Unit::Angle(1_f64.to_radians()))))
    }
}

fn metres(name: &str) -> Crs {
    Crs::new(name.into(), name.into(), None, Unit::Length(1.0, "metre".into()))
}

fn placed(globe: fn(DVec2) -> DVec2, file: DMat2) -> Georeference {
    Georeference::new(metres("file"), metres("map"), Arc::new(Map { globe, file }))
}

fn bearing(georeference: &Georeference, north: North, place: DVec2) -> Option<f64> {
    georeference.bearings(place).expect("no register is asked").of(north)
}

/// x = R longitude cos latitude, y = R latitude.
fn sinusoidal(place: DVec2) -> DVec2 {
    let latitude = place.y / RADIUS;
    DVec2::new(place.x / RADIUS / latitude.cos(), latitude).map(f64::to_degrees)
}

/// The pole in the middle, the meridian of 0 downwards: rho = 2 R tan(half the angle from the pole).
fn polar(place: DVec2) -> DVec2 {
    let from_pole = 2.0 * (place.length() / (2.0 * RADIUS)).atan();
    DVec2::new(place.x.atan2(-place.y).to_degrees(), 90.0 - from_pole.to_degrees())
}

/// Degrees between two bearings.
fn apart(a: f64, b: f64) -> f64 {
    ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs()
}

#[test]
fn true_north_on_a_sheared_map_is_the_tangent_of_the_meridian() {
    let map = placed(sinusoidal, DMat2::IDENTITY);
    for (longitude, latitude) in [(-110.0, 45.0), (0.0, 45.0), (30.0, -60.0), (170.0, 20.0), (12.0, 0.0)] {
        let [l, phi] = [longitude, latitude].map(f64::to_radians);
        let place = DVec2::new(l * phi.cos(), phi) * RADIUS;
        // d(x, y) / d latitude = R (-longitude sin latitude, 1).
        let wanted = (-l * phi.sin()).atan().to_degrees();
        let found = bearing(&map, North::True, place).expect("a north");
        assert!(apart(found, wanted) < NORTH_DEGREES, "{longitude}, {latitude}: {found}, not {wanted}");
        assert!(wanted == 0.0 || apart(found, -wanted) > 1.0, "the check must see a north on the other side");
    }
}

#[test]
fn true_north_on_a_polar_map_leads_to_the_pole_from_everywhere() {
    let map = placed(polar, DMat2::IDENTITY);
    // Longitude leaps at 180 degrees.
    for longitude in [0.0, 100.0, 145.0, 179.999_999, 180.0, -179.999_999, -90.0] {
        let out = DVec2::from_angle(f64::to_radians(longitude - 90.0));
        let found = bearing(&map, North::True, out * 2e6).expect("a north");
        assert!(apart(found, -longitude) < NORTH_DEGREES, "{longitude}: {found}");
        let convergence = map.bearings(out * 2e6).expect("no register is asked").convergence().expect("both norths");
        assert!(apart(convergence, longitude) < NORTH_DEGREES && convergence.abs() <= 180.0, "{longitude}");
    }
}

#[test]
fn there_is_no_north_at_a_pole() {
    let map = placed(polar, DMat2::IDENTITY);
    for metres in [0.0, 1e-9, 0.5, 1.0, 2.0, 99.0] {
        assert_eq!(bearing(&map, North::True, DVec2::new(0.0, metres)), None, "{metres} m from the pole");
        assert_eq!(map.bearings(DVec2::new(metres, 0.0)).expect("no register is asked").convergence(), None);
    }
    let found = bearing(&map, North::True, DVec2::new(101.0, 0.0)).expect("a north");
    assert!(apart(found, -90.0) < 0.01, "{found}");
}

#[test]
fn grid_north_is_where_the_second_coordinate_of_the_file_grows() {
    let place = DVec2::new(3e5, 5e6);
    for degrees in [-145.0, -30.0, 0.5, 170.0] {
        // Coordinates of axes turned clockwise.
        let turned = DMat2::from_angle(f64::to_radians(degrees));
        let found = bearing(&placed(sinusoidal, turned), North::Grid, place).expect("a north");
        assert!(apart(found, degrees) < NORTH_DEGREES, "{degrees}: {found}");
    }
    // Sheared: the second axis leans over, where the first coordinate stays.
    let leaning = DMat2::from_cols(DVec2::new(1.0, 0.0), DVec2::new(-1.0, 1.0));
    let found = bearing(&placed(sinusoidal, leaning), North::Grid, place).expect("a north");
    assert!(apart(found, 45.0) < NORTH_DEGREES, "{found}");
}

#[test]
fn grid_north_is_up_to_the_last_bit_where_nothing_was_warped() {
    let place = DVec2::new(3e5, 5e6);
    let same = Georeference::new(metres("map"), metres("map"), Arc::new(Map { globe: sinusoidal, file: DMat2::NAN }));
    assert_eq!(bearing(&same, North::Grid, place), Some(0.0), "nothing is computed");
    // Axes that run west or south, or change places: flipped like a mirrored raster.
    let flipped = [[-1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, -1.0], [-1.0, 0.0, 0.0, -1.0], [0.0, -1.0, -1.0, 0.0]];
    for signs in flipped {
        let file = placed(sinusoidal, DMat2::from_cols_array(&signs));
        assert_eq!(bearing(&file, North::Grid, place), Some(0.0), "{signs:?}");
    }
    // Turned by chance to the south and of another scale, it was warped.
    let south = placed(sinusoidal, DMat2::from_diagonal(DVec2::splat(-0.97)));
    assert_eq!(bearing(&south, North::Grid, place).map(f64::abs), Some(180.0));
}

#[test]
fn nobody_knows_the_north_of_a_grid_that_nobody_placed() {
    let nowhere = Georeference::unknown();
    assert_eq!(bearing(&nowhere, North::Grid, DVec2::ONE), Some(0.0));
    assert_eq!(bearing(&nowhere, North::True, DVec2::ONE), None);
    assert_eq!(nowhere.bearings(DVec2::ONE).expect("no register is asked").convergence(), None);
    // A place that is not on the map has none either.
    let map = placed(sinusoidal, DMat2::NAN);
    assert_eq!(bearing(&map, North::Grid, DVec2::ONE), None);
}
