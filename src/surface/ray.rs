//! What lies first on the way from one place of the world to another: the facet of a level that a ray meets.
//!
//! Method: the pyramid's bounds lead to squares of some cells, nearest first; a patch there is halved along its sides until a facet of
//! the level is left. The points of a part of a patch, 1/n of it along a side, leave the triangle over its corners by at most its
//! bulge over n^2 ([`Patch::bulge`]), facets of level m by that over m^2 more. Cost: some microseconds a ray, a read for each
//! square on the way of a DEM that stays in its file. Does not handle: facets seen edge-on, which hide nothing that their neighbours
//! do not hide.

use std::borrow::Cow;

use glam::DVec3;

use super::lattice::{CELL_STEPS, CHUNK_QUADS, Level, patch_exists};
use super::patch::{Corner, Patch, Surface};
use crate::error::Result;

/// Where a ray meets the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Met {
    /// The share of the way that leads there, 0 to 1.
    pub share: f64,
    /// Metres of the exaggerated world, on a facet of the level.
    pub place: DVec3,
    /// Unit normal of the patch there, upwards but for overhangs.
    pub normal: DVec3,
    /// Whether the facet shows its upper side.
    pub is_toward: bool,
}

/// A way from a place, in metres from there.
struct Ray {
    way: DVec3,
    inverse: DVec3,
}

/// A part of a patch: barycentric weights of its corners, and where they lie from the start of the ray.
#[derive(Clone, Copy)]
struct Part {
    weights: [DVec3; 3],
    corners: [DVec3; 3],
}

/// The facet met so far: the share of the way, the weights there, and whether it is seen from above.
type Hit = (f64, DVec3, bool);

impl Surface {
    /// What lies first on the way between two places of the exaggerated world, as facets of `level`; `None` where nothing does.
    ///
    /// # Errors
    /// As [`Self::pyramid`] and [`Self::part`].
    pub(crate) fn first_met(&self, from: DVec3, to: DVec3, level: Level) -> Result<Option<Met>> {
        let pyramid = self.pyramid()?;
        let way = to - from;
        let ray = Ray { way, inverse: way.recip() };
        let dem = self.dem();
        let origin = dem.position(0, 0).with_z(0.0) - from;
        let enters = |at: [u32; 2], step: u32| {
            let corners = pyramid.bounds(at, step)?;
            ray.enters(corners.map(|corner| origin + corner))
        };
        let (coarsest, finest) = (pyramid.coarsest_step(), pyramid.finest_step());
        let last = [dem.columns(), dem.rows()].map(|samples| (samples as u32 - 1) * CELL_STEPS);
        let starts = |axis: usize| (0..last[axis]).step_by((CHUNK_QUADS * coarsest) as usize);
        let all = starts(1).flat_map(|y| starts(0).map(move |x| [x, y]));
        // Squares still to be looked at, the nearest last.
        let mut open: Vec<(f64, [u32; 2], u32)> =
            all.filter_map(|at| Some((enters(at, coarsest)?, at, coarsest))).collect();
        open.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut met: Option<Met> = None;
        while let Some((enter, at, step)) = open.pop() {
            if met.is_some_and(|met| met.share < enter) {
                continue;
            }
            if step == finest {
                let cells = (CHUNK_QUADS * step / CELL_STEPS) as usize;
                let found = self.met_in(at.map(|at| (at / CELL_STEPS) as usize), cells, from, &ray, level)?;
                met = [met, found].into_iter().flatten().min_by(|a, b| a.share.total_cmp(&b.share));
                continue;
            }
            let half = step / 2;
            let beside = CHUNK_QUADS * half;
            let quarters = [[0, 0], [beside, 0], [0, beside], [beside, beside]].map(|[x, y]| [at[0] + x, at[1] + y]);
            let mut inside: Vec<_> =
                quarters.into_iter().filter_map(|at| Some((enters(at, half)?, at, half))).collect();
            inside.sort_by(|a, b| b.0.total_cmp(&a.0));
            open.append(&mut inside);
        }
        Ok(met)
    }

