//! Picks: what a pixel shows and where a place stands, on land whose answers are known in closed form; which rule drew a line or
//! left it out; and what is said where there is no answer.

mod advised;

use std::fs;
use std::path::Path;
use std::process::Output;

use gdal::DriverManager;
use gdal::raster::Buffer;
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use glam::{DVec2, DVec3};
use hachure::geo::{ReadOptions, read};
use hachure::view::Camera;
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};
use crate::tolerances::PICKED_M;

/// Samples along a side of made land, metres between them, its north-west corner as files have it.
const SIDE: usize = 200;
const CELL: f64 = 10.0;
const CORNER: [f64; 2] = [560_000.0, 5_540_000.0];
/// A page, small.
const SIZE: [&str; 2] = ["--size", "320x240"];

/// A file of made land in UTM zone 32; heights by metres east and south of its north-west sample.
pub fn land(path: &Path, height: impl Fn(f64, f64) -> f64) {
    // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
    let _ = read(Path::new(""), &ReadOptions::default());
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    let mut file = driver.create_with_band_type::<f32, _>(path, SIDE, SIDE, 1).expect("a file");
    file.set_geo_transform(&[CORNER[0], CELL, 0.0, CORNER[1], 0.0, -CELL]).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(32632).expect("a CRS")).expect("a CRS");
    let of = |i: usize| height((i % SIDE) as f64 * CELL, (i / SIDE) as f64 * CELL) as f32;
    let mut samples = Buffer::new((SIDE, SIDE), (0..SIDE * SIDE).map(of).collect());
    file.rasterband(1).expect("a band").write((0, 0), (SIDE, SIDE), &mut samples).expect("samples");
    file.close().expect("a file");
}

/// Easting and northing of a place so many metres east and south of the north-west sample.
fn at(east: f64, south: f64) -> DVec2 {
    DVec2::new(CORNER[0] + CELL / 2.0 + east, CORNER[1] - CELL / 2.0 - south)
}

fn pick(place: &Place, flags: &[&str]) -> Output {
    let output = place.run(&[&["pick", "land.tif", "--keep-steps"], flags].concat());
    assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
    output
}

fn answer(place: &Place, flags: &[&str]) -> Value {
    let output = pick(place, &[flags, &["--json", "-"]].concat());
    serde_json::from_slice(&output.stdout).expect("nothing but JSON")
}

fn text(place: &Place, flags: &[&str]) -> String {
    String::from_utf8(pick(place, flags).stdout).expect("text")
}

/// What stands behind a name in the words of an answer.
fn row<'a>(text: &'a str, name: &str) -> &'a str {
    let found = text.lines().find_map(|line| line.strip_prefix(name).filter(|rest| rest.starts_with(' ')));
    found.unwrap_or_else(|| panic!("no {name}: {text}")).trim_start()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn pair(value: &Value) -> DVec2 {
    DVec2::new(number(&value[0]), number(&value[1]))
}

/// A plane that rises by .2 to the east and by .1 to the south.
fn plane(east: f64, south: f64) -> f64 {
    100.0 + 0.2 * east + 0.1 * south
}

/// Where the ray through the middle of a pixel meets the plane, its heights times a factor: by the formulas of the handbook.
fn on_plane(camera: &Camera, pixel: [u32; 2], exaggeration: f64) -> DVec3 {
    let (a, e) = (camera.azimuth.to_radians(), camera.altitude.to_radians());
    let forward = DVec3::new(a.sin() * e.cos(), a.cos() * e.cos(), e.sin());
    let right = DVec3::new(a.cos(), -a.sin(), 0.0);
    let up = right.cross(forward);
    let focal = f64::from(camera.width) / 2.0 / (camera.fov.to_radians() / 2.0).tan();
    let x = (f64::from(pixel[0]) + 0.5 - f64::from(camera.width) / 2.0) / focal;
    let y = (f64::from(pixel[1]) + 0.5 - f64::from(camera.height) / 2.0) / focal;
    let ray = forward + right * x - up * y;
    let origin = at(0.0, 0.0);
    let normal = DVec3::new(-0.2, 0.1, 1.0 / exaggeration);
    let below = (camera.eye - DVec3::new(origin.x, origin.y, 100.0 * exaggeration)).dot(normal);
    camera.eye - ray * (below / ray.dot(normal))
}

