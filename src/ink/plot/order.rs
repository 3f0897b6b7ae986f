//! The order of strokes, for little way through the air.
//!
//! Up to [`MOST`] strokes: from the corner to the nearest end, and on to the nearest end of what is left, along each stroke
//! in the better direction; then [improved](super::improved). Closed strokes begin where the pen comes from, at any of
//! their points, and once the order is found, where the way in and the way out are shortest together. Beyond: along a curve
//! of Hilbert (1891) through the strokes' middles, each in the better direction (Platzman and Bartholdi 1989). Of equally
//! good ones the first wins.
//!
//! Cost: n log n, where each point of a closed stroke counts; along the curve a tenth of that,
//! for two or three times the way.

use fast_hilbert::xy2h;
use glam::DVec2;

use super::improved::improved;
use super::nearest::Nearest;
use crate::ink::Stroke;

/// Most strokes of which the nearest is looked for.
const MOST: usize = 200_000;

/// A stroke in the order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Visit {
    /// Which one.
    pub stroke: usize,
    /// At which of its points it begins: the first or the last, but of closed ones any.
    pub begin: usize,
    /// Where that is, and where it ends.
    pub ends: [DVec2; 2],
}

impl Visit {
    fn new(strokes: &[Stroke], stroke: usize, begin: usize) -> Self {
        let Stroke { points, closed, .. } = &strokes[stroke];
        let last = if *closed { begin } else { points.len() - 1 - begin };
        Self { stroke, begin, ends: [begin, last].map(|i| points[i].place) }
    }

    /// The same the other way round.
    pub(super) fn turned(self, strokes: &[Stroke]) -> Self {
        let Stroke { points, closed, .. } = &strokes[self.stroke];
        let begin = if *closed { self.begin } else { points.len() - 1 - self.begin };
        Self::new(strokes, self.stroke, begin)
    }
}

/// The strokes in their order, from a place on.
pub(super) fn ordered(strokes: Vec<Stroke>, from: DVec2) -> Vec<Stroke> {
    let visits = match strokes.len() > MOST {
        true => along_curve(&strokes, from),
        false => improved(&strokes, by_nearest(&strokes, from), from),
    };
    let visits = begun_best(&strokes, visits, from);
    let mut left: Vec<Option<Stroke>> = strokes.into_iter().map(Some).collect();
    visits.iter().filter_map(|visit| Some(begun_at(left[visit.stroke].take()?, visit.begin))).collect()
}

/// The points of a stroke at which it may begin.
fn begins(stroke: &Stroke) -> Vec<usize> {
    if stroke.closed { (0..stroke.points.len()).collect() } else { vec![0, stroke.points.len() - 1] }
}

/// The nearest first.
fn by_nearest(strokes: &[Stroke], from: DVec2) -> Vec<Visit> {
    let of = |(stroke, of): (usize, &Stroke)| begins(of).into_iter().map(move |begin| (stroke, begin));
    let candidates: Vec<(usize, usize)> = strokes.iter().enumerate().flat_map(of).collect();
    let mut tree = Nearest::new(candidates.iter().map(|&(s, begin)| strokes[s].points[begin].place));
    let mut at = from;
    let next = || {
        let (_, nearest) = *tree.find(at, 1, f64::INFINITY, |_| true).first()?;
        let (stroke, begin) = candidates[nearest as usize];
        let first = candidates.partition_point(|candidate| candidate.0 < stroke);
        let all = candidates[first..].iter().take_while(|candidate| candidate.0 == stroke);
        (first..first + all.count()).for_each(|candidate| tree.remove(candidate as u32));
        let visit = Visit::new(strokes, stroke, begin);
        at = visit.ends[1];
        Some(visit)
    };
    std::iter::from_fn(next).collect()
}

/// Along a curve through the middles of all.
fn along_curve(strokes: &[Stroke], from: DVec2) -> Vec<Visit> {
    let middle = |stroke: &Stroke| {
        let low = stroke.points.iter().fold(DVec2::INFINITY, |low, point| low.min(point.place));
        let high = stroke.points.iter().fold(DVec2::NEG_INFINITY, |high, point| high.max(point.place));
        low.midpoint(high)
    };
    let middles: Vec<DVec2> = strokes.iter().map(middle).collect();
    let low = middles.iter().fold(DVec2::INFINITY, |low, middle| low.min(*middle));
    let high = middles.iter().fold(DVec2::NEG_INFINITY, |high, middle| high.max(*middle));
    // The square of the curve, in so many cells a side.
    let scale = f64::from(u16::MAX) / (high - low).max_element().max(f64::MIN_POSITIVE);
    let place = |s: usize| {
        let cell = (middles[s] - low) * scale;
        xy2h(cell.x as u16, cell.y as u16, 16)
    };
    let mut order: Vec<usize> = (0..strokes.len()).collect();
    order.sort_by_cached_key(|&s| (place(s), s));
    let mut at = from;
    let visit = |s| {
        let ways = begins(&strokes[s]).into_iter().map(|begin| Visit::new(strokes, s, begin));
        let best = ways.min_by(|a, b| at.distance_squared(a.ends[0]).total_cmp(&at.distance_squared(b.ends[0])));
        at = best.map_or(at, |visit| visit.ends[1]);
        best
    };
    order.into_iter().filter_map(visit).collect()
}

/// The same order, in which closed strokes begin where that shortens the way in and the way out.
fn begun_best(strokes: &[Stroke], mut visits: Vec<Visit>, from: DVec2) -> Vec<Visit> {
    for i in 0..visits.len() {
        let stroke = visits[i].stroke;
        if strokes[stroke].closed {
            let before = if i == 0 { from } else { visits[i - 1].ends[1] };
            let after = visits.get(i + 1).map(|next| next.ends[0]);
            let way = |visit: &Visit| {
                let [begin, end] = visit.ends;
                before.distance(begin) + after.map_or(0.0, |after| end.distance(after))
            };
            let ways = (0..strokes[stroke].points.len()).map(|begin| Visit::new(strokes, stroke, begin));
            visits[i] = ways.min_by(|a, b| way(a).total_cmp(&way(b))).unwrap_or(visits[i]);
        }
    }
    visits
}

/// The stroke that begins at one of its points.
fn begun_at(mut stroke: Stroke, begin: usize) -> Stroke {
    match stroke.closed {
        true => stroke.points.rotate_left(begin),
        false if begin > 0 => stroke.points.reverse(),
        false => (),
    }
    stroke
}
