//! Drawings without a line, DEMs without a facet, cells that cannot be metres, a far horizon: each has its word, and what
//! is proposed works when it is typed.

use std::fs;
use std::process::Output;

use serde_json::Value;

use crate::cli::{DRAW, Place, QUICK, refuses, stderr};

/// A text grid with these heights, `None` for voids.
fn write_grid(place: &Place, name: &str, size: usize, cell: f64, height: impl Fn(usize, usize) -> Option<f64>) {
    let mut text = format!("ncols {size}\nnrows {size}\nxllcorner 500000\nyllcorner 4000000\ncellsize {cell}\n");
    text += "NODATA_value -9999\n";
    for r in 0..size {
        (0..size).for_each(|c| text += &format!("{} ", height(c, r).unwrap_or(-9999.0)));
        text += "\n";
    }
    fs::write(place.path(name), text).expect("a grid");
}

fn succeeds(output: Output) -> (String, String) {
    assert!(output.status.success(), "{}", stderr(&output));
    (String::from_utf8_lossy(&output.stdout).into_owned(), stderr(&output))
}

/// How many pixels the last line says are inked.
fn inked(stdout: &str) -> usize {
    let line = stdout.lines().find(|line| line.contains(" pixels inked")).expect("a last line");
    let before = line.split(" of ").next().expect("a number");
    before.rsplit(' ').next().expect("a number").parse().expect("a number")
}

/// Draws a blank page, finds its warning, and draws with the flags that it gives.
fn blank(place: &Place, arguments: &[&str], words: &str) {
    let (stdout, said) = succeeds(place.run(arguments));
    assert_eq!(inked(&stdout), 0, "{arguments:?}");
    let warning = said.lines().find(|line| line.contains(words)).unwrap_or_else(|| panic!("{arguments:?}: {said}"));
    let flags = warning.split("; give ").nth(1).unwrap_or_else(|| panic!("no flags: {warning}"));
    assert!(flags.starts_with("--eye "), "{warning}");
    let kept = [&arguments[..4], &QUICK[6..]].concat();
    let (stdout, said) = succeeds(place.run(&[kept, flags.split(' ').collect()].concat()));
    assert!(inked(&stdout) > 0, "{flags}: {stdout}");
    assert!(!said.contains("is on the page") && !said.contains("nothing is drawn"), "{said}");
}

#[test]
fn a_page_without_land_says_where_it_lies_and_how_to_see_it() {
    let place = Place::new();
    let views: [&[&str]; 6] = [
        // Looking away, up, and over it; from below, from afar, and from where it is smaller than a pixel.
        &["--eye", "500200,3999000,50", "--azimuth", "180"],
        &["--eye", "500200,4000200,500", "--altitude", "90"],
        &["--eye", "500200,3999900,400", "--azimuth", "0", "--altitude", "40"],
        &["--eye", "500200,4000200,-50", "--altitude", "-40"],
        &["--eye", "530200,4000200,5000"],
        &["--eye", "5000000,500000,700"],
    ];
    for view in views {
        blank(&place, &[&QUICK[..], view].concat(), "no part of the DEM is on the page: its middle lies ");
    }
    let (_, said) = succeeds(place.run(&[&DRAW[..], views[0]].concat()));
    assert!(said.contains("lies 1200 m from the eye at azimuth 0, "), "{said}");
    let (_, said) = succeeds(place.run(&DRAW));
    assert!(!said.contains("page"), "a drawing with lines has no such word: {said}");
}

#[test]
fn land_without_a_line_has_its_word() {
    let place = Place::new();
    let down = ["--eye", "500200,4000200,900", "--altitude", "-90", "--fov", "1"];
    blank(&place, &[&DRAW[..], &down].concat(), "nothing is drawn: 3072 of 3072 pixels show land");
    write_grid(&place, "flat.asc", 20, 10.0, |_, _| Some(7.0));
    let flat = ["draw", "flat.asc", "-o", "out.png", "--size", "64x48", "--border", "off"];
    let (stdout, said) = succeeds(place.run(&flat));
    assert_eq!(inked(&stdout), 0);
    assert!(said.contains("nothing is drawn: ") && said.contains("--border on"), "{said}");
}

#[test]
fn compare_says_where_the_dem_lies_that_is_not_in_view() {
    let place = Place::new();
    let compare = ["compare", "hill.asc", "-o", "report", "--methods", "walk", "--levels", "1", "--no-cache"];
    let away = ["--eye", "500200,3999000,50", "--azimuth", "180", "--size", "64x48"];
    let refused = |view: &[&str], words| refuses(&place, &[&compare[..], view].concat(), 1, words);
    refused(&away, "nothing of the DEM is in view (its middle lies 1200 m from the eye at azimuth 0, altitude -0.96");
    let down = ["--eye", "500200,4000200,900", "--altitude", "-90", "--fov", "1", "--size", "64x48"];
    refused(&down, "no silhouette is in view, so there is nothing to compare (its middle lies 870 m from the eye");
}

