//! Which parts of a curve the eye sees, exact where the raster leaves doubt.
//!
//! Method: concave stretches are hidden by themselves. About doubt, and where seen and hidden meet, the number of sheets of
//! the surface before the curve is counted from crossing to crossing with nearer boundaries (Appel 1967), held by the sure
//! stretches on both ends: free is 0, hidden any other number. Of all counts the one that explains most is taken: a change
//! without a crossing costs as much as [`UNEXPLAINED`] px of doubtful stretches against what the nearest pixel says. So a
//! curve that passes behind a nearer one ends on it, to the last bit; pixels decide only where nothing else is known.
//!
//! Cost: crossings of the doubtful stretches, and a look at each of their pieces. Does not handle: sure stretches that
//! are wrong for longer than [`MARGIN`].

use std::ops::Range;

use super::crossing::Crossings;
use super::labels::{Labelled, cheapest};
use super::{Curve, Sight};

/// How far doubt reaches into sure stretches beside it, px: how far from its crossing a change may be seen.
const MARGIN: f64 = 1.5;
/// What a change of the count without a crossing costs, px.
const UNEXPLAINED: f64 = 256.0;
/// What a px against a sure stretch costs, px: a change moves by [`MARGIN`] rather than being unexplained.
const SURE: f64 = UNEXPLAINED / 1.6;
/// Numbers of sheets that are told apart, from 0.
const COUNTS: usize = 8;

/// From where to where something holds along a curve: numbers of stretches, and shares of them.
pub(super) type Span = [f64; 2];

/// Adds a span after the others, to the last where that ends there.
pub(super) fn join(spans: &mut Vec<Span>, [from, to]: Span) {
    match spans.last_mut() {
        Some(last) if last[1] == from => last[1] = to,
        _ => spans.push([from, to]),
    }
}

/// The stretches in doubt, in runs of convex ones.
pub(super) fn doubtful(curve: &Curve, convex: &[bool]) -> Vec<Range<usize>> {
    let n = convex.len();
    let mut is_open = vec![false; n];
    let mut spread = |order: &mut dyn Iterator<Item = usize>| {
        let (mut since, mut before) = (f64::INFINITY, None);
        for i in order {
            let sight = curve.stretches[i].sight;
            let is_change = before.is_some_and(|before| before != sight);
            before = convex[i].then_some(sight);
            since = match (convex[i], sight) {
                (false, _) => f64::INFINITY,
                (true, Sight::Doubt { .. }) => 0.0,
                (true, _) if is_change => 0.0,
                (true, _) => since,
            };
            is_open[i] |= since < MARGIN;
            if !matches!(sight, Sight::Doubt { .. }) {
                since += curve.length(i);
            }
        }
    };
    spread(&mut (0..n));
    spread(&mut (0..n).rev());
    let mut start = 0;
    let runs = is_open.chunk_by(|a, b| a == b).map(|run| {
        start += run.len();
        start - run.len()..start
    });
    runs.filter(|run| is_open[run.start]).collect()
}

/// What the eye sees of a curve, in order; `doubtful` are its stretches in doubt.
pub(super) fn seen(
    curves: &[Curve],
    curve: usize,
    convex: &[bool],
    doubtful: &[Range<usize>],
    near: &Crossings,
) -> Vec<Span> {
    let stretches = &curves[curve].stretches;
    let mut spans: Vec<Span> = Vec::new();
    let mut see = |span| join(&mut spans, span);
    let mut next = 0;
    let end = stretches.len()..stretches.len();
    for run in doubtful.iter().chain([&end]) {
        let sure = (next..run.start).filter(|&i| convex[i] && stretches[i].sight == Sight::Free);
        sure.for_each(|i| see([i as f64, i as f64 + 1.0]));
        resolve(&curves[curve], curve, convex, run.clone(), near).into_iter().for_each(&mut see);
        next = run.end;
    }
    spans
}

/// What the eye sees of a run of stretches in doubt.
fn resolve(curve: &Curve, number: usize, convex: &[bool], run: Range<usize>, near: &Crossings) -> Vec<Span> {
    let sure = |i: usize| Some(curve.stretches.get(i)?.sight).filter(|_| convex[i]);
    let anchor = |sight: Option<Sight>| Labelled { costs: costs(sight, f64::INFINITY), step: 0 };
    let (mut spans, mut pieces) = (Vec::new(), Vec::new());
    let mut add = |span: Span, piece: Labelled<COUNTS>| {
        spans.push(span);
        pieces.push(piece);
    };
    add([run.start as f64; 2], anchor(run.start.checked_sub(1).and_then(sure)));
    for i in run.clone() {
        let (length, sight) = (curve.length(i), curve.stretches[i].sight);
        let (mut from, mut step) = (0.0, 0);
        let at = |share: f64| if share < 1.0 { i as f64 + share } else { i as f64 + 1.0 };
        for crossing in near.of(number, i) {
            let costs = costs(Some(sight), length * (crossing.at - from));
            add([at(from), at(crossing.at)], Labelled { costs, step });
            (from, step) = (crossing.at, crossing.step);
        }
        add([at(from), at(1.0)], Labelled { costs: costs(Some(sight), length * (1.0 - from)), step });
    }
    add([run.end as f64; 2], anchor(sure(run.end)));
    let counts = cheapest(&pieces, UNEXPLAINED);
    spans.into_iter().zip(counts).filter(|&([from, to], count)| count == 0 && from < to).map(|(span, _)| span).collect()
}

/// What each number of sheets before a piece of this length costs, against what is known of it.
fn costs(sight: Option<Sight>, length: f64) -> [f64; COUNTS] {
    let (free, hidden) = match sight {
        None => (0.0, 0.0),
        Some(Sight::Free) => (0.0, length * SURE),
        Some(Sight::Hidden) => (length * SURE, 0.0),
        Some(Sight::Doubt { free: true }) => (0.0, length),
        Some(Sight::Doubt { free: false }) => (length, 0.0),
    };
    std::array::from_fn(|count| if count == 0 { free } else { hidden })
}
