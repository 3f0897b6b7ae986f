//! From chains to strokes: where on the sheet, and how wide.
//!
//! Lines thin with distance, where little lies between them and what is behind, and by the weight that
//! [economy](crate::line::economy) leaves contours; traced lines thin where many crowd together. Free ends taper. A hand's
//! wobble moves the sheet under the pen. All is cut at the margins, half a pen inside them.

use glam::{DVec2, FloatExt};

use super::plot;
use super::sheet::Placement;
use super::style::{Dashes, Weight};
use super::wobble::Hand;
use crate::line::{Chain, ChainPoint, Line, Recession};
use crate::view::cut::share_within;

/// Most points between two of a line where it tapers.
const TAPERED: usize = 16;
/// Least weight of a hidden line that is drawn.
const SHOWN: f64 = 0.5;
/// Pixels of the square in which ink crowds.
const SQUARE: f64 = 81.0;

/// A point of a line on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InkPoint {
    /// Millimetres from the sheet's top left corner.
    pub place: DVec2,
    /// As a share of the pen's.
    pub width: f64,
    /// From the eye, metres of the exaggerated world.
    pub distance: f64,
}

/// A line on the sheet, without lifting the pen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PenRun {
    /// At least one.
    pub points: Vec<InkPoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

/// How the chains of a page come to lie on the sheet.
#[derive(Debug)]
pub(crate) struct Inking<'a> {
    /// From pixels to millimetres.
    pub placement: Placement,
    /// Where lines may lie, mm.
    pub area: [DVec2; 2],
    /// How wide they are.
    pub weight: &'a Weight,
    /// How wide the farthest hachures are, as a share of the nearest.
    pub far_hachures: f64,
    /// How they recede.
    pub recession: &'a Recession,
    /// Who draws them.
    pub hand: Hand,
    /// Where from they are seen, metres of the exaggerated world.
    pub eye: glam::DVec3,
}

impl InkPoint {
    fn lerp(&self, other: &Self, t: f64) -> Self {
        Self {
            place: self.place.lerp(other.place, t),
            width: self.width.lerp(other.width, t),
            distance: self.distance.lerp(other.distance, t),
        }
    }
}

impl Inking<'_> {
    /// The runs of a chain, cut where it has no weight; `free` tells which of its ends taper.
    pub(crate) fn weighed(&self, chain: &Chain, free: [bool; 2]) -> Vec<PenRun> {
        let points = chain.points.iter().map(|point| self.inked(point, self.width(point))).collect();
        let mut run = PenRun { points, closed: chain.closed };
        run.taper(free, self.weight.taper);
        run.without_blanks()
    }

    /// The run of a chain, as wide as the pen.
    pub(crate) fn even(&self, chain: &Chain) -> PenRun {
        PenRun { points: chain.points.iter().map(|point| self.inked(point, 1.0)).collect(), closed: chain.closed }
    }

    /// The dashes of a hidden chain where economy leaves it, as wide as the pen: what is shorter than a dash says nothing.
    pub(crate) fn dashed(&self, chain: &Chain, dashes: &Dashes) -> Vec<PenRun> {
        let points = chain.points.iter().map(|point| self.inked(point, point.weight.into())).collect();
        let parts = PenRun { points, closed: chain.closed }.banded(&[SHOWN], |point| point.width);
        let shown = parts.into_iter().filter(|(band, run)| *band == 1 && run.length() >= dashes.dash);
        shown.flat_map(|(_, run)| run.evened().dashed(dashes)).collect()
    }

    /// What lies inside the margins of a run that a pen so wide draws, as the hand draws it.
    pub(crate) fn finished(&self, run: PenRun, pen: f64) -> Vec<PenRun> {
        let [low, high] = [self.area[0] + inset(pen), self.area[1] - inset(pen)];
        // A pen may be broader than the sheet.
        if low.cmplt(high).all() { self.strayed(run).within([low, high]) } else { Vec::new() }
    }

    fn inked(&self, point: &ChainPoint, width: f64) -> InkPoint {
        InkPoint { place: self.placement.on_sheet(point.place), width, distance: point.world.distance(self.eye) }
    }

    /// Width of a line at a point, as a share of the pen's.
    fn width(&self, point: &ChainPoint) -> f64 {
        let Weight { far, flat, crowd, .. } = *self.weight;
        let far = if point.line == Line::Hachure { self.far_hachures } else { far };
        let receding = 1.0 - (1.0 - far) * self.recession.share(point);
        let roomy = (receding * (crowd * SQUARE / f64::from(point.crowd.max(1))).sqrt().min(1.0)).max(far);
        // What lies on the land has nothing behind it: its width is a matter of its own.
        let apart = if point.line.is_of_land() { 1.0 } else { flat + (1.0 - flat) * point.relief().sqrt() };
        roomy * f64::from(point.weight) * apart
    }

    /// The run as the hand draws it.
    fn strayed(&self, run: PenRun) -> PenRun {
        let longest = self.hand.step();
        if longest.is_infinite() {
            return run;
        }
        let run = run.stepped(longest);
        let stray = |point: &InkPoint| InkPoint { place: self.hand.stray(point.place), ..*point };
        PenRun { points: run.points.iter().map(stray).collect(), ..run }
    }
}