    /// What a ray meets first of the cells of a square.
    fn met_in(&self, first: [usize; 2], cells: usize, from: DVec3, ray: &Ray, level: Level) -> Result<Option<Met>> {
        let part = match self.dem().is_filed() {
            true => Cow::Owned(self.part(first, [cells + 1; 2])?),
            false => Cow::Borrowed(self),
        };
        let dem = part.dem();
        let corner = |c: usize, r: usize| -> Corner {
            (dem.position(c, r) - from, (-part.gradient(c, r)).extend(1.0).normalize())
        };
        let mut met: Option<Met> = None;
        let end = [0, 1].map(|axis| (first[axis] + cells).min([dem.columns(), dem.rows()][axis] - 1));
        for (c, r) in (first[1]..end[1]).flat_map(|r| (first[0]..end[0]).map(move |c| (c, r))) {
            let corners = [corner(c, r), corner(c, r + 1), corner(c + 1, r + 1), corner(c + 1, r)];
            for half in (0..2).filter(|half| patch_exists(dem, c, r, *half)) {
                let patch = Patch::of_cell(corners, half);
                if let Some((share, weights, is_toward)) = ray.first_in(&patch, level)
                    && met.is_none_or(|met| share < met.share)
                {
                    let place = from + ray.way * share;
                    met = Some(Met { share, place, normal: patch.normal(weights.to_array()), is_toward });
                }
            }
        }
        Ok(met)
    }
}

impl Patch {
    /// Its unit normal at barycentric weights.
    pub fn normal(&self, weights: [f64; 3]) -> DVec3 {
        let [a, b, c] = self.derivatives(weights);
        (b - a).cross(c - a).normalize_or(DVec3::Z)
    }
}

impl Ray {
    /// The share of the way at which it enters a box; `None` where it passes it by.
    fn enters(&self, [low, high]: [DVec3; 2]) -> Option<f64> {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            if self.way[axis] == 0.0 {
                if low[axis] > 0.0 || high[axis] < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low[axis] * self.inverse[axis], high[axis] * self.inverse[axis]);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        (enter <= leave).then_some(enter)
    }

    /// The first facet of a patch that it meets.
    fn first_in(&self, patch: &Patch, level: Level) -> Option<Hit> {
        let (n, bulge) = (f64::from(level.subdivisions()), patch.bulge().limit);
        let weights = [DVec3::X, DVec3::Y, DVec3::Z];
        let whole = Part { weights, corners: weights.map(|weights| patch.point(weights.to_array())) };
        let (mut open, mut first): (Vec<(Part, f64)>, Option<Hit>) = (vec![(whole, 1.0)], None);
        while let Some((part, size)) = open.pop() {
            let leaves = DVec3::splat(bulge * (size * size + (n * n).recip()));
            let [a, b, c] = part.corners;
            let Some(enter) = self.enters([a.min(b).min(c) - leaves, a.max(b).max(c) + leaves]) else { continue };
            if first.is_some_and(|first| first.0 < enter) {
                continue;
            }
            if size * n > 1.0 {
                open.extend(part.halved(patch).map(|part| (part, size / 2.0)));
            } else if let Some(hit) = self.crosses(&part).filter(|hit| first.is_none_or(|first| hit.0 < first.0)) {
                first = Some(hit);
            }
        }
        first
    }

    /// Where it crosses a facet or its sides.
    fn crosses(&self, Part { weights, corners: [a, b, c] }: &Part) -> Option<Hit> {
        let side = |p: DVec3, q: DVec3| self.way.dot(p.cross(q));
        let volumes = [side(*b, *c), side(*c, *a), side(*a, *b)];
        if volumes.iter().any(|v| *v > 0.0) && volumes.iter().any(|v| *v < 0.0) {
            return None;
        }
        let normal = (*b - *a).cross(*c - *a);
        let (at, along) = (normal.dot(*a), normal.dot(self.way));
        let share = at / along;
        let sum: f64 = volumes.iter().sum();
        let at = (weights[0] * volumes[0] + weights[1] * volumes[1] + weights[2] * volumes[2]) / sum;
        ((0.0..=1.0).contains(&share) && at.is_finite()).then_some((share, at, along < 0.0))
    }
}

impl Part {
    /// Its four parts of half the size.
    fn halved(&self, patch: &Patch) -> [Self; 4] {
        let [a, b, c] = self.weights;
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        let [p, q, r] = self.corners;
        let [pq, qr, rp] = [ab, bc, ca].map(|weights| patch.point(weights.to_array()));
        let part = |weights, corners| Self { weights, corners };
        [
            part([a, ab, ca], [p, pq, rp]),
            part([ab, b, bc], [pq, q, qr]),
            part([ca, bc, c], [rp, qr, r]),
            part([ab, bc, ca], [pq, qr, rp]),
        ]
    }
}
