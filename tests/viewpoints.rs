//! Where the eye stands and what it looks at, in whatever coordinates; and DEMs that must draw the same picture.

use std::fs;
use std::path::Path;
use std::process::Output;

use gdal::spatial_ref::SpatialRef;
use gdal::{Dataset, DriverManager};
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};
use crate::common::shared_dems;
use crate::tolerances::{REACH_PX, SAME_GRID_SHARE, SAME_TERRAIN_SHARE};

/// A corner of the sample, drawn small.
const SMALL: [&str; 8] =
    ["--size", "96x64", "--crop", "540000,4184000,546000,4190000", "--level", "1", "-o", "out.png"];

/// The sample, from the repository.
fn sample() -> String {
    format!("{}/dem/golden-gate.tif", env!("CARGO_MANIFEST_DIR"))
}

fn draw(place: &Place, dem: &str, flags: &[&str]) -> Output {
    let output = place.run(&[&["draw", dem], flags].concat());
    assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
    output
}

/// Draws and returns the view of the report.
fn view(place: &Place, dem: &str, flags: &[&str]) -> Value {
    draw(place, dem, &[flags, &["--json", "report.json"]].concat());
    let text = fs::read_to_string(place.path("report.json")).expect("a report");
    serde_json::from_str::<Value>(&text).expect("JSON")["view"].take()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

/// What the program printed behind `label`.
fn printed(output: &Output, label: &str) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find_map(|line| line.strip_prefix(label)).unwrap_or_else(|| panic!("no {label}: {text}"));
    line.split(' ').map(str::to_owned).collect()
}

/// Length of the meridian from the equator on the WGS 84 ellipsoid, metres, by adding up its curvature.
fn meridian(latitude: f64) -> f64 {
    let (a, e2) = (6_378_137.0, 0.006_694_379_990_141_3_f64);
    let n = 100_000;
    let step = latitude.to_radians() / f64::from(n);
    let radius = |phi: f64| a * (1.0 - e2) / (1.0 - e2 * phi.sin().powi(2)).powf(1.5);
    (0..n).map(|i| radius((f64::from(i) + 0.5) * step) * step).sum()
}

#[test]
fn longitude_and_latitude_become_metres_of_the_map() {
    let place = Place::new();
    // On the middle meridian of zone 10 easting is 500 km, and northing 0.9996 of the meridian's length.
    let flags = [&SMALL[..], &["--lonlat", "-123,37.8,3000", "--azimuth", "90"]].concat();
    let view = view(&place, &sample(), &flags);
    let [x, y, z] = numbers(&view["eye"])[..] else { panic!("{view}") };
    let northing = 0.9996 * meridian(37.8);
    assert!((x - 500_000.0).abs() < 0.001 && (y - northing).abs() < 0.001 && z == 3000.0, "{x}, {y}, {z}; {northing}");
    let [longitude, latitude] = numbers(&view["lonlat"])[..] else { panic!("{view}") };
    assert!((longitude + 123.0).abs() < 1e-7 && (latitude - 37.8).abs() < 1e-7);
    assert_eq!(
        (&view["crs"], &view["metres_per_unit"]),
        (&Value::from("WGS 84 / UTM zone 10N (EPSG:32610)"), &Value::from(1.0))
    );
    assert!(view["crs_wkt"].as_str().is_some_and(|wkt| wkt.contains("Transverse_Mercator")));
}

#[test]
fn both_printed_views_repeat_the_picture() {
    let place = Place::new();
    let output =
        draw(&place, &sample(), &[&SMALL[..], &["--lonlat", "-122.51,37.83,+250", "--azimuth", "20"]].concat());
    let first = fs::read(place.path("out.png")).expect("out.png");
    for (label, eye) in [("view: ", "--eye"), ("or with: ", "--lonlat")] {
        let flags = printed(&output, label);
        assert_eq!([&flags[0], &flags[2], &flags[3]], [eye, "--north", "true"]);
        let repeat: Vec<_> = flags.iter().map(String::as_str).chain(SMALL.into_iter().skip(2)).collect();
        draw(&place, &sample(), &repeat);
        assert_eq!(fs::read(place.path("out.png")).expect("out.png"), first, "{flags:?}");
    }
}