#[test]
fn without_facets_nothing_starts_and_the_remedy_works() {
    type Valid = fn(usize, usize) -> bool;
    let heights: [(&str, Valid); 3] = [
        ("checkerboard", |c, r| (c + r).is_multiple_of(2)),
        ("row", |_, r| r == 7),
        ("sample", |c, r| c == 5 && r == 3),
    ];
    for (name, valid) in heights {
        for level in if name == "row" { vec!["1", "auto"] } else { vec!["1"] } {
            let place = Place::new();
            let write = |name| {
                write_grid(&place, name, 24, 10.0, |c, r| valid(c, r).then_some((c * r) as f64 / 9.0));
            };
            write("hill.asc");
            // No adapter is looked for.
            let draw = [&DRAW[..], &["--level", level, "--adapter", "none of this name"]].concat();
            for memory in [&["--memory", "1GiB"][..], &["--memory", "1KiB"]] {
                let arguments = [&draw[..], memory].concat();
                refuses(&place, &arguments, 1, "no three neighbours among the others span a facet; ");
                let said = stderr(&place.run(&arguments));
                assert!(said.contains("W 500005 S 4000005 E 500235 N 4000235 m"), "{name}: {said}");
                let remedy = said.split_once("--fill-voids").expect("a remedy").1.split(',').next().expect("flags");
                let remedy = format!("--fill-voids{remedy}");
                let remedied = [&QUICK[..], &remedy.split(' ').collect::<Vec<_>>()].concat();
                let (stdout, _) = succeeds(place.run(&remedied));
                assert!(inked(&stdout) > 0, "{name}: {remedy}");
                fs::remove_file(place.path("out.png")).expect("out.png");
            }
        }
    }
}

#[test]
fn cells_that_cannot_be_metres_are_warned_of() {
    let place = Place::new();
    let hill = |c: usize, r: usize| Some(20.0 + (c as f64 / 3.0).sin() * (r as f64 / 4.0).cos());
    for (name, cell, words) in [
        ("micro.asc", 1e-6, "cells of 0.000001 x 0.000001 m at 500000,4000000 are no land"),
        ("half.asc", 5e-4, "cells of 0.0005 x 0.0005 m at 500000,4000000 are no land"),
    ] {
        write_grid(&place, name, 42, cell, hill);
        let output = place.run(&["draw", name, "-o", "out.png", "--size", "64x48"]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains(words), "{name}: {}", stderr(&output));
    }
    write_grid(&place, "wide.asc", 42, 1e6, hill);
    let said = stderr(&place.run(&["draw", "wide.asc", "-o", "out.png", "--size", "64x48"]));
    assert!(said.contains("more than once around the Earth") && said.contains("m across (W "), "{said}");
    // Heights that f32 knows to a tenth of a cell at best.
    write_grid(&place, "high.asc", 12, 0.002, |c, r| Some(8000.0 + (c * r) as f64));
    let said = stderr(&place.run(&["draw", "high.asc", "-o", "out.png", "--size", "64x48"]));
    assert!(said.contains("its heights are known to 4."), "{said}");
    let said = stderr(&place.run(&DRAW));
    assert!(!said.contains("land of"), "{said}");
}

#[test]
fn far_land_says_how_far_the_flat_earth_lifts_it() {
    let place = Place::new();
    // Cells of 2 km near the Cape Verde islands, a ridge in the north, 60 km from the eye.
    let utm = "PROJCS[\"WGS 84 / UTM zone 26N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,\
               298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],\
               PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],\
               PARAMETER[\"central_meridian\",-27],PARAMETER[\"scale_factor\",0.9996],\
               PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
    write_grid(&place, "far.asc", 40, 2000.0, |_, r| Some(if r == 4 { 3000.0 } else { 0.0 }));
    let eye = ["--eye", "540000,4011000,100", "--azimuth", "0", "--size", "256x64", "--border", "off"];
    let draw = [&["draw", "far.asc", "-o", "out.png", "--json", "out.json"][..], &eye].concat();
    let (stdout, _) = succeeds(place.run(&draw));
    assert!(!stdout.contains("drawn flat"), "nobody says that it lies on Earth: {stdout}");
    fs::write(place.path("far.prj"), utm).expect("far.prj");
    let (stdout, _) = succeeds(place.run(&draw));
    assert!(stdout.contains("the Earth is drawn flat: the farthest land drawn, "), "{stdout}");
    let report: Value = serde_json::from_slice(&fs::read(place.path("out.json")).expect("out.json")).expect("JSON");
    let [farthest, lifted] = ["farthest_m", "lifted_m"].map(|key| report["flat_earth"][key].as_f64().expect(key));
    // The crest at 60 km, straight ahead; 78 km in the corners of the page, where depths along the axis are the same.
    assert!((60e3..71e3).contains(&farthest), "{farthest}");
    assert!((lifted - farthest * farthest / 2.0 / 6_371_008.8).abs() < 1e-6 * lifted, "{lifted}");
    assert!(stdout.contains(&format!("{:.1} km away, stands {lifted:.0} m too high", farthest / 1e3)), "{stdout}");
    let near = ["draw", "hill.asc", "-o", "out.png", "--json", "out.json", "--size", "64x48"];
    assert!(!succeeds(place.run(&near)).0.contains("drawn flat"));
    let report: Value = serde_json::from_slice(&fs::read(place.path("out.json")).expect("out.json")).expect("JSON");
    assert!(report["flat_earth"].is_null() && report["covered"].as_u64() > Some(100), "{report}");
}