/// Degrees between two directions.
fn turned(a: f64, b: f64) -> f64 {
    ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs()
}

#[test]
fn a_pixel_tells_where_its_land_is_how_high_how_far_and_how_steep() {
    let place = Place::new();
    land(&place.path("land.tif"), plane);
    let mut from = SpatialRef::from_epsg(32632).expect("a CRS");
    let mut to = SpatialRef::from_epsg(4326).expect("a CRS");
    from.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    to.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let to_degrees = CoordTransform::new(&from, &to).expect("a way");
    for (exaggeration, altitude) in [(1.0, -20.0), (3.0, -45.0)] {
        let stand = at(900.0, 1500.0);
        let eye = stand.extend(600.0 * exaggeration);
        let camera = Camera { eye, azimuth: 340.0, altitude, fov: 50.0, width: 320, height: 240 };
        let (eye_flag, factor) = (format!("{},{},{}", eye.x, eye.y, eye.z), exaggeration.to_string());
        let altitude = altitude.to_string();
        let view = ["--eye", &eye_flag, "--azimuth", "340", "--altitude", &altitude, "--fov", "50"];
        for pixel in [[160, 120], [20, 230], [300, 200]] {
            let asked = format!("{},{}", pixel[0], pixel[1]);
            let told = answer(&place, &[&view[..], &SIZE, &["--exaggeration", &factor, "--at", &asked]].concat());
            let met = on_plane(&camera, pixel, exaggeration);
            assert!(met.distance(eye) < 4000.0, "the plane is there: {met}");
            assert_eq!(told["shows"], "land");
            let found = pair(&told["place"]);
            assert!(found.distance(met.truncate()) < PICKED_M, "{found} and {met}");
            assert!((number(&told["elevation_m"]) - met.z / exaggeration).abs() < PICKED_M, "{told}");
            // The land's own, without exaggeration.
            let way = (met - eye) * DVec3::new(1.0, 1.0, 1.0 / exaggeration);
            assert!((number(&told["distance_m"]) - way.length()).abs() < PICKED_M);
            assert!((number(&told["map_distance_m"]) - way.truncate().length()).abs() < PICKED_M);
            let angle = (way.z / way.truncate().length()).atan().to_degrees();
            assert!((number(&told["vertical_angle"]) - angle).abs() < 1e-4, "{angle}: {told}");
            let bearing = way.x.atan2(way.y).to_degrees().rem_euclid(360.0);
            assert!(turned(number(&told["grid_bearing"]), bearing) < 1e-4, "{bearing}: {told}");
            // By the convergence of a transverse Mercator map at the eye, 9 degrees east being its meridian.
            let (mut lon, mut lat) = ([stand.x, found.x], [stand.y, found.y]);
            to_degrees.transform_coords(&mut lon, &mut lat, &mut []).expect("degrees");
            let convergence = ((lon[0] - 9.0).to_radians().tan() * lat[0].to_radians().sin()).atan().to_degrees();
            assert!(convergence > 0.5, "worth a test");
            assert!(turned(number(&told["true_bearing"]), bearing + convergence) < 1e-3, "{convergence}: {told}");
            assert!(pair(&told["lonlat"]).distance(DVec2::new(lon[1], lat[1])) < 1e-9, "{told}");
            let normal = DVec3::new(-0.2, 0.1, 1.0).normalize();
            let off_sight = normal.dot(way.normalize()).abs().asin().to_degrees();
            let facing = told["lines"].as_array().expect("lines").iter().find(|line| line["rule"] == "facing");
            let facing = number(&facing.expect("no silhouette")["numbers"]["off_sight_degrees"]);
            assert!((facing - off_sight).abs() < 1e-2, "{facing} and {off_sight}");
            assert!((number(&told["slope"]) - 0.05_f64.sqrt().atan().to_degrees()).abs() < 1e-3, "{told}");
            // Down to the north-west: .2 to the west for .1 to the north.
            assert!(
                turned(number(&told["falls_towards"]), 360.0 - 2.0_f64.atan().to_degrees() + convergence) < 0.05,
                "{told}"
            );
        }
    }
}

