//! The library as its users see it: the examples, run.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use glam::DVec2;
use hachure::geo::{ReadOptions, own_lines, read};

/// Runs an example, built by `cargo test` beside the binary.
fn run(name: &str, arguments: &[&Path]) -> Output {
    let built = Path::new(env!("CARGO_BIN_EXE_hachure")).with_file_name("examples").join(name);
    assert!(built.is_file(), "build the examples first: cargo build --release --examples");
    let output = Command::new(built).args(arguments).output().expect("the example runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif")
}

#[test]
fn some_twenty_lines_draw_a_dem() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("picture.png");
    run("draw", &[&sample(), &picture]);
    let drawn = image::open(picture).expect("a picture").to_luma8();
    let dark = drawn.pixels().filter(|p| p.0[0] < 100).count();
    assert_eq!((drawn.width(), drawn.height()), (1200, 600));
    assert!(dark > 2000, "{dark} dark pixels");
    let code = include_str!("../examples/draw.rs");
    let lines = code.lines().filter(|line| !line.is_empty() && !line.starts_with("//")).count();
    assert!(lines <= 22, "{lines} lines");
}

#[test]
fn what_a_view_shows_goes_to_the_map() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("lines.gpkg");
    let output = run("contours", &[&sample(), &file]);
    let said = String::from_utf8(output.stdout).expect("text");
    let count: usize = said.split_whitespace().next().expect("a number").parse().expect("a number");
    assert!(count > 50, "{said}");
    // Read back, as many lines lie where the sample does, whose world is that of its file.
    let dem = read(sample(), &ReadOptions::default()).expect("the sample");
    let [west, south, east, north] = dem.extent();
    let lines = own_lines(&file, false).expect("a GeoPackage");
    let layer = &lines.layers[0];
    assert_eq!((lines.layers.len(), layer.lines.len()), (1, count));
    assert_eq!(layer.crs.as_ref().and_then(|crs| crs.epsg()), Some(32_610));
    // The file's numbers are rounded where the land ends.
    let [low, high] = [DVec2::new(west, south) - 0.01, DVec2::new(east, north) + 0.01];
    let is_there = |place: &DVec2| place.cmpge(low).all() && place.cmple(high).all();
    assert!(layer.lines.iter().flat_map(|line| &line.places).all(is_there));
}

#[test]
fn methods_are_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = run("methods", &[&sample(), folder.path()]);
    let table = String::from_utf8(output.stdout).expect("text");
    let inked = |name: &str| -> usize {
        let row = table.lines().find(|line| line.starts_with(&format!("{name} "))).expect("a row");
        row.split_whitespace().nth(1).expect("a number").parse().expect("a number")
    };
    assert!(inked("walk") > inked("toward-away") && inked("adjacency") > 2 * inked("walk"), "{table}");
    for name in ["walk", "toward-away", "toward-away-wide", "adjacency", "adjacency-corner"] {
        let mask = image::open(folder.path().join(name).with_extension("png")).expect("a mask").to_luma8();
        assert_eq!(mask.pixels().filter(|p| p.0[0] == 0).count(), inked(name), "{name}");
    }
}
