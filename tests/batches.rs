//! Batches: a file of drawings, each made once; sheets of a map.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::cli::{Place, stderr};

/// Two views and a plan of the hill.
const DRAWINGS: &str = r#"
[defaults]
dem = "hill.asc"
size = "120x60"
style = "atlas"

[[drawing]]
name = "from the south"
output = ["out/south.png", "out/south.svg", "out/south.pdf"]
mask = "out/south-mask.png"
eye = [500195, 4000020, "+30"]
azimuth = -0.5

[[drawing]]
output = "out/chosen.png"
min_gap = "2px"

[[drawing]]
output = "out/plan.svg"
plan = true
scale = "1:5000"
size = false
"#;

fn batch(place: &Place, text: &str, more: &[&str]) -> (i32, String, String) {
    fs::write(place.path("drawings.toml"), text).expect("a file");
    let output = place.run(&[&["batch", "drawings.toml"], more].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.code().unwrap_or(-1), said, stderr(&output))
}

#[test]
fn each_drawing_is_that_of_draw_and_is_made_once() {
    let place = Place::new();
    let (code, said, errors) = batch(&place, DRAWINGS, &[]);
    assert_eq!(code, 0, "{errors}");
    assert!(said.contains("3 drawings drawn, 0 were there"), "{said}");
    let flags = [
        "draw",
        "hill.asc",
        "-o",
        "alone.png",
        "-o",
        "alone.svg",
        "--mask",
        "alone-mask.png",
        "--size",
        "120x60",
        "--style",
        "atlas",
        "--eye",
        "500195,4000020,+30",
        "--azimuth",
        "-0.5",
    ];
    assert_eq!(place.run(&flags).status.code(), Some(0));
    let pixels = |name: &str| image::open(place.path(name)).expect("a picture").to_rgb8().into_raw();
    assert_eq!(pixels("out/south.png"), pixels("alone.png"));
    assert_eq!(pixels("out/south-mask.png"), pixels("alone-mask.png"));
    let lines = |name: &str| {
        let text = fs::read_to_string(place.path(name)).expect("a drawing");
        text.lines().filter(|line| !line.starts_with("<metadata>")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(lines("out/south.svg"), lines("alone.svg"), "nothing but the seal differs");
    let (code, said, _) = batch(&place, DRAWINGS, &[]);
    assert!(code == 0 && said.contains("0 drawings drawn, 3 were there"), "{said}");
    fs::remove_file(place.path("out/south.pdf")).expect("it is there");
    let (_, said, _) = batch(&place, DRAWINGS, &[]);
    assert!(said.contains("1 drawings drawn, 2 were there"), "one of its files is gone: {said}");
    let (_, said, _) = batch(&place, &DRAWINGS.replace("2px", "3px"), &[]);
    assert!(said.contains("1 drawings drawn, 2 were there"), "one of them changed: {said}");
    let with_fov = |fov: &str| DRAWINGS.replace("azimuth = -0.5", &format!("azimuth = -0.5\nfov = {fov}"));
    assert!(batch(&place, &with_fov("50"), &[]).1.contains("2 drawings drawn"));
    assert!(batch(&place, &with_fov("0x32"), &[]).1.contains("0 drawings drawn"), "50 in another base");
    batch(&place, DRAWINGS, &[]);
    assert_eq!(place.run(&["merge", "out"]).status.code(), Some(0));
}

#[test]
fn a_drawing_that_cannot_be_made_costs_itself_alone() {
    let place = Place::new();
    let text = DRAWINGS.replace("output = \"out/chosen.png\"", "output = \"out/chosen.png\"\ndem = \"none.tif\"");
    let (code, said, errors) = batch(&place, &text, &["--progress", "json"]);
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("1 of 3 drawings failed") && errors.contains("none.tif: there is no such file"),
        "{errors}"
    );
    let events: Vec<Value> = said.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let named: Vec<&str> = events.iter().filter_map(|event| event["event"].as_str()).collect();
    assert_eq!(named.iter().filter(|event| **event == "frame").count(), 2, "{named:?}");
    assert!(place.path("out/plan.svg").exists());
    let (_, listed, _) = batch(&place, &text.replace("none.tif", "hill.asc"), &["--list"]);
    let jobs: Vec<Value> = listed.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let done: Vec<_> = jobs.iter().map(|job| job["done"].as_bool()).collect();
    assert_eq!(done, [Some(true), Some(false), Some(true)], "{listed}");
}

#[test]
fn sheets_of_a_map_are_drawn_one_by_one_and_true_to_scale() {
    let place = Place::new();
    fs::write(place.path("hill.prj"), wkt()).expect("a file");
    let text = r#"
[[drawing]]
dem = "hill.asc"
output = "sheets/{sheet}.png"
size = "80x40"

[[drawing]]
dem = "hill.asc"
output = "sheets/{sheet}.svg"
plan = true
scale = "1:2000"
"#;
    let (code, said, errors) = batch(&place, text, &["--grid", "EPSG:32611", "--sheet", "200m", "--halo", "40m"]);
    assert_eq!(code, 0, "{errors}");
    assert!(said.contains("8 drawings drawn"), "{said}");
    for corner in ["E500000_N4000000", "E500200_N4000000", "E500000_N4000200", "E500200_N4000200"] {
        assert!(place.path(&format!("sheets/{corner}.png")).exists(), "{corner}");
        let plan = fs::read_to_string(place.path(&format!("sheets/{corner}.svg"))).expect("a plan");
        let width = plan.split("width=\"").nth(1).and_then(|rest| rest.split("mm").next()).expect("a width");
        // 200 m at 1:2000 are 100 mm, with a margin of 10 mm on either side.
        assert_eq!(width, "120", "{corner}");
    }
    let (_, said, _) = batch(&place, text, &["--grid", "EPSG:32611", "--sheet", "200m", "--halo", "40m"]);
    assert!(said.contains("0 drawings drawn, 8 were there"), "{said}");
    let (code, _, errors) = batch(&place, text, &[]);
    assert!(code == 2 && errors.contains("is named after sheets, and there are none; add --grid EPSG:N"), "{errors}");
    for (more, words) in [
        (["--grid", "EPSG:4326", "--sheet", "1km"], "counts degrees"),
        (["--grid", "EPSG:32611", "--sheet", "0m"], "a sheet of no length"),
        (["--grid", "EPSG:32611", "--sheet", "0.5m"], "makes over 100000 sheets"),
        (["--grid", "EPSG:32611", "--sheet", "1e-200m"], "makes over 100000 sheets"),
    ] {
        let (code, _, errors) = batch(&place, text, &more);
        assert!(code == 2 && errors.contains(words), "{errors}");
    }
}

#[test]
fn lists_stand_beside_each_other_and_folders_can_be_moved() {
    let place = Place::new();
    assert_eq!(batch(&place, DRAWINGS, &[]).0, 0);
    fs::write(
        place.path("more.toml"),
        "[[drawing]]\ndem = \"hill.asc\"\noutput = \"out/more.png\"\nsize = \"80x40\"\n",
    )
    .expect("a file");
    assert_eq!(place.run(&["batch", "more.toml"]).status.code(), Some(0), "another list in the same folder");
    fs::rename(place.path("out"), place.path("moved")).expect("it is there");
    let output = place.run(&["merge", "moved"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("3 of 3 are whole") && said.contains("1 of 1 are whole"), "{said}");
    fs::remove_file(place.path("moved/more.png")).expect("it is there");
    assert_eq!(place.run(&["merge", "moved"]).status.code(), Some(1));
}

#[test]
fn no_drawing_replaces_what_is_read() {
    let place = Place::new();
    let mut translate = Command::new("gdal_translate");
    translate.args(["-q", "-ot", "UInt16", "-of", "PNG"]).arg(place.path("hill.asc")).arg(place.path("land.png"));
    if !translate.status().is_ok_and(|status| status.success()) {
        println!("SKIP no gdal_translate");
        return;
    }
    let vrt = Command::new("gdalbuildvrt").arg("-q").arg(place.path("land.vrt")).arg(place.path("land.png")).status();
    assert!(vrt.is_ok_and(|status| status.success()));
    let before = fs::read(place.path("land.png")).expect("a DEM");
    let text = "[[drawing]]\ndem = \"land.vrt\"\nband = 1\noutput = \"land.png\"\nsize = \"80x40\"\n";
    let (code, _, errors) = batch(&place, text, &[]);
    assert_eq!(code, 1, "{errors}");
    assert!(errors.contains("which is read as input"), "{errors}");
    assert_eq!(fs::read(place.path("land.png")).expect("a DEM"), before);
}

#[test]
fn mistakes_are_told_with_their_place() {
    let place = Place::new();
    let with = |line: &str| format!("[defaults]\ndem = \"hill.asc\"\n\n[[drawing]]\n{line}\n");
    for (text, words) in [
        (with("ouput = \"a.png\""), "line 5, column 1: unknown key `ouput`; use `output`"),
        (with("output = \"a.png\"\nfov = 500"), "line 6, column 7: drawing 0: invalid value '500' for '--fov <DEG>'"),
        (with("output = \"a.png\"\njson = \"a.json\""), "`json` is no key of a drawing"),
        (with("output = \"a.png\"\nfov = {}"), "it is no value of a flag"),
        (with("output = \"a.png\"\nmask = [\"b.png\", \"c.png\"]"), "line 6, column 8: `mask` takes no list"),
        (with("output = \"a.png\"\nscale = \"1:1000\""), "required arguments were not provided: --plan"),
        (with("output = \"-\""), "standard output takes no drawing"),
        (with("output = \"a.tif\""), "a.tif does not end in .png, .svg or .pdf"),
        (with("output = \"a.png\"\n[[drawing]]\noutput = \"./a.png\""), "another output already"),
        (
            with("output = \"b/a.png\"\n[[drawing]]\noutput = \"b/../b/a.png\""),
            "b/../b/a.png is another drawing's output already",
        ),
        (with("output = \"a.png\"\n[[drawings]]"), "`drawings` is neither [defaults] nor [[drawing]]; use `drawing`"),
        ("[drawing]\noutput = \"a.png\"".to_owned(), "write [[drawing]]"),
        ("[[drawing]]\noutput = \"a.png\"".to_owned(), "required arguments were not provided: <DEM>"),
        (String::new(), "no drawing is in it; write [[drawing]]"),
    ] {
        let (code, _, errors) = batch(&place, &text, &[]);
        assert_eq!(code, 1, "{text}: {errors}");
        assert!(errors.contains(words), "{text}: {errors}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
    }
    assert_eq!(place.written(), ["drawings.toml"], "nothing was made");
}

/// UTM zone 11 north, as GDAL's files beside grids have it.
fn wkt() -> &'static str {
    "PROJCS[\"WGS_1984_UTM_Zone_11N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,\
     298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],\
     PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",-117.0],\
     PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]"
}