#[test]
fn the_report_sets_any_place_on_the_page() {
    let place = Place::new();
    let flags = [&SMALL[..], &["--eye", "541000,4183000,900", "--look-at", "543210,4188765,123"]].concat();
    let view = view(&place, &sample(), &flags);
    let projection = &view["page"];
    let [right, up, forward] = ["right", "up", "forward"].map(|axis| numbers(&projection[axis]));
    let eye = numbers(&view["eye"]);
    let page = |p: [f64; 3]| {
        let dot = |axis: &[f64]| (0..3).map(|i| (p[i] - eye[i]) * axis[i]).sum::<f64>();
        let scale = projection["focal_px"].as_f64().expect("focal") / dot(&forward);
        let centre = numbers(&projection["centre_px"]);
        [centre[0] + scale * dot(&right), centre[1] - scale * dot(&up)]
    };
    let [x, y] = page([543_210.0, 4_188_765.0, 123.0]);
    assert!((x - 48.0).abs() < 0.01 && (y - 32.0).abs() < 0.01, "{x}, {y}: what is looked at is in the middle");
    let [higher, _] = [page([543_210.0, 4_188_765.0, 323.0]), [0.0; 2]];
    assert!(higher[1] < 31.0 && (higher[0] - 48.0).abs() < 0.01, "{higher:?}: higher is further up");
    // Half a page is half the angle of view.
    let half =
        (projection["centre_px"][0].as_f64().expect("centre") / projection["focal_px"].as_f64().expect("focal")).atan();
    assert!((half.to_degrees() - 30.0).abs() < 1e-9);
}

#[test]
fn eyes_may_be_given_in_another_system() {
    let place = Place::new();
    let globe = view(&place, &sample(), &[&SMALL[..], &["--lonlat", "-122.51,37.83,600", "--azimuth", "0"]].concat());
    let crs = [&SMALL[..], &["--crs", "EPSG:4326", "--eye", "-122.51,37.83,600", "--azimuth", "0"]].concat();
    assert_eq!(view(&place, &sample(), &crs)["eye"], globe["eye"], "x first, also for EPSG:4326");
    // The neighbouring zone reaches over.
    let east = [&SMALL[..], &["--crs", "EPSG:32611", "--eye", "14934.3,4195921.0,600", "--azimuth", "0"]].concat();
    let eye = numbers(&view(&place, &sample(), &east)["eye"]);
    assert!((540_000.0..548_000.0).contains(&eye[0]) && (4_180_000.0..4_190_000.0).contains(&eye[1]), "{eye:?}");
    // Looking at a place on the globe is looking at it on the map.
    let crs = [&SMALL[..], &["--crs", "EPSG:4326", "--eye", "-122.51,37.83,600", "--look-at", "-122.5,37.84"]].concat();
    let azimuth = view(&place, &sample(), &crs)["azimuth"].as_f64().expect("an azimuth");
    // 880 m east and 1110 m north on the globe, grid north half a degree west of it.
    assert!((azimuth - 38.4).abs() < 1.0, "{azimuth}");
}

#[test]
fn a_dem_in_degrees_is_seen_from_degrees() {
    let place = Place::new();
    let path = place.path("degrees.asc");
    let mut text = String::from("ncols 60\nnrows 60\nxllcorner 8.0\nyllcorner 46.5\ncellsize 0.001\n");
    for (c, r) in (0..60).flat_map(|r| (0..60).map(move |c| (f64::from(c) - 30.0, f64::from(r) - 30.0))) {
        text += &format!("{:.2} ", 900.0 * (-(c * c + r * r) / 150.0).exp());
    }
    fs::write(&path, text).expect("degrees.asc");
    let small = ["--size", "96x64", "--level", "2", "-o", "out.png"];
    let output = draw(&place, "degrees.asc", &[&small[..], &["--eye", "8.03,46.505,+300", "--azimuth", "0"]].concat());
    assert!(stderr(&output).contains("warning: assumed that coordinates are longitude and latitude"));
    let first = fs::read(place.path("out.png")).expect("out.png");
    let flags = printed(&output, "view: ");
    assert!(flags[1].starts_with("8.03,46.505,"), "{flags:?}");
    let repeat =
        [&["--level", "2", "-o", "out.png"][..], &flags.iter().map(String::as_str).collect::<Vec<_>>()].concat();
    draw(&place, "degrees.asc", &repeat);
    assert_eq!(fs::read(place.path("out.png")).expect("out.png"), first);
    // A chosen view is printed in degrees too, and repeats.
    let chosen = draw(&place, "degrees.asc", &small);
    let first = fs::read(place.path("out.png")).expect("out.png");
    let flags = printed(&chosen, "view: ");
    assert!(flags[1].starts_with("8.0") || flags[1].starts_with("7.9"), "{flags:?}");
    let repeat =
        [&["--level", "2", "-o", "out.png"][..], &flags.iter().map(String::as_str).collect::<Vec<_>>()].concat();
    draw(&place, "degrees.asc", &repeat);
    assert_eq!(fs::read(place.path("out.png")).expect("out.png"), first, "{flags:?}");
}

