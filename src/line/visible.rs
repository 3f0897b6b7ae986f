//! From curves on the surface to the chains that the eye sees of them.
//!
//! Method: of each curve the convex stretches that nothing hides, on the page. Hidden runs
//! under `LEAST` px between seen ones are closed where depth goes on, seen ones under `LEAST` px left out. A chain runs
//! through a change of what it draws; flicker of it is smoothed away. Places are those of the curves, nothing is smoothed;
//! points that no pen shows are left out. Chains are [named](super::identity) and stand in an order of their own: the
//! same curves, in any order and begun anywhere, give the same bytes.
//!
//! Cost: some looks at each stretch, spread over all cores. Does not handle: curves that join; where two
//! meet on the page one ends on the other.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::crossing::Crossings;
use super::doubt::{Span, doubtful, join, seen};
use super::folds::convex;
use super::identity::{Held, key, names};
use super::labels::{Labelled, cheapest};
use super::shown::shown;
use super::{Bound, Chain, ChainPoint, Curve, CurvePoint, Id, Line, Sight, Stretch};
use crate::view::cut::share_within;

/// Least length of what is drawn and of a gap, px.
const LEAST: f64 = 2.0;
/// Depth goes on over a gap where ln depth changes by at most this: 5 % of the distance.
const GOES_ON: f64 = 0.05;
/// What a change of what is drawn costs, px of stretches that draw another: runs under twice that are flicker.
const FLICKER: f64 = 1.5;

/// What boundaries of the surface draw, in the order of labels.
const LINES: [Line; 3] = [Line::Occluding, Line::Skyline, Line::Border];

/// What the eye sees of curves on a page of so many pixels across and down.
pub fn chains(curves: Vec<Curve>, size: [u32; 2]) -> Vec<Chain> {
    sighted(curves, size, false).0
}

/// The same, and what it would see besides were there no nearer land: stretches that hide themselves are in neither.
pub fn seen_and_hidden(curves: Vec<Curve>, size: [u32; 2]) -> (Vec<Chain>, Vec<Chain>) {
    sighted(curves, size, true)
}

fn sighted(mut curves: Vec<Curve>, [width, height]: [u32; 2], wants_hidden: bool) -> (Vec<Chain>, Vec<Chain>) {
    let page = DVec2::new(width.into(), height.into());
    let prepare = |curve: &mut Curve| {
        begin_where_sure(curve);
        let convex = convex(curve);
        let doubtful = doubtful(curve, &convex);
        (convex, doubtful)
    };
    let (folds, doubts): (Vec<Vec<bool>>, Vec<Vec<Range<usize>>>) = curves.par_iter_mut().map(prepare).unzip();
    let near = Crossings::new(&curves, &doubts, page);
    let of_curve = |c: usize| {
        let spans = seen(&curves, c, &folds[c], &doubts[c], &near);
        let spans = joined(&curves[c], &folds[c], clipped(&curves[c], &spans, page));
        let bounds = !matches!(curves[c].stretches[0].bound, Bound::Nothing(_));
        let hidden = if wants_hidden && bounds { hidden(&curves[c], &folds[c], &spans, page) } else { Vec::new() };
        let chains = |spans: Vec<Span>| spans.into_iter().map(|span| chain(&curves[c], span)).collect::<Vec<_>>();
        (chains(spans), chains(hidden))
    };
    let (seen, hidden): (Vec<_>, Vec<_>) = (0..curves.len()).into_par_iter().map(of_curve).unzip();
    let (chains, mut hidden) = (named(seen.concat()), named(hidden.concat()));
    hidden.iter_mut().for_each(|chain| chain.id = chain.id.map(Id::hidden));
    (chains, hidden)
}

/// Chains with their names, in order.
fn named(mut chains: Vec<(Chain, Vec<Held>)>) -> Vec<Chain> {
    chains.par_sort_by(|(a, _), (b, _)| in_order(a, b));
    let (mut chains, held): (Vec<Chain>, Vec<Vec<Held>>) = chains.into_iter().unzip();
    for (chain, id) in chains.iter_mut().zip(names(&held)) {
        chain.id = id;
    }
    chains
}

