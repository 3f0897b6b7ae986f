//! Lines on the land through the program: layers of their own, in views, plans, flights and batches, and only where asked for.

use std::fs;

use serde_json::Value;

use crate::cli::{Place, refuses, stderr};

/// A valley down to the south between two ridges, a side valley in its western flank; 90 x 90 samples, 20 m.
pub fn valley(place: &Place) {
    let mut text = String::from("ncols 90\nnrows 90\nxllcorner 500000\nyllcorner 4000000\ncellsize 20\n");
    for r in 0..90 {
        for c in 0..90 {
            let (x, y) = (f64::from(c) - 45.3, f64::from(r));
            let side =
                if x < 0.0 { 25.0 * (-(y - 40.0 + x * 0.6).powi(2) / 30.0).exp() * (x / 20.0).tanh() } else { 0.0 };
            let height = 300.0 - 3.0 * y + 140.0 * (1.0 - (-x * x / 300.0).exp()) + side
                - 0.2 * (x.abs() - 28.0).max(0.0).powi(2);
            text += &format!("{height:.3} ");
        }
        text += "\n";
    }
    fs::write(place.path("valley.asc"), text).expect("valley.asc");
}

/// From before the lower end, looking up the valley.
pub const VIEW: [&str; 8] = ["--eye", "500900,3999700,230", "--azimuth", "0", "--altitude", "2", "--size", "480x320"];

pub fn draw(place: &Place, more: &[&str]) {
    let output = place.run(&[&["draw", "valley.asc"], &VIEW[..], more].concat());
    assert!(output.status.success(), "{more:?}: {}", stderr(&output));
}

/// Names of the layers of a report, less their numbers.
pub fn layers(place: &Place, name: &str) -> Vec<String> {
    let report: Value = serde_json::from_slice(&fs::read(place.path(name)).expect("a report")).expect("JSON");
    let names =
        report["layers"].as_array().expect("layers").iter().map(|layer| layer["name"].as_str().expect("a name"));
    names.map(|name| name.split_once(' ').expect("a number before it").1.to_owned()).collect()
}

#[test]
fn creases_stand_in_layers_of_their_own_and_leave_the_rest_as_it_is() {
    let place = Place::new();
    valley(&place);
    draw(&place, &["-o", "none.svg", "--mask", "none.png", "--json", "none.json"]);
    draw(&place, &["-o", "off.svg", "--creases", "none"]);
    draw(&place, &["-o", "all.svg", "--mask", "all.png", "--json", "all.json", "--creases", "ridges,drainage"]);
    draw(&place, &["-o", "again.svg", "--creases", "drainage,ridges"]);
    draw(&place, &["-o", "drainage.svg", "--json", "drainage.json", "--creases", "drainage"]);
    let read = |name: &str| fs::read(place.path(name)).expect("a file");
    assert_eq!(layers(&place, "none.json"), ["border", "silhouette"]);
    assert_eq!(layers(&place, "all.json"), ["drainage", "ridge", "border", "silhouette"]);
    assert_eq!(layers(&place, "drainage.json"), ["drainage", "border", "silhouette"]);
    assert_eq!(read("none.svg"), read("off.svg"));
    assert_eq!(read("all.svg"), read("again.svg"), "the same lines in every run");
    assert_eq!(read("none.png"), read("all.png"), "the mask knows no style");
    // Strokes of borders and silhouettes are the same, stroke by stroke.
    let strokes = |name: &str| {
        let text = String::from_utf8(read(name)).expect("text");
        let of_surface = text.split("<g ").filter(|group| group.contains("border") || group.contains("silhouette"));
        of_surface
            .flat_map(|group| group.split(" d=\"").skip(1))
            .map(|path| path.split('"').next().expect("a path").to_owned())
            .collect::<Vec<_>>()
    };
    let without = strokes("none.svg");
    assert!(without.len() >= 2 && without == strokes("all.svg"));
    // Passes over lines on the land run only where there are some.
    let passes = |name: &str| String::from_utf8(read(name)).expect("JSON").contains("\"lay\"");
    assert!(passes("all.json") && !passes("none.json"));
}