#[test]
fn a_missing_register_of_systems_is_told() {
    let place = Place::new();
    let mut command = place.command(&["draw", &sample(), "-o", "out.png", "--lonlat", "-122.5,37.8,900"]);
    let output = command.env("PROJ_DATA", "/nonexistent").env("PROJ_LIB", "/nonexistent").output().expect("it runs");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stderr(&output);
    assert!(said.contains("PROJ cannot find its register") && said.contains("PROJ_DATA"), "{said}");
    assert_eq!(place.written(), Vec::<String>::new());
}

#[test]
fn wrong_viewpoints_exit_with_2() {
    let place = Place::new();
    let draw = ["draw", "hill.asc", "-o", "out.png"];
    let cases: [(&[&str], &str); 12] = [
        (&["--lonlat", "7,46,500"], "names no coordinate system"),
        (&["--crs", "EPSG:4326", "--eye", "7,46,500"], "names no coordinate system"),
        (&["--lonlat", "46.5,95,500"], "longitude"),
        (&["--lonlat", "7,46"], "want LON,LAT,Z"),
        (&["--lonlat", "7,46,500", "--eye", "1,2,3"], "cannot be used with"),
        (&["--look-at", "1,2"], "--eye"),
        (&["--look-at", "1,2", "--eye", "500200,4000200,90", "--azimuth", "3"], "cannot be used with"),
        (&["--look-at", "500200,4000200,90", "--eye", "500200,4000200,90"], "where the eye stands"),
        (&["--look-at", "1,2", "--eye", "500200,4000200,90"], "no ground at 1,2"),
        (&["--crs", "EPSG:4326"], "--eye"),
        (&["--crs", "EPSG:1", "--eye", "1,2,3"], "EPSG:1 is unknown"),
        (&["--crs", "utm", "--eye", "1,2,3"], "want EPSG:N"),
    ];
    for (flags, words) in cases {
        refuses(&place, &[&draw[..], flags].concat(), 2, words);
    }
}