/// What of the convex stretches of a curve on the page is not in the spans that are seen.
fn hidden(curve: &Curve, convex: &[bool], seen: &[Span], page: DVec2) -> Vec<Span> {
    let n = convex.len() as f64;
    let mut all = Vec::new();
    (0..convex.len()).filter(|i| convex[*i]).for_each(|i| join(&mut all, [i as f64, i as f64 + 1.0]));
    // A span that leads on beyond the last stretch goes on at the first.
    let led_on = seen.iter().map(|[from, to]| [from - n, to - n]).filter(|[_, to]| *to > 0.0);
    let seen: Vec<Span> = led_on.chain(seen.iter().copied()).collect();
    let mut left = Vec::new();
    for [mut from, to] in clipped(curve, &all, page) {
        for [enter, leave] in &seen {
            if *enter < to && *leave > from {
                left.push([from, *enter]);
                from = *leave;
            }
        }
        left.push([from, to]);
    }
    let along = Along::new(curve);
    left.retain(|&[from, to]| from < to && along.length([from, to]) >= LEAST);
    left
}

/// Turns a closed curve so that it begins in the middle of its longest free run, or at its lowest place on the lattice.
fn begin_where_sure(curve: &mut Curve) {
    if !curve.closed {
        return;
    }
    let low = (0..curve.points.len()).min_by_key(|&i| curve.points[i].at).unwrap_or(0);
    curve.turn(low);
    let is_free = |i: usize| curve.stretches[i].sight == Sight::Free;
    let Some(bound) = (0..curve.stretches.len()).find(|&i| !is_free(i)) else { return };
    curve.turn(bound);
    let (mut start, mut longest) = (0, 0..0);
    for run in curve.stretches.chunk_by(|a, b| a.sight == b.sight) {
        if run[0].sight == Sight::Free && run.len() > longest.len() {
            longest = start..start + run.len();
        }
        start += run.len();
    }
    curve.turn((longest.start + longest.end) / 2);
}

/// The parts of spans of a curve that are on the page.
fn clipped(curve: &Curve, spans: &[Span], page: DVec2) -> Vec<Span> {
    let mut parts = Vec::new();
    for [from, to] in pieces(spans) {
        let i = from.trunc();
        let [a, b] = curve.ends(i as usize).map(|end| end.place);
        if let Some([enter, leave]) = share_within([DVec2::ZERO, page], a, b) {
            let [from, to] = [from.max(i + enter), to.min(i + leave)];
            if from < to {
                join(&mut parts, [from, to]);
            }
        }
    }
    parts
}

/// Spans cut where stretches meet.
fn pieces(spans: &[Span]) -> impl Iterator<Item = Span> {
    let of_span = |&[from, to]: &Span| {
        let stretches = from as usize..to.ceil() as usize;
        stretches.map(move |i| [from.max(i as f64), to.min(i as f64 + 1.0)])
    };
    spans.iter().flat_map(of_span)
}

/// The spans of a curve without short gaps, short ones left out. In a closed curve one may lead on beyond the last stretch.
fn joined(curve: &Curve, convex: &[bool], mut spans: Vec<Span>) -> Vec<Span> {
    let n = convex.len();
    let along = Along::new(curve);
    let is_closable = |[from, to]: Span| {
        let mut stretches = from as usize..to.ceil() as usize;
        let depths = [from, to].map(|at| curve.at(at).depth.ln());
        along.length([from, to]) < LEAST && (depths[0] - depths[1]).abs() <= GOES_ON && stretches.all(|i| convex[i % n])
    };
    spans.dedup_by(|next, last| {
        let closed = is_closable([last[1], next[0]]);
        if closed {
            last[1] = next[1];
        }
        closed
    });
    if let (true, Some(&[first, end]), Some(&[_, last])) = (curve.closed, spans.first(), spans.last())
        && is_closable([last, first + n as f64])
    {
        match &mut spans[..] {
            [only] => *only = [0.0, n as f64],
            [.., last] => last[1] = end + n as f64,
            [] => {}
        }
        if spans.len() > 1 {
            spans.remove(0);
        }
    }
    spans.retain(|&span| along.length(span) >= LEAST);
    spans
}