#[test]
fn what_is_told_of_a_pixel_leads_back_to_it() {
    let place = Place::new();
    land(&place.path("land.tif"), |east, south| 150.0 + 60.0 * (east / 130.0).sin() * (south / 170.0).cos());
    let eye = at(1000.0, 1900.0);
    let eye = format!("{},{},+40", eye.x, eye.y);
    let view = [&["--eye", &eye, "--azimuth", "5", "--altitude", "-6"][..], &SIZE].concat();
    let mut seen = 0;
    for pixel in ["11,200", "160,130", "310,190", "80,120", "222,160", "160,239"] {
        let words = text(&place, &[&view[..], &["--at", pixel]].concat());
        if !row(&words, "pixel").contains(": land") {
            continue;
        }
        seen += 1;
        let (map, rest) = row(&words, "place").split_once(" (longitude, latitude ").expect("both");
        for of in [map, rest.trim_end_matches(')')] {
            let words = text(&place, &[&view[..], &["--of", of]].concat());
            let [column, row_of] = pixel.split(',').collect::<Vec<_>>()[..] else { panic!() };
            let wanted = format!("pixel {pixel}, at {column}.50,{row_of}.50 px");
            assert_eq!((row(&words, "page"), row(&words, "seen")), (wanted.as_str(), "yes"), "{of}: {words}");
        }
    }
    assert!(seen > 3, "only {seen} pixels show land");
}

/// A wall of 100 m that runs from west to east, 1000 m south of the northern edge, 200 m across; plain to both sides.
fn wall(_: f64, south: f64) -> f64 {
    (100.0 - (south - 1000.0).abs()).max(0.0)
}

#[test]
fn a_hidden_place_names_what_hides_it() {
    let place = Place::new();
    land(&place.path("land.tif"), wall);
    let (eye, hidden) = (at(1000.0, 1900.0), at(1040.0, 700.0));
    let eye = format!("{},{},50", eye.x, eye.y);
    let view = [&["--eye", &eye, "--azimuth", "0"][..], &SIZE].concat();
    let of = format!("{},{}", hidden.x, hidden.y);
    let told = answer(&place, &[&view[..], &["--of", &of]].concat());
    assert_eq!((&told["seen"], &told["why_not"]), (&false.into(), &"hidden".into()), "{told}");
    // The line of sight falls from 50 m to 0 over 1200 m; the southern face of the wall rises by a metre a metre from 1100 m on.
    let along = |south: f64| (1900.0 - south) / 1200.0;
    let south = (1100.0 - 50.0 + 50.0 * 1900.0 / 1200.0) / (1.0 + 50.0 / 1200.0);
    let wanted = at(1000.0 + 40.0 * along(south), south);
    let by = &told["hidden_by"];
    assert!(pair(&by["place"]).distance(wanted) < 1.0, "{wanted}: {by}");
    assert!((number(&by["elevation_m"]) - (50.0 - 50.0 * along(south))).abs() < 1.0, "{by}");
    let distance = (DVec2::new(40.0, 1200.0) * along(south)).extend(50.0 * along(south)).length();
    assert!((number(&by["distance_m"]) - distance).abs() < 1.0, "{distance}: {by}");
    // Over the crest, 900 m away and 50 m above the eye, sight rises as much again until there; the crest is rounded.
    let from = 50.0 + 50.0 / 900.0 * 1200.0;
    assert!((number(&by["seen_from_m"]) - from).abs() < 3.0, "{from}: {by}");
    let words = text(&place, &[&view[..], &["--of", &of]].concat());
    let [x, y] = [number(&by["place"][0]), number(&by["place"][1])];
    let begin = format!("no: hidden by land {:.2} m away at {x:.3},{y:.3} (longitude, ", number(&by["distance_m"]));
    assert!(row(&words, "seen").starts_with(&begin) && words.contains(" m above its ground on it is seen"), "{words}");
    assert!(row(&words, "page").starts_with("pixel 1"), "it stands on the page all the same: {words}");
    // In front of the wall, and on its crest, nothing hides it.
    for south in [1500.0, 1000.0] {
        let of = at(1040.0, south);
        let of = format!("{},{}", of.x, of.y);
        assert_eq!(row(&text(&place, &[&view[..], &["--of", &of]].concat()), "seen"), "yes", "{south}");
    }
}