#[test]
fn a_place_on_the_globe_is_refused_in_the_name_of_a_local_system() {
    let place = Place::new();
    fs::write(place.path("hill.prj"), "LOCAL_CS[\"Site\",UNIT[\"metre\",1]]").expect("hill.prj");
    for flags in [&["--lonlat", "9,45,+100"][..], &["--crs", "EPSG:4326", "--eye", "9,45,+100"]] {
        let output = place.run(&[&["draw", "hill.asc", "-o", "out.png"], flags].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        let parts =
            ["local system \"Site\"", "give --eye E,N", "between 500005.00,4000005.00 and 500395.00,4000395.00 metres"];
        assert!(parts.iter().all(|part| said.contains(part)) && !said.contains("9,45"), "{said}");
    }
    // As it says: a place between them.
    draw(&place, "hill.asc", &["--eye", "500200,4000100,+100", "--size", "64x48", "-o", "out.png"]);
}

#[test]
fn a_place_off_the_map_is_told_with_the_system_of_the_dem() {
    let place = Place::new();
    let output = place.run(&["draw", &sample(), "-o", "out.png", "--lonlat", "147.5,0,500"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    let parts =
        ["\"WGS 84 / UTM zone 10N (EPSG:32610)\"", "between 536715.00,4180515.00 and 551685.00,4195485.00 metres"];
    assert!(parts.iter().all(|part| said.contains(part)), "{said}");
}

#[test]
fn longitude_and_latitude_of_another_body_are_its_own() {
    let place = Place::new();
    let mut text = String::from("ncols 40\nnrows 40\nxllcorner -134\nyllcorner 18\ncellsize 0.02\n");
    for (r, c) in (0..40).flat_map(|r| (0..40).map(move |c| (r, c))) {
        let hill = (-(f64::from(c - 20).powi(2) + f64::from(r - 10).powi(2)) / 30.0).exp();
        text += &format!("{} ", -2000.0 + 3000.0 * hill);
    }
    fs::write(place.path("mars.asc"), text).expect("mars.asc");
    let sphere = "DATUM[\"Mars\",SPHEROID[\"Mars\",3396190,0]],PRIMEM[\"Reference meridian\",0]";
    let globe = format!("GEOGCS[\"Mars\",{sphere},UNIT[\"degree\",0.0174532925199433]]");
    fs::write(place.path("mars.prj"), globe).expect("mars.prj");
    let flags = ["--lonlat", "-133.6,18.1,+2000", "--azimuth", "0", "--size", "96x64", "-o", "out.png"];
    let view = view(&place, "mars.asc", &flags);
    let at = numbers(&view["lonlat"]);
    assert!((at[0] + 133.6).abs() < 1e-7 && (at[1] - 18.1).abs() < 1e-7, "{at:?}");
    // Land 30 km away, of which it would be said how far the Earth's curve lowers it.
    let said = draw(&place, "mars.asc", &flags).stdout;
    assert!(!String::from_utf8_lossy(&said).contains("Earth"));
    let output = place.run(&["draw", "mars.asc", "-o", "out.png", "--crs", "EPSG:4326", "--eye", "-133.6,18.1,9000"]);
    let said = stderr(&output);
    assert!(output.status.code() == Some(2) && said.contains("the DEM, which lies in \"Mars"), "{said}");
}

/// A grid of 60 x 40 samples with a high hill in the west and a low one in the east, on a map whose axes run so.
fn two_hills(place: &Place, name: &str, epsg: u32, south_west: bool) {
    let (columns, rows, cell) = (60, 40, 30.0);
    let hill =
        |c: usize, r: usize, at: [f64; 2]| (-((c as f64 - at[0]).powi(2) + (r as f64 - at[1]).powi(2)) / 40.0).exp();
    let height =
        |c: usize, r: usize| (100.0 + 300.0 * hill(c, r, [20.0, 12.0]) + 150.0 * hill(c, r, [42.0, 10.0])) as f32;
    let [east, north] = [-703_000.0, -1_058_000.0];
    let (size, transform, heights): (_, _, Vec<f32>) = match south_west {
        true => {
            let heights = (0..columns).flat_map(|c| (0..rows).map(move |r| height(c, r))).collect();
            ((rows, columns), [-north, cell, 0.0, -east, 0.0, -cell], heights)
        }
        false => {
            let heights = (0..rows).flat_map(|r| (0..columns).map(move |c| height(c, r))).collect();
            ((columns, rows), [east, cell, 0.0, north, 0.0, -cell], heights)
        }
    };
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    let mut file = driver.create_with_band_type::<f32, _>(place.path(name), size.0, size.1, 1).expect("a file");
    file.set_geo_transform(&transform).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(epsg).expect("a system")).expect("a system");
    let mut buffer = gdal::raster::Buffer::new(size, heights);
    file.rasterband(1).expect("a band").write((0, 0), size, &mut buffer).expect("heights");
    file.close().expect("a file");
}

#[test]
fn axes_south_and_west_draw_the_same_picture_and_not_its_mirror_image() {
    let place = Place::new();
    two_hills(&place, "south-west.tif", 5513, true);
    two_hills(&place, "east-north.tif", 5514, false);
    let eye = "--lonlat 15.0144,49.9927,+80 --azimuth 0 --fov 90 --size 160x90 -o out.png --mask mask.png";
    let eye: Vec<_> = eye.split(' ').collect();
    let mask = |dem: &str, flags: &[&str]| {
        let view = view(&place, dem, flags);
        (fs::read(place.path("mask.png")).expect("a mask"), view)
    };
    let (truth, _) = mask("east-north.tif", &eye);
    let (ours, view) = mask("south-west.tif", &eye);
    assert!(ours == truth && truth.len() > 200, "the same from the same place");
    assert_eq!(view["axes"], serde_json::json!([[0.0, -1.0], [-1.0, 0.0]]));
    // The printed flags are in the file's own coordinates.
    let file = numbers(&view["file"]["eye"]);
    assert!(file[0] > 1_050_000.0 && file[1] > 690_000.0 && file[1] < 710_000.0, "{file:?}");
    let flags: Vec<_> = view["flags"].as_str().expect("flags").split(' ').collect();
    let (again, _) = mask("south-west.tif", &[&flags[..], &["-o", "out.png", "--mask", "mask.png"]].concat());
    assert!(again == truth, "{flags:?}");
    // Left is left: turned back, the picture is another.
    let mut turned = eye.clone();
    turned[3] = "180";
    assert!(mask("south-west.tif", &turned).0 != truth);
}

/// Ink of a mask, as (x, y).
fn ink(path: &Path) -> (u32, u32, Vec<bool>) {
    let mask = image::open(path).expect("a mask").to_luma8();
    (mask.width(), mask.height(), mask.pixels().map(|p| p.0[0] == 0).collect())
}

/// Share of the ink of `a` with ink of `b` within a pixel.
fn share_within_a_pixel(a: &Path, b: &Path) -> f64 {
    let ((width, height, a), (_, _, b)) = (ink(a), ink(b));
    let at = |x: i64, y: i64| {
        x >= 0 && y >= 0 && x < i64::from(width) && y < i64::from(height) && b[(y * i64::from(width) + x) as usize]
    };
    let reach = REACH_PX as i64;
    let near = |i: usize| {
        let (x, y) = (i as i64 % i64::from(width), i as i64 / i64::from(width));
        (-reach..=reach).any(|dy| (-reach..=reach).any(|dx| at(x + dx, y + dy)))
    };
    let inked: Vec<_> = (0..a.len()).filter(|&i| a[i]).collect();
    assert!(inked.len() > 1000, "{} pixels are too few to judge", inked.len());
    inked.iter().filter(|&&i| near(i)).count() as f64 / inked.len() as f64
}

/// Draws a DEM from a place on Earth.
fn draw_from(place: &Place, dem: &str, eye: &str, mask: &str) {
    let view = ["--crs", "EPSG:26911", "--eye", eye, "--look-at", "280000,4181000,2000", "--size", "960x540"];
    draw(place, dem, &[&view[..], &["--border", "off", "-o", "out.png", "--mask", mask]].concat());
}

/// Draws two DEMs from one place on Earth and returns the shares of ink of each within a pixel of the other's.
fn compared(place: &Place, dems: [&str; 2], eye: &str) -> [f64; 2] {
    for (dem, mask) in dems.iter().zip(["a.png", "b.png"]) {
        draw_from(place, dem, eye, mask);
    }
    let (a, b) = (place.path("a.png"), place.path("b.png"));
    [share_within_a_pixel(&a, &b), share_within_a_pixel(&b, &a)]
}

#[test]
fn yosemite_in_feet_and_in_metres_is_the_same_picture() {
    let Some(shared) = shared_dems() else { return };
    let place = Place::new();
    let (feet, metres) = (shared.join("yosemite_calif3_feet.tif"), shared.join("yosemite_utm11n_30m.tif"));
    let [feet, metres] = [&feet, &metres].map(|path| path.to_str().expect("a path"));
    let [a, b] = compared(&place, [feet, metres], "255000,4160000,6000");
    println!("feet and metres, two samplings of the ground: {a:.4} and {b:.4} of the ink within a pixel");
    assert!(a >= SAME_TERRAIN_SHARE && b >= SAME_TERRAIN_SHARE, "{a}, {b}");
    // The same samples, written in metres on every axis: the same projection has a name in metres.
    let same = place.path("same.tif");
    in_metres(Path::new(feet), &same);
    let [a, b] = compared(&place, [feet, same.to_str().expect("a path")], "273209,4179010,2225");
    println!("feet and metres, the same samples: {a:.4} and {b:.4}");
    assert!(a >= SAME_GRID_SHARE && b >= SAME_GRID_SHARE, "{a}, {b}");
    // The check sees an eye 30 m aside.
    draw_from(&place, feet, "273239,4179010,2225", "c.png");
    let aside = share_within_a_pixel(&place.path("c.png"), &place.path("b.png"));
    assert!(aside < SAME_TERRAIN_SHARE, "{aside}");
}

/// Writes a DEM in US survey feet (EPSG:2227) as one in metres (EPSG:26943), sample by sample.
fn in_metres(from: &Path, to: &Path) {
    let foot = 1200.0 / 3937.0;
    let feet = Dataset::open(from).expect("the feet");
    let (columns, rows) = feet.raster_size();
    let band = feet.rasterband(1).expect("a band");
    let nodata = band.no_data_value();
    let mut samples = band.read_band_as::<f32>().expect("samples");
    let metres = |v: f32| if Some(f64::from(v)) == nodata { v } else { (f64::from(v) * foot) as f32 };
    samples.data_mut().iter_mut().for_each(|v| *v = metres(*v));
    let driver = DriverManager::get_driver_by_name("GTiff").expect("GTiff");
    let mut file = driver.create_with_band_type::<f32, _>(to, columns, rows, 1).expect("a file");
    file.set_geo_transform(&feet.geo_transform().expect("a place").map(|v| v * foot)).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(26943).expect("EPSG:26943")).expect("a system");
    let mut band = file.rasterband(1).expect("a band");
    band.set_no_data_value(nodata).expect("nodata");
    band.write((0, 0), (columns, rows), &mut samples).expect("samples");
    file.close().expect("written");
}
