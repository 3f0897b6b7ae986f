//! Strokes whose ends meet become one.
//!
//! Ends meet that lie within .05 mm. Where three or more do, those pairs are joined first that go on the straightest, of
//! equally straight ones those that came first; what is left over may be joined in turn. Cost: a look for the nearest ends
//! an end.
//!
//! Not handled: where more than [`MOST`] ends meet, an end is joined to one of the nearest of them only.

use glam::DVec2;

use super::nearest::Nearest;
use super::segments;
use crate::ink::{Stroke, StrokePoint};

/// How far apart ends may lie that meet, mm.
const REACH: f64 = 0.05;
/// Nearest ends that an end may be joined to.
const MOST: usize = 16;
/// How far from its end a stroke shows where it heads, mm: beyond the wiggles of its last points.
const AHEAD: f64 = 0.2;
/// Length of the shortest stroke whose two ends may be joined to each other, mm: a shorter one hardly leads away.
const RING: f64 = 0.2;

/// An end of a stroke: twice its number, and one more where it is the end of its last point.
type End = u32;

/// The other end of the stroke.
fn other(end: End) -> End {
    end ^ 1
}

/// The strokes with those joined whose ends meet, in the order of the first of each; closed where they come round. A place
/// where ends meet is a point of either.
pub(super) fn merged(strokes: Vec<Stroke>) -> Vec<Stroke> {
    let partners = partners(&strokes);
    let mut left: Vec<Option<Stroke>> = strokes.into_iter().map(Some).collect();
    let ends = 0..partners.len() as End;
    // From free ends first: what remains comes round.
    let free = ends.clone().filter(|&end| partners[end as usize].is_none());
    free.chain(ends).filter_map(|end| walked(end, &partners, &mut left)).collect()
}

/// What each end is joined to.
fn partners(strokes: &[Stroke]) -> Vec<Option<End>> {
    let ends = strokes.iter().flat_map(|stroke| [&stroke.points[0], &stroke.points[stroke.points.len() - 1]]);
    let ends: Vec<DVec2> = ends.map(|point| point.place).collect();
    let headings: Vec<DVec2> = strokes.iter().flat_map(headings).collect();
    let of = |end: End| &strokes[end as usize / 2];
    let mut tree = Nearest::new(ends.iter().copied());
    // Dots and rings have no ends.
    let is_open = |stroke: &Stroke| !stroke.closed && stroke.points.len() > 1;
    (0..ends.len() as End).filter(|&end| !is_open(of(end))).for_each(|end| tree.remove(end));

    let mut pairs: Vec<(f64, End, End)> = Vec::new();
    for a in (0..ends.len() as End).filter(|&end| is_open(of(end))) {
        let leads_away = || segments(of(a)).map(|[from, to]| from.distance(to)).sum::<f64>() >= RING;
        let is_other = |b: End| b != a && (b != other(a) || leads_away());
        let near = tree.find(ends[a as usize], MOST, REACH, is_other);
        // The cosine of two that go on in each other is -1.
        let bend = |b: End| headings[a as usize].dot(headings[b as usize]);
        pairs.extend(near.into_iter().map(|(_, b)| (bend(b), a.min(b), a.max(b))));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut partners = vec![None; ends.len()];
    for (_, a, b) in pairs {
        if partners[a as usize].is_none() && partners[b as usize].is_none() {
            (partners[a as usize], partners[b as usize]) = (Some(b), Some(a));
        }
    }
    partners
}

/// Where a stroke heads at its first and at its last point, outwards.
fn headings(stroke: &Stroke) -> [DVec2; 2] {
    fn heading<'a>(mut inwards: impl Iterator<Item = &'a StrokePoint>) -> DVec2 {
        let end = inwards.next().map_or(DVec2::ZERO, |point| point.place);
        let mut away = DVec2::ZERO;
        for point in inwards {
            away = end - point.place;
            if away.length() >= AHEAD {
                break;
            }
        }
        away.normalize_or_zero()
    }
    [heading(stroke.points.iter()), heading(stroke.points.iter().rev())]
}

/// The stroke that begins at an end and goes on through its partners; `None` where that one is part of another already.
fn walked(begin: End, partners: &[Option<End>], left: &mut [Option<Stroke>]) -> Option<Stroke> {
    let oriented = |mut stroke: Stroke, end: End| {
        if end % 2 == 1 {
            stroke.points.reverse();
        }
        stroke
    };
    let mut whole = oriented(left[begin as usize / 2].take()?, begin);
    let mut leave = other(begin);
    while let Some(enter) = partners[leave as usize] {
        let Some(next) = left[enter as usize / 2].take() else {
            // Only a stroke that comes round leads to one that is taken.
            whole.closed = true;
            break;
        };
        let next = oriented(next, enter);
        whole.chain = whole.chain.into_iter().chain(next.chain).min();
        whole.points.extend(next.points);
        leave = other(enter);
    }
    Some(whole)
}
