//! What poppler and resvg see in our files is what our own picture shows.

use std::fs;
use std::io::{Write, stderr};
use std::process::Command;
use std::thread;

use glam::{DVec2, dvec2};
use hachure::ink::{Colour, Drawing, Layer, Stroke};
use image::RgbImage;

use super::pictures::{Seen, difference, farthest_block, png, seen};
use super::samples::{all, centre_lines, dot, drawing, even, layer, ring, shares, spiral, tapered, widths, zigzag};
use crate::sheets::real_drawings;
use crate::tolerances::{CROWDED, LENGTH_MM};

/// Pixels a millimetre: of both the sheet is a whole number of pixels.
const SCALES: [f64; 2] = [4.0, 8.0];

/// pdftoppm, a stranger to our PDFs.
pub struct Poppler;

impl Poppler {
    /// `None`, with a line that says so, where it is missing: what the test wanted of it is skipped.
    pub fn find() -> Option<Self> {
        let found = Command::new("pdftoppm").arg("-v").output().is_ok_and(|output| output.status.success());
        if !found {
            skip("install poppler-utils");
        }
        found.then_some(Self)
    }

    /// The first page; it must be without fault.
    pub fn picture(&self, file: &[u8], px_per_mm: f64, [width, height]: [u32; 2]) -> RgbImage {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("in.pdf"), file).expect("in.pdf");
        let numbers = [px_per_mm * 25.4, width.into(), height.into()].map(|number| number.to_string());
        let output = Command::new("pdftoppm")
            .args([
                "-png",
                "-singlefile",
                "-r",
                &numbers[0],
                "-x",
                "0",
                "-y",
                "0",
                "-W",
                &numbers[1],
                "-H",
                &numbers[2],
            ])
            .args(["in.pdf", "out"])
            .current_dir(folder.path())
            .output()
            .expect("pdftoppm runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success() && said.is_empty(), "pdftoppm: {said}");
        image::open(folder.path().join("out.png")).expect("out.png").to_rgb8()
    }
}

/// Says that something is missing here, past the capture of the test harness, which shows nothing of a test that passes.
pub fn skip(remedy: &str) {
    let _ = writeln!(stderr(), "SKIP {}: {remedy}", thread::current().name().unwrap_or("test"));
}

/// Drawings of one subject each, and all together.
fn cases() -> Vec<(&'static str, Drawing)> {
    let one = |width, strokes| drawing(vec![layer("1 ink", width, [0, 0, 0], 1.0, strokes)]);
    let pale = |strokes| drawing(vec![layer("1 pale", 2.5, [0, 0, 0], 0.5, strokes)]);
    let tight = || spiral(dvec2(50.0, 40.0), 9.0, 20.0);
    let back = |x: f64| widths([0.0, 1.0, 0.2, 0.9].map(|t| (dvec2(x + 30.0 * t, 20.0), 1.0 - t / 2.0)));
    vec![
        ("tapered", one(0.5, (0..9).map(|i| tapered(dvec2(8.0, 10.0 + 7.0 * f64::from(i)), 80.0)).collect())),
        ("tight spiral", one(3.0, vec![tight(), ring(dvec2(12.0, 12.0), 1.0), ring(dvec2(24.0, 12.0), 3.0)])),
        ("zigzag", one(1.5, vec![zigzag(dvec2(10.0, 10.0), 50.0), zigzag(dvec2(60.0, 40.0), 2.0)])),
        ("back and forth", one(4.0, vec![back(10.0), back(50.0)])),
        ("dots", one(0.7, (0..40).map(|i| dot(dvec2(5.0, 4.0) + 1.83 * f64::from(i))).collect())),
        ("pale crossings", pale(vec![tight(), zigzag(dvec2(10.0, 10.0), 50.0)])),
        (
            "layers over each other",
            drawing(vec![
                layer("1 wide", 8.0, [200, 160, 40], 1.0, vec![even([dvec2(10.0, 10.0), dvec2(90.0, 70.0)])]),
                layer("2 pale", 6.0, [0, 60, 200], 0.5, vec![even([dvec2(90.0, 10.0), dvec2(10.0, 70.0)])]),
            ]),
        ),
        (
            "centre lines",
            drawing(vec![centre_lines(layer(
                "1 lines",
                0.6,
                [0, 0, 0],
                0.5,
                vec![
                    tight(),
                    ring(dvec2(80.0, 60.0), 8.0),
                    even(shares(90).map(|t| dvec2(10.0 + 70.0 * t, 70.0 - 9.0 * (t * 8.0).cos()))),
                    dot(dvec2(5.0, 5.0)),
                ],
            ))]),
        ),
        ("all", all()),
    ]
}

