//! Grid north and true north: bearings against closed forms, pictures in which a peak due north stands in the middle, and
//! what flags, views and reports say of them.

mod bearings;
mod pictures;
mod said;

use std::fs;
use std::path::Path;
use std::process::Output;

use gdal::DriverManager;
use gdal::spatial_ref::SpatialRef;
use glam::DVec2;
use serde_json::Value;

use crate::cli::{Place, stderr};

/// Samples along a side of the DEMs here.
const SIDE: usize = 160;
/// A page on which a degree is 9.7 px across, of facets as coarse as the samples, by a method that is soon compiled.
const PAGE: [&str; 10] =
    ["--size", "640x360", "--level", "1", "--border", "off", "--method", "toward-away", "-o", "out.png"];
/// Where the land of [`arctic`] lies: on the meridian 145 degrees east of that on which its map stands upright.
const ARCTIC: [f64; 2] = [100.0, 72.0];
/// Where the land of [`degrees`] lies: 2.9 degrees from the middle of the 32nd zone of UTM.
const DEGREES: [f64; 2] = [11.9, 65.0];
/// Metres of a degree of latitude, near enough for hills.
const DEGREE: f64 = 111_400.0;

/// A peak 2 km north of the middle and, a third as high, one to the east of it.
fn hills(place: DVec2) -> f64 {
    let hill = |at: DVec2, width: f64| (-(place - at).length_squared() / (2.0 * width * width)).exp();
    100.0 + 500.0 * hill(DVec2::new(0.0, 2000.0), 150.0) + 150.0 * hill(DVec2::new(900.0, 2000.0), 150.0)
}

/// A square DEM of cells of `cell` around `middle`, with the height that `land` gives for the way from the middle.
fn write(path: &Path, crs: &SpatialRef, middle: DVec2, cell: DVec2, land: impl Fn(DVec2) -> f64) {
    let driver = DriverManager::get_driver_by_name("GTiff").expect("GTiff");
    let mut file = driver.create_with_band_type::<f32, _>(path, SIDE, SIDE, 1).expect("a file");
    let half = SIDE as f64 / 2.0;
    let corner = middle + DVec2::new(-half, half) * cell;
    file.set_geo_transform(&[corner.x, cell.x, 0.0, corner.y, 0.0, -cell.y]).expect("a place");
    file.set_spatial_ref(crs).expect("a system");
    let way = |i: usize| DVec2::new((i % SIDE) as f64 + 0.5 - half, half - (i / SIDE) as f64 - 0.5) * cell;
    let samples = (0..SIDE * SIDE).map(|i| land(way(i)) as f32).collect();
    let mut samples = gdal::raster::Buffer::new((SIDE, SIDE), samples);
    file.rasterband(1).expect("a band").write((0, 0), (SIDE, SIDE), &mut samples).expect("samples");
    file.close().expect("written");
}

/// The hills on the polar map EPSG:3413, where meridians are rays from the pole: true north is 145 degrees left of grid
/// north. The place is that which the formulas of the map give for [`ARCTIC`].
fn arctic(place: &Place) {
    let turn = (-(ARCTIC[0] + 45.0)).to_radians();
    let (north, east) = (DVec2::new(turn.sin(), turn.cos()), DVec2::new(turn.cos(), -turn.sin()));
    let middle = DVec2::new(1_127_330.452, 1_609_994.738);
    let crs = SpatialRef::from_epsg(3413).expect("EPSG:3413");
    let land = |way: DVec2| hills(DVec2::new(way.dot(east), way.dot(north)));
    write(&place.path("arctic.tif"), &crs, middle, DVec2::splat(38.0), land);
}

/// The hills in degrees.
fn degrees(place: &Place) {
    let metres = DVec2::new(DEGREE * DEGREES[1].to_radians().cos(), DEGREE);
    let crs = SpatialRef::from_epsg(4326).expect("EPSG:4326");
    let middle = DVec2::from_array(DEGREES);
    write(&place.path("degrees.tif"), &crs, middle, DVec2::splat(38.0) / metres, |way| hills(way * metres));
}

fn draw(place: &Place, dem: &str, flags: &[&str]) -> Output {
    let output = place.run(&[&["draw", dem, "--json", "report.json"], &PAGE[..], flags].concat());
    assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
    output
}

/// The view of the report of the last drawing.
fn reported(place: &Place) -> Value {
    let text = fs::read_to_string(place.path("report.json")).expect("a report");
    serde_json::from_str::<Value>(&text).expect("JSON")["view"].take()
}

/// Draws and returns the view of the report.
fn view(place: &Place, dem: &str, flags: &[&str]) -> Value {
    draw(place, dem, flags);
    reported(place)
}
