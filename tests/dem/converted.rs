//! What is done to a DEM on its way to metres, north up: places and heights against closed forms and the plain file.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use hachure::dem::{Crs, Dem};
use hachure::geo::{ElevationUnit, ReadOptions, ReadStage, read, read_all as read_files};

use super::{Raster, TRANSFORM, cropped, folder, hill, read_all, sized_vrt, vrt, with_steps};
use crate::common::words;
use crate::tolerances::{PLANE_METRES, WARP_METRES};

/// Metres per US survey foot.
const US_FOOT: f64 = 1200.0 / 3937.0;

/// Columns and rows of `waves`.
const SIZE: [usize; 2] = [120, 100];
/// Their corner and cell, degrees: in the west of UTM zone 11, where grid north is 1.6 degrees off.
const CORNER: [f64; 2] = [-119.6, 37.8];
const CELL: f64 = 1.0 / 3600.0;

/// Metres at a place in degrees: waves of 18 cells on a slope.
fn wave(place: DVec2) -> f64 {
    let p = (place - DVec2::from_array(CORNER)) / CELL;
    1500.0 + 2.0 * p.x - 3.0 * p.y + 40.0 * (p.x / 18.0 * std::f64::consts::TAU).sin() * (p.y / 18.0).cos()
}

/// The waves as samples in degrees.
fn waves() -> Raster<f32> {
    let place = |i: usize| DVec2::new((i % SIZE[0]) as f64 + 0.5, -((i / SIZE[0]) as f64 + 0.5));
    let heights = (0..SIZE[0] * SIZE[1]).map(|i| wave(DVec2::from_array(CORNER) + place(i) * CELL) as f32);
    let transform = Some([CORNER[0], CELL, 0.0, CORNER[1], 0.0, -CELL]);
    Raster { transform, epsg: Some(4326), ..Raster::new(SIZE[0], heights.collect()) }
}

fn written(raster: Raster<f32>, name: &str, folder: &Path) -> PathBuf {
    raster.write("GTiff", &folder.join(name))
}

/// Largest distance of the DEM's valid samples from the waves, metres, each looked up where PROJ says it lies.
fn off_waves(dem: &Dem) -> f64 {
    let mut worst: f64 = 0.0;
    for (c, r) in (0..dem.rows()).step_by(7).flat_map(|r| (0..dem.columns()).step_by(5).map(move |c| (c, r))) {
        let Some(height) = dem.height(c, r) else { continue };
        let place = dem.georeference().lonlat(dem.position(c, r).truncate()).unwrap().unwrap();
        worst = worst.max((f64::from(height) - wave(place)).abs());
    }
    worst
}

#[test]
fn degrees_become_square_metres_in_the_right_place() {
    let dir = folder();
    let dem = read_all(&written(waves(), "waves.tif", dir.path()));
    assert_eq!(dem.georeference().world().epsg(), Some(32611));
    assert_eq!(dem.georeference().file().epsg(), Some(4326));
    // 30.8 m x 24.5 m, so 27.5 m square; whole multiples of it.
    assert_eq!(dem.cell(), DVec2::splat(27.5));
    assert!(dem.position(0, 0).truncate().to_array().iter().all(|x| (x / 27.5).fract().abs() < 1e-9));
    let worst = off_waves(&dem);
    println!("waves in degrees: {worst} m off at worst");
    assert!(worst < WARP_METRES, "{worst} m");
    assert!(words(dem.history().converted())[0].contains("WGS 84 / UTM zone 11N (EPSG:32611), cubic"));
    // A reader that took corners for middles would be half a cell off: the check must see that.
    let mut shifted = waves();
    shifted.transform = shifted.transform.map(|[x, dx, a, y, b, dy]| [x + CELL / 2.0, dx, a, y, b, dy]);
    assert!(off_waves(&read_all(&written(shifted, "shifted.tif", dir.path()))) > 10.0 * WARP_METRES);
}

#[test]
fn a_warped_dem_is_cut_to_a_full_rectangle() {
    let dir = folder();
    let dem = read_all(&written(waves(), "waves.tif", dir.path()));
    assert_eq!(dem.voids(), 0, "no sample may lie outside the data");
    let share = (dem.columns() * dem.rows()) as f64 / (SIZE[0] * SIZE[1]) as f64;
    assert!(share > 0.88, "only {share} of the samples are left");
}

