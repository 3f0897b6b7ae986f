//! Curved PN triangles in f64: the surface every picture is measured against.
//!
//! Vlachos, Peters, Boyd, Mitchell 2001, "Curved PN Triangles", section 3: a cubic Bezier triangle whose edge control
//! points lie in the tangent planes of the nearer corner. Only the geometry is cubic; facing comes from the facets.
//! Cost: about 150 operations a point. It does not handle creases: one sample has one normal.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};

use super::lattice::{CELL_STEPS, LatticePoint, Level};
use super::limits::Limits;
use super::normals::{Gradients, cut, gradients, of_samples, with_one_around};
use super::pyramid::Pyramid;
use crate::dem::{Band, Dem};
use crate::error::Result;

/// A DEM with its vertex normals: everything a place on the surface depends on.
///
/// Of a held DEM all normals are in memory; of a filed one they are computed where they are asked for, one at a time or,
/// far quicker, by [`Surface::part`] and [`Surface::bands`].
#[derive(Debug, Clone)]
pub struct Surface {
    pub(super) dem: Dem,
    gradients: Option<Gradients>,
    pyramid: OnceLock<Pyramid>,
    /// Which of its gradients are limited, so that no patch folds.
    limits: Arc<Limits>,
}

/// Rows of a surface, in memory with some rows around them.
#[derive(Debug)]
pub struct SurfaceBand<'a> {
    /// The rows it is about.
    pub rows: Range<usize>,
    /// The surface there: samples and gradients elsewhere must not be asked for.
    pub surface: Cow<'a, Surface>,
}

impl Surface {
    /// Computes the normals of `dem`, if it is held.
    pub fn new(dem: Dem) -> Self {
        let whole = [dem.columns(), dem.rows()];
        let gradients = dem.held().ok().map(|samples| of_samples(samples, [0, 0], whole, dem.cell()));
        Self { gradients, dem, pyramid: OnceLock::new(), limits: Arc::default() }
    }

    /// The grid below the surface.
    pub fn dem(&self) -> &Dem {
        &self.dem
    }

    /// The same surface with tangents limited as far as is needed for no patch to fold: itself where none does. Cost: as
    /// [`Surface::folds`], and gradients and pyramid anew where some are.
    ///
    /// # Errors
    /// As [`Limits::of`].
    pub fn limited(self) -> Result<Self> {
        let limits = Arc::new(Limits::of(&self)?);
        if limits.is_empty() {
            return Ok(self);
        }
        let gradients = self.gradients.map(|gradients| gradients.limited(&limits));
        Ok(Self { gradients, pyramid: OnceLock::new(), limits, dem: self.dem })
    }

    /// Which of its gradients are limited.
    pub(crate) fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Gives it a pyramid that was kept, unless it has one.
    pub(crate) fn remember(&self, pyramid: Pyramid) {
        let _ = self.pyramid.set(pyramid);
    }

    /// Gradients of row `r`, see [`Gradients::components`]; nothing where they are not in memory.
    pub(super) fn gradients_of_row(&self, r: usize) -> [&[f32]; 2] {
        self.gradients.as_ref().map_or([&[]; 2], |gradients| gradients.row(r))
    }

    /// The same surface with the samples of a window and their gradients in memory: bit by bit those of the whole, for
    /// work that looks at each of them. Samples farther out than one read as voids.
    ///
    /// # Errors
    /// As [`Dem::window`].
    pub fn part(&self, first: [usize; 2], size: [usize; 2]) -> Result<Self> {
        self.part_with(first, size, self.limits.clone())
    }

    /// The same with no tangents limited.
    pub(super) fn part_without_limits(&self, first: [usize; 2], size: [usize; 2]) -> Result<Self> {
        self.part_with(first, size, Arc::default())
    }

    fn part_with(&self, first: [usize; 2], size: [usize; 2], limits: Arc<Limits>) -> Result<Self> {
        let samples = with_one_around(&self.dem, first, size)?;
        let gradients = of_samples(&samples, first, cut(&self.dem, first, size), self.dem.cell());
        let gradients = Some(gradients.limited(&limits));
        Ok(Self { dem: self.dem.with_samples(samples), gradients, pyramid: OnceLock::new(), limits })
    }

