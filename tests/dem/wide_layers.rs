//! Fine land in files that are far larger than one map can show: what is drawn there, and the crops that errors name.

use std::path::{Path, PathBuf};

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use glam::DVec2;
use hachure::door::cli::words::line;
use hachure::geo::{ReadOptions, read_all};

use super::{Raster, cropped, folder};
use crate::common::words;

const CELL: f64 = 200.0;
/// Samples along a side of the near file.
const SIDE: usize = 40;

/// Heights between longitudes and latitudes in cells of a degree.
fn degrees(path: &Path, [west, east]: [f64; 2], [south, north]: [f64; 2]) -> PathBuf {
    let [columns, rows] = [east - west, north - south].map(|span| span as usize);
    let values = (0..columns * rows).map(|i| 500.0 + (i % columns) as f32 + (i / columns) as f32).collect();
    let transform = Some([west, 1.0, 0.0, north, 0.0, -1.0]);
    Raster { transform, epsg: Some(4326), ..Raster::new(columns, values) }.write("GTiff", path)
}

/// 8 km of land around a place in degrees, and the middle of it in the zone.
fn near(path: &Path, epsg: u32, place: [f64; 2]) -> (PathBuf, DVec2) {
    let system = |code| {
        let mut system = SpatialRef::from_epsg(code).unwrap();
        system.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        system
    };
    let [mut x, mut y] = place.map(|degrees| [degrees]);
    CoordTransform::new(&system(4326), &system(epsg)).unwrap().transform_coords(&mut x, &mut y, &mut []).unwrap();
    let middle = (DVec2::new(x[0], y[0]) / CELL).round() * CELL;
    let half = CELL * SIDE as f64 / 2.0;
    let transform = Some([middle.x - half, CELL, 0.0, middle.y + half, 0.0, -CELL]);
    let values = (0..SIDE * SIDE).map(|i| 700.0 + (i % 7) as f32 + 0.1).collect();
    (Raster { transform, epsg: Some(epsg), ..Raster::new(SIDE, values) }.write("GTiff", path), middle)
}

/// The crop that words name.
fn named(said: &str) -> [f64; 4] {
    let crop = said.split("--crop ").nth(1).and_then(|rest| rest.split([' ', '`']).next()).expect(said);
    let edges: Vec<f64> = crop.split(',').map(|edge| edge.parse().unwrap()).collect();
    edges.try_into().unwrap()
}

#[test]
fn fine_land_in_a_globe_is_drawn_wherever_the_crop_lies() {
    let dir = folder();
    let places = [(32632, [9.0, 45.0]), (32631, [0.0, 51.5]), (32701, [-180.0, -17.0])];
    let globes = [[-180.0, 180.0], [0.0, 360.0]]
        .map(|span| degrees(&dir.path().join(format!("globe{}.tif", span[1])), span, [-90.0, 90.0]));
    for (epsg, place) in places {
        let (near, middle) = near(&dir.path().join(format!("near{epsg}.tif")), epsg, place);
        for globe in &globes {
            let (low, high) = (middle - 30_000.0, middle + 30_000.0);
            let options = cropped([low.x, low.y, high.x, high.y]);
            let dem = read_all(&[near.clone(), globe.clone()], &options, &|_, _| ()).unwrap();
            assert_eq!((dem.columns(), dem.rows()), (300, 300), "EPSG:{epsg} in {}", globe.display());
            let [x, y] = place;
            let options = cropped([x - 0.2, y - 0.2, x + 0.2, y + 0.2]);
            let dem = read_all(&[globe.clone(), near.clone()], &options, &|_, _| ()).unwrap();
            assert_eq!(dem.cell(), DVec2::splat(CELL));
            let across = 0.4 * 111_000.0 * y.to_radians().cos() / CELL;
            assert!(dem.columns() as f64 > 0.85 * across, "{} columns of {across}", dem.columns());
        }
    }
    // A hemisphere, whose corners have no place in the zone at all.
    let hemisphere = degrees(&dir.path().join("hemisphere.tif"), [-90.0, 90.0], [0.0, 90.0]);
    let (near, _) = near(&dir.path().join("near.tif"), 32632, [9.0, 45.0]);
    let dem = read_all(&[hemisphere, near], &cropped([8.5, 45.0, 9.5, 45.3]), &|_, _| ()).unwrap();
    assert_eq!(dem.voids(), 0);
    assert!(dem.columns() > 370 && dem.rows() > 150, "{} x {}", dem.columns(), dem.rows());
}

#[test]
fn files_too_large_for_one_map_are_refused_with_a_crop_that_is_drawn() {
    let dir = folder();
    let (near, _) = near(&dir.path().join("near.tif"), 32632, [9.0, 45.0]);
    let globe = degrees(&dir.path().join("globe.tif"), [-180.0, 180.0], [-90.0, 90.0]);
    let continent = degrees(&dir.path().join("continent.tif"), [-25.0, 45.0], [34.0, 72.0]);
    let small = ReadOptions { memory: 4 << 20, ..Default::default() };
    for files in [[&near, &globe], [&globe, &near], [&near, &continent], [&continent, &near]] {
        let files = files.map(PathBuf::clone);
        let error = line(&read_all(&files, &small, &|_, _| ()).unwrap_err());
        assert!(error.contains("too much of the globe") && error.contains("in the cells of near.tif"), "{error}");
        let dem = read_all(&files, &ReadOptions { crop: Some(named(&error)), ..small.clone() }, &|_, _| ()).unwrap();
        assert_eq!(dem.cell(), DVec2::splat(CELL), "{error}");
    }
}

#[test]
fn a_crop_is_named_across_the_meridian_where_degrees_begin_anew() {
    let dir = folder();
    let wide = degrees(&dir.path().join("wide.tif"), [178.0, 184.0], [-20.0, -14.0]);
    let (near, _) = near(&dir.path().join("near.tif"), 32701, [-180.0, -17.0]);
    let small = ReadOptions { memory: 1 << 20, ..Default::default() };
    for files in [[&wide, &near], [&near, &wide]].map(|files| files.map(PathBuf::clone)) {
        let dem = read_all(&files, &small, &|_, _| ()).unwrap();
        assert!(dem.cell().x > 10_000.0);
        let said = words(dem.history().assumed()).join("\n");
        let [west, south, east, north] = named(&said);
        assert!(east - west < 1e5 && west < east && south < north, "{said}");
        let part = ReadOptions { crop: Some([west, south, east, north]), ..small.clone() };
        let dem = read_all(&files, &part, &|_, _| ()).unwrap();
        assert_eq!(dem.cell(), DVec2::splat(CELL), "{said}");
    }
    // A globe that ends there is drawn in its own cells on both sides, too.
    let globe = degrees(&dir.path().join("globe.tif"), [-180.0, 180.0], [-90.0, 90.0]);
    let options = ReadOptions { memory: 1 << 17, ..cropped([177.0, -20.0, 183.0, -14.0]) };
    let dem = read_all(&[globe, near], &options, &|_, _| ()).unwrap();
    assert!(dem.cell().x > 10_000.0 && dem.voids() == 0, "{:?}, {} voids", dem.cell(), dem.voids());
    assert!(dem.columns() as f64 * dem.cell().x > 5.0 * 100_000.0, "{} columns of {:?}", dem.columns(), dem.cell());
}