#[test]
fn styles_ask_for_creases_and_flags_overrule_them() {
    let place = Place::new();
    valley(&place);
    fs::write(place.path("wet.toml"), "creases = [\"drainage\"]\n[pens.drainage]\ncolour = \"#2b5c8a\"\n")
        .expect("a style");
    draw(&place, &["-o", "a.svg", "--json", "style.json", "--style", "wet.toml"]);
    assert!(fs::read_to_string(place.path("a.svg")).expect("a file").contains("#2b5c8a"));
    draw(&place, &["-o", "a.svg", "--json", "flag.json", "--style", "wet.toml", "--creases", "none"]);
    assert_eq!(layers(&place, "style.json"), ["drainage", "border", "silhouette"]);
    assert_eq!(layers(&place, "flag.json"), ["border", "silhouette"]);
}

#[test]
fn creases_of_a_style_that_a_method_does_not_draw_are_told_once() {
    let place = Place::new();
    valley(&place);
    let told = |more: &[&str]| {
        let output = place.run(more);
        assert!(output.status.success(), "{more:?}: {}", stderr(&output));
        stderr(&output).lines().filter(|line| line.contains("left out: ")).map(str::to_owned).collect::<Vec<_>>()
    };
    let view = [&["draw", "valley.asc", "-o", "a.png"], &VIEW[..]].concat();
    let with = |more: &[&'static str]| told(&[&view[..], more].concat());
    let words = "the style's drainage and ridges are left out: they go with contours only; leave out --method, or add --creases none";
    let traced = ["--style", "atlas", "--method", "adjacency"];
    assert_eq!(with(&traced), [format!("warning: {words}")]);
    for silent in [
        &["--style", "atlas", "--method", "adjacency", "--creases", "none"][..],
        &["--style", "atlas", "--method", "contour"],
        &["--style", "atlas"],
        &["--method", "adjacency"],
    ] {
        assert_eq!(with(silent), Vec::<String>::new(), "{silent:?}");
    }
    let orbit =
        ["fly", "valley.asc", "--orbit", "500900,4000800", "--radius", "900", "--height", "+300", "--count", "2"];
    let fly = |output: [&'static str; 2]| told(&[&orbit[..], &["--size", VIEW[7]], &output, &traced].concat());
    assert_eq!(fly(["-o", "%d.png"]), [format!("warning: {words}")]);
    assert_eq!(fly(["--mask", "m%d.png"]), Vec::<String>::new(), "a mask has no style");
    let drawing = |name: &str| format!("[[drawing]]\noutput = \"{name}.svg\"\nmethod = \"adjacency\"\n");
    let list = "[defaults]\ndem = \"valley.asc\"\nstyle = \"atlas\"\nsize = \"64x48\"\n".to_owned();
    fs::write(place.path("list.toml"), list + &drawing("x") + &drawing("y")).expect("a list");
    assert_eq!(told(&["batch", "list.toml"]), [format!("warning: drawing 0 and 1 more: {words}")]);
}

#[test]
fn plans_and_batches_have_creases_too() {
    let place = Place::new();
    valley(&place);
    let plan = ["draw", "valley.asc", "--plan", "--scale", "1:20000", "-o", "plan.svg", "--json", "plan.json"];
    let output = place.run(&[&plan[..], &["--creases", "drainage,ridges"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(layers(&place, "plan.json"), ["drainage", "ridge", "border"]);
    let list = r#"
[defaults]
dem = "valley.asc"
[[drawing]]
output = "one.svg"
creases = "drainage"
eye = [500900, 3999700, 230]
azimuth = 0
altitude = 2
size = "480x320"
[[drawing]]
output = "two.svg"
eye = [500900, 3999700, 230]
azimuth = 0
altitude = 2
size = "480x320"
[[drawing]]
output = "three.svg"
creases = "drainage,ridges"
plan = true
scale = "1:20000"
"#;
    fs::write(place.path("list.toml"), list).expect("a list");
    let output = place.run(&["batch", "list.toml"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let groups = |name: &str, layer: &str| {
        fs::read_to_string(place.path(name)).expect("a drawing").contains(&format!("{layer}\""))
    };
    assert!(groups("one.svg", "drainage") && !groups("two.svg", "drainage") && groups("three.svg", "ridge"));
    // What is there is not made again; with other lines it is another drawing.
    let again = place.run(&["batch", "list.toml"]);
    assert!(String::from_utf8_lossy(&again.stdout).contains("0 drawings drawn, 3 were there"));
    fs::write(place.path("list.toml"), list.replace("\"drainage\"", "\"ridges\"")).expect("a list");
    let changed = place.run(&["batch", "list.toml"]);
    assert!(String::from_utf8_lossy(&changed.stdout).contains("1 drawings drawn, 2 were there"), "{changed:?}");
}

#[test]
fn lines_of_the_users_own_are_drawn_in_views_and_plans() {
    let place = Place::new();
    valley(&place);
    let road = r#"{"type": "LineString", "coordinates": [[500100, 4000200], [501700, 4000300]]}"#;
    let crs = r#""crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32631"}}"#;
    let file = format!(
        r#"{{"type": "FeatureCollection", {crs}, "features": [{{"type": "Feature", "properties": {{"order": 3}}, "geometry": {road}}}]}}"#
    );
    fs::write(place.path("road.geojson"), file).expect("a road");
    let of_dem = ["--lines", "road.geojson"];
    fs::write(place.path("valley.prj"), epsg(32631)).expect("a system");
    draw(&place, &[&["-o", "a.svg", "--json", "a.json"], &of_dem[..]].concat());
    assert_eq!(layers(&place, "a.json"), ["road", "border", "silhouette"]);
    let over = place.run(&["draw", "valley.asc", "--json", "road.geojson", "-o", "b.svg", "--lines", "road.geojson"]);
    assert_eq!(over.status.code(), Some(2), "{}", stderr(&over));
    assert!(stderr(&over).contains("road.geojson") && !place.path("b.svg").exists());
    let output = place.run(
        &[&["draw", "valley.asc", "--plan", "--scale", "1:20000", "-o", "p.svg", "--json", "p.json"], &of_dem[..]]
            .concat(),
    );
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(layers(&place, "p.json"), ["road", "border"]);
}

/// A system of coordinates in the words of a .prj file.
pub fn epsg(code: u32) -> String {
    let system = gdal::spatial_ref::SpatialRef::from_epsg(code).expect("a system");
    system.to_wkt().expect("words")
}

#[test]
fn mistakes_are_told_before_the_work() {
    let place = Place::new();
    let always = ["draw", "hill.asc", "-o", "a.png"];
    let refuse = |more: &[&str], code, words: &str| refuses(&place, &[&always[..], more].concat(), code, words);
    refuse(&["--creases", "rivers"], 2, "drainage, ridges, shores");
    refuse(&["--channel-area", "12"], 2, "40000m2");
    refuse(&["--channel-area=-1km2"], 2, "40000m2");
    refuse(&["--channel-area", "4ha"], 2, "--creases drainage");
    refuse(&["--creases", "drainage", "--method", "adjacency"], 2, "leave out --method");
    refuse(&["--lines", "nothing.gpkg"], 1, "nothing.gpkg");
}

#[test]
fn creases_of_a_dem_in_its_file_lie_where_those_of_a_held_one_do() {
    let place = Place::new();
    valley(&place);
    let route =
        ["draw", "valley.asc", "--plan", "--scale", "1:20000", "--creases", "drainage,ridges", "--cache", "kept"];
    let held = place.run(&[&route[..], &["-o", "held.svg"]].concat());
    let filed = place.run(&[&route[..], &["-o", "filed.svg", "--memory", "1KiB"]].concat());
    assert!(held.status.success() && filed.status.success(), "{} {}", stderr(&held), stderr(&filed));
    // So small a DEM has blocks of one sample.
    assert_eq!(fs::read(place.path("held.svg")).expect("a plan"), fs::read(place.path("filed.svg")).expect("a plan"));
}

#[test]
fn shores_of_a_dem_in_its_file_are_those_of_a_held_one() {
    let place = Place::new();
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let route = ["draw", dem, "--plan", "--scale", "1:100000", "--creases", "drainage,shores", "--cache", "kept"];
    let held = place.run(&[&route[..], &["-o", "held.svg", "--json", "held.json"]].concat());
    assert!(held.status.success(), "{}", stderr(&held));
    assert!(layers(&place, "held.json").contains(&"shore".to_owned()), "{:?}", layers(&place, "held.json"));
    let held = fs::read(place.path("held.svg")).expect("a plan");
    // Found, then known.
    for name in ["found.svg", "known.svg"] {
        let filed = place.run(&[&route[..], &["-o", name, "--memory", "1KiB"]].concat());
        assert!(filed.status.success(), "{}", stderr(&filed));
        assert!(fs::read(place.path(name)).expect("a plan") == held, "{name}");
    }
}
