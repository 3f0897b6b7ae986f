//! Files on several grids as one DEM: fine land in coarse, seams, whose cells are drawn, and what it costs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::cli::words::line;
use hachure::geo::{Order, ReadOptions, read_all};
use serde_json::Value;
use tempfile::TempDir;

use super::{Raster, cropped, folder};
use crate::common::words;
use crate::tolerances::{ENLARGED_METRES, FINE_METRES, MIXED_FACETS, NEIGHBOURS_METRES, PLANE_METRES, SEAM_SLOPE};

const ZONE: u32 = 32632;
const LONLAT: u32 = 4326;
/// The middle of all files.
const MIDDLE: DVec2 = DVec2::new(500_000.0, 5_000_000.0);
/// Half the sides of the two files, metres.
const WIDE: f64 = 4500.0;
const NEAR: f64 = 1000.0;

/// Smooth relief.
fn relief(p: DVec2) -> f64 {
    let (x, y, s, top) = (p.x, p.y, 24_000.0, 1200.0);
    let hill = |a: f64, cx: f64, cy: f64, w: f64| {
        a * top * (-((x - cx * s).powi(2) + (y - cy * s).powi(2)) / (2.0 * (w * s).powi(2))).exp()
    };
    let hills = hill(1.0, 0.1, 0.15, 0.09) + hill(0.6, -0.22, 0.05, 0.07) + hill(0.45, -0.02, -0.2, 0.06);
    let off = y - 0.33 * s - 0.05 * s * (x / (0.08 * s)).sin();
    let ridge = 0.35 * top * (-off * off / (2.0 * (0.03 * s).powi(2))).exp();
    300.0 + hills + ridge + 0.04 * top * (x / (0.03 * s)).sin() * (y / (0.037 * s)).cos()
}

/// The same with hummocks around the middle that cells of 90 m cannot hold.
fn hummocks(p: DVec2) -> f64 {
    let p = p - MIDDLE;
    let detail = 25.0 * (p.x / 45.0).sin() * (p.y / 55.0).cos();
    relief(p) + detail * (-p.length_squared() / (2.0 * 1500.0 * 1500.0)).exp()
}

fn plane(p: DVec2) -> f64 {
    700.0 + 0.1 * (p.x - MIDDLE.x) - 0.07 * (p.y - MIDDLE.y)
}

/// A square file around the middle, `half` metres to each side, of `cell` metres.
fn square(path: &Path, half: f64, cell: f64, land: impl Fn(DVec2) -> f64) -> PathBuf {
    let [west, north] = [MIDDLE.x - half, MIDDLE.y + half];
    let side = (2.0 * half / cell).round() as usize;
    let place =
        |i: usize| DVec2::new(west, north) + DVec2::new((i % side) as f64 + 0.5, -((i / side) as f64 + 0.5)) * cell;
    let values = (0..side * side).map(|i| land(place(i)) as f32).collect();
    let transform = Some([west, cell, 0.0, north, 0.0, -cell]);
    Raster { transform, epsg: Some(ZONE), nodata: Some(-9999.0), ..Raster::new(side, values) }.write("GTiff", path)
}

/// The same in degrees, `cell` metres from south to north.
fn degrees(path: &Path, half: f64, cell: f64, land: impl Fn(DVec2) -> f64) -> PathBuf {
    let system = |code| {
        let mut system = SpatialRef::from_epsg(code).unwrap();
        system.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        system
    };
    let (zone, globe) = (system(ZONE), system(LONLAT));
    let [mut x, mut y] = [[MIDDLE.x], [MIDDLE.y]];
    CoordTransform::new(&zone, &globe).unwrap().transform_coords(&mut x, &mut y, &mut []).unwrap();
    let (side, step) = ((2.0 * half / cell).round() as usize, cell / 111_150.0);
    let [west, north] = [x[0] - step * side as f64 / 2.0, y[0] + step * side as f64 / 2.0];
    let mut x: Vec<_> = (0..side * side).map(|i| west + ((i % side) as f64 + 0.5) * step).collect();
    let mut y: Vec<_> = (0..side * side).map(|i| north - ((i / side) as f64 + 0.5) * step).collect();
    CoordTransform::new(&globe, &zone).unwrap().transform_coords(&mut x, &mut y, &mut []).unwrap();
    let values = x.iter().zip(&y).map(|(x, y)| land(DVec2::new(*x, *y)) as f32).collect();
    let transform = Some([west, step, 0.0, north, 0.0, -step]);
    Raster { transform, epsg: Some(LONLAT), ..Raster::new(side, values) }.write("GTiff", path)
}