    /// World position in metres of a lattice vertex; `None` where a sample it depends on is void or outside.
    pub fn position(&self, at: LatticePoint) -> Option<DVec3> {
        let (c, r) = ((at.x / CELL_STEPS) as usize, (at.y / CELL_STEPS) as usize);
        let u = f64::from(at.x % CELL_STEPS) / f64::from(CELL_STEPS);
        let v = f64::from(at.y % CELL_STEPS) / f64::from(CELL_STEPS);
        // Corners NW, SE and the third one of the patch: SW below the diagonal, NE above it.
        let third = if v >= u { (c, r + 1) } else { (c + 1, r) };
        let weights = [1.0 - u.max(v), u.min(v), (u - v).abs()];
        let corners = [(c, r), (c + 1, r + 1), third];
        let mut points = [DVec3::ZERO; 3];
        let mut normals = [DVec3::Z; 3];
        for i in (0..3).filter(|&i| weights[i] > 0.0) {
            let (c, r) = corners[i];
            if c >= self.dem.columns() || r >= self.dem.rows() || self.dem.height(c, r).is_none() {
                return None;
            }
            points[i] = self.dem.position(c, r);
            normals[i] = (-self.gradient(c, r)).extend(1.0).normalize();
        }
        Some(Patch::new(points, normals).point(weights))
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Surface {
    /// Gradients of all samples, dz/d east and dz/d north, see [`Gradients::components`].
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) for a filed DEM.
    pub fn gradients(&self) -> Result<[&[f32]; 2]> {
        match &self.gradients {
            Some(gradients) => Ok(gradients.components()),
            None => Err(self.dem.not_held()),
        }
    }

    /// Its bounds and the deviations of its facets, made when first asked for.
    ///
    /// # Errors
    /// As [`Pyramid::new`].
    pub fn pyramid(&self) -> Result<&Pyramid> {
        match self.pyramid.get() {
            Some(pyramid) => Ok(pyramid),
            None => {
                let pyramid = Pyramid::new(self)?;
                Ok(self.pyramid.get_or_init(|| pyramid))
            }
        }
    }

    /// Gradient of sample (c, r): dz/d east, dz/d north. (0, 0) where it cannot be read, see [`Dem::check`].
    pub fn gradient(&self, c: usize, r: usize) -> DVec2 {
        match &self.gradients {
            Some(gradients) => gradients.get(c, r).unwrap_or_default(),
            None => {
                let gradients = self.dem.kept(gradients(&self.dem, [c, r], [1, 1]));
                gradients.and_then(|g| g.limited(&self.limits).get(c, r)).unwrap_or_default()
            }
        }
    }

    /// All rows once, in order, with `halo` rows above and below each band: see [`Dem::bands`].
    ///
    /// # Errors
    /// Each band may fail as [`Dem::window`].
    pub fn bands(&self, halo: usize) -> impl Iterator<Item = Result<SurfaceBand<'_>>> {
        self.dem.bands(halo + 1).map(move |band| {
            let Band { rows, samples } = band?;
            let surface = match samples {
                Cow::Borrowed(_) => Cow::Borrowed(self),
                Cow::Owned(samples) => {
                    let first = [0, rows.start.saturating_sub(halo)];
                    let size = [self.dem.columns(), (rows.end + halo).min(self.dem.rows()) - first[1]];
                    let gradients = of_samples(&samples, first, size, self.dem.cell());
                    let (gradients, limits) = (Some(gradients.limited(&self.limits)), self.limits.clone());
                    Cow::Owned(Self {
                        dem: self.dem.with_samples(samples),
                        gradients,
                        pyramid: OnceLock::new(),
                        limits,
                    })
                }
            };
            Ok(SurfaceBand { rows, surface })
        })
    }

    /// Position and unit normal of each sample of row `r`, heights of voids being 0; nothing outside.
    pub fn corners(&self, r: usize) -> Vec<Corner> {
        let columns = if r < self.dem.rows() { self.dem.columns() } else { 0 };
        let normal = |c| (-self.gradient(c, r)).extend(1.0).normalize();
        (0..columns).map(|c| (self.dem.position(c, r), normal(c))).collect()
    }

