//! Pictures that look north, and flags that repeat them.

use std::fs;

use super::{ARCTIC, DEGREES, arctic, degrees, draw, reported};
use crate::cli::Place;
use crate::tolerances::{CONVERGENCE_DEGREES, DUE_NORTH_PX};

/// Mean column of the ink in the highest inked row between two columns, and that row.
fn top(place: &Place, columns: std::ops::Range<u32>) -> Option<(f64, u32)> {
    let mask = image::open(place.path("mask.png")).expect("a mask").to_luma8();
    let inked = |row: u32| columns.clone().filter(|c| mask.get_pixel(*c, row).0[0] == 0).collect::<Vec<_>>();
    let (row, columns) = (0..mask.height()).map(|row| (row, inked(row))).find(|(_, columns)| !columns.is_empty())?;
    let mean = columns.iter().map(|c| f64::from(*c) + 0.5).sum::<f64>() / columns.len() as f64;
    Some((mean, row))
}

/// How far from the middle the highest peak stands, px; the eye is at `flag` and looks north as `flags` say.
fn off_the_middle(place: &Place, dem: &str, [flag, eye]: [&str; 2], flags: &[&str]) -> f64 {
    draw(place, dem, &[&[flag, eye, "--azimuth", "0", "--mask", "mask.png"], flags].concat());
    top(place, 0..640).map_or(f64::INFINITY, |(column, _)| (column - 320.0).abs())
}

fn eye([longitude, latitude]: [f64; 2]) -> String {
    format!("{longitude},{latitude},+40")
}

#[test]
fn a_peak_due_north_on_a_polar_map_stands_in_the_middle() {
    let place = Place::new();
    arctic(&place);
    let at = eye(ARCTIC);
    assert!(off_the_middle(&place, "arctic.tif", ["--lonlat", &at], &[]) < DUE_NORTH_PX);
    let (left, right) = (top(&place, 0..420).expect("a hill"), top(&place, 420..640).expect("a hill"));
    assert!(left.1 + 40 < right.1, "the tall hill is left, the low one right: {left:?}, {right:?}");
    // 145 degrees aside there is nothing of them.
    assert!(off_the_middle(&place, "arctic.tif", ["--lonlat", &at], &["--north", "grid"]) > 50.0);
    let view = reported(&place);
    assert_eq!((&view["north"], &view["azimuth"], &view["grid_north"]), (&"grid".into(), &0.0.into(), &0.0.into()));
    assert!((view["true_north"].as_f64().expect("a bearing") + 145.0).abs() < 1e-6, "{}", view["true_north"]);
}

#[test]
fn a_peak_due_north_in_degrees_stands_in_the_middle() {
    let place = Place::new();
    degrees(&place);
    let at = eye(DEGREES);
    for north in [&[][..], &["--north", "true"], &["--north", "grid"]] {
        let off = off_the_middle(&place, "degrees.tif", ["--eye", &at], north);
        assert!(off < DUE_NORTH_PX, "{north:?}: {off} px aside");
    }
    // As the meridians of UTM converge on the sphere.
    let view = reported(&place);
    let [from_middle, latitude] = [DEGREES[0] - 9.0, DEGREES[1]].map(f64::to_radians);
    let wanted = -(from_middle.tan() * latitude.sin()).atan().to_degrees();
    for north in ["grid_north", "true_north"] {
        let found = view[north].as_f64().expect("a bearing");
        assert!((found - wanted).abs() < CONVERGENCE_DEGREES, "{north} {found}, not {wanted}");
    }
    // To the north of the zone's grid, which its user never sees, the peak would stand 2.6 degrees aside.
    draw(&place, "degrees.tif", &["--eye", &at, "--azimuth", &(-wanted).to_string(), "--mask", "mask.png"]);
    let (column, _) = top(&place, 0..640).expect("a hill");
    assert!((320.0 - column - 25.5).abs() < 2.0, "{column}");
}

/// The flags that a drawing printed behind `label`.
fn printed(said: &[u8], label: &str) -> Vec<String> {
    let said = String::from_utf8_lossy(said).into_owned();
    let line = said.lines().find_map(|line| line.strip_prefix(label)).unwrap_or_else(|| panic!("no {label}: {said}"));
    line.split(' ').map(str::to_owned).collect()
}

#[test]
fn what_is_printed_names_its_north_and_repeats_the_picture() {
    let place = Place::new();
    arctic(&place);
    degrees(&place);
    let (polar, globe) = (eye(ARCTIC), eye(DEGREES));
    let cases: [(&str, &[&str], &str); 6] = [
        ("arctic.tif", &[], "grid"),
        ("arctic.tif", &["--north", "true", "--azimuth", "33.3"], "true"),
        ("arctic.tif", &["--lonlat", &polar, "--azimuth", "152", "--north", "grid"], "grid"),
        ("arctic.tif", &["--lonlat", &polar, "--look-at", "100.02,72.02,300", "--crs", "EPSG:4326"], "true"),
        ("degrees.tif", &[], "true"),
        ("degrees.tif", &["--eye", &globe, "--azimuth", "12", "--north", "grid"], "grid"),
    ];
    for (dem, flags, north) in cases {
        let run = |flags: &[&str]| {
            // A method that is soon compiled: what its lines are is nothing to views.
            let draw = ["draw", dem, "--level", "1", "--method", "adjacency", "-o", "out.png"];
            let said = place.run(&[&draw[..], flags].concat()).stdout;
            (printed(&said, "view: "), fs::read(place.path("out.png")).expect("out.png"), said)
        };
        let (view, picture, said) = run(&[flags, &["--size", "240x135"]].concat());
        assert!(!String::from_utf8_lossy(&said).contains(" 0 of "), "{dem} {flags:?}: nothing is drawn");
        assert_eq!(view[2..4], ["--north", north], "{dem} {flags:?}");
        assert!(view.iter().all(|word| word.len() < 40), "{view:?} is long");
        for label in ["view: ", "or with: "] {
            let flags = printed(&said, label);
            let (again, same, _) = run(&flags.iter().map(String::as_str).collect::<Vec<_>>());
            assert!(again == view && same == picture, "{dem} {flags:?} became {again:?}");
        }
    }
}