/// A wide file of 90 m and a near one of 10 m with hummocks.
fn wide_and_near(dir: &TempDir) -> [PathBuf; 2] {
    [
        square(&dir.path().join("wide.tif"), WIDE, 90.0, hummocks),
        square(&dir.path().join("near.tif"), NEAR, 10.0, hummocks),
    ]
}

/// Heights on planes are multiples of something.
fn as_they_are() -> ReadOptions {
    ReadOptions { keep_steps: true, ..Default::default() }
}

fn together(paths: &[&PathBuf], options: &ReadOptions) -> Dem {
    read_all(&paths.iter().map(|path| path.to_path_buf()).collect::<Vec<_>>(), options, &|_, _| ()).unwrap()
}

/// Places of all samples with heights.
fn places(dem: &Dem) -> impl Iterator<Item = DVec3> + '_ {
    let all = (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| (c, r)));
    all.filter(|(c, r)| dem.height(*c, *r).is_some()).map(|(c, r)| dem.position(c, r))
}

/// Metres from a place to the outline of the near file, inward.
fn inward(p: DVec3) -> f64 {
    NEAR - (p.truncate() - MIDDLE).abs().max_element()
}

/// The mean of the four samples around the middle.
fn height_in_the_middle(dem: &Dem) -> f64 {
    let near: Vec<_> = places(dem).filter(|p| (p.truncate() - MIDDLE).abs().max_element() < 6.0).map(|p| p.z).collect();
    assert_eq!(near.len(), 4, "{:?}", dem.cell());
    near.iter().sum::<f64>() / 4.0
}

#[test]
fn fine_land_lies_in_coarse_whatever_the_order() {
    let dir = folder();
    let [wide, near] = wide_and_near(&dir);
    let options = ReadOptions::default();
    let dem = together(&[&wide, &near], &options);
    assert_eq!((dem.cell(), dem.columns()), (DVec2::splat(10.0), 892), "up to the outermost samples of the wide one");
    assert_eq!(dem.voids(), 0);
    let middle = height_in_the_middle(&dem);
    assert!((middle - hummocks(MIDDLE)).abs() < FINE_METRES, "{middle} for {}", hummocks(MIDDLE));
    let said = words(dem.history().converted());
    assert_eq!(said, ["near.tif on wide.tif, cells of 10 m, seams blended over 360 m"]);
    let mut fine = 0;
    for p in places(&dem) {
        let off = (p.z - hummocks(p.truncate())).abs();
        if inward(p) > 360.0 {
            fine += 1;
            assert!(off < 1e-3, "{p}: the near file itself, {off} m off");
        } else if inward(p) < 0.0 {
            let smooth = (p.z - relief(p.truncate() - MIDDLE)).abs();
            let away = (p.truncate() - MIDDLE).length();
            assert!(away < 4200.0 || smooth < ENLARGED_METRES, "{p}: {smooth} m off");
        }
    }
    assert_eq!(fine, 128 * 128);
    let back = together(&[&near, &wide], &options);
    assert!(places(&dem).eq(places(&back)), "the other way round");
    let given = ReadOptions { order: Order::Given, ..options };
    let covered = together(&[&near, &wide], &given);
    let inner = places(&covered).filter(|p| inward(*p) > 500.0).map(|p| (p.z - hummocks(p.truncate())).abs());
    assert!(inner.fold(0.0, f64::max) > 1.0, "the wide one, named last, lies on top");
    let covered = together(&[&wide, &near], &given);
    let inner = places(&covered).filter(|p| inward(*p) > 0.0).map(|p| (p.z - hummocks(p.truncate())).abs());
    assert!(inner.fold(0.0, f64::max) < 1e-3, "and here the near one is the last, up to its border");
    assert_eq!(words(covered.history().converted()), ["near.tif on wide.tif, cells of 10 m"]);
}

