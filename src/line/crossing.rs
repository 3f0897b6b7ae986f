//! Where curves pass behind nearer ones on the page.
//!
//! Method: the stretches that the asked ones may cross are listed by cell of the page, and tried one by one. The surface
//! that faces the eye lies to the left of its boundary, on the page too: crossing a nearer stretch to its left, a curve
//! passes behind one more sheet of it, to its right, behind one less (Appel 1967, quantitative invisibility). Concave
//! stretches bound the surface as convex ones do, and count.
//!
//! Cost: a look at the stretches of a cell or two each; memory grows with the lines, not with the page. Does not handle:
//! stretches that lie on one another.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::{Bound, Curve};

/// Width and height of a cell, px: a stretch is at most about a pixel long, and those that crowd on far slopes lie level.
const CELL: DVec2 = DVec2::new(1.0, 0.25);
/// A stretch is nearer where its depth is more than this share larger: what f32 leaves of it.
const ROUNDING: f64 = 1.0e-6;

/// Where a stretch passes under a nearer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    /// Share of the stretch before it.
    pub at: f64,
    /// 1 where it goes behind what the nearer stretch bounds, -1 where it comes out.
    pub step: isize,
}

/// Stretches of curves by the cells of the page they touch.
pub(super) struct Crossings<'a> {
    curves: &'a [Curve],
    page: DVec2,
    /// Where each bucket of cells begins in `held`, and where the last ends.
    starts: Vec<u32>,
    held: Vec<Edge>,
}

/// A stretch on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Edge {
    places: [DVec2; 2],
    depths: [f64; 2],
}

impl Edge {
    fn new(curve: &Curve, stretch: usize) -> Self {
        let ends = curve.ends(stretch);
        Self { places: ends.map(|end| end.place), depths: ends.map(|end| end.depth) }
    }
}

impl<'a> Crossings<'a> {
    /// What may cross these stretches of each curve, on a page of so many pixels across and down.
    pub(super) fn new(curves: &'a [Curve], asked: &[Vec<Range<usize>>], page: DVec2) -> Self {
        let count: usize = asked.iter().flatten().map(Range::len).sum();
        let mut crossings =
            Self { curves, page, starts: vec![0; (2 * count).next_power_of_two() + 1], held: Vec::new() };
        let mut is_asked = vec![false; crossings.starts.len()];
        for (curve, ranges) in curves.iter().zip(asked) {
            for stretch in ranges.iter().cloned().flatten() {
                crossings.buckets(curve, stretch).for_each(|bucket| is_asked[bucket] = true);
            }
        }
        let of_curve = |curve: &'a Curve| {
            // Lines that lie on the surface bound nothing: they hide none.
            let bounds = |s: &usize| !matches!(curve.stretches[*s].bound, Bound::Nothing(_));
            let stretches = (0..curve.stretches.len()).filter(bounds);
            let asked = |s: usize| crossings.buckets(curve, s).filter(|&bucket| is_asked[bucket]).map(move |b| (b, s));
            let listed = stretches.flat_map(asked).map(|(bucket, s)| (bucket, Edge::new(curve, s)));
            listed.collect::<Vec<_>>()
        };
        let listed: Vec<(usize, Edge)> = curves.par_iter().flat_map_iter(of_curve).collect();
        listed.iter().for_each(|&(bucket, _)| crossings.starts[bucket + 1] += 1);
        for bucket in 1..crossings.starts.len() {
            crossings.starts[bucket] += crossings.starts[bucket - 1];
        }
        let mut next = crossings.starts.clone();
        crossings.held = vec![Edge { places: [DVec2::ZERO; 2], depths: [0.0; 2] }; listed.len()];
        for (bucket, edge) in listed {
            crossings.held[next[bucket] as usize] = edge;
            next[bucket] += 1;
        }
        crossings
    }

    /// Where a stretch passes under nearer ones, in order along it.
    pub(super) fn of(&self, curve: usize, stretch: usize) -> Vec<Crossing> {
        let far = Edge::new(&self.curves[curve], stretch);
        let in_bucket = |bucket: usize| &self.held[self.starts[bucket] as usize..self.starts[bucket + 1] as usize];
        let listed = self.buckets(&self.curves[curve], stretch).flat_map(in_bucket);
        // Itself and its neighbours it meets at its own depth.
        let mut found: Vec<Crossing> = listed.filter_map(|near| crossing(&far, near)).collect();
        found.sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then(a.step.cmp(&b.step)));
        // What two cells list is found twice.
        found.dedup();
        found
    }

    /// The buckets of the cells that a stretch may touch; none beside the page.
    fn buckets(&self, curve: &Curve, stretch: usize) -> impl Iterator<Item = usize> + use<> {
        let [a, b] = curve.ends(stretch).map(|end| end.place);
        let (low, high) = (a.min(b) / CELL, a.max(b).min(self.page) / CELL);
        // `as` takes what is left of the page to its first cell; a stretch beside it has an empty range.
        let (columns, rows) = (low.x as u64..=high.x as u64, low.y as u64..=high.y as u64);
        let mask = self.starts.len() as u64 - 2;
        let bucket = move |column: u64, row: u64| (xxh3_64(&(column << 32 | row).to_le_bytes()) & mask) as usize;
        rows.flat_map(move |row| columns.clone().map(move |column| bucket(column, row)))
    }
}

/// Where a stretch passes under a nearer one, if it does.
fn crossing(far: &Edge, near: &Edge) -> Option<Crossing> {
    // Above 0 to the left of the edge: rows run down.
    let side = |edge: &Edge, p: DVec2| (p - edge.places[0]).perp_dot(edge.places[1] - edge.places[0]);
    let sides = far.places.map(|end| side(near, end));
    let is_left = sides.map(|side| side > 0.0);
    if is_left[0] == is_left[1] {
        return None;
    }
    let others = near.places.map(|end| side(far, end));
    if (others[0] > 0.0) == (others[1] > 0.0) {
        return None;
    }
    let share = |[from, to]: [f64; 2]| from / (from - to);
    let depth = |edge: &Edge, share: f64| edge.depths[0] + (edge.depths[1] - edge.depths[0]) * share;
    let at = share(sides);
    let is_nearer = depth(near, share(others)) > depth(far, at) * (1.0 + ROUNDING);
    is_nearer.then_some(Crossing { at, step: if is_left[1] { 1 } else { -1 } })
}
