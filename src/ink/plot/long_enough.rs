//! No segment and no stroke is too short.
//!
//! Plotters stutter over segments of some micrometres, and their pens leave nothing where they only touch the paper. Points
//! go that are nearer than .02 mm to the last one kept; where that would crowd the end of a stroke, what lies before it is
//! thinned by the rule of Douglas and Peucker (1973), each of whose points is as far as its tolerance from both neighbours.
//! So a line moves by .02 mm at most, and ends stay. A stroke shorter than .05 mm is drawn out to that at both ends.
//!
//! Cost: linear, but for what lies within .02 mm of an end.

use glam::DVec2;

use super::segments;
use crate::ink::{Stroke, StrokePoint};

/// Length of the shortest segment, mm: .02 in files too, which round to .001.
const SEGMENT: f64 = 0.0215;
/// Length of the shortest stroke, mm: .05 in files.
const STROKE: f64 = 0.0515;
/// How far ends of strokes that are too short move outwards at most, mm.
pub const GROWTH: f64 = STROKE / 2.0;

/// The stroke without segments that are too short. A ring of two points is left to go there and back.
pub(super) fn thinned(mut stroke: Stroke) -> Stroke {
    if segments(&stroke).all(|[a, b]| a.distance(b) >= SEGMENT) {
        return stroke;
    }
    stroke.points.extend(stroke.points.first().copied().filter(|_| stroke.closed));
    let path: Vec<DVec2> = stroke.points.iter().map(|point| point.place).collect();
    stroke.points = kept(&path).into_iter().map(|i| stroke.points[i]).collect();
    if stroke.closed {
        stroke.points.pop();
    }
    stroke
}

/// Which points of a path stay, the first and the last among them.
fn kept(path: &[DVec2]) -> Vec<usize> {
    let last = path.len() - 1;
    let is_far = |from: usize, to: usize| path[from].distance(path[to]) >= SEGMENT;
    let mut kept = vec![0];
    for i in 1..last {
        if is_far(kept[kept.len() - 1], i) {
            kept.push(i);
        }
    }
    while kept.len() > 1 && !is_far(kept[kept.len() - 1], last) {
        kept.pop();
    }
    strays(path, [kept[kept.len() - 1], last], &mut kept);
    kept.push(last);
    kept
}

/// Adds the points between two that their chord would pass too far from, in their order.
fn strays(path: &[DVec2], [from, to]: [usize; 2], kept: &mut Vec<usize>) {
    let stray = |i: &usize| distance(path[*i], [path[from], path[to]]);
    let farthest = (from + 1..to).max_by(|a, b| stray(a).total_cmp(&stray(b)));
    if let Some(farthest) = farthest.filter(|i| stray(i) >= SEGMENT) {
        strays(path, [from, farthest], kept);
        kept.push(farthest);
        strays(path, [farthest, to], kept);
    }
}

/// Distance of a place from a segment.
fn distance(place: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let t = (place - a).dot(b - a) / (b - a).length_squared();
    // Where both ends are one, there is no share.
    place.distance(a.lerp(b, if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) }))
}

/// Way along a stroke, mm.
fn length(stroke: &Stroke) -> f64 {
    segments(stroke).map(|[a, b]| a.distance(b)).sum()
}

/// Whether a stroke is long enough as it is.
pub(super) fn leaves_ink(stroke: &Stroke) -> bool {
    length(stroke) >= STROKE
}

/// A thinned stroke that was shorter, drawn out at both ends to the least length; a dot, to the left and to the right.
pub(super) fn lengthened(mut stroke: Stroke) -> Stroke {
    let more = (STROKE - length(&stroke)) / 2.0;
    if let [dot] = stroke.points[..] {
        stroke.points.push(dot);
    }
    let outward = |end: &StrokePoint, inner: &StrokePoint| (end.place - inner.place).try_normalize();
    if let [first, second, ..] = &mut stroke.points[..] {
        first.place += more * outward(first, second).unwrap_or(DVec2::NEG_X);
    }
    if let [.., inner, last] = &mut stroke.points[..] {
        last.place += more * outward(last, inner).unwrap_or(DVec2::X);
    }
    stroke
}
