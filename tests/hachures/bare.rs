//! Land so near that strokes would stand closer than lines do: it stays bare, and that is said.

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::line::hachures::{Viewer, hatched};

use super::map::{Map, PX_PER_MM, lehmann};
use crate::cli::{Place, stderr};

/// Metres of a cell.
const CELL: f64 = 30.0;

/// A map of a slope on which strokes are to stand so far apart, in least spacings of lines.
fn map(apart: f64) -> Map {
    let heights = (0..21 * 21).map(|i| (i % 21) as f32 * 15.0).collect();
    let dem = Dem::from_heights(21, DVec2::splat(CELL), DVec2::new(500_000.0, 4_000_000.0), heights);
    // An eighth of a cell, by strokes a millimetre apart at most.
    Map::new(dem, apart * CELL / 8.0 * 1000.0 / lehmann().spacing, lehmann())
}

#[test]
fn land_too_near_for_lines_stays_bare() {
    for (apart, strokes, bare) in [(0.3, false, true), (3.0, true, false)] {
        let map = map(apart);
        let wanted = map.look.apart(26.57 / 45.0) / map.overhead.px_per_metre;
        println!("{} strokes, {:.2} spacings apart", map.strokes.len(), wanted / map.slopes().least_spacing());
        let found = hatched(map.slopes(), &map.look, Viewer::Above(&map.overhead)).expect("lines");
        assert_eq!((map.strokes.len() > 20, found.bare.is_some()), (strokes, bare), "{apart} at {PX_PER_MM} px/mm");
        assert!(strokes || map.strokes.is_empty());
    }
}

/// Warnings that land stays bare.
fn told(arguments: &[&str]) -> Vec<String> {
    let place = Place::new();
    let output = place.run(arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let said = stderr(&output);
    said.lines().filter(|line| line.contains("hachures")).map(str::to_owned).collect()
}

#[test]
fn land_that_stays_bare_is_told() {
    let draw = ["draw", "hill.asc", "-o", "a.png", "--size", "320x240", "--azimuth", "90"];
    let near = [&draw[..], &["--eye", "500100,4000200,+2", "--altitude", "-10"]].concat();
    let far = [&draw[..], &["--eye", "498500,4000200,700", "--altitude", "-20"]].concat();
    let hatched = |arguments: &[&str]| told(&[arguments, &["--hachures", "both"]].concat());
    let [line] = &hatched(&near)[..] else { panic!("not one line") };
    assert!(line.starts_with("warning: land nearer than ") && line.contains(" m has no hachures"), "{line}");
    assert_eq!(hatched(&far), Vec::<String>::new());
    assert_eq!(told(&near), Vec::<String>::new());
    let plan = |scale: &str| hatched(&["draw", "hill.asc", "-o", "a.png", "--plan", "--scale", scale]);
    assert_eq!(plan("1:5000"), Vec::<String>::new());
    let [line] = &plan("1:400")[..] else { panic!("not one line") };
    assert!(line.contains("--scale with a larger N"), "{line}");
}