    /// How many patches exist, see [`Dem::patches`].
    pub fn patches(&self) -> u64 {
        self.dem.patches()
    }

    /// Height in exaggerated metres of the highest facet of `level` over a map place in metres; `None` over voids and
    /// outside. Cost: the facets of nine cells, for patches also bend sideways.
    pub fn height_below(&self, place: DVec2, level: Level) -> Option<f64> {
        let at = self.dem.grid_place(place).floor();
        if self.gradients.is_none() {
            // The corners of the nine cells, read together.
            let first = (at - 1.0).max(DVec2::ZERO).to_array().map(|at| at as usize);
            return self.dem.kept(self.part(first, [4; 2]))?.height_below(place, level);
        }
        let near = |x: f64, samples: usize| {
            let first = (x - 1.0).clamp(0.0, samples as f64) as u32;
            let end = (x + 2.0).clamp(0.0, (samples - 1) as f64) as u32;
            first * CELL_STEPS..end * CELL_STEPS
        };
        let step = level.step();
        let mut highest: Option<f64> = None;
        for y in near(at.y, self.dem.rows()).step_by(step as usize) {
            for x in near(at.x, self.dem.columns()).step_by(step as usize) {
                let vertex = |dx, dy| self.position(LatticePoint { x: x + dx * step, y: y + dy * step });
                for [b, c] in [[(0, 1), (1, 1)], [(1, 1), (1, 0)]] {
                    let (Some(p), Some(q), Some(r)) = (vertex(0, 0), vertex(b.0, b.1), vertex(c.0, c.1)) else {
                        continue;
                    };
                    highest = height_in(place, p, q, r).into_iter().chain(highest).reduce(f64::max);
                }
            }
        }
        highest
    }
}

/// Height of a facet over a map place inside it.
fn height_in(place: DVec2, p: DVec3, q: DVec3, r: DVec3) -> Option<f64> {
    let (u, v, w) = (q.truncate() - p.truncate(), r.truncate() - p.truncate(), place - p.truncate());
    let area = u.perp_dot(v);
    let (b, c) = (w.perp_dot(v) / area, u.perp_dot(w) / area);
    let inside = b >= 0.0 && c >= 0.0 && b + c <= 1.0;
    inside.then_some(p.z + (q.z - p.z) * b + (r.z - p.z) * c)
}

/// A PN triangle as a cubic Bezier triangle.
#[derive(Debug, Clone, Copy)]
pub struct Patch {
    /// b_ijk by [`Patch::index`]: b300 b210 b120 b030, b201 b111 b021, b102 b012, b003.
    control: [DVec3; 10],
}

/// How far facets leave a patch, metres; see [`Patch::bulge`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bulge {
    /// Of ever finer ones, times the square of their level.
    pub limit: f64,
    /// Of the one of level 1.
    pub flat: f64,
}

/// World position in metres and unit normal of a sample.
pub(crate) type Corner = (DVec3, DVec3);

impl Patch {
    /// Patch 0 (NW, SW, SE) or 1 (NW, SE, NE) of the cell with corners NW, SW, SE, NE.
    pub fn of_cell([nw, sw, se, ne]: [Corner; 4], half: usize) -> Self {
        let [a, b, c] = if half == 0 { [nw, sw, se] } else { [nw, se, ne] };
        Self::new([a.0, b.0, c.0], [a.1, b.1, c.1])
    }

    /// Over three corners with unit normals.
    pub fn new(p: [DVec3; 3], n: [DVec3; 3]) -> Self {
        // The control point a third of the way from corner i to corner j, moved into i's tangent plane.
        let edge = |i: usize, j: usize| p[i] + ((p[j] - p[i]) - n[i] * (p[j] - p[i]).dot(n[i])) / 3.0;
        let [ab, ba, bc, cb, ca, ac] = [edge(0, 1), edge(1, 0), edge(1, 2), edge(2, 1), edge(2, 0), edge(0, 2)];
        let mean = (ab + ba + bc + cb + ca + ac) / 6.0;
        let centre = mean + (mean - (p[0] + p[1] + p[2]) / 3.0) / 2.0;
        Self { control: [p[0], ab, ba, p[1], ac, centre, bc, ca, cb, p[2]] }
    }