#[test]
fn a_seam_grows_smoothly_from_coarse_to_fine() {
    const OFF: f64 = 20.0;
    let dir = folder();
    let wide = square(&dir.path().join("wide.tif"), WIDE, 90.0, |p| plane(p) + OFF);
    let hole = |p: DVec2| (p - MIDDLE).length() < 250.0;
    let pinhole = |p: DVec2| (p - MIDDLE - DVec2::new(505.0, 505.0)).abs().max_element() < 30.0;
    let near =
        square(&dir.path().join("near.tif"), NEAR, 10.0, |p| if hole(p) || pinhole(p) { -9999.0 } else { plane(p) });
    let dem = together(&[&wide, &near], &ReadOptions::default());
    assert_eq!(dem.voids(), 0);
    let off = |p: DVec3| p.z - plane(p.truncate());
    for p in places(&dem) {
        let from_hole = (p.truncate() - MIDDLE).length() - 250.0;
        let least = inward(p).min(from_hole);
        if least < 0.0 {
            assert!((off(p) - OFF).abs() < PLANE_METRES, "{p}: coarse, {}", off(p));
        } else if least > 375.0 {
            assert!(off(p).abs() < PLANE_METRES, "{p}: fine, {}", off(p));
        } else {
            assert!((-PLANE_METRES..OFF + PLANE_METRES).contains(&off(p)), "{p}: between, {}", off(p));
        }
    }
    let row: Vec<_> = (0..dem.columns()).map(|c| off(dem.position(c, dem.rows() / 2))).collect();
    let steps = row.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let steepest = steps.fold(0.0, f64::max);
    // Half the radius of the largest disk between the hole and a corner: 240 m.
    assert!(steepest < SEAM_SLOPE * OFF / 24.0, "{steepest} m from sample to sample");
    assert!(steepest > 0.5 * OFF / 36.0, "there is a seam: {steepest}");
    // Where nothing lies beneath, the fine one keeps its weight up to its border.
    let half = square(&dir.path().join("half.tif"), NEAR - 100.0, 90.0, |p| plane(p) + OFF);
    let dem = together(&[&half, &square(&dir.path().join("all.tif"), NEAR, 10.0, plane)], &ReadOptions::default());
    assert!(places(&dem).all(|p| off(p).abs() < PLANE_METRES));
}

#[test]
fn a_seam_is_as_wide_as_the_land_beneath_is_coarse() {
    let dir = folder();
    let [wide, near] = wide_and_near(&dir);
    let between = square(&dir.path().join("between.tif"), 2100.0, 30.0, plane);
    let dem = together(&[&between, &near, &wide], &ReadOptions::default());
    let said = words(dem.history().converted());
    assert_eq!(said, ["near.tif on between.tif on wide.tif, cells of 10 m, seams blended over 120 to 360 m"]);
    let fine = places(&dem).filter(|p| inward(*p) > 120.0);
    let worst = fine.map(|p| (p.z - hummocks(p.truncate())).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst} m off");
}

