//! Which parts of the mask no stroke draws, and why.
//!
//! Cost: four looks a pixel of line, nine for each of ink.

use glam::DVec2;
use rustc_hash::FxHashSet;
use serde::Serialize;

use super::Drawing;
use super::sheet::Placement;
use crate::line::strays::{LEAST, around, connected};
use crate::line::{Id, Lines, Marks};
use crate::view::cut::steps;

/// An 8-connected set of inked pixels in which and beside which no stroke runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Unstroked {
    /// Column and row of its first pixel in reading order.
    pub pixel: [u32; 2],
    /// How many pixels it has.
    pub px: usize,
    /// Why it is not drawn.
    pub why: Why,
}

/// Why no stroke draws a part of the mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// Economy leaves its line no weight.
    Economy,
    /// Its line is finer than half the finest pen.
    Pens,
    /// It is a speck of some pixels without a line: lone ones are dots, if the style draws these.
    Speck,
    /// It lies at the edge, where a pen would leave the margins.
    Margin,
    /// No line was found there.
    NoLine,
}

/// The parts of a mask without a stroke of the drawing of its lines, in reading order; dashes of hidden lines are none.
pub fn unstroked(mask: &Marks, lines: &Lines, drawing: &Drawing) -> Vec<Unstroked> {
    let size = [mask.width, mask.height];
    let placement = drawing.sheet.placement(size);
    let points = |keeps: fn(f32) -> bool| {
        let pairs = lines.chains.iter().flat_map(|chain| chain.pairs());
        let kept = pairs.filter(move |pair| pair.iter().any(|point| keeps(point.weight)));
        pixels(size, kept.map(|pair| pair.map(|point| point.place)))
    };
    let (found, weighed) = (points(|_| true), points(|weight| weight > 0.0));
    let lone = lines.chains.iter().filter(|chain| chain.points.len() == 1);
    let dots = pixels(size, lone.flat_map(|chain| chain.pairs()).map(|pair| pair.map(|point| point.place)));
    let stroked = pixels(size, strokes(drawing, placement));
    let ink: Vec<[i64; 2]> = mask.places().map(|at| at.map(i64::from)).collect();
    let edge = |[x, y]: &[i64; 2]| *x <= 1 || *y <= 1 || *x >= i64::from(size[0]) - 2 || *y >= i64::from(size[1]) - 2;
    let of_set = |set: Vec<[i64; 2]>| {
        let meets =
            |lines: &FxHashSet<[i64; 2]>| set.iter().any(|at| around(*at).any(|beside| lines.contains(&beside)));
        if meets(&stroked) {
            return None;
        }
        let why = match (meets(&weighed), meets(&found)) {
            _ if set.len() == 1 && meets(&dots) => Why::Speck,
            (true, _) if set.iter().any(edge) => Why::Margin,
            (true, _) => Why::Pens,
            (false, true) => Why::Economy,
            (false, false) if set.len() < LEAST => Why::Speck,
            (false, false) => Why::NoLine,
        };
        let first = set.iter().min_by_key(|[x, y]| (*y, *x))?;
        Some(Unstroked { pixel: first.map(|v| v as u32), px: set.len(), why })
    };
    connected(&ink).into_iter().filter_map(of_set).collect()
}

/// The pieces of all strokes of what is seen, in pixels of the frame.
fn strokes(drawing: &Drawing, placement: Placement) -> impl Iterator<Item = [DVec2; 2]> {
    let strokes = drawing.layers.iter().flat_map(|layer| &layer.strokes);
    let seen = strokes.filter(|stroke| !stroke.chain.is_some_and(Id::is_hidden));
    seen.flat_map(move |stroke| {
        let next = |i: usize| stroke.points.get(i + 1).or(stroke.points.first().filter(|_| stroke.closed));
        let piece = move |(i, point)| {
            let end: &super::StrokePoint = next(i).unwrap_or(point);
            [point.place, end.place].map(|place| placement.in_frame(place))
        };
        stroke.points.iter().enumerate().map(piece)
    })
}

/// The pixels through which pieces of line run.
fn pixels(size: [u32; 2], pieces: impl Iterator<Item = [DVec2; 2]>) -> FxHashSet<[i64; 2]> {
    let at = |[a, b]: [DVec2; 2]| {
        steps(size, a, b).map(move |step| a.lerp(b, step.middle).floor().to_array().map(|v| v as i64))
    };
    pieces.flat_map(at).collect()
}