#[test]
fn a_crop_in_degrees_takes_the_same_samples() {
    let dir = folder();
    let path = written(waves(), "waves.tif", dir.path());
    let at_30 = ReadOptions { resample: Some(30.0), ..Default::default() };
    let whole = read(&path, &at_30).unwrap();
    let [west, south, east, north] = [-119.59, 37.78, -119.575, 37.793];
    let part = read(&path, &ReadOptions { crop: Some([west, south, east, north]), ..at_30 }).unwrap();
    assert!(part.columns() > 35 && part.rows() > 40, "{} x {}", part.columns(), part.rows());
    let [nw, first] = [&whole, &part].map(|dem| dem.position(0, 0));
    let [dc, dr] = [(first.x - nw.x) / 30.0, (nw.y - first.y) / 30.0].map(|d| d.round() as usize);
    for (c, r) in (0..part.rows()).flat_map(|r| (0..part.columns()).map(move |c| (c, r))) {
        let place = part.georeference().lonlat(part.position(c, r).truncate()).unwrap().unwrap();
        assert!((west..=east).contains(&place.x) && (south..=north).contains(&place.y), "{place} is outside");
        let gap = part.height(c, r).unwrap() - whole.height(c + dc, r + dr).unwrap();
        assert!(f64::from(gap.abs()) < WARP_METRES, "sample {c}, {r}: {gap} m");
    }
}

#[test]
fn longitudes_may_run_round_the_globe() {
    let dir = folder();
    for turn in [360.0, -360.0] {
        let mut raster = waves();
        raster.transform = raster.transform.map(|[x, dx, a, y, b, dy]| [x + turn, dx, a, y, b, dy]);
        let dem = read_all(&written(raster, "turned.tif", dir.path()));
        assert!(off_waves(&dem) < WARP_METRES && dem.voids() == 0);
    }
}

#[test]
fn zones_follow_the_middle_and_poles_have_their_own() {
    let dir = folder();
    for (place, epsg) in [([170.1, -43.5], 32759), ([10.0, 88.0], 5041), ([-60.0, -85.0], 5042), ([8.0, 47.0], 32632)] {
        let raster = Raster { transform: Some([place[0], 0.01, 0.0, place[1], 0.0, -0.001]), ..waves() };
        let dem = read_all(&written(raster, "place.tif", dir.path()));
        assert_eq!(dem.georeference().world().epsg(), Some(epsg));
    }
}

#[test]
fn nameless_degrees_are_taken_with_a_warning() {
    let dir = folder();
    let dem = read_all(&written(Raster { epsg: None, ..waves() }, "nameless.tif", dir.path()));
    assert_eq!(dem.georeference().file().epsg(), Some(4326));
    let warning = &words(dem.history().assumed())[0];
    assert!(warning.starts_with("coordinates are longitude and latitude in degrees"), "{warning}");
    assert!(warning.contains("gdal_translate -a_srs"), "{warning}");
    assert!(off_waves(&dem) < WARP_METRES);
}

#[test]
fn marks_are_voids_before_anything_is_resampled() {
    let dir = folder();
    let mut raster = waves();
    // Undeclared, declared and not a number: each would drag its neighbours down or away.
    for (i, mark) in [(3000, -32767.0), (5050, -9999.0), (7070, f32::NAN)] {
        raster.values[i] = mark;
    }
    raster.nodata = Some(-9999.0);
    let dem = read_all(&written(raster, "marks.tif", dir.path()));
    assert!((1..9).contains(&dem.voids()), "{} voids", dem.voids());
    let worst = off_waves(&dem);
    assert!(worst < 10.0 * WARP_METRES, "beside a void {worst} m");
    assert!(words(dem.history().assumed())[0].starts_with("1 samples at or below -32767"), "{:?}", dem.history());
}