#[test]
fn places_beside_the_page_behind_the_eye_and_without_land_are_told() {
    let place = Place::new();
    land(&place.path("land.tif"), |_, _| 20.0);
    let eye = at(1000.0, 1000.0);
    let eye = format!("{},{},100", eye.x, eye.y);
    let view = [&["--eye", &eye, "--azimuth", "0"][..], &SIZE].concat();
    let of = |east: f64, south: f64| {
        let of = at(east, south);
        text(&place, &[&view[..], &["--of", &format!("{},{}", of.x, of.y)]].concat())
    };
    let beside = of(1900.0, 900.0);
    // 900 m to the right of 100 m ahead, at 277.1 px for a unit of tangent.
    assert_eq!(row(&beside, "page"), "none: 2654.15,341.70 px lies beside it");
    assert_eq!(row(&beside, "seen"), "no: beside the page; --azimuth 83.6598 --altitude -5.0487 looks at it");
    let behind = of(1000.0, 1500.0);
    assert_eq!(row(&behind, "page"), "none: it lies behind the eye");
    assert_eq!(row(&behind, "seen"), "no: behind the eye; --azimuth 180 --altitude -9.0903 looks at it");
    // With the flags that are told it stands in the middle.
    let turned = [&["--eye", &eye, "--azimuth", "180", "--altitude", "-9.0903"][..], &SIZE].concat();
    let there = at(1000.0, 1500.0);
    let there = text(&place, &[&turned[..], &["--of", &format!("{},{}", there.x, there.y)]].concat());
    assert!(row(&there, "page").ends_with(", at 160.00,120.00 px") && row(&there, "seen") == "yes", "{there}");
    // Above the horizon, which the edge of the land does not reach.
    let sky = text(&place, &[&view[..], &["--at", "3,4"]].concat());
    assert_eq!(row(&sky, "pixel"), "3,4 of 320x240: sky, no land of the DEM lies there");
    assert!(!sky.contains("elevation") && row(&sky, "angle").ends_with(" degrees above the horizon"), "{sky}");
    let refuse = |flags: &[&str], words: &str| {
        let output = place.run(&[&["pick", "land.tif"], flags].concat());
        assert_eq!(
            (output.status.code(), stderr(&output).lines().last().unwrap_or_default()),
            (Some(2), words),
            "{flags:?}"
        );
    };
    refuse(
        &[&view[..], &["--at", "320,4"]].concat(),
        "error: --at: there is no pixel 320,4 on a page of 320x240; give one from 0,0 to 319,239, or another --size",
    );
    refuse(
        &[&view[..], &["--of", "1000000,2000000"]].concat(),
        "error: --of: 1000000,2000000 is no place of the DEM; give one with data between 560005.00,5538005.00 and \
         561995.00,5539995.00 metres in \"WGS 84 / UTM zone 32N (EPSG:32632)\", or its longitude and latitude",
    );
    for (flags, words) in [
        (&["--at", "a,4"][..], "`a` is no number of a pixel"),
        (&["--at", "-3,4"], "`-3` is no number of a pixel"),
        (&["--at", "1.5,4"], "`1.5` is no number of a pixel"),
        (&["--at", "4"], "want X,Y: the pixel's column and row, whole numbers from 0,0 at the top left"),
        (&["--of", "x,4"], "`x` is no number"),
        (&["--at", "1,1", "--of", "2,2"], "cannot be used with"),
        (&["--at", "1,1", "--json", "land.tif"], "which is read as input; give each file a name of its own"),
    ] {
        let output = place.run(&[&["pick", "land.tif"], flags].concat());
        assert_eq!(output.status.code(), Some(2), "{flags:?}");
        assert!(stderr(&output).contains(words), "{flags:?}: {}", stderr(&output));
    }
    fs::remove_file(place.path("land.tif")).expect("gone");
    refuses(&place, &["pick", "none.tif", "--at", "1,1"], 1, "none.tif: ");
}

