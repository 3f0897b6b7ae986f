//! What a pen plotter gets of a layer: every line once, in few strokes, in an order with little way through the air.
//!
//! The stages, each a file of this folder: a segment that is there already is left out; strokes whose ends meet become one;
//! segments too short to be drawn go, and what is too short to leave ink grows; what is left is put in order. Lines move by
//! .03 mm at most, and nothing is added but .05 mm where ends are joined.
//!
//! Cost: n log n for n points; 2 x 10^5 strokes of some points take two seconds. The result depends on the strokes and their
//! order alone, not on the number of threads.
//!
//! Not handled: segments that overlap without having both ends in common, and the way from one layer to the next, where
//! the pen is changed.

mod improved;
mod long_enough;
mod merged;
mod nearest;
mod once;
mod order;

pub use long_enough::GROWTH;

use std::iter::Sum;

use glam::DVec2;

use super::Stroke;
use super::style::Plot;

/// Where the pen is before the first stroke of a layer: the sheet's top left corner.
const HOME: DVec2 = DVec2::ZERO;

/// The strokes of a layer of one width, all that it draws drawn once, in the order of plotting.
pub fn planned(strokes: Vec<Stroke>) -> Vec<Stroke> {
    let merged = merged::merged(once::once(strokes));
    let thinned: Vec<_> = merged.into_iter().map(long_enough::thinned).collect();
    // What differed by less than a short segment may be the same now, and what grows may grow onto something.
    let (long, short): (Vec<_>, Vec<_>) = once::once(thinned).into_iter().partition(long_enough::leaves_ink);
    let whole = once::once(long.into_iter().chain(short.into_iter().map(long_enough::lengthened)).collect());
    order::ordered(whole, HOME)
}

/// What the pen of a plotter does. Each layer begins at the sheet's top left corner, where pens are changed; the way back
/// there is not counted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Journey {
    /// Way on paper, mm.
    pub drawn: f64,
    /// Way in the air, mm.
    pub travel: f64,
    /// How often the pen is lowered, and lifted again.
    pub strokes: usize,
}

impl Journey {
    /// Through the strokes of a layer as they stand.
    pub fn through(strokes: &[Stroke]) -> Self {
        let starts = strokes.iter().map(|stroke| stroke.points[0].place);
        let ends = strokes.iter().map(|Stroke { points, closed, .. }| {
            let end = if *closed { 0 } else { points.len() - 1 };
            points[end].place
        });
        let way = |stroke: &Stroke| segments(stroke).map(|[from, to]| from.distance(to)).sum::<f64>();
        Self {
            drawn: strokes.iter().map(way).sum(),
            travel: [HOME].into_iter().chain(ends).zip(starts).map(|(from, to)| from.distance(to)).sum(),
            strokes: strokes.len(),
        }
    }

    /// How long that takes with such a plotter, s, without its accelerations and changes of pens.
    pub fn seconds(&self, plotter: &Plot) -> f64 {
        self.drawn / plotter.speed + self.travel / plotter.travel_speed + self.strokes as f64 * plotter.lift
    }
}

/// One layer after the other.
impl Sum for Journey {
    fn sum<I: Iterator<Item = Self>>(journeys: I) -> Self {
        journeys.fold(Self::default(), |a, b| Self {
            drawn: a.drawn + b.drawn,
            travel: a.travel + b.travel,
            strokes: a.strokes + b.strokes,
        })
    }
}

/// The segments of a stroke, the last of a closed one leading back to its first point.
fn segments(stroke: &Stroke) -> impl Iterator<Item = [DVec2; 2]> {
    let points = &stroke.points;
    let closing = points.last().zip(points.first()).filter(|_| stroke.closed).map(|(last, first)| [last, first]);
    points.windows(2).map(|pair| [&pair[0], &pair[1]]).chain(closing).map(|pair| pair.map(|point| point.place))
}
