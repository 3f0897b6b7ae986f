//! The flag, and what is said of wrong files.

use std::path::Path;

use clap::Parser;
use hachure::dem::Dem;
use hachure::door::cli::lines::LinesArguments;
use hachure::door::cli::talk::{LinesTo, Talk, TalkArguments};
use hachure::door::cli::words::line;
use hachure::geo::own_lines;
use hachure::relief;
use tempfile::TempDir;

use super::voids::{grid, through};
use super::{collection, feature, ogr2ogr, way};
use crate::flights::{folder, sample, write};

#[derive(Parser)]
struct Typed {
    #[command(flatten)]
    lines: LinesArguments,
    #[command(flatten)]
    talk: TalkArguments,
}

fn typed(paths: &[&str]) -> Typed {
    let flags = paths.iter().map(|path| format!("--lines={path}"));
    Typed::try_parse_from(["draw".to_owned(), "-q".to_owned()].into_iter().chain(flags))
        .unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_flag_is_repeatable_and_names_what_was_asked() {
    let folder = folder();
    let road = |end: f64| feature("LineString", &format!("[[-122.5,37.8],[-122.49,{end}]]"), "");
    let [one, other] = [37.81, 37.82].map(|end| write(&folder, &format!("{end}.geojson"), &road(end)));
    let typed_two = typed(&[&one, &other]);
    let talk = Talk::new(&typed_two.talk, LinesTo::Stdout);
    assert_eq!(typed_two.lines.files(), [Path::new(&one), Path::new(&other)]);
    assert!(!typed_two.lines.is_empty() && typed(&[]).lines.is_empty());
    let lines = typed_two.lines.read(sample().dem(), false, &talk).unwrap_or_else(|e| panic!("{}", line(&e)));
    assert_eq!(lines.len(), 2);
    let asked = |paths: &[&str]| typed(paths).lines.open(false).unwrap_or_else(|e| panic!("{}", line(&e))).asked();
    assert_eq!(asked(&[]), "");
    assert_eq!(asked(&[&one, &other]), asked(&[&one, &other]));
    assert_ne!(asked(&[&one, &other]), asked(&[&other, &one]), "the last lies on top");
    let elsewhere = TempDir::new().expect("a folder");
    let copy = |end| write(&elsewhere, "37.81.geojson", &road(end));
    let layer = copy(37.81) + ":37.81";
    assert_eq!((asked(&[&copy(37.81)]), typed(&[&layer]).lines.files()), (asked(&[&one]), vec![copy(37.81).into()]));
    assert_ne!(asked(&[&copy(37.810001)]), asked(&[&one]), "other places");
}

/// The line of an error about a file of lines.
fn refused(path: &str, dem: &Dem) -> String {
    let lines = own_lines(Path::new(path), false).and_then(|given| relief::own_lines(Path::new(path), &given, dem, 0));
    let said = line(&lines.expect_err(path));
    assert!(!said.contains('\n'), "{said}");
    said
}

#[test]
fn wrong_files_are_refused_in_one_line() {
    let (folder, dem) = (folder(), sample().dem());
    let road = feature("LineString", "[[-122.5,37.8],[-122.49,37.81]]", "");
    let far = feature("LineString", "[[10.5,47.8],[10.6,47.9]]", "");
    for (name, text, words) in [
        ("empty.geojson", "", &["is empty (0 bytes)"][..]),
        ("nothing.geojson", &collection(&[]), &["holds no line and no area; give a file with lines"]),
        ("points.geojson", &feature("Point", "[-122.5,37.8]", ""), &["holds points, no line and no area; "]),
        (
            "far.geojson",
            &far,
            &[
                "lies outside the DEM: between 10.500000,47.800000 and 10.600000,47.900000 of WGS 84 (EPSG:4326), and the DEM between 536715.00,4180515.00 and 551685.00,4195485.00 metres of \"WGS 84 / UTM zone 10N (EPSG:32610)\"",
                "; give lines over the DEM, x first, in the system that the file names",
            ],
        ),
        (
            "words.gpx",
            "no lines at all",
            &["is in no format of lines that hachure reads; give lines as GeoPackage, GeoJSON"],
        ),
        ("cut.geojson", "{\"type\":\"FeatureCollection\",\"features\":[{\"type\"", &["cannot be opened as lines ("]),
    ] {
        let said = refused(&write(&folder, name, text), dem);
        assert!(words.iter().all(|words| said.contains(words)), "{name}: {said}");
    }
    let good = write(&folder, "road.geojson", &road);
    let raster = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    for (path, words) in [
        (format!("{good}:rails").as_str(), "has no layer rails; name one of its layers: road"),
        (raster, "holds a raster, not lines"),
        ("nowhere.gpkg", "nowhere.gpkg: there is no such file; "),
        ("http://a.b/c.gpkg", "lies on a network; download it first, or add `--allow-remote`"),
        ("PG:dbname=a", "is no file, but a connection"),
    ] {
        let said = refused(path, dem);
        assert!(said.contains(words), "{said}");
    }
    // A GeoPackage that ends amid its pages.
    let gpkg = folder.path().join("road.gpkg");
    let many =
        write(&folder, "many.geojson", &collection(&vec![feature("LineString", &format!("{:?}", way()), ""); 200]));
    if ogr2ogr(&[], &gpkg, &many) {
        let whole = std::fs::read(&gpkg).expect("a file");
        std::fs::write(&gpkg, &whole[..whole.len() / 3]).expect("a file");
        let said = refused(gpkg.to_str().expect("a name"), dem);
        assert!(said.contains("is damaged or cut short (") || said.contains("cannot be opened as lines ("), "{said}");
    }
    let nowhere = grid(&[]);
    assert!(
        refused(&good, &nowhere)
            .contains("lies in WGS 84 (EPSG:4326), and the DEM in no named system, of which nobody knows")
    );
    let all: Vec<[usize; 2]> = (0..21 * 21).map(|i| [i % 21, i / 21]).filter(|place| place[1] > 5).collect();
    let in_void = relief::own_lines(Path::new("a"), &through(&[(&[[5.0, 9.0], [9.0, 9.0]], false)]), &grid(&all), 0);
    assert_eq!(
        line(&in_void.expect_err("no land")),
        "a: its lines lie in voids of the DEM alone; give lines over its land, or fill its voids"
    );
}