#[test]
fn a_hole_in_a_layer_between_widens_no_other_seam() {
    const OFF: f64 = 20.0;
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let wide = square(&at("wide.tif"), WIDE, 300.0, |p| plane(p) + OFF);
    let is_hole = |p: DVec2| (p - MIDDLE).length() < 400.0;
    let between = square(&at("between.tif"), 2100.0, 30.0, |p| if is_hole(p) { -9999.0 } else { plane(p) + OFF });
    let dem = together(&[&wide, &between, &square(&at("near.tif"), NEAR, 10.0, plane)], &as_they_are());
    let fine = places(&dem).filter(|p| inward(*p) > 125.0);
    let worst = fine.map(|p| (p.z - plane(p.truncate())).abs()).fold(0.0, f64::max);
    assert!(worst < PLANE_METRES, "{worst} m off");
}

#[test]
fn a_fine_file_narrower_than_a_coarse_seam_shows() {
    const OFF: f64 = 20.0;
    let dir = folder();
    let wide = square(&dir.path().join("wide.tif"), WIDE, 90.0, |p| plane(p) + OFF);
    let is_strip = |p: DVec2| (p.x - MIDDLE.x).abs() < 150.0;
    let land = |p: DVec2| if is_strip(p) { plane(p) } else { -9999.0 };
    let dem = together(&[&wide, &square(&dir.path().join("strip.tif"), NEAR, 10.0, land)], &as_they_are());
    assert_eq!(words(dem.history().converted()), ["strip.tif on wide.tif, cells of 10 m, seams blended over 75 m"]);
    let inner = places(&dem).filter(|p| (p.x - MIDDLE.x).abs() < 75.0 && (p.y - MIDDLE.y).abs() < 900.0);
    let worst = inner.map(|p| (p.z - plane(p.truncate())).abs()).fold(0.0, f64::max);
    assert!(worst < PLANE_METRES, "{worst} m off");
}

#[test]
fn neighbours_with_other_cells_meet_without_a_stair() {
    let dir = folder();
    let slope = |p: DVec2| 2.0 * plane(p);
    let tile = |name: &str, west: f64, size: [usize; 2], cell: f64| {
        let corner = MIDDLE + DVec2::new(west, 300.0);
        let place = |i: usize| corner + DVec2::new((i % size[0]) as f64 + 0.5, -((i / size[0]) as f64 + 0.5)) * cell;
        let values = (0..size[0] * size[1]).map(|i| slope(place(i)) as f32).collect();
        let transform = Some([corner.x, cell, 0.0, corner.y, 0.0, -cell]);
        Raster { transform, epsg: Some(ZONE), ..Raster::new(size[0], values) }.write("GTiff", &dir.path().join(name))
    };
    let left = tile("left.tif", -400.0, [40, 60], 10.0);
    let right = tile("right.tif", 0.0, [20, 20], 30.0);
    // Beside one that is warped another that is.
    let beyond = tile("beyond.tif", 600.0, [30, 30], 20.0);
    for files in [[&left, &right, &beyond], [&beyond, &right, &left]] {
        let dem = together(&files, &as_they_are());
        assert_eq!((dem.cell(), dem.voids()), (DVec2::splat(10.0), 0));
        assert_eq!(words(dem.history().converted()), ["left.tif on beyond.tif on right.tif, cells of 10 m"]);
        let off = |p: DVec3| (p.z - slope(p.truncate())).abs();
        // The rim of all stays flat.
        let inner = places(&dem).filter(|p| (p.y - MIDDLE.y).abs() < 260.0 && p.x - MIDDLE.x < 1180.0);
        let worst = inner.map(off).fold(0.0, f64::max);
        assert!(worst < NEIGHBOURS_METRES, "{worst} m off");
    }
}