    /// Place of b_ijk in [`Self::control`], i = 3 - j - k.
    pub fn index(j: usize, k: usize) -> usize {
        [0, 4, 7, 9][k] + j
    }

    /// The control points, whose hull holds the patch.
    pub fn control(&self) -> &[DVec3; 10] {
        &self.control
    }

    /// Second differences of the control points along the three sides; of each side, those at the three corners.
    fn second_differences(&self) -> [[DVec3; 3]; 3] {
        let at = |[j, k]: [usize; 2], corners: [usize; 2]| {
            let count = |corner| corners.iter().filter(|c| **c == corner).count();
            self.control[Self::index(j + count(1), k + count(2))]
        };
        let along = |m, n| [[0, 0], [1, 0], [0, 1]].map(|p| at(p, [m, m]) - at(p, [m, n]) * 2.0 + at(p, [n, n]));
        [along(0, 1), along(1, 2), along(2, 0)]
    }

    /// Largest second difference of the control points along the three sides, per axis.
    pub fn largest_second_difference(&self) -> DVec3 {
        self.second_differences().as_flattened().iter().fold(DVec3::ZERO, |largest, d| largest.max(d.abs()))
    }

    /// How far its facets leave it: a bulge of at most `limit` / n^2 metres at level n, `flat` at level 1, where bends to
    /// one side and to the other make up for each other.
    ///
    /// Between the ends of a chord a curve with the second derivative M leaves it by M / 8, and M is six second
    /// differences, which change linearly over the patch. Between three sides that bend to different sides it may be up
    /// to 2.2 times as much. Where the second derivative changes from -M to M, a curve leaves its chord by M / 125.
    pub fn bulge(&self) -> Bulge {
        let longest = |vectors: &[DVec3]| vectors.iter().map(|v| v.length_squared()).fold(0.0, f64::max).sqrt();
        let sides = self.second_differences();
        let means = sides.map(|[a, b, c]| (a + b + c) / 3.0);
        let changes = sides.map(|[a, b, c]| (a - b).abs().max((b - c).abs()).max((c - a).abs()));
        Bulge { limit: 0.75 * longest(sides.as_flattened()), flat: 0.75 * longest(&means) + 0.05 * longest(&changes) }
    }

    /// The point with barycentric weights `[a, b, c]`. A corner of weight 0 has no influence.
    pub fn point(&self, [a, b, c]: [f64; 3]) -> DVec3 {
        let p = &self.control;
        let (a3, b3, c3) = (3.0 * a, 3.0 * b, 3.0 * c);
        p[0] * (a * a * a)
            + p[3] * (b * b * b)
            + p[9] * (c * c * c)
            + p[1] * (a3 * a * b)
            + p[2] * (b3 * b * a)
            + p[6] * (b3 * b * c)
            + p[8] * (c3 * c * b)
            + p[7] * (c3 * c * a)
            + p[4] * (a3 * a * c)
            + p[5] * (2.0 * a3 * b * c)
    }
    /// How the point changes with each of the weights `[a, b, c]`, which count as independent: along a side of the patch it
    /// changes as those of its two ends do apart.
    pub fn derivatives(&self, [a, b, c]: [f64; 3]) -> [DVec3; 3] {
        let p = &self.control;
        let [aa, bb, cc, ab, bc, ca] = [a * a, b * b, c * c, 2.0 * a * b, 2.0 * b * c, 2.0 * c * a];
        let of = |[i, j, k, l, m, n]: [usize; 6]| {
            (p[i] * aa + p[j] * bb + p[k] * cc + p[l] * ab + p[m] * bc + p[n] * ca) * 3.0
        };
        [of([0, 2, 7, 1, 5, 4]), of([1, 3, 8, 2, 6, 5]), of([4, 6, 9, 5, 8, 7])]
    }
}
