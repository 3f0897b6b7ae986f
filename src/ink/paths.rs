//! Strokes as the paths of a file: their corners in whole micrometres, the digits of those, and pieces of layers that are
//! written one after the other.
//!
//! Cost: some 10 ns a number; memory for a piece of 1 MB a core and what is made of it.

use glam::DVec2;
use rayon::prelude::*;

use super::outline::outline;
use super::{Area, Layer, Stroke, StrokeForm};

/// Points of the strokes in a piece: about 1 MB of text.
const PIECE: usize = 1 << 15;

/// A way through corners.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// Micrometres on the sheet; none is repeated, unless the path is a dot.
    pub corners: Vec<[i64; 2]>,
    /// Whether it goes back to the first.
    pub closed: bool,
}

/// What a file holds of a stroke: the borders of its area, or the way of the pen.
pub(super) fn paths(stroke: &Stroke, layer: &Layer) -> Vec<Path> {
    match layer.form {
        StrokeForm::Outlines => {
            let polygons = outline(stroke, layer.pen.width);
            polygons.into_iter().map(|polygon| Path::new(polygon.into_iter(), true)).collect()
        }
        StrokeForm::CentreLines => vec![Path::new(stroke.points.iter().map(|point| point.place), stroke.closed)],
    }
}

/// What a file holds of an area: its borders.
pub(super) fn borders(area: &Area) -> Vec<Path> {
    area.0.iter().map(|ring| Path::new(ring.iter().copied(), true)).collect()
}

impl Path {
    fn new(places: impl Iterator<Item = DVec2>, closed: bool) -> Self {
        let mut corners: Vec<[i64; 2]> = places.map(|place| place.to_array().map(micrometres)).collect();
        corners.dedup();
        if closed && corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if let [dot] = corners[..] {
            // A way without length, which round ends make a dot.
            corners.push(dot);
        }
        Self { corners, closed }
    }
}

/// Millimetres in whole micrometres.
pub(super) fn micrometres(mm: f64) -> i64 {
    (mm * 1000.0).round() as i64
}

/// Writes micrometres as millimetres: no zeros at the end, no sign before 0.
pub(super) fn number(micrometres: i64, text: &mut Vec<u8>) {
    if micrometres < 0 {
        text.push(b'-');
    }
    let (mut whole, mut part) = (micrometres.unsigned_abs() / 1000, micrometres.unsigned_abs() % 1000);
    let first = text.len();
    loop {
        text.push(b'0' + (whole % 10) as u8);
        whole /= 10;
        if whole == 0 {
            break;
        }
    }
    text[first..].reverse();
    if part > 0 {
        text.push(b'.');
    }
    while part > 0 {
        text.push(b'0' + (part / 100) as u8);
        part = part % 100 * 10;
    }
}

/// What `write` makes of the strokes, piece by piece: made on every core, in the order of the strokes.
pub(super) fn in_order<'a>(
    strokes: &'a [Stroke],
    write: impl Fn(&[Stroke]) -> Vec<u8> + Sync + 'a,
) -> impl Iterator<Item = Vec<u8>> + 'a {
    let mut pieces = pieces(strokes);
    let batches = std::iter::from_fn(move || {
        let batch: Vec<&[Stroke]> = pieces.by_ref().take(rayon::current_num_threads()).collect();
        (!batch.is_empty()).then_some(batch)
    });
    batches.flat_map(move |batch| batch.par_iter().map(|piece| write(piece)).collect::<Vec<_>>())
}

/// The strokes in pieces of about so many points; which ones depends on nothing else.
fn pieces(mut strokes: &[Stroke]) -> impl Iterator<Item = &[Stroke]> {
    std::iter::from_fn(move || {
        let mut points = 0;
        let whole = strokes.iter().take_while(|stroke| {
            let fits = points < PIECE;
            points += stroke.points.len();
            fits
        });
        let (piece, rest) = strokes.split_at(whole.count());
        strokes = rest;
        (!piece.is_empty()).then_some(piece)
    })
}
