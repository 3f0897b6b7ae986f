//! Layers of the user's own lines: what they are called, and that each has the pen that a style gives its name.

use std::fs;
use std::path::Path;

use hachure::door::cli::words::line;
use hachure::door::geo::with_layer;
use hachure::geo::own_lines;
use hachure::relief::{self, LineKind};

use super::{collection, feature, ogr2ogr};
use crate::cli::{Place, stderr};
use crate::creases::{VIEW, draw, epsg, layers, valley};
use crate::flights::{folder, sample, write};

/// A road over the sample, so far north.
fn road(north: f64) -> String {
    feature("LineString", &format!("[[-122.53,{north}],[-122.5,{north}]]"), "")
}

fn names(path: &str) -> Vec<String> {
    let lines = own_lines(Path::new(path), false).unwrap_or_else(|e| panic!("{}", line(&e)));
    lines.names(Path::new(path))
}

#[test]
fn layers_are_called_as_their_file_or_as_there() {
    let folder = folder();
    let alone = write(&folder, "a river.geojson", &road(37.83));
    let point = write(&folder, "points.geojson", &feature("Point", "[-122.5,37.8]", ""));
    assert_eq!(names(&alone), ["a river"]);
    let (gpkg, one) = (folder.path().join("all.gpkg"), folder.path().join("one:way.gpkg"));
    let (gpkg, one) = (gpkg.to_str().expect("a name"), one.to_str().expect("a name"));
    let add = |name: &str, from: &str| ogr2ogr(&["-update", "-nln", name], Path::new(gpkg), from);
    if !(ogr2ogr(&["-nln", "rivers"], Path::new(gpkg), &alone)
        && ogr2ogr(&["-nln", "a:b"], Path::new(one), &alone)
        && add("points", &point)
        && add("to:the:sea", &write(&folder, "b.geojson", &collection(&[road(37.84), road(37.85)]))))
    {
        return;
    }
    assert_eq!(names(gpkg), ["rivers", "to:the:sea"], "points are none");
    assert_eq!(names(&format!("{gpkg}:to:the:sea")), ["to:the:sea"]);
    assert_eq!(names(one), ["one:way"], "its only layer");
    assert_eq!(names(&format!("{one}:a:b")), ["a:b"]);
    // The longest name of a file is the file, the rest its layer.
    assert_eq!(with_layer(Path::new(&format!("{one}:a:b"))), (one.into(), Some("a:b".into())));
    assert_eq!(with_layer(Path::new(&format!("{gpkg}:a:"))), (gpkg.into(), Some("a:".into())));
    assert_eq!(with_layer(Path::new("no:file")), ("no:file".into(), None));
    // Numbers go on from file to file.
    let given = own_lines(Path::new(gpkg), false).unwrap_or_else(|e| panic!("{}", line(&e)));
    let found =
        relief::own_lines(Path::new(gpkg), &given, sample().dem(), 3).unwrap_or_else(|e| panic!("{}", line(&e)));
    let kinds: Vec<LineKind> = found.iter().map(|line| line.kind).collect();
    assert_eq!(kinds, [3, 4, 4].map(LineKind::Own));
}

/// Writes a way from one place of UTM zone 31 to another.
pub fn way(place: &Place, name: &str, from: [f64; 2], to: [f64; 2]) {
    let crs = r#""crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32631"}}"#;
    let line = feature("LineString", &format!("[{from:?},{to:?}]"), "");
    let file = format!(r#"{{"type": "FeatureCollection", {crs}, "features": [{line}]}}"#);
    fs::write(place.path(name), file).expect("a way");
}

/// Colours of the layers of an SVG by their names, less their numbers.
fn colours(place: &Place, name: &str) -> Vec<(String, String)> {
    let text = fs::read_to_string(place.path(name)).expect("a drawing");
    let quoted = |group: &str, key: &str| {
        group.split_once(key).and_then(|(_, rest)| rest.split_once('"')).map(|(value, _)| value.to_owned())
    };
    let layer = |group: &str| {
        let label = quoted(group, "inkscape:label=\"").expect("a label");
        let ink = quoted(group, " stroke=\"").or_else(|| quoted(group, " fill=\"")).expect("an ink");
        (label.split_once(' ').expect("a number").1.to_owned(), ink)
    };
    text.split("<g ").skip(1).map(|group| layer(group.split('>').next().expect("a tag"))).collect()
}

const STYLE: &str = r##"
[pens.own]
colour = "#00aa00"
[pens.lines.river]
colour = "#0000ff"
[pens.lines."nowhere at all"]
width = 0.2
"##;

#[test]
fn each_file_is_a_layer_with_the_pen_of_its_name() {
    let place = Place::new();
    valley(&place);
    fs::write(place.path("valley.prj"), epsg(32631)).expect("a system");
    fs::write(place.path("my.toml"), STYLE).expect("a style");
    way(&place, "road.geojson", [500_100.0, 4_000_400.0], [501_700.0, 4_000_500.0]);
    way(&place, "river.geojson", [500_100.0, 4_000_700.0], [501_700.0, 4_000_800.0]);
    let files = ["--lines", "road.geojson", "--lines", "river.geojson"];
    let styled = [&["--style", "my.toml"][..], &files].concat();
    let own = [("road", "#00aa00"), ("river", "#0000ff")].map(|(name, ink)| (name.to_owned(), ink.to_owned()));
    draw(&place, &[&["-o", "a.svg", "--json", "a.json"], &styled[..]].concat());
    assert_eq!(layers(&place, "a.json"), ["road", "river", "border", "silhouette"]);
    assert_eq!(colours(&place, "a.svg")[..2], own);
    draw(&place, &["-o", "b.svg", "--style", "my.toml", "--lines", "river.geojson", "--lines", "road.geojson"]);
    assert_eq!(colours(&place, "b.svg")[..2], [own[1].clone(), own[0].clone()], "the last lies on top");
    draw(
        &place,
        &[&["-o", "c.svg", "--json", "c.json", "--style", "plotter", "--hidden", "dashed"], &files[..]].concat(),
    );
    let plotted = layers(&place, "c.json");
    assert!(["road 0.3 mm", "river 0.3 mm"].iter().all(|name| plotted.contains(&(*name).to_owned())), "{plotted:?}");
    let plan = ["draw", "valley.asc", "--plan", "--scale", "1:20000", "-o", "p.svg"];
    let output = place.run(&[&plan[..], &styled].concat());
    assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    assert_eq!(colours(&place, "p.svg")[..2], own);
    let list = format!(
        "[[drawing]]\ndem = \"valley.asc\"\noutput = \"d.svg\"\nstyle = \"my.toml\"\nhachures = \"none\"\nlines = [{}]\neye = [500900, 3999700, 230]\nazimuth = 0\naltitude = 2\nsize = \"480x320\"\n",
        "\"road.geojson\", \"river.geojson\""
    );
    fs::write(place.path("list.toml"), list).expect("a list");
    let output = place.run(&["batch", "list.toml"]);
    assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    assert_eq!(colours(&place, "d.svg"), colours(&place, "a.svg"));
    let fly = ["fly", "valley.asc", "--orbit", "500900,4000800", "--radius", "900", "--height", "+300", "--count", "2"];
    let output = place.run(&[&fly[..], &["--size", VIEW[7], "-o", "%d.svg"], &styled].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(own.iter().all(|own| colours(&place, "1.svg").contains(own)), "{:?}", colours(&place, "1.svg"));
}