#[test]
fn a_hole_of_the_dem_is_no_place() {
    let place = Place::new();
    let output = place.run(&["pick", "hill.asc", "--of", "500055,4000085", "--eye", "500200,4000000,90"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).ends_with(
            "error: --of: the DEM has no data at 500055,4000085; give one with data between 500005.00,4000005.00 and \
         500395.00,4000395.00 metres"
        ),
        "{}",
        stderr(&output)
    );
    let told = place.run(&["pick", "hill.asc", "--of", "500200,4000200", "--eye", "500200,4000000,90", "-q"]);
    let told = String::from_utf8_lossy(&told.stdout).into_owned();
    assert_eq!(row(&told, "bearing"), "0.00 degrees from grid north; true north is unknown");
}

/// Two ridges before a plain, the second just higher to the eye that stands 50 m above the first, 500 m before it.
fn ridges(_: f64, south: f64) -> f64 {
    let ridge = |at: f64, height: f64| height - (south - at).abs();
    ridge(1400.0, 100.0).max(ridge(1280.0, 91.5)).max(0.0)
}

/// The first line of an answer.
fn line(told: &Value) -> &Value {
    &told["lines"][0]
}

#[test]
fn a_line_that_economy_left_out_names_its_rule_and_the_flag_that_draws_it() {
    let place = Place::new();
    land(&place.path("land.tif"), ridges);
    let eye = at(1000.0, 1900.0);
    let eye = format!("{},{},150", eye.x, eye.y);
    let view = [
        "--eye",
        &eye,
        "--azimuth",
        "0",
        "--altitude",
        "0",
        "--fov",
        "60",
        "--size",
        "640x480",
        "--border",
        "off",
        "--hachures",
        "none",
    ];
    // The crest of the first ridge stands 50 m below the eye in 500 m.
    let focal = 320.0 / 30_f64.to_radians().tan();
    let pixel = format!("320,{}", (240.0 + focal * 0.1).round());
    let asked = |more: &[&str]| answer(&place, &[&view[..], &["--at", &pixel], more].concat());
    let plain = asked(&["--min-gap", "0", "--min-jump", "0"]);
    assert_eq!((&line(&plain)["rule"], &line(&plain)["drawn"]), (&"drawn".into(), &true.into()), "{plain}");
    let id = line(&plain)["id"].as_str().expect("a name").to_owned();
    for (rule, flags) in [
        ("min-jump", &["--min-jump", "5", "--min-gap", "0"][..]),
        ("min-gap", &["--min-gap", "24px", "--min-jump", "0"]),
    ] {
        let told = asked(flags);
        let left_out = told["lines"].as_array().expect("lines").iter().find(|line| line["id"] == id.as_str());
        let left_out = left_out.unwrap_or_else(|| panic!("{rule}: {told}"));
        assert_eq!((&left_out["rule"], &left_out["drawn"]), (&rule.into(), &false.into()), "{left_out}");
        let remedy = left_out["flags"].as_str().expect("flags").to_owned();
        let words = left_out["words"].as_str().expect("words");
        assert!(remedy.starts_with(&format!("--{rule} ")) && words.contains(&format!("{remedy} draws it")), "{words}");
        // What is told to draw it does, and the picture holds its chain then, as it did not before.
        let remedied: Vec<&str> = match rule {
            "min-jump" => remedy.split(' ').chain(["--min-gap", "0"]).collect(),
            _ => remedy.split(' ').chain(["--min-jump", "0"]).collect(),
        };
        let drawn = asked(&remedied);
        assert_eq!(
            (&line(&drawn)["id"], &line(&drawn)["drawn"]),
            (&id.as_str().into(), &true.into()),
            "{remedy}: {drawn}"
        );
        let has = |flags: &[&str]| {
            let draw = [&["draw", "land.tif", "--keep-steps", "-o", "out.svg"], &view[..], flags].concat();
            let output = place.run(&draw);
            assert!(output.status.success(), "{}", stderr(&output));
            let svg = fs::read_to_string(place.path("out.svg")).expect("a picture");
            svg.contains(&format!("id=\"{id}\"")) || svg.contains(&format!("id=\"{id}-"))
        };
        assert!(has(&remedied), "{rule}: {remedy} draws {id}");
    }
    // The numbers are those of the land: behind the first ridge the second one's face lies a fifth farther.
    let told = asked(&["--min-jump", "5", "--min-gap", "0"]);
    let numbers = &line(&told)["numbers"];
    assert!((0.1..0.4).contains(&number(&numbers["jump"])) && numbers["min_jump"] == 5.0, "{numbers}");
    // What presses it runs within the gap.
    let told = asked(&["--min-gap", "24px", "--min-jump", "0"]);
    let gaps = told["lines"].as_array().expect("lines").iter().find(|line| line["id"] == id.as_str()).expect("it");
    assert!((1.0..5.0).contains(&number(&gaps["numbers"]["apart_px"])), "{gaps}");
    // With a gap that it just keeps it is faded, and that is said too.
    let told = asked(&["--min-gap", "4.5px", "--min-jump", "0"]);
    let faded = told["lines"].as_array().expect("lines").iter().find(|line| line["id"] == id.as_str()).expect("it");
    let words = faded["words"].as_str().expect("words");
    assert!(words.contains(" % by --min-gap 4.5px: ") && words.ends_with(" draws it whole"), "{words}");
}

