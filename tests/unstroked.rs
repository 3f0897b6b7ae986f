//! Parts of the mask that no stroke draws, and why, on lines and masks made here.

use std::fs;

use glam::{DVec2, DVec3};
use hachure::door::ink::unstroked;
use hachure::door::ink::unstroked::{Unstroked, Why};
use hachure::ink::Surround;
use hachure::ink::style::{Plot, Weight};
use hachure::ink::{Sheet, Style, draw};
use hachure::line::{Chain, ChainPoint, Kind, Line, Lines, Marks, Recession};

use serde_json::Value;

use crate::cli::{Place, stderr};
use crate::ink::raster;

const FRAME: [u32; 2] = [120, 60];
const SHEET: Sheet = Sheet { size: DVec2::new(120.0, 60.0), margin: 0.0, surround: Surround::NONE };

#[test]
fn on_real_land_every_line_of_the_mask_has_its_stroke_or_is_left_out_by_economy() {
    let place = Place::new();
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let lines = |more: &[&str]| {
        let always = ["draw", dem, "-o", "a.svg", "--json", "a.json", "--size", "1600x700", "--azimuth", "318"];
        let output = place.run(&[&always[..], &["--eye", "547500,4183300,+300", "--altitude", "-6"], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&fs::read(place.path("a.json")).expect("a file")).expect("JSON");
        let without = report["without_stroke"].as_array().expect("a list").clone();
        without.into_iter().filter(|part| part["why"] != "speck").collect::<Vec<_>>()
    };
    let sparing = lines(&["--min-gap", "2mm"]);
    assert!(!sparing.is_empty() && sparing.iter().all(|part| part["why"] == "economy"), "{sparing:?}");
    assert_eq!(lines(&["--min-gap", "0", "--min-jump", "0"]), [] as [Value; 0]);
}

/// A line of ink from column 10 to 109 in these rows.
fn mask(rows: &[i64]) -> Marks {
    let inked = |x: i64, y: i64| (rows.contains(&y) && (10..110).contains(&x)).then_some((Kind::Silhouette, 0.01));
    Marks::from(&raster(FRAME[0], FRAME[1], inked))
}

/// A chain there, of so much weight.
fn chain(row: i64, weight: f32) -> Chain {
    let point = |x: u32| ChainPoint {
        place: DVec2::new(f64::from(x) + 0.5, row as f64 + 0.5),
        line: Line::Skyline,
        depth: 0.01,
        behind: 0.0,
        world: DVec3::ZERO,
        crowd: 0,
        weight,
        black: 1.0,
    };
    Chain { id: None, points: (10..110).map(point).collect(), closed: false }
}

fn found(rows: &[i64], chains: Vec<Chain>) -> Vec<Unstroked> {
    let [width, height] = FRAME;
    let recession = Recession::of([(0.01, 1.0)].into_iter());
    let lines = Lines { width, height, eye: DVec3::ZERO, chains, hidden: vec![], recession, own: vec![] };
    let plot = Plot { centre_lines: true, ..Plot::default() };
    let weight = Weight { far: 1.0, flat: 1.0, taper: 0.0, ..Weight::default() };
    let drawing = draw(&lines, &SHEET, &Style { plot, weight, ..Style::default() }, &[]).expect("a drawing");
    unstroked(&mask(rows), &lines, &drawing)
}

#[test]
fn each_part_of_the_mask_has_its_stroke_or_a_reason() {
    let rows = [5, 15, 25, 35];
    let whole = || rows.iter().map(|row| chain(*row, 1.0)).collect::<Vec<_>>();
    assert_eq!(found(&rows, whole()), []);
    let chains = vec![chain(5, 1.0), chain(15, 0.0), chain(25, 0.2)];
    let part = |row, why| Unstroked { pixel: [10, row], px: 100, why };
    assert_eq!(found(&rows, chains), [part(15, Why::Economy), part(25, Why::Pens), part(35, Why::NoLine)]);
    // A line beside it by a pixel is its own, by two it is another's.
    assert_eq!(found(&[5], vec![chain(6, 1.0)]), []);
    assert_eq!(found(&[5], vec![chain(7, 1.0)]), [part(5, Why::NoLine)]);
    // At the very edge a pen would leave the sheet.
    assert_eq!(
        found(
            &[0],
            vec![Chain {
                points: chain(0, 1.0).points.iter().map(|p| ChainPoint { place: p.place - 0.45, ..*p }).collect(),
                ..chain(0, 1.0)
            }]
        ),
        [part(0, Why::Margin)]
    );
}
