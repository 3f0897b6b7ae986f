//! Drawings with all that is hard to outline, on a sheet of fractional size.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};
use hachure::ink::Surround;
use hachure::ink::plot::Journey;
use hachure::ink::{Colour, Drawing, Layer, Pen, Sheet, Stroke, StrokeForm, StrokePoint};
use hachure::line::Id;

/// Whole pixels at the scales of the tests.
pub const SHEET: Sheet = Sheet { size: DVec2::new(100.5, 80.25), margin: 0.0, surround: Surround::NONE };

/// A stroke through places of the same width.
pub fn even(places: impl IntoIterator<Item = DVec2>) -> Stroke {
    widths(places.into_iter().map(|place| (place, 1.0)))
}

/// A stroke through places, each with its width.
pub fn widths(points: impl IntoIterator<Item = (DVec2, f64)>) -> Stroke {
    let points = points.into_iter().map(|(place, width)| StrokePoint { place, width }).collect();
    Stroke { chain: None, piece: 0, points, closed: false }
}

pub fn closed(stroke: Stroke) -> Stroke {
    Stroke { closed: true, ..stroke }
}

/// Shares of a way, ends included.
pub fn shares(steps: u32) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |i| f64::from(i) / f64::from(steps))
}

/// A wave that begins and ends in points.
pub fn tapered(left: DVec2, length: f64) -> Stroke {
    widths(shares(120).map(|t| (left + dvec2(length * t, 6.0 * (t * 9.0).sin()), 4.0 * t * (1.0 - t))))
}

/// Out from the centre, tighter there than the pen.
pub fn spiral(centre: DVec2, radius: f64, turns: f64) -> Stroke {
    even(shares(400).map(|t| centre + DVec2::from_angle(t * turns * TAU) * radius * t))
}

/// There and back, at sharper and sharper bends.
pub fn zigzag(left: DVec2, height: f64) -> Stroke {
    let step = |i: u32| 6.0 * 0.75_f64.powi(i as i32);
    let x = |i: u32| (0..i).map(step).sum::<f64>();
    widths((0..16).map(|i| (left + dvec2(x(i), f64::from(i % 2) * height), if i % 3 == 0 { 0.3 } else { 1.0 })))
}

pub fn ring(centre: DVec2, radius: f64) -> Stroke {
    closed(even((0..60).map(|i| centre + DVec2::from_angle(f64::from(i) * TAU / 60.0) * radius)))
}

pub fn dot(place: DVec2) -> Stroke {
    even([place])
}

pub fn layer(name: &str, width: f64, colour: [u8; 3], opacity: f64, strokes: Vec<Stroke>) -> Layer {
    let pen = Pen { width, colour: Colour(colour), opacity };
    Layer { name: name.into(), pen, form: StrokeForm::Outlines, found: Journey::default(), strokes, areas: Vec::new() }
}

pub fn centre_lines(layer: Layer) -> Layer {
    Layer { form: StrokeForm::CentreLines, ..layer }
}

/// Layers on white paper, the strokes named.
pub fn drawing(mut layers: Vec<Layer>) -> Drawing {
    for (i, stroke) in layers.iter_mut().flat_map(|layer| &mut layer.strokes).enumerate() {
        (stroke.chain, stroke.piece) = (Some(Id(0x2f_0000_0000 + i as u64 / 2)), i as u32 % 2);
    }
    Drawing { sheet: SHEET, paper: Colour([255; 3]), layers, title: None, seal: None }
}

/// All of it, in four layers, one over the other.
pub fn all() -> Drawing {
    let knot =
        even(shares(300).map(|t| dvec2(72.0, 24.0) + dvec2((t * 3.0 * TAU).sin(), (t * 2.0 * TAU).cos()) * 17.0));
    let lines = (0..6).map(|i| even([dvec2(4.0, 50.0 + 4.0 * f64::from(i)), dvec2(60.0, 76.0 - 4.0 * f64::from(i))]));
    drawing(vec![
        layer("1 knot", 3.0, [0, 0, 0], 0.5, vec![knot, zigzag(dvec2(8.0, 8.0), 22.0)]),
        layer(
            "2 curves",
            0.8,
            [38, 30, 24],
            1.0,
            vec![
                tapered(dvec2(6.0, 40.0), 60.0),
                tapered(dvec2(30.0, 14.0), 12.0),
                spiral(dvec2(80.0, 60.0), 14.0, 9.0),
                ring(dvec2(72.0, 24.0), 6.0),
                ring(dvec2(72.0, 24.0), 0.3),
                dot(dvec2(90.0, 8.0)),
                dot(dvec2(92.3, 8.4)),
            ],
        ),
        centre_lines(layer("3 lines", 0.5, [20, 60, 140], 1.0, lines.collect())),
        centre_lines(layer(
            "4 pale lines",
            2.0,
            [200, 0, 0],
            0.5,
            vec![
                even([dvec2(10.0, 60.0), dvec2(50.0, 70.0), dvec2(30.0, 45.0), dvec2(20.0, 76.0)]),
                closed(even([dvec2(60.0, 45.0), dvec2(64.0, 52.0), dvec2(56.0, 52.0)])),
                dot(dvec2(94.0, 40.0)),
            ],
        )),
    ])
}