#[test]
fn turned_grids_stand_north_up() {
    let dir = folder();
    let plane = |p: DVec2| 100.0 + 0.3 * (p.x - 5e5) - 0.2 * (p.y - 4e6);
    let grids =
        [[5e5, 30.0, 8.0, 4e6, 8.0, -30.0], [5e5, 0.0, 30.0, 4e6, 30.0, 0.0], [5e5, -21.0, 21.0, 4e6, 21.0, 21.0]];
    for [x, along_x, down_x, y, along_y, down_y] in grids {
        let place = |i: usize| {
            let (c, r) = ((i % 60) as f64 + 0.5, (i / 60) as f64 + 0.5);
            DVec2::new(x + c * along_x + r * down_x, y + c * along_y + r * down_y)
        };
        let heights = (0..60 * 50).map(|i| plane(place(i)) as f32).collect();
        let transform = Some([x, along_x, down_x, y, along_y, down_y]);
        let path = written(Raster { transform, ..Raster::new(60, heights) }, "turned.tif", dir.path());
        let dem = read(&path, &with_steps()).unwrap();
        assert_eq!(dem.voids(), 0);
        assert!(dem.columns() * dem.rows() > 1000, "{} x {}", dem.columns(), dem.rows());
        for (c, r) in (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| (c, r))) {
            let p = dem.position(c, r);
            assert!((p.z - plane(p.truncate())).abs() < PLANE_METRES, "sample {c}, {r} of {transform:?}: {p}");
        }
        assert_eq!(dem.georeference().world(), dem.georeference().file());
    }
}

#[test]
fn south_up_and_mirrored_grids_are_read_backwards() {
    let dir = folder();
    let truth = read_all(&written(hill(), "hill.tif", dir.path()));
    for [mirrored, south_up] in [[false, true], [true, false], [true, true]] {
        let flip = |i: usize| {
            let (c, r) = (i % 4, i / 4);
            (if south_up { 2 - r } else { r }) * 4 + if mirrored { 3 - c } else { c }
        };
        let [x, dx, _, y, _, dy] = TRANSFORM;
        let (x, dx) = if mirrored { (x + 4.0 * dx, -dx) } else { (x, dx) };
        let (y, dy) = if south_up { (y + 3.0 * dy, -dy) } else { (y, dy) };
        let values = (0..12).map(|i| hill().values[flip(i)]).collect();
        let raster = Raster { values, transform: Some([x, dx, 0.0, y, 0.0, dy]), ..hill() };
        let path = written(raster, "flipped.tif", dir.path());
        let dem = read_all(&path);
        assert_eq!(
            dem.held().unwrap().heights(),
            truth.held().unwrap().heights(),
            "mirrored {mirrored}, south-up {south_up}"
        );
        assert_eq!(dem.extent(), truth.extent());
        assert_eq!(words(dem.history().converted()), ["rows and columns are read backwards, north up"]);
        let crop = cropped([500_045.0, 4_199_950.0, 500_104.9, 4_199_970.0]);
        assert_eq!(read(&path, &crop).unwrap().held().unwrap().heights(), [105.0, 106.0, 109.0, 110.0]);
    }
}

#[test]
fn feet_become_metres_on_every_axis() {
    let dir = folder();
    let transform = Some([6.8e6, 100.0, 0.0, 2.1e6, 0.0, -100.0]);
    let path = written(Raster { transform, epsg: Some(2227), ..hill() }, "feet.tif", dir.path());
    let dem = read_all(&path);
    assert!((dem.cell() - DVec2::splat(100.0 * US_FOOT)).length() < 1e-9);
    let sample = DVec3::new(6_800_050.0 * US_FOOT, 2_099_950.0 * US_FOOT, 100.0);
    assert!((dem.position(0, 0) - sample).length() < 1e-6, "{}", dem.position(0, 0));
    // Beside feet on the map, metres of elevation are worth a warning; the flag ends it.
    assert!(words(dem.history().assumed())[0].starts_with("elevations are metres"), "{:?}", dem.history());
    let told = ReadOptions { elevation_unit: Some(ElevationUnit::US_FOOT), ..Default::default() };
    let dem = read(&path, &told).unwrap();
    assert!((f64::from(dem.range().unwrap()[0]) - 100.0 * US_FOOT).abs() < 1e-5);
    assert!(dem.history().assumed().is_empty(), "{:?}", dem.history());
    // The place is the same one on the globe as in the same projection in metres.
    let [feet, metres] = [2227, 26943].map(|epsg| Crs::from_epsg(epsg).unwrap());
    let world = dem.position(0, 0).truncate();
    let in_metres = dem.georeference().place_in(&metres, world).unwrap();
    assert!((in_metres - world).length() < 1e-3, "{in_metres} is not {world}");
    assert!(
        (dem.georeference().place_in(&feet, world).unwrap() - DVec2::new(6_800_050.0, 2_099_950.0)).length() < 1e-3
    );
}

