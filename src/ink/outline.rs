//! The area that a stroke covers, as polygons.
//!
//! Method: along the left side, around the end, back along the right side, around the beginning; of a closed stroke each
//! side is a ring, the right one backwards. At a bend the outer side goes around the point and the inner one through it:
//!
//! ```text
//!      L ------- L1 arc
//!                  \  L2
//!      a ------- b    |        inner side: R1, b, R2
//!                | \  |
//!      R ------- R1   |
//!                  R2 b'
//! ```
//!
//! So the whole is the sum of one trapezoid a segment, one sector a joint and a half-disc an end, all wound the same way
//! (the ways through the points cancel): by the non-zero rule it is their union, whatever crosses or turns back, and nothing
//! cancels to a hole. Where a bend hardly shows, each side has one corner on the bisector; only so far from the ends of
//! its segments that their trapezoids stay what they are. Where widths change steeply, discs at sharp bends and ends stick
//! out of the trapezoids: there the way goes around once more.
//!
//! Cost: linear; about two corners a point, 20 more at sharp bends and ends of a pen of .3 mm. Does not handle: removal of
//! what lies inside, so that polygons of strokes that cross themselves do so too.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use glam::DVec2;

use super::Stroke;

/// How far inside a circle the middles of its chords may lie, mm.
const ARC: f64 = 0.004;
/// How far bends may be cut, mm.
const CUT: f64 = 0.002;
/// How far discs may stick out unseen, mm.
const PROUD: f64 = 0.002;
/// Cosine of the bend from which on a joint is a whole disc: 30 degrees, as pictures have it.
const SHARP: f64 = 0.866;

/// A point of a stroke that differs from the one before.
#[derive(Debug, Clone, Copy)]
struct Spot {
    at: DVec2,
    /// Half the width, mm.
    half: f64,
}

/// From one spot to the next.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: Spot,
    to: Spot,
    /// Unit vector; its left is its `perp`.
    along: DVec2,
    length: f64,
}

impl Segment {
    fn new(from: Spot, to: Spot) -> Self {
        let step = to.at - from.at;
        Self { from, to, along: step.normalize_or(DVec2::X), length: step.length() }
    }

    /// Change of half the width along the way.
    fn slope(&self) -> f64 {
        (self.to.half - self.from.half).abs() / self.length
    }
}

/// The two sides of a stroke, both from its beginning on.
#[derive(Debug, Default)]
struct Sides {
    left: Vec<DVec2>,
    right: Vec<DVec2>,
}

/// The area of a stroke of a pen so many millimetres wide, as closed polygons in millimetres: one, or two where the stroke
/// is closed; the non-zero rule fills them. Nowhere more than .005 mm off.
pub fn outline(stroke: &Stroke, pen: f64) -> Vec<Vec<DVec2>> {
    let spots = spots(stroke, pen / 2.0);
    let mut segments: Vec<Segment> = spots.windows(2).map(|pair| Segment::new(pair[0], pair[1])).collect();
    let (Some(first), Some(last)) = (segments.first().copied(), segments.last().copied()) else {
        return spots.first().map(|dot| disc(*dot)).into_iter().collect();
    };
    let widest = spots.iter().map(|spot| spot.half).fold(0.0, f64::max);
    let steepest = segments.iter().map(Segment::slope).fold(0.0, f64::max);
    let more = if widest * steepest.powi(2) / 2.0 > PROUD { TAU } else { 0.0 };
    let mut sides = Sides::default();
    if stroke.closed {
        segments.push(first);
    } else {
        arc(&mut sides.left, first.from.at, -first.along.perp() * first.from.half, -PI - more);
    }
    segments.windows(2).for_each(|pair| sides.bend(&pair[0], &pair[1], more));
    let Sides { mut left, mut right } = sides;
    right.reverse();
    if stroke.closed {
        return vec![left, right];
    }
    arc(&mut left, last.to.at, last.along.perp() * last.to.half, -PI - more);
    left.append(&mut right);
    vec![left]
}

/// The points of a stroke without repetitions, the first once more where it is closed.
fn spots(stroke: &Stroke, half: f64) -> Vec<Spot> {
    let closing = stroke.points.first().filter(|_| stroke.closed);
    let points = stroke.points.iter().chain(closing);
    let mut spots: Vec<Spot> =
        points.map(|point| Spot { at: point.place, half: point.width.max(0.0) * half }).collect();
    spots.dedup_by(|a, b| a.at == b.at);
    spots
}

impl Sides {
    /// Goes on from one segment to the next; around the joint by so much `more` where the bend is sharp.
    fn bend(&mut self, before: &Segment, after: &Segment, more: f64) {
        let Spot { at, half } = before.to;
        let turn = before.along.angle_to(after.along);
        let (sin, cos) = (turn / 2.0).sin_cos();
        let shift = half * sin.abs();
        let cut = half * (1.0 - cos) + shift * before.slope().max(after.slope());
        if cut <= CUT && 2.0 * shift <= before.length.min(after.length) {
            let left = before.along.rotate(DVec2::new(cos, sin)).perp() * half;
            self.left.push(at + left);
            self.right.push(at - left);
            return;
        }
        let (inner, outer, out) =
            if turn > 0.0 { (&mut self.left, &mut self.right, -1.0) } else { (&mut self.right, &mut self.left, 1.0) };
        let [from, to] = [before, after].map(|segment| segment.along.perp() * out * half);
        inner.extend([at - from, at, at - to]);
        let more = if before.along.dot(after.along) > SHARP { 0.0 } else { more };
        arc(outer, at, from, turn - more * out);
    }
}

/// A dot.
fn disc(spot: Spot) -> Vec<DVec2> {
    let mut corners = Vec::new();
    arc(&mut corners, spot.at, DVec2::X * spot.half, -TAU);
    corners.pop();
    corners
}

/// Adds corners of an arc about `centre`, from there by `from` and then on by an angle, both ends among them.
fn arc(corners: &mut Vec<DVec2>, centre: DVec2, from: DVec2, turn: f64) {
    let longest = 2.0 * (1.0 - ARC / from.length()).max(FRAC_1_SQRT_2).acos();
    let steps = (turn.abs() / longest).ceil().max(1.0);
    corners.extend((0..=steps as u32).map(|i| {
        let angle = turn * f64::from(i) / steps;
        centre + DVec2::from_angle(angle).rotate(from)
    }));
}
