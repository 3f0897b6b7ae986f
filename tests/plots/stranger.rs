//! A stranger judges the order of plotting: `vpype`, which plotters' owners use for that.

use std::fs;
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use hachure::ink;
use hachure::ink::Surround;
use hachure::ink::plot::planned;
use hachure::ink::styles::BuiltIn;
use hachure::ink::{Colour, Drawing, Layer, Pen, Sheet, Stroke, StrokeForm};

use crate::plots::checks;
use crate::plots::made::curves;
use crate::sheets::real_drawings;

/// Millimetres of a unit of vpype's, which has 96 in an inch.
const UNIT: f64 = 25.4 / 96.0;

/// vpype, as the set-up of the tests installs it, or on the `PATH`. `None`, with a line that says so, where there is none:
/// the test that called is skipped.
fn vpype() -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/vpype/bin");
    let folders = [own].into_iter().chain(std::env::split_paths(&path));
    let found = folders.map(|folder| folder.join("vpype")).find(|file| file.is_file());
    if found.is_none() {
        // Past the capture of the test harness, which shows nothing of a test that passes.
        let _ = writeln!(stderr(), "SKIP {}: install vpype", thread::current().name().unwrap_or("test"));
    }
    found
}

/// What vpype says of a layer.
#[derive(Debug, PartialEq)]
struct Said {
    name: String,
    paths: usize,
    drawn: f64,
    travel: f64,
}

/// What vpype says of each layer of a drawing, as it is and as vpype would sort it.
fn judged(vpype: &Path, drawing: &Drawing) -> [Vec<Said>; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("plot.svg");
    let mut svg = Vec::new();
    ink::write_svg(drawing, &mut svg).expect("an SVG");
    fs::write(&file, svg).expect("plot.svg");
    let output = Command::new(vpype).args(["read", "--no-crop"]).arg(&file).args(["stat", "linesort", "stat"]).output();
    let output = output.expect("vpype starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout).expect("text");
    let stats: Vec<Vec<Said>> = said.split("= Stats =").skip(1).map(layers).collect();
    stats.try_into().unwrap_or_else(|_| panic!("two statistics expected: {said}"))
}

/// The layers of one statistic.
fn layers(stat: &str) -> Vec<Said> {
    let stat = stat.split("\nTotals").next().unwrap_or_default();
    let layer = |text: &str| {
        let value = |key: &str| {
            let line = text.lines().find_map(|line| line.trim().strip_prefix(key));
            line.unwrap_or_else(|| panic!("no {key} in {text}")).trim()
        };
        let number = |key| value(key).parse::<f64>().expect("a number");
        Said {
            name: value("vp_name:").trim_matches('\'').into(),
            paths: number("Path count:") as usize,
            drawn: number("Length:") * UNIT,
            travel: number("Pen-up length:") * UNIT,
        }
    };
    stat.split("\nLayer ").skip(1).map(layer).collect()
}

/// Share of the way in the air that vpype saves.
fn saved([before, after]: &[Said; 2]) -> f64 {
    1.0 - after.travel / before.travel
}

/// Drawing of layers on an A3 sheet.
fn drawing(layers: Vec<(&str, Vec<Stroke>)>) -> Drawing {
    let layer = |(name, strokes): (&str, Vec<Stroke>)| Layer {
        name: name.into(),
        pen: Pen::default(),
        form: StrokeForm::CentreLines,
        found: hachure::ink::plot::Journey::through(&strokes),
        strokes,
        areas: Vec::new(),
    };
    let sheet = Sheet { size: glam::DVec2::new(420.0, 297.0), margin: 0.0, surround: Surround::NONE };
    Drawing { sheet, paper: Colour([255; 3]), layers: layers.into_iter().map(layer).collect(), title: None, seal: None }
}

#[test]
fn vpype_reads_a_real_plot_and_finds_no_shorter_way() {
    let Some(vpype) = vpype() else { return };
    let plot = real_drawings().iter().find(|(style, _)| *style == BuiltIn::Plotter);
    let (_, plot) = plot.expect("a plot");
    let found = judged(&vpype, plot);
    let names = |said: &[Said]| said.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&found[0]), plot.layers.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>());
    assert!(plot.layers.len() > 3, "{:?}", names(&found[0]));
    for (before, after) in found[0].iter().zip(&found[1]) {
        assert!(before.travel - after.travel < 0.05 * before.travel, "{before:?}, {after:?}");
    }
}

#[test]
fn vpype_hardly_shortens_the_way_and_reads_every_layer() {
    let Some(vpype) = vpype() else { return };
    let mut contours = curves(71, 1500, [5.0, 60.0]);
    // Rings, which vpype begins where they begin.
    contours.iter_mut().step_by(5).for_each(|stroke| stroke.closed = true);
    let hachures = curves(72, 4000, [2.0, 2.0]);
    let names = ["1 hidden", "2 silhouette to 2.5 km 0.3 mm"];
    let planned = drawing(vec![(names[0], planned(contours.clone())), (names[1], planned(hachures.clone()))]);
    let [before, after] = judged(&vpype, &planned);
    assert_eq!(before.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(), names);
    for ((before, after), layer) in before.into_iter().zip(after).zip(&planned.layers) {
        assert_eq!(before.paths, layer.strokes.len());
        let drawn: f64 = layer.strokes.iter().map(checks::length).sum();
        assert!((before.drawn - drawn).abs() < 1e-3 * drawn, "{} and {drawn} mm drawn", before.drawn);
        // vpype does not count the way to the first stroke.
        let first = layer.strokes[0].points[0].place.length();
        let travel = checks::travel(&layer.strokes) - first;
        assert!((before.travel - travel).abs() < 1e-3 * travel, "{} and {travel} mm in the air", before.travel);
        let saved = saved(&[before, after]);
        println!("{}: vpype saves {:.2} % of {travel:.0} mm", layer.name, 100.0 * saved);
        assert!(saved < 0.05, "{}: vpype saves {saved} of the way in the air", layer.name);
    }

    // As found, vpype would save most of it.
    let found = drawing(vec![(names[0], contours), (names[1], hachures)]);
    let [before, after] = judged(&vpype, &found);
    for layers in before.into_iter().zip(after).map(<[Said; 2]>::from) {
        assert!(saved(&layers) > 0.9, "vpype saves {} only", saved(&layers));
    }
}