/// How far inside the margins the lines of a pen end, mm: what is too short to leave ink will grow.
pub(crate) fn inset(pen: f64) -> f64 {
    pen / 2.0 + plot::GROWTH
}

impl PenRun {
    /// Length of line, mm.
    pub(crate) fn length(&self) -> f64 {
        self.steps().map(|[a, b]| a.place.distance(b.place)).sum()
    }

    /// The same, as wide as the pen everywhere.
    pub(crate) fn evened(mut self) -> Self {
        self.points.iter_mut().for_each(|point| point.width = 1.0);
        self
    }

    /// Each point with the next, the last of a closed run with the first.
    fn steps(&self) -> impl Iterator<Item = [&InkPoint; 2]> {
        let closing = self.points.last().zip(self.points.first()).filter(|_| self.closed).map(|(a, b)| [a, b]);
        self.points.windows(2).map(|pair| [&pair[0], &pair[1]]).chain(closing)
    }

    /// The same, begun with its first point again where it is closed: an open run all the same.
    fn opened(mut self) -> Self {
        if self.closed {
            self.points.push(self.points[0]);
        }
        Self { closed: false, ..self }
    }

    /// Lets free ends run out over so many millimetres, less in short runs.
    fn taper(&mut self, free: [bool; 2], taper: f64) {
        if taper == 0.0 || free == [false; 2] || self.points.len() < 2 {
            return;
        }
        let length = self.length();
        if length == 0.0 {
            return;
        }
        let ends = if free == [true; 2] { 2.0 } else { 1.0 };
        let taper = taper.min(length / ends);
        let runs_out = |is_free: bool, way: f64| {
            let t = if is_free { (way / taper).clamp(0.0, 1.0) } else { 1.0 };
            t * (2.0 - t)
        };
        let share = |arc: f64| runs_out(free[0], arc) * runs_out(free[1], length - arc);
        let mut tapered = Vec::with_capacity(self.points.len() + 2 * TAPERED);
        let mut arc = 0.0;
        for pair in self.points.windows(2) {
            let step = pair[0].place.distance(pair[1].place);
            // What is whole at both ends is so between, but for runs shorter than both tapers.
            let is_whole = share(arc) == 1.0 && share(arc + step) == 1.0;
            let steps = if is_whole { 1.0 } else { (step / taper * 4.0).ceil().clamp(1.0, TAPERED as f64) };
            tapered.extend((0..steps as u32).map(|s| {
                let t = f64::from(s) / steps;
                let point = pair[0].lerp(&pair[1], t);
                InkPoint { width: point.width * share(arc + t * step), ..point }
            }));
            arc += step;
        }
        tapered.extend(self.points.last().map(|last| InkPoint { width: last.width * share(length), ..*last }));
        self.points = tapered;
    }

    /// The parts with width: they run out to points without, between two of which there is nothing.
    fn without_blanks(mut self) -> Vec<Self> {
        let Some(first) = self.points.iter().position(|point| point.width <= 0.0) else { return vec![self] };
        if self.closed {
            self.points.rotate_left(first);
            self = self.opened();
        }
        let pieces = self.points.chunk_by(|a, b| a.width > 0.0 || b.width > 0.0);
        let drawn = pieces.filter(|piece| piece.len() > 1);
        drawn.map(|piece| Self { points: piece.to_vec(), closed: false }).collect()
    }