#[test]
fn elevations_become_metres_by_the_unit_of_the_band() {
    let dir = folder();
    hill().write("GTiff", &dir.path().join("hill.tif"));
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    let units = [
        ("ft", 0.3048),
        ("Feet", 0.3048),
        ("US survey foot", US_FOOT),
        ("us-ft", US_FOOT),
        ("dm", 0.1),
        ("km", 1000.0),
        ("m", 1.0),
        ("Meters", 1.0),
        ("", 1.0),
    ];
    for (unit, metres) in units {
        let path = vrt(&dir.path().join("up.vrt"), "", &format!("<UnitType>{unit}</UnitType>{source}"));
        let lowest = f64::from(read_all(&path).range().unwrap()[0]);
        assert!((lowest / (100.0 * metres) - 1.0).abs() < 1e-6, "{unit}: {lowest} m");
        let told = ReadOptions { elevation_unit: Some(ElevationUnit::FOOT), ..Default::default() };
        let lowest = f64::from(read(&path, &told).unwrap().range().unwrap()[0]);
        assert!((lowest / 30.48 - 1.0).abs() < 1e-6, "{unit}, told feet: {lowest} m");
    }
    let compound = "<SRS>EPSG:32610+6360</SRS><GeoTransform>500000, 30, 0, 4200000, 0, -20</GeoTransform>";
    let dem = read_all(&vrt(&dir.path().join("compound.vrt"), compound, source));
    assert!((f64::from(dem.range().unwrap()[0]) / (100.0 * US_FOOT) - 1.0).abs() < 1e-6);
}

#[test]
fn an_image_is_placed_by_the_size_of_its_cells() {
    let dir = folder();
    let path = written(Raster { transform: None, epsg: None, ..hill() }, "image.tif", dir.path());
    let dem = read(&path, &ReadOptions { cell: Some(25.0), ..Default::default() }).unwrap();
    assert_eq!((dem.cell(), dem.extent()), (DVec2::splat(25.0), [12.5, 12.5, 87.5, 62.5]));
    assert_eq!(dem.held().unwrap().heights(), hill().values);
}

#[test]
fn resampling_is_asked_for_and_exact_on_a_plane() {
    let dir = folder();
    let heights = (0..4000).map(|i| (i % 80) as f32 * 3.0 + (i / 80) as f32 * 2.0).collect();
    let path = written(Raster::new(80, heights), "plane.tif", dir.path());
    assert_eq!(read_all(&path).cell(), DVec2::new(30.0, 20.0), "a projected north-up grid is never resampled unasked");
    for metres in [12.5, 100.0] {
        let dem = read(&path, &ReadOptions { resample: Some(metres), ..with_steps() }).unwrap();
        assert_eq!((dem.cell(), dem.voids()), (DVec2::splat(metres), 0));
        // Where larger cells gather beyond the border the plane bends.
        let edge = if metres > 30.0 { 3 } else { 2 };
        for (c, r) in (edge..dem.rows() - edge).flat_map(|r| (edge..dem.columns() - edge).map(move |c| (c, r))) {
            let p = dem.position(c, r);
            let plane = (p.x - 500_015.0) / 30.0 * 3.0 + (4_199_990.0 - p.y) / 20.0 * 2.0;
            assert!((p.z - plane).abs() < PLANE_METRES, "{metres} m, sample {c}, {r}: {} is not {plane}", p.z);
        }
    }
}