#[test]
fn a_globe_beneath_has_no_edges() {
    let dir = folder();
    let land = |lon: f64| 500.0 + 300.0 * (8.0 * lon).to_radians().sin();
    let values = (0..360 * 180).map(|i| land((i % 360) as f64 + 0.5) as f32).collect();
    let transform = Some([0.0, 1.0, 0.0, 90.0, 0.0, -1.0]);
    let globe = Raster { transform, epsg: Some(LONLAT), ..Raster::new(360, values) }
        .write("GTiff", &dir.path().join("globe.tif"));
    // At Greenwich.
    let middle = DVec2::new(291_800.0, 5_710_000.0);
    let transform = Some([middle.x - 2500.0, 1000.0, 0.0, middle.y + 2500.0, 0.0, -1000.0]);
    let near = Raster { transform, epsg: Some(32631), ..Raster::new(5, vec![500.0f32; 25]) }
        .write("GTiff", &dir.path().join("near.tif"));
    let [west, south, east, north] = [-40_000.0, -40_000.0, 40_000.0, 40_000.0];
    let crop = [middle.x + west, middle.y + south, middle.x + east, middle.y + north];
    let options = ReadOptions { keep_steps: true, ..cropped(crop) };
    let dem = together(&[&near, &globe], &options);
    assert_eq!(words(dem.history().converted())[0].split(',').next(), Some("near.tif on globe.tif"));
    let lonlat = hachure::dem::Crs::from_epsg(LONLAT).unwrap();
    let far = places(&dem).filter(|p| (p.truncate() - middle).abs().max_element() > 3000.0);
    let off = |p: DVec3| (p.z - land(dem.georeference().place_in(&lonlat, p.truncate()).unwrap().x)).abs();
    let worst = far.map(off).fold(0.0, f64::max);
    assert!(worst < 1.0, "{worst} m off");
}

#[test]
fn the_grid_of_a_file_is_drawn_where_it_is_asked_for() {
    let dir = folder();
    let [wide, near] = wide_and_near(&dir);
    let of = |path: &PathBuf| ReadOptions { cell_of: Some(path.clone()), ..Default::default() };
    let dem = together(&[&near, &wide], &of(&wide));
    assert_eq!((dem.cell(), dem.columns()), (DVec2::splat(90.0), 100));
    assert_eq!(together(&[&near, &wide], &of(&near)).cell(), DVec2::splat(10.0));
    let paths = [near.clone(), wide.clone()];
    let error = line(&read_all(&paths, &of(&dir.path().join("far.tif")), &|_, _| ()).unwrap_err());
    assert!(error.starts_with("--cell-of: ") && error.contains("far.tif is none of the files"), "{error}");
    assert!(error.contains(&format!("{}, {}", near.display(), wide.display())), "{error}");
    let refused = ReadOptions { memory: 1 << 20, ..of(&near) };
    let error = line(&read_all(&paths, &refused, &|_, _| ()).unwrap_err());
    assert!(error.contains("wide.tif is laid between the samples of others") && error.contains("--memory"), "{error}");
}

