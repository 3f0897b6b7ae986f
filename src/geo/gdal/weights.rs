//! The weight of a layer over what lies beneath, from 0 at its seams to 1 inside.
//!
//! A seam is where the layer is void and another beneath it is not. The weight grows by the smooth step of fifth degree
//! (Perlin 2002, Improving Noise), so that no slope and no curvature jumps, over four cells of what shows on the other side
//! of that seam, at most over half the radius of the largest disk in its connected part: fine land shows wherever it is
//! wide enough to be seen. Towards places where nothing is beneath, the weight grows likewise. Cost: a distance a sample for
//! the parts, one for each kind of cell along the seams, and the parts. Not handled: arms of a part far narrower than itself;
//! they are blended as widely.

use rayon::prelude::*;

use super::connected::{NONE, parts};
use super::distance::distances;

/// Cells of the coarser layer over which a seam is blended.
const SEAM_CELLS: f64 = 4.0;
/// Most of the largest disk's radius that a seam takes.
const SEAM_SHARE: f64 = 0.5;
/// Cells along a seam that differ by no more than this share are of one kind.
const LIKE_CELLS: f32 = 0.1;

/// A layer on `size` samples (columns, rows), `step` metres apart along rows and down columns, and what shows beneath.
pub(super) struct Pair<'a, F> {
    pub size: [usize; 2],
    pub step: [f64; 2],
    /// The layer, NaN at voids.
    pub upper: &'a [f32],
    /// Metres of its own cells.
    pub cell: f64,
    /// Metres of the cells of what shows beneath a sample, 0 for nothing.
    pub beneath: &'a F,
}

/// The connected parts of a layer.
struct Parts {
    labels: Vec<u32>,
    /// Metres over which the seams of each are blended at most.
    widest: Vec<f32>,
}

impl<F: Fn(usize) -> f32 + Sync> Pair<'_, F> {
    /// The weight of each sample, and the least and most metres over which seams are blended; `None` where there is no
    /// seam.
    pub(super) fn weights(&self) -> Option<(Vec<f32>, [f64; 2])> {
        let Self { size, step, .. } = *self;
        let kinds = self.kinds();
        let seam = |kind: f32| SEAM_CELLS * f64::from(kind).max(self.cell);
        let widest = seam(*kinds.last()?);
        let mut to_seam = distances(size, step, widest / SEAM_SHARE, |i| self.is_seam(i));
        let parts = Parts::of(size, to_seam.as_ref()?, |i| self.covers(i));
        let within = distances(size, step, widest, |i| self.covers(i) && (self.beneath)(i) == 0.0);
        let mut weights = vec![1.0; self.upper.len()];
        let mut widths = None;
        let beside = step[0].max(step[1]) as f32;
        for (i, kind) in kinds.iter().enumerate() {
            let above = if i > 0 { kinds[i - 1] } else { 0.0 };
            let of_kind = |i: usize| self.is_seam(i) && (self.beneath)(i) > above && (self.beneath)(i) <= *kind;
            let most = seam(*kind);
            let metres = if kinds.len() == 1 { to_seam.take() } else { distances(size, step, most, of_kind) }?;
            let weigh = |(i, weight): (usize, &mut f32)| {
                let width = parts.widest.get(parts.labels[i] as usize)?.min(most as f32);
                let [from_seam, from_end] = [Some(metres[i]), within.as_ref().map(|within| within[i])]
                    .map(|metres| metres.map_or(1.0, |metres| (metres / width).min(1.0)));
                *weight *= smooth_step(from_seam / (from_seam + from_end * (1.0 - from_seam)));
                (metres[i] <= beside && (self.beneath)(i) > 0.0).then_some([f64::from(width); 2])
            };
            let used = weights.par_iter_mut().enumerate().filter_map(weigh);
            let used = used.reduce_with(wider);
            widths = used.into_iter().chain(widths).reduce(wider);
        }
        // Layers that only touch are not blended.
        widths.map(|widths| (weights, widths))
    }

    fn covers(&self, i: usize) -> bool {
        !self.upper[i].is_nan()
    }

    /// Whether a sample that shows what is beneath touches the layer.
    fn is_seam(&self, i: usize) -> bool {
        let [columns, rows] = self.size;
        let (c, r) = (i % columns, i / columns);
        let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        let touches = || around(r, rows).any(|r| around(c, columns).any(|c| self.covers(r * columns + c)));
        !self.covers(i) && (self.beneath)(i) > 0.0 && touches()
    }

    /// The largest of each kind of cells along the seams, in rising order.
    fn kinds(&self) -> Vec<f32> {
        let add = |mut found: Vec<f32>, cell: f32| {
            if !found.contains(&cell) {
                found.push(cell);
            }
            found
        };
        let seams = (0..self.upper.len()).into_par_iter().filter(|i| self.is_seam(*i)).map(|i| (self.beneath)(i));
        let cells = seams.fold(Vec::new, add).reduce(Vec::new, |one, other| other.into_iter().fold(one, add));
        let mut cells: Vec<f32> = cells;
        cells.sort_by(|a, b| b.total_cmp(a));
        let mut kinds: Vec<f32> = Vec::new();
        for cell in cells {
            if kinds.last().is_none_or(|last| cell < last * (1.0 - LIKE_CELLS)) {
                kinds.push(cell);
            }
        }
        kinds.reverse();
        kinds
    }
}

impl Parts {
    /// Of samples that lie so many metres from the nearest seam.
    fn of(size: [usize; 2], to_seam: &[f32], covers: impl Fn(usize) -> bool) -> Self {
        let (labels, count) = parts(size, covers);
        let mut widest = vec![0.0_f32; count];
        for (label, metres) in labels.iter().zip(to_seam).filter(|(label, _)| **label != NONE) {
            let most = &mut widest[*label as usize];
            *most = most.max(metres * SEAM_SHARE as f32);
        }
        Self { labels, widest }
    }
}

/// Least and most of both.
fn wider(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}

/// From 0 at 0 to 1 at 1, level and without curvature at both.
fn smooth_step(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}
