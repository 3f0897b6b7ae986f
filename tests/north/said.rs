//! What is said of norths that differ, and where one is unknown.

use std::fs;

use gdal::spatial_ref::SpatialRef;
use glam::DVec2;
use serde_json::Value;

use super::{ARCTIC, DEGREES, PAGE, arctic, degrees, draw, hills, view, write};
use crate::cli::{Place, refuses, stderr};

/// A map that says nothing of where on Earth it is.
const SITE: &str = r#"ENGCRS["Site",EDATUM["Peg"],CS[Cartesian,2],AXIS["(E)",east,ORDER[1]],AXIS["(N)",north,ORDER[2]],LENGTHUNIT["metre",1.0]]"#;

fn said(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What is said where a drawing is refused as wrong usage.
fn refused(place: &Place, dem: &str, flags: &[&str]) -> String {
    let output = place.run(&[&["draw", dem], &PAGE[..], flags].concat());
    let words = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{dem} {flags:?}: {words}");
    words
}

#[test]
fn norths_over_a_degree_apart_are_said() {
    let place = Place::new();
    arctic(&place);
    degrees(&place);
    let lines = said(&draw(&place, "arctic.tif", &[]));
    let words = "azimuths are counted from grid north; at the eye grid north lies 145.0 degrees east of true north (--north true)";
    // The chosen eye stands within a kilometre or two of the middle.
    let line = |lines: &str| lines.lines().find(|line| line.starts_with("azimuths")).map(str::to_owned);
    let near = |line: &str, words: &str| line.replace("144.9", "145.0").replace("145.1", "145.0") == words;
    assert!(line(&lines).is_some_and(|line| near(&line, words)), "{lines}");
    let [longitude, latitude] = ARCTIC;
    let lines = said(&draw(&place, "arctic.tif", &["--lonlat", &format!("{longitude},{latitude},+40")]));
    let words = "azimuths are counted from true north; at the eye grid north lies 145.0 degrees east of true north (--north grid)";
    assert!(line(&lines).is_some_and(|line| near(&line, words)), "{lines}");
    let told = said(&place.run(&["info", "arctic.tif"]));
    assert!(told.contains("\nnorth      at the middle grid north lies 145.0 degrees east of true north\n"), "{told}");
    // Of a DEM in degrees both are the meridian.
    assert_eq!(line(&said(&draw(&place, "degrees.tif", &[]))), None);
    assert!(!said(&place.run(&["info", "degrees.tif"])).contains("\nnorth "));
    // In the next zone of UTM it is 2.6 degrees, in the middle of one nothing.
    for (code, east, told) in [(32632, 636_000.0, true), (32632, 503_000.0, false)] {
        let crs = SpatialRef::from_epsg(code).expect("UTM");
        write(&place.path("utm.tif"), &crs, DVec2::new(east, 7.212e6), DVec2::splat(38.0), hills);
        let found = said(&place.run(&["info", "utm.tif"]));
        assert_eq!(found.contains("grid north lies 2.6 degrees east of true north"), told, "{found}");
        assert_eq!(found.contains("\nnorth "), told, "{found}");
    }
}

#[test]
fn true_north_is_refused_where_nobody_knows_it() {
    let place = Place::new();
    let north = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48", "--north", "true"];
    refuses(
        &place,
        &north,
        2,
        "--north: the DEM names no coordinate system, so true north is unknown; give --north grid",
    );
    refuses(&place, &["draw", "hill.asc", "-o", "out.png", "--north", "up"], 2, "[possible values: grid, true]");
    assert!(place.run(&[&north[..7], &["grid"]].concat()).status.success(), "the remedy works");
    let crs = SpatialRef::from_wkt(SITE).expect("a system");
    write(&place.path("site.tif"), &crs, DVec2::new(5e5, 5e6), DVec2::splat(38.0), hills);
    let words = refused(&place, "site.tif", &["--north", "true"]);
    assert!(words.contains("the DEM lies in Site") && words.contains("give --north grid"), "{words}");
    let view = view(&place, "site.tif", &["--north", "grid"]);
    assert_eq!((&view["grid_north"], &view["true_north"]), (&0.0.into(), &Value::Null), "the remedy works");
}

#[test]
fn at_a_pole_there_is_grid_north_alone() {
    let place = Place::new();
    let crs = SpatialRef::from_epsg(3413).expect("EPSG:3413");
    write(&place.path("pole.tif"), &crs, DVec2::ZERO, DVec2::splat(38.0), hills);
    // 45 m away a sample of the DEM may lie beyond the pole.
    for eye in ["0,90,+40", "30,89.9996,+40"] {
        let at_pole = ["--lonlat", eye, "--azimuth", "0", "--no-warp"];
        let words = refused(&place, "pole.tif", &at_pole);
        assert!(
            words.contains("there is no true north at longitude") && words.contains("give --north grid"),
            "{words}"
        );
        let grid = view(&place, "pole.tif", &[&at_pole[..], &["--north", "grid"]].concat());
        assert_eq!((&grid["azimuth"], &grid["true_north"]), (&0.0.into(), &Value::Null), "the remedy works");
    }
    // A few hundred metres away there is one: 30 + 45 degrees left of grid north.
    let near = view(&place, "pole.tif", &["--lonlat", "30,89.995,+40", "--azimuth", "0", "--no-warp"]);
    let found = near["true_north"].as_f64().expect("a bearing");
    assert!((found + 75.0).abs() < 0.01, "{found}");
}

#[test]
fn at_a_pole_a_dem_in_degrees_has_no_north_at_all() {
    let place = Place::new();
    let crs = SpatialRef::from_epsg(4326).expect("EPSG:4326");
    write(&place.path("cap.tif"), &crs, DVec2::new(0.0, 89.5), DVec2::new(0.04, 0.0004), |_| 100.0);
    for north in ["true", "grid"] {
        let words = refused(&place, "cap.tif", &["--eye", "10,90,3000", "--north", north]);
        assert!(words.contains(&format!("there is no {north} north")), "{words}");
        assert!(words.contains("give an eye farther from the pole"), "{words}");
    }
    let view = view(&place, "cap.tif", &["--eye", "20,89.99,3000", "--azimuth", "180"]);
    let north = view["true_north"].as_f64().expect("a bearing");
    // On the polar map the meridian of 0 runs upward to the pole.
    assert!((north + 20.0).abs() < 0.01 && view["grid_north"] == view["true_north"], "{view}");
}

#[test]
fn a_remedy_counts_from_the_norths_of_the_view() {
    let place = Place::new();
    arctic(&place);
    let [longitude, latitude] = ARCTIC;
    // South of the land, looking away from it.
    let eye = format!("{longitude},{},300", latitude - 0.05);
    let output = place.run(&[&["draw", "arctic.tif", "--lonlat", &eye, "--azimuth", "180"], &PAGE[..]].concat());
    let words = stderr(&output);
    assert!(words.contains("no part of the DEM is on the page") && words.contains("at azimuth 0, "), "{words}");
    let remedy = words.split("; give ").nth(1).expect("a remedy").trim();
    let flags: Vec<_> = remedy.split(' ').filter(|word| !word.starts_with("640x")).filter(|w| *w != "--size").collect();
    assert!(remedy.contains("--north true --azimuth 0 "), "{remedy}");
    let shown = draw(&place, "arctic.tif", &flags);
    assert!(!stderr(&shown).contains("on the page"), "{remedy}");
}

#[test]
fn views_of_a_file_name_their_north() {
    let place = Place::new();
    degrees(&place);
    let views = |north: &str| {
        let [longitude, latitude] = DEGREES;
        let text = format!(
            r#"{{"views": [{{"name": "a", "dem": "degrees.tif", "lonlat": [{longitude}, {latitude}, "+40"], {north} "azimuth": 0}}]}}"#
        );
        fs::write(place.path("views.json"), text).expect("views.json");
        let flags = ["compare", "degrees.tif", "-o", "report", "--views", "views.json", "--size", "64x36"];
        place.run(&[&flags[..], &["--levels", "1", "--methods", "walk", "--truth-level", "8", "--no-cache"]].concat())
    };
    for (north, wanted) in [("", "grid"), (r#""north": "true","#, "true")] {
        let output = views(north);
        assert!(output.status.success(), "{}", stderr(&output));
        let text = fs::read_to_string(place.path("report/results.json")).expect("results");
        let scene = serde_json::from_str::<Value>(&text).expect("JSON")["scenes"][0].take();
        assert_eq!((&scene["north"], &scene["azimuth"]), (&wanted.into(), &0.0.into()));
        assert!(scene["flags"].as_str().is_some_and(|flags| flags.contains(&format!("--north {wanted} --azimuth 0 "))));
        let page = fs::read_to_string(place.path("report/report.html")).expect("a page");
        assert!(page.contains(&format!("azimuth 0.00° from {wanted} north")));
    }
    let output = views(r#""north": "up","#);
    let words = stderr(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(words.contains("views.json: unknown variant `up`, expected `grid` or `true` at line 1"), "{words}");
}