#[test]
fn borders_creases_and_bare_land_name_their_rules() {
    let place = Place::new();
    // A valley to the south with a ridge on each side.
    land(&place.path("land.tif"), |east, south| 0.35 * (east - 1000.0).abs() + 0.08 * (2000.0 - south));
    let eye = at(1000.0, 1700.0);
    let eye = format!("{},{},700", eye.x, eye.y);
    let view = ["--eye", &eye, "--azimuth", "0", "--altitude", "-40", "--hachures", "none", "--size", "640x480"];
    let asked = |pixel: &str, more: &[&str]| answer(&place, &[&view[..], &["--at", pixel], more].concat());
    let rules = |told: &Value| -> Vec<(String, String)> {
        let lines = told["lines"].as_array().expect("lines");
        let word = |line: &Value, key: &str| line[key].as_str().unwrap_or("none").to_owned();
        lines.iter().map(|line| (word(line, "kind"), word(line, "rule"))).collect()
    };
    let bed = rules(&asked("320,240", &["--creases", "ridges"]));
    assert!(
        bed.contains(&("drainage".into(), "creases".into())) && bed.contains(&("none".into(), "facing".into())),
        "{bed:?}"
    );
    let drawn = asked("320,240", &["--creases", "drainage"]);
    assert_eq!((&line(&drawn)["kind"], &line(&drawn)["rule"]), (&"drainage".into(), &"drawn".into()), "{drawn}");
    let slope = asked("500,240", &["--creases", "drainage", "--channel-area", "50ha"]);
    let channels = slope["lines"].as_array().expect("lines").iter().find(|line| line["rule"] == "channel-area");
    let channels = &channels.unwrap_or_else(|| panic!("{slope}"))["numbers"];
    assert!(channels["channel_area_m2"] == 500_000.0 && number(&channels["gathers_m2"]) < 500_000.0, "{channels}");
    // Just before the northern edge: 1.5 px below it.
    let of = at(1000.0, 15.0);
    let of = answer(&place, &[&view[..], &["--of", &format!("{},{}", of.x, of.y)]].concat());
    let pixel = format!("{},{}", of["pixel"][0], of["pixel"][1]);
    assert!(rules(&asked(&pixel, &["--border", "off"])).contains(&("border".into(), "border".into())));
    assert!(rules(&asked(&pixel, &[])).contains(&("border".into(), "drawn".into())));
}
