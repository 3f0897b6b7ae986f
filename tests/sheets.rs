//! Sheets of paper: what size they and the frames on them have, and that no stroke leaves their margins.

use std::fs;
use std::sync::{Arc, OnceLock};

use glam::DVec2;
use hachure::door::ink::sheet::PAPERS;
use hachure::geo::{ReadOptions, read};
use hachure::ink::Surround;
use hachure::ink::styles::BuiltIn;
use hachure::ink::{Drawing, Sheet, draw};
use hachure::plan::{Border, Curves, Detail, Method, Plan};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::{Fixed, choose};
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};
use crate::common::gpu;

const A4: Sheet = Sheet { size: DVec2::new(210.0, 297.0), margin: 10.0, surround: Surround::NONE };

#[test]
fn a_frame_fills_the_sheet_less_its_margins() {
    assert_eq!(A4.frame(8.0), [1520, 2216]);
    let placement = A4.placement([1520, 2216]);
    assert_eq!(placement.px_per_mm, 8.0);
    assert_eq!(placement.on_sheet(DVec2::ZERO), DVec2::splat(10.0));
    assert_eq!(placement.on_sheet(DVec2::new(1520.0, 2216.0)), DVec2::new(200.0, 287.0));
    assert_eq!(placement.in_frame(placement.on_sheet(DVec2::new(3.0, 7.0))), DVec2::new(3.0, 7.0));
    // Letters are no whole pixels: square ones all the same, and half of what stands over on either side.
    let letter = Sheet { size: DVec2::new(215.9, 279.4), margin: 10.0, surround: Surround::NONE };
    let frame = letter.frame(8.0);
    let placement = letter.placement(frame);
    let over = placement.on_sheet(DVec2::new(0.0, f64::from(frame[1]))).y - (279.4 - 10.0);
    assert!((0.0..0.5 / placement.px_per_mm).contains(&over), "{over} mm");
    assert_eq!(placement.on_sheet(DVec2::new(f64::from(frame[0]), 0.0)).x, 215.9 - 10.0);
    for (name, size) in PAPERS {
        let sheet = Sheet { size: size.into(), margin: 10.0, surround: Surround::NONE };
        for px_per_mm in [1.0, 8.0, 11.81] {
            sheet.check_frame(sheet.frame(px_per_mm)).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
    assert_eq!(Sheet::for_frame([1920, 1080]).size, DVec2::new(240.0, 135.0));
}

/// Width, height and pixels for each metre that a PNG tells.
fn png(place: &Place, name: &str) -> (u32, u32, u32) {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(place.path(name)).expect("a file")));
    let reader = decoder.read_info().expect("a PNG");
    let info = reader.info();
    (info.width, info.height, info.pixel_dims.map_or(0, |dims| dims.xppu))
}