#[test]
fn strangers_see_real_drawings_as_pictures_show_them() {
    let poppler = Poppler::find();
    for (style, drawing) in real_drawings() {
        // Vectors have no paper; and poppler moves upright and level lines, as marks are, to whole pixels.
        let mut drawing = Drawing { paper: Colour([255; 3]), ..drawing.clone() };
        drawing.layers.iter_mut().for_each(|layer| layer.strokes.retain(|stroke| stroke.chain.is_some()));
        // Far lines of a tenth of a millimetre are nowhere thinner than a pixel or two.
        let picture = png(&drawing, 16.0);
        for Seen { who, picture: found, darkness } in seen(&drawing, 16.0, poppler.as_ref()) {
            let (block, by) = farthest_block(&picture, &found);
            assert!(by <= darkness * CROWDED, "{style}, {who}: block at {block:?} is {by} darker or lighter");
            // Poppler makes whatever is thinner than a pixel as wide as one: ends that run out are dark.
            let places = (who == "resvg").then(|| difference(&picture, &found, darkness * CROWDED)).flatten();
            assert!(places.is_none(), "{style}, {who}: {places:?}");
        }
    }
}

#[test]
fn strangers_see_what_the_picture_shows() {
    let poppler = Poppler::find();
    for px_per_mm in SCALES {
        for (name, drawing) in cases() {
            let expected = png(&drawing, px_per_mm);
            for Seen { who, picture, darkness } in seen(&drawing, px_per_mm, poppler.as_ref()) {
                let by = farthest_block(&expected, &picture).1;
                println!("{name} at {px_per_mm} px/mm: {who} is {by:.2} of 255 off in the farthest block");
                if let Some(difference) = difference(&expected, &picture, darkness) {
                    let kept = std::env::temp_dir().join("hachure-vectors");
                    fs::create_dir_all(&kept).expect("a folder");
                    expected.save(kept.join("expected.png")).expect("a file");
                    picture.save(kept.join("seen.png")).expect("a file");
                    panic!("{name} at {px_per_mm} px/mm, {who}: {difference}; see {}", kept.display());
                }
            }
        }
    }
}

#[test]
fn strangers_see_what_is_missing_moved_or_darker() {
    let poppler = Poppler::find();
    for px_per_mm in SCALES {
        let expected = png(&all(), px_per_mm);
        let noticed = |what: &str, change: &dyn Fn(&mut Drawing)| {
            let mut changed = all();
            change(&mut changed);
            for Seen { who, picture, darkness } in seen(&changed, px_per_mm, poppler.as_ref()) {
                assert!(
                    difference(&expected, &picture, darkness).is_some(),
                    "{what} at {px_per_mm} px/mm: {who} is not heard"
                );
            }
        };
        let two_px = DVec2::Y * 2.0 / px_per_mm;
        noticed("a moved point", &|drawing| drawing.layers[0].strokes[1].points[1].place += two_px);
        noticed("a moved end", &|drawing| drawing.layers[2].strokes[3].points[1].place += two_px);
        noticed("a missing dot", &|drawing| drop(drawing.layers[1].strokes.pop()));
        noticed("a missing line", &|drawing| drop(drawing.layers[2].strokes.remove(2)));
        noticed("darker crossings", &|drawing| {
            let knot = drawing.layers[0].clone();
            let halves = knot.strokes[0].points.chunks(150);
            let strokes = halves.map(|half| Stroke { points: half.to_vec(), ..knot.strokes[0].clone() });
            let split: Vec<Layer> = strokes.map(|stroke| Layer { strokes: vec![stroke], ..knot.clone() }).collect();
            drawing.layers.extend(split);
            drawing.layers[0].strokes.remove(0);
        });
        noticed("another order", &|drawing| drawing.layers.swap(0, 3));
    }
}

#[test]
fn a_hundred_millimetres_are_a_hundred_millimetres() {
    let poppler = Poppler::find();
    // Round ends of a pen of 1 mm: from 5 to 105 mm across, from 10 to 60 mm down.
    let bars = vec![even([dvec2(5.5, 5.0), dvec2(104.5, 5.0)]), even([dvec2(50.0, 10.5), dvec2(50.0, 59.5)])];
    for form in [|layer| layer, centre_lines] {
        let mut drawing = drawing(vec![form(layer("1 bars", 1.0, [0, 0, 0], 1.0, bars.clone()))]);
        drawing.sheet.size = dvec2(110.25, 70.5);
        for px_per_mm in SCALES {
            for Seen { who, picture, .. } in seen(&drawing, px_per_mm, poppler.as_ref()) {
                let dark = |x: f64, y: f64| f64::from(255 - picture.get_pixel(x as u32, y as u32).0[0]) / 255.0;
                let (width, height) = (picture.width(), picture.height());
                let row: Vec<f64> = (0..width).map(|x| dark(x.into(), 5.0 * px_per_mm)).collect();
                let column: Vec<f64> = (0..height).map(|y| dark(50.0 * px_per_mm, y.into())).collect();
                let lit = |line: &[f64]| line.iter().take_while(|dark| **dark < 0.5).count() as f64 / px_per_mm;
                let across = row.iter().sum::<f64>() / px_per_mm;
                let down = column[8 * px_per_mm as usize..].iter().sum::<f64>() / px_per_mm;
                println!(
                    "{who} at {px_per_mm} px/mm: {across:.3} mm across, {down:.3} mm down, from {} mm on",
                    lit(&row)
                );
                assert!((across - 100.0).abs() <= LENGTH_MM, "{who}: {across} mm");
                assert!((down - 50.0).abs() <= LENGTH_MM, "{who}: {down} mm");
                assert!((lit(&row) - 5.0).abs() <= 1.0 / px_per_mm, "{who}: begins at {} mm", lit(&row));
            }
        }
    }
}