/// Lengths along a curve, px.
struct Along(Vec<f64>);

impl Along {
    fn new(curve: &Curve) -> Self {
        let mut sum = 0.0;
        let lengths = (0..curve.stretches.len()).map(|i| {
            sum += curve.length(i);
            sum
        });
        Self([0.0].into_iter().chain(lengths).collect())
    }

    /// Length of a span, which may lead on beyond the last stretch.
    fn length(&self, [from, to]: Span) -> f64 {
        self.to(to) - self.to(from)
    }

    fn to(&self, at: f64) -> f64 {
        let n = self.0.len() - 1;
        let (round, i) = ((at / n as f64).floor(), at as usize % n);
        round * self.0[n] + self.0[i] + (self.0[i + 1] - self.0[i]) * at.fract()
    }
}

/// The chain of a span, without a name, and how much of it lies where.
fn chain(curve: &Curve, span: Span) -> (Chain, Vec<Held>) {
    let n = curve.stretches.len();
    let closed = curve.closed && span == [0.0, n as f64];
    let pieces: Vec<Span> = pieces(&[span]).collect();
    let stretch = |[from, _]: Span| &curve.stretches[from as usize % n];
    let length = |[from, to]: Span| curve.length(from as usize % n) * (to - from);
    let drawn: Vec<Line> = pieces.iter().map(|piece| line_of(stretch(*piece))).collect();
    let lengths: Vec<f64> = pieces.iter().map(|piece| length(*piece)).collect();
    let drawn = settled(&drawn, &lengths);
    let point = |at: f64, piece: usize| {
        let CurvePoint { place, depth, world, weight, black, .. } = curve.at(at);
        let behind = stretch(pieces[piece]).behind;
        ChainPoint { place, line: drawn[piece], depth: depth as f32, behind, world, crowd: 0, weight, black }
    };
    let mut points: Vec<ChainPoint> = (0..pieces.len()).map(|i| point(pieces[i][0], i)).collect();
    points.push(point(span[1], pieces.len() - 1));
    let mut points = shown(&points, &lengths);
    if closed {
        points.pop();
    }
    let held = pieces.iter().map(|&piece| {
        let at = curve.points[piece[0] as usize % n].at;
        Held { key: key(at, stretch(piece).outward), length: length(piece) }
    });
    (Chain { id: None, points, closed }, held.collect())
}

/// What pieces draw, without flicker.
fn settled(drawn: &[Line], lengths: &[f64]) -> Vec<Line> {
    if drawn.windows(2).all(|pair| pair[0] == pair[1]) {
        return drawn.to_vec();
    }
    let labelled = |(drawn, length): (&Line, &f64)| {
        let costs = std::array::from_fn(|label| if LINES[label] == *drawn { 0.0 } else { *length });
        Labelled::<3> { costs, step: 0 }
    };
    let labelled: Vec<_> = drawn.iter().zip(lengths).map(labelled).collect();
    cheapest(&labelled, FLICKER).into_iter().map(|label| LINES[label]).collect()
}

/// What a stretch draws.
fn line_of(stretch: &Stretch) -> Line {
    match stretch.bound {
        Bound::Rim => Line::Border,
        Bound::Contour if stretch.behind == 0.0 => Line::Skyline,
        Bound::Contour => Line::Occluding,
        Bound::Nothing(line) => line,
    }
}

/// The order of chains: by places of their points on the page, the first that differs.
fn in_order(a: &Chain, b: &Chain) -> Ordering {
    let place = |point: &ChainPoint| [point.place.y, point.place.x].map(f64::to_bits);
    let places = |chain: &Chain| chain.points.iter().map(place).collect::<Vec<_>>();
    let first = |chain: &Chain| chain.points.first().map(place);
    first(a).cmp(&first(b)).then_with(|| places(a).cmp(&places(b)))
}