#[test]
fn a_page_is_drawn_at_any_dpi_from_one_frame() {
    let place = Place::new();
    let draw = |more: &[&str]| {
        let always =
            ["draw", "hill.asc", "-o", "a.png", "-o", "a.svg", "-o", "a.pdf", "--mask", "m.png", "--json", "a.json"];
        let output = place.run(&[&always[..], &["--page", "A6", "--landscape", "--margin", "5"], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        ["a.svg", "a.pdf"].map(|name| fs::read(place.path(name)).expect("a file"))
    };
    let at_300 = draw(&[]);
    assert_eq!(png(&place, "a.png"), (1748, 1240, 11811), "148 x 105 mm at 300 pixels an inch");
    assert_eq!(png(&place, "m.png"), (1104, 760, 0), "138 x 95 mm at 8 pixels a millimetre");
    let report: Value = serde_json::from_slice(&fs::read(place.path("a.json")).expect("a file")).expect("JSON");
    assert_eq!(report["page"]["size_mm"], serde_json::json!([148.0, 105.0]));
    assert_eq!(report["page"]["frame_px_per_mm"], 8.0);
    assert_eq!(draw(&["--dpi", "72"]), at_300);
    assert_eq!(png(&place, "a.png"), (420, 298, 2835));
    // The mask's size, told: its pixels are larger, so lines may lie elsewhere by a little.
    assert_ne!(draw(&["--size", "276x190"]), at_300);
    assert_eq!(png(&place, "m.png"), (276, 190, 0));
}

#[test]
fn without_a_page_a_picture_has_the_pixels_of_its_frame() {
    let place = Place::new();
    let output = place.run(&["draw", "hill.asc", "-o", "a.png", "-o", "b.svg", "--size", "641x333"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let (width, height, per_metre) = png(&place, "a.png");
    assert_eq!((width, height, per_metre), (641, 333, 2671), "240 mm across");
    assert!(fs::read_to_string(place.path("b.svg")).expect("a file").contains("width=\"240mm\""));
}

#[test]
fn pages_that_cannot_be_are_refused_before_the_work() {
    let place = Place::new();
    let with = |more: &[&'static str]| [&["draw", "hill.asc", "-o", "out.png"], more].concat();
    for (more, words) in [
        (&["--page", "0x100"][..], "want one of A0, A1"),
        (&["--page", "A7"], "or WxH in millimetres, each from 10 to 5000"),
        (&["--page", "nanxnan"], "or WxH in millimetres"),
        (&["--page", "A4", "--margin", "105"], "--margin: margins of 105 mm leave nothing of a page of 210 x 297 mm"),
        (&["--page", "A4", "--margin", "-1"], "want millimetres, from 0 to 5000"),
        (&["--margin", "5"], "--margin: goes with a page of millimetres only; add --page NAME|WxH or leave it out"),
        (&["--landscape"], "--page"),
        (
            &["--page", "A4", "--size", "1520x2000"],
            "--size: 1520x2000 is not as the page less its margins, 190 x 277 mm; use --size 1520x2216",
        ),
        (&["--page", "A4", "--dpi", "0"], "want pixels an inch, from 10 to 4800"),
        (&["--page", "5000x5000", "--dpi", "4800"], "--dpi: makes a picture of 944882x944882 pixels"),
        (&["--min-gap", "1inch"], "want millimetres, from 0 to 100, as .4mm, or pixels"),
        (&["--split", "distance:5"], "want distance: and distances that rise, as distance:5km,10km"),
        (&["--split", "distance:5km,2km"], "distances that rise"),
        (&["--split", "5km"], "want distance:"),
        (&["--method", "adjacency", "--hidden", "dashed"], "--hidden: goes with contours only"),
    ] {
        refuses(&place, &with(more), 2, words);
    }
    refuses(&place, &["draw", "hill.asc", "-o", "out.gif"], 2, "out.gif does not end in .png, .svg or .pdf");
    refuses(&place, &["draw", "hill.asc", "-o", "a.svg", "--mask", "m.svg"], 2, "m.svg does not end in .png");
    refuses(&place, &["draw", "hill.asc", "-o", "a.svg", "-o", "a.svg"], 2, "a.svg");
}

/// How far the ink of a drawing stands over the margins, mm.
fn over(drawing: &Drawing) -> f64 {
    let [low, high] = drawing.sheet.area();
    let layers = drawing.layers.iter();
    let ink = layers.flat_map(|layer| {
        let points = layer.strokes.iter().flat_map(|stroke| &stroke.points);
        points.map(|point| (point.place, point.width * layer.pen.width / 2.0))
    });
    let over = |(place, half): (DVec2, f64)| (low - place).max(place - high).max_element() + half;
    ink.map(over).fold(f64::NEG_INFINITY, f64::max)
}

/// The Golden Gate in every built-in style, hidden lines and all, in zones of distance; drawn once for all tests.
pub fn real_drawings() -> &'static [(BuiltIn, Drawing)] {
    static DRAWINGS: OnceLock<Vec<(BuiltIn, Drawing)>> = OnceLock::new();
    DRAWINGS.get_or_init(draw_all)
}

fn draw_all() -> Vec<(BuiltIn, Drawing)> {
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default()).expect("a DEM")));
    let sheet = Sheet { size: DVec2::new(105.0, 74.0), margin: 7.5, surround: Surround::NONE };
    let frame = sheet.frame(8.0);
    let camera = choose(surface.dem(), Fixed::default(), 60.0, frame[0], frame[1]).expect("a view");
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    let plan = Plan { curves: Curves::All, ..Plan::new(Detail::default(), Method::Walk, Border::On) };
    let page = renderer.page(&plan, &camera, |_| ()).expect("a page");
    assert!(!page.hidden.is_empty());
    let px_per_mm = sheet.placement(frame).px_per_mm;
    let drawing = |name: BuiltIn| {
        let style = name.style().expect("a style");
        let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
        (name, draw(&lines, &sheet, &style, &[5000.0, 9000.0]).expect("a drawing"))
    };
    BuiltIn::ALL.map(drawing).to_vec()
}

#[test]
fn no_stroke_leaves_the_margins_in_any_style() {
    for (name, drawing) in real_drawings() {
        let (strokes, over) = (drawing.layers.iter().map(|layer| layer.strokes.len()).sum::<usize>(), over(drawing));
        println!("{name}: {strokes} strokes, {} layers, {over:.4} mm over", drawing.layers.len());
        assert!(strokes > 50 && over <= 1e-9, "{name}");
        // Lines do run off the page, so that something was cut.
        assert!(over > -0.5, "{name}");
        // Each stroke of a chain has a name of its own.
        let names = drawing.layers.iter().flat_map(|layer| &layer.strokes);
        let mut names: Vec<_> = names.filter_map(|stroke| Some((stroke.chain?, stroke.piece))).collect();
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{name}");
    }
}