#[test]
fn larger_cells_are_means_not_picks() {
    let dir = folder();
    // Every other sample 100 m higher: a pick is 20 m or 120 m, a mean 70 m.
    let heights = (0..6400).map(|i| if (i % 80 + i / 80) % 2 == 0 { 20.0 } else { 120.0 }).collect();
    let transform = Some([5e5, 10.0, 0.0, 42e5, 0.0, -10.0]);
    let path = written(Raster { transform, ..Raster::new(80, heights) }, "checks.tif", dir.path());
    let dem = read(&path, &ReadOptions { resample: Some(60.0), ..Default::default() }).unwrap();
    let [low, high] = dem.range().unwrap();
    assert!(low > 60.0 && high < 80.0, "{low} to {high} m");
}

#[test]
fn voids_are_filled_when_asked_and_only_so_far() {
    let dir = folder();
    let width = 300;
    let hole = |i: usize| (40..44).contains(&(i % width)) && (10..13).contains(&(i / width)) || i % width > 150;
    let heights = (0..width * 30).map(|i| if hole(i) { -9999.0 } else { (i % width) as f32 }).collect();
    let path = written(Raster { nodata: Some(-9999.0), ..Raster::new(width, heights) }, "holes.tif", dir.path());
    assert_eq!(read_all(&path).voids(), 12 + 149 * 30);
    let dem = read(&path, &ReadOptions { fill_voids: true, ..with_steps() }).unwrap();
    assert!((dem.height(41, 11).unwrap() - 41.0).abs() < 3.0, "{:?}", dem.height(41, 11));
    assert!(dem.height(200, 15).is_some() && dem.height(290, 15).is_none());
    let filled = 12 + 149 * 30 - dem.voids();
    let said = &words(dem.history().converted())[0];
    assert!(said.starts_with(&format!("{filled} voids filled from up to 100 samples away (--fill-voids), ")), "{said}");
    assert!(said.ends_with(&format!("{} farther away stay holes", dem.voids())), "{said}");
    let whole = read(written(hill(), "hill.tif", dir.path()), &ReadOptions { fill_voids: true, ..Default::default() });
    assert!(whole.unwrap().history().converted().is_empty(), "nothing to fill, nothing to say");
}

#[test]
fn stretched_maps_too_small_to_be_warped_get_a_warning() {
    let dir = folder();
    let mercator = Raster { transform: Some([-13e6, 30.0, 0.0, 6e6, 0.0, -30.0]), epsg: Some(3857), ..hill() };
    let dem = read_all(&written(mercator, "mercator.tif", dir.path()));
    let warning = &words(dem.history().assumed())[0];
    assert!(warning.contains("scale 1.47") && warning.contains("too flat"), "{warning}");
    assert!(read_all(&written(hill(), "hill.tif", dir.path())).history().assumed().is_empty());
}

#[test]
fn a_huge_grid_of_degrees_is_read_by_window() {
    let dir = folder();
    let degrees = "<SRS>EPSG:4326</SRS><GeoTransform>-180, 1e-5, 0, 90, 0, -1e-5</GeoTransform>";
    let path = sized_vrt(&dir.path().join("globe.vrt"), 36_000_000, 18_000_000, degrees, "<Scale>1</Scale>");
    let dem = read(&path, &cropped([8.0, 46.0, 8.002, 46.002])).unwrap();
    assert!(dem.columns() > 150 && dem.rows() > 150, "{} x {}", dem.columns(), dem.rows());
}

#[test]
fn progress_runs_through_every_stage_once() {
    let dir = folder();
    let mut raster = waves();
    raster.values[5050] = f32::NAN;
    let path = written(raster, "waves.tif", dir.path());
    let heard = std::cell::RefCell::new(Vec::new());
    let options = ReadOptions { fill_voids: true, ..Default::default() };
    read_files(&[path], &options, &|stage, share| heard.borrow_mut().push((stage, share))).unwrap();
    let heard = heard.into_inner();
    for stage in [ReadStage::Read, ReadStage::Warp, ReadStage::Fill] {
        let shares: Vec<_> = heard.iter().filter(|(s, _)| *s == stage).map(|(_, share)| *share).collect();
        assert!(shares.is_sorted() && shares.last() == Some(&1.0), "{stage:?}: {shares:?}");
    }
    let order = heard.iter().map(|(stage, _)| *stage as u8);
    assert!(order.is_sorted(), "{heard:?}");
}
