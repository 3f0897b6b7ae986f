//! Sheets of a map that lines of the user's own do not reach.

use std::fs;

use super::layers::way;
use crate::cli::{Place, stderr};
use crate::creases::epsg;

const LIST: &str = r#"
[[drawing]]
name = "view"
dem = "hill.asc"
output = "{sheet}.png"
size = "80x40"
lines = ["west.geojson", "far.geojson"]

[[drawing]]
name = "plan"
dem = "hill.asc"
output = "{sheet}.svg"
plan = true
scale = "1:2000"
lines = ["west.geojson", "far.geojson"]
"#;

#[test]
fn sheets_without_a_line_are_drawn_and_named_and_drawings_without_fail() {
    let place = Place::new();
    fs::write(place.path("hill.prj"), epsg(32631)).expect("a system");
    // The western sheets alone; and nowhere.
    way(&place, "west.geojson", [500_050.0, 4_000_050.0], [500_150.0, 4_000_350.0]);
    way(&place, "far.geojson", [600_050.0, 4_000_050.0], [600_150.0, 4_000_350.0]);
    fs::write(place.path("list.toml"), LIST).expect("a list");
    let output = place.run(&["batch", "list.toml", "--grid", "EPSG:32631", "--sheet", "200m"]);
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("8 drawings drawn, 0 were there"));
    // A plan is a window over the whole, on which there are lines.
    let missed = [0, 200].map(|north| {
        format!("warning: view, sheet E500200_N4000{north:03}: no line of --lines lies on its land: drawn without")
    });
    let told: Vec<&str> = said.lines().filter(|line| line.contains("--lines")).collect();
    assert_eq!(told, missed);
    let has_line = |sheet: &str| fs::read_to_string(place.path(sheet)).expect("a plan").contains(" west\"");
    assert!(has_line("E500000_N4000000.svg") && has_line("E500000_N4000200.svg"));
    assert!(!has_line("E500200_N4000000.svg") && !has_line("E500200_N4000200.svg"));
    // A drawing by itself fails without a line.
    let alone = Place::new();
    fs::copy(place.path("hill.prj"), alone.path("hill.prj")).expect("a system");
    let east =
        ["draw", "hill.asc", "-o", "a.svg", "--plan", "--scale", "1:2000", "--crop", "500200,4000000,500400,4000400"];
    let west = place.path("west.geojson");
    let lines = ["--lines", west.to_str().expect("a name")];
    let output = alone.run(&[&east[..], &lines].concat());
    assert_eq!((output.status.code(), alone.written()), (Some(1), vec!["hill.prj".to_owned()]));
    assert!(stderr(&output).contains("west.geojson: lies outside the DEM: "), "{}", stderr(&output));
}