#[test]
fn where_the_finest_does_not_fit_the_crop_that_is_named_draws_it() {
    let dir = folder();
    let [wide, near] = wide_and_near(&dir);
    let globe = degrees(&dir.path().join("globe.tif"), WIDE, 90.0, hummocks);
    // 43 000 samples: the 10 000 of the wide file, not all 40 000 of the near one with those around it.
    let memory = 1 << 19;
    for files in [[&wide, &near], [&globe, &near], [&near, &globe]] {
        let small = ReadOptions { memory, ..Default::default() };
        let dem = together(&files, &small);
        assert!((70.0..100.0).contains(&dem.cell().x), "{files:?}: {:?}", dem.cell());
        let said = words(dem.history().assumed()).join("\n");
        assert!(said.contains("(all in the 10 m of near.tif do not fit: use --crop "), "{said}");
        assert!(said.contains("cells of 90 m ") || said.contains("cells of 75.7 m "), "{said}");
        let crop = said.split("--crop ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        let edges: Vec<f64> = crop.split(',').map(|edge| edge.parse().unwrap()).collect();
        let dem = together(&files, &ReadOptions { crop: edges.try_into().ok(), ..small });
        assert_eq!(dem.cell(), DVec2::splat(10.0), "{files:?}: {crop}");
        let share = (dem.columns() * dem.rows()) as f64 * 12.125 / memory as f64;
        assert!((0.85..1.0).contains(&share), "{files:?}: {crop} is about all that fits, {share}");
        let memory = said.split("--memory ").nth(1).and_then(|rest| rest.split("MiB").next()).unwrap();
        let more = ReadOptions { memory: memory.parse::<u64>().unwrap() << 20, ..Default::default() };
        assert_eq!(together(&files, &more).cell(), DVec2::splat(10.0), "{files:?}: {memory} MiB");
    }
    // A crop beside the near file has the cells of the wide one.
    let beside = cropped([497_000.0, 4_997_000.0, 498_500.0, 5_003_000.0]);
    assert_eq!(together(&[&wide, &near], &beside).cell(), DVec2::splat(90.0));
}

#[test]
fn files_of_several_systems_go_straight_to_the_finest() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let globe = degrees(&at("globe.tif"), WIDE, 90.0, plane);
    let near = square(&at("near.tif"), NEAR, 10.0, plane);
    let wide = square(&at("wide.tif"), WIDE, 90.0, plane);
    let near_globe = degrees(&at("near_globe.tif"), NEAR, 10.0, plane);
    let options = ReadOptions::default();
    for (files, degrees_first) in
        [([&globe, &near], true), ([&near, &globe], false), ([&wide, &near_globe], false), ([&near_globe, &wide], true)]
    {
        let dem = together(&files, &options);
        assert!((8.0..10.5).contains(&dem.cell().x), "{files:?}: {:?}", dem.cell());
        assert_eq!(dem.georeference().file().epsg(), Some(if degrees_first { LONLAT } else { ZONE }));
        assert_eq!(dem.georeference().world().epsg(), Some(ZONE));
        let inner = |p: &DVec3| (p.truncate() - MIDDLE).abs().max_element() < 2500.0;
        let worst = places(&dem).filter(inner).map(|p| (p.z - plane(p.truncate())).abs()).fold(0.0, f64::max);
        assert!(worst < PLANE_METRES, "{files:?}: {worst} m off");
    }
    // A crop is in the units of the first file.
    let part = [8.99, 45.14, 9.01, 45.16];
    let dem = together(&[&globe, &near], &cropped(part));
    let [west, south, east, north] = dem.extent();
    assert!(
        (1500.0..1700.0).contains(&(east - west)) && (2200.0..2300.0).contains(&(north - south)),
        "{:?}",
        dem.extent()
    );
}

#[test]
fn coarse_land_in_fine_cells_costs_what_it_shows() {
    let dir = folder();
    let [wide, near] = wide_and_near(&dir).map(|path| path.display().to_string());
    let [fine, json] = ["fine.png", "out.json"].map(|name| dir.path().join(name).display().to_string());
    let facets = |files: &[&str], view: &[&str]| {
        let arguments = [&["draw", "-o", &fine, "--json", &json, "--size", "320x200"], view, files].concat();
        let ran = Command::new(env!("CARGO_BIN_EXE_hachure")).args(arguments).output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
        let report: Value = serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
        report["facets"].as_f64().unwrap()
    };
    // Over the wide file, away from the near one, and from its edge over it.
    let out = ["--eye", "500000,5001500,+100", "--azimuth", "0", "--altitude", "-5"];
    let over = ["--eye", "500000,4999200,+100", "--azimuth", "0", "--altitude", "-5"];
    let (mixed, coarse) = (facets(&[&wide, &near], &out), facets(&[&wide], &out));
    assert!(mixed < MIXED_FACETS * coarse, "{mixed} facets for {coarse} of the wide one alone");
    let (mixed, parts) = (facets(&[&wide, &near], &over), facets(&[&wide], &over) + facets(&[&near], &over));
    assert!(mixed < MIXED_FACETS * parts, "{mixed} facets for {parts} of both alone");
}