    /// The run with more points between those that lie more than `longest` mm apart.
    fn stepped(self, longest: f64) -> Self {
        let closed = self.closed;
        let mut points = Vec::with_capacity(self.points.len());
        for [a, b] in self.steps() {
            let steps = (a.place.distance(b.place) / longest).ceil().max(1.0);
            points.extend((0..steps as u32).map(|s| a.lerp(b, f64::from(s) / steps)));
        }
        points.extend(self.points.last().filter(|_| !closed));
        Self { points, closed }
    }

    /// The parts inside a rectangle.
    fn within(self, [low, high]: [DVec2; 2]) -> Vec<Self> {
        let inside = |point: &InkPoint| point.place.cmpge(low).all() && point.place.cmple(high).all();
        if self.points.iter().all(inside) {
            return vec![self];
        }
        let spans = self.opened().cut_by(|a, b| share_within([low, high], a.place, b.place).into_iter().collect());
        spans.into_iter().map(|points| Self { points, closed: false }).collect()
    }

    /// The parts in each band between two bounds of a value, which rise; bands are numbered from 0, up to the first bound.
    pub(crate) fn banded(self, bounds: &[f64], value: impl Fn(&InkPoint) -> f64) -> Vec<(usize, Self)> {
        let band = |v: f64| bounds.partition_point(|&bound| bound <= v);
        let first = self.points.first().map_or(0, |point| band(value(point)));
        if self.points.iter().all(|point| band(value(point)) == first) {
            return vec![(first, self)];
        }
        let opened = self.opened();
        let mut parts: Vec<(usize, Self)> = Vec::new();
        let mut add = |of: usize, points: [InkPoint; 2]| match parts.last_mut() {
            Some((last, run)) if *last == of => run.points.push(points[1]),
            _ => parts.push((of, Self { points: points.to_vec(), closed: false })),
        };
        for pair in opened.points.windows(2) {
            let [from, to] = [value(&pair[0]), value(&pair[1])];
            let (low, high) = (from.min(to), from.max(to));
            let mut cuts: Vec<f64> =
                bounds.iter().filter(|&&b| low < b && b < high).map(|b| (b - from) / (to - from)).collect();
            cuts.sort_by(f64::total_cmp);
            let mut at = 0.0;
            for next in cuts.into_iter().chain([1.0]) {
                let ends = [at, next].map(|t| pair[0].lerp(&pair[1], t));
                add(band(value(&pair[0].lerp(&pair[1], (at + next) / 2.0))), ends);
                at = next;
            }
        }
        parts
    }

    /// The dashes of a run, the first and the last half a dash long where it is open, all between drawn out or in to fit.
    fn dashed(self, dashes: &Dashes) -> Vec<Self> {
        let length = self.length();
        let count = (length / (dashes.dash + dashes.gap)).round();
        if count < 1.0 {
            return vec![self];
        }
        let period = length / count;
        let dash = period * dashes.dash / (dashes.dash + dashes.gap);
        let mut arc = 0.0;
        let spans = self.opened().cut_by(|a, b| {
            let (from, step) = (arc, a.place.distance(b.place));
            arc += step;
            let turns = (from / period).floor() as u64..=(arc / period).floor() as u64 + 1;
            let ends = turns.map(|k| [k as f64 * period - dash / 2.0, k as f64 * period + dash / 2.0]);
            let parts = ends.map(|ends| ends.map(|end| ((end - from) / step).clamp(0.0, 1.0)));
            parts.filter(|[enter, leave]| step > 0.0 && enter < leave).collect()
        });
        spans.into_iter().map(|points| Self { points, closed: false }).collect()
    }

    /// The parts of an open run that lie in the spans of its steps, as shares of each, joined where one goes on in the next.
    fn cut_by(&self, mut spans: impl FnMut(&InkPoint, &InkPoint) -> Vec<[f64; 2]>) -> Vec<Vec<InkPoint>> {
        let mut parts: Vec<Vec<InkPoint>> = Vec::new();
        let mut goes_on = false;
        for pair in self.points.windows(2) {
            let spans = spans(&pair[0], &pair[1]);
            let leads_on = spans.last().is_some_and(|span| span[1] == 1.0);
            for [enter, leave] in spans {
                let ends = [enter, leave].map(|t| pair[0].lerp(&pair[1], t));
                match parts.last_mut() {
                    Some(part) if goes_on && enter == 0.0 => part.push(ends[1]),
                    _ => parts.push(ends.to_vec()),
                }
            }
            goes_on = leads_on;
        }
        parts
    }
}
