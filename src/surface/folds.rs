//! Patches that fold: whose ground, the map's projection of the patch, turns back on itself.
//!
//! Method: the control points of a PN triangle (Vlachos et al. 2001) lie beside the thirds of its sides where normals lean, so the
//! ground is a cubic map of the triangle. Its Jacobian, the ground that a share of the triangle covers, is 1 where the patch is
//! flat and 0 or less where it folds. It is a polynomial of degree 4: where all its Bernstein coefficients are above 0, so is it,
//! and at the corners it is its coefficients (Farin 1986, "Triangular Bernstein-Bezier patches"). Where they do not tell, the
//! triangle is halved until they do: the answer is exact, but that a ground of 0 to 2^-12 of the triangle's side across is a fold.
//!
//! A facet folds where its own three places on the map stand clockwise. Of a patch that is *plain* no facet does, at any level: each
//! pair of the differences of its control points, along two sides, spans ground, and sides of facets are means of these. Of others
//! the four quarters are looked at, and so on down to the finest level.
//!
//! Cost: squares of the pyramid whose patches bend by less than a twelfth of a cell are passed over, for these cannot fold (see
//! [`MAY_FOLD`]); of others some 0.2 us a patch. Does not handle: facets coarser than the grid, which are planes over samples and
//! never fold; facets along seams, which join vertices of the coarser side.

use std::array::from_fn;
use std::borrow::Cow;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::lattice::{CELL_STEPS, CHUNK_SIDE, Chunk, Lattice, LatticePoint, patch_exists};
use super::patch::{Patch, Surface};
use crate::error::Result;

/// Patches that bend by less than this share of a cell do not fold. With second differences of control points up to S, these
/// lie aside by S at most, their first differences differ from those of the flat triangle by 2 S, and the derivatives by 6 S:
/// less than a cell over the root of 2, since 0.75 S is the bend. Of 0.0884, rounded down.
const MAY_FOLD: f64 = 0.08;
/// How often the triangle is halved where its coefficients do not tell.
const HALVINGS: u32 = 24;
/// Cells along a part of a DEM in its file that is read at once.
const BLOCK: u32 = 64;
/// Subdivisions at whose vertices the least ground of a patch that folds is looked for.
const LOOKED: u32 = 8;

/// A patch: its cell and which half.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PatchAt {
    /// Row and column of its cell.
    pub cell: [u32; 2],
    /// 0 (NW, SW, SE) or 1 (NW, SE, NE).
    pub half: usize,
}

/// A patch that folds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Which one.
    pub at: PatchAt,
    /// The least Jacobian at its vertices of level 8: how much ground it covers there, of a flat patch 1.
    pub ground: f64,
    /// Where on the map, metres.
    pub place: DVec2,
}

/// A square of cells: row and column of its north-west one, and cells along its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cells {
    first: [u32; 2],
    side: u32,
}

impl Cells {
    /// A cell.
    pub(super) fn one(first: [u32; 2]) -> Self {
        Self { first, side: 1 }
    }

    fn block(&self) -> [u32; 2] {
        self.first.map(|at| at / BLOCK)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Surface {
    /// Its patches that fold, row by row.
    ///
    /// # Errors
    /// As [`Surface::pyramid`] and [`Surface::part`].
    pub fn folds(&self) -> Result<Vec<Fold>> {
        let mut folds = self.look(self.bent()?, |part, at| {
            let patch = part.patch(at, |sample| part.gradient_at(sample));
            let low = || self.dem.position(at.cell[1] as usize, at.cell[0] as usize);
            Ground::of(&patch, self.dem.cell()).folds().then(|| Fold::of(at, &patch, low()))
        })?;
        folds.sort_by_key(|fold| fold.at);
        Ok(folds)
    }

    /// How many facets of a frame's lattice fold: those finer than the grid.
    ///
    /// # Errors
    /// As [`Surface::folds`].
    pub fn folding_facets(&self, lattice: &Lattice) -> Result<u64> {
        let (pyramid, bend) = (self.pyramid()?, self.least_bend());
        let bends = |chunk: &&Chunk| {
            chunk.step < CELL_STEPS && f64::from(pyramid.relief(chunk.origin, chunk.step).beyond) > bend
        };
        let chunks: Vec<&Chunk> = lattice.chunks().iter().filter(bends).collect();
        match self.dem.is_parallel() {
            true => chunks.par_iter().map(|chunk| self.folding_facets_of(chunk)).sum(),
            false => chunks.iter().map(|chunk| self.folding_facets_of(chunk)).sum(),
        }
    }
}

impl Surface {
    /// The facets of a chunk that fold.
    fn folding_facets_of(&self, chunk: &Chunk) -> Result<u64> {
        let side = chunk.size().div_ceil(CELL_STEPS);
        let [column, row] = chunk.origin.map(|at| at / CELL_STEPS);
        let part = self.in_memory([column, row], side)?;
        let is_plain = |at| Ground::of(&part.patch(at, |sample| part.gradient_at(sample)), self.dem.cell()).is_plain();
        if part.patches_of(Cells { first: [row, column], side }).all(is_plain) {
            return Ok(0);
        }
        let vertices = (0..CHUNK_SIDE).flat_map(|y| (0..CHUNK_SIDE).map(move |x| [x, y]));
        let at = |[x, y]: [u32; 2]| [chunk.origin[0] + x * chunk.step, chunk.origin[1] + y * chunk.step];
        let places: Vec<Option<DVec2>> = vertices
            .map(|vertex| {
                let [x, y] = at(vertex);
                part.position(LatticePoint { x, y }).map(|place| place.truncate())
            })
            .collect();
        let place = |vertex: LatticePoint| {
            let [x, y] = [vertex.x - chunk.origin[0], vertex.y - chunk.origin[1]].map(|at| at / chunk.step);
            places[(y * CHUNK_SIDE + x) as usize]
        };
        let folds = |facet: &[LatticePoint; 3]| {
            let [a, b, c] = facet.map(place);
            a.zip(b).zip(c).is_some_and(|((a, b), c)| (b - a).perp_dot(c - a) <= 0.0)
        };
        Ok(chunk.facets().filter(folds).count() as u64)
    }

    /// Squares of cells whose patches bend enough to fold.
    pub(super) fn bent(&self) -> Result<Vec<Cells>> {
        Ok(self.pyramid()?.bent(self.least_bend()).map(|(first, side)| Cells { first, side }).collect())
    }

    /// Patches that bend by less do not fold, metres.
    fn least_bend(&self) -> f64 {
        MAY_FOLD * self.dem.cell().min_element()
    }

    /// The samples of so many cells from a column and row on with their gradients in memory: of a held DEM all are.
    fn in_memory(&self, first: [u32; 2], cells: u32) -> Result<Cow<'_, Self>> {
        match self.dem.is_filed() {
            true => Ok(Cow::Owned(self.part(first.map(|at| at as usize), [cells as usize + 1; 2])?)),
            false => Ok(Cow::Borrowed(self)),
        }
    }

    /// The patches over a square of cells.
    fn patches_of(&self, Cells { first, side }: Cells) -> impl Iterator<Item = PatchAt> {
        let cells = [self.dem.rows(), self.dem.columns()].map(|samples| samples as u32 - 1);
        let [rows, columns] = [0, 1].map(|axis| first[axis]..(first[axis] + side).min(cells[axis]));
        let cells = rows.flat_map(move |r| columns.clone().map(move |c| [r, c]));
        let patches = cells.flat_map(|cell| [0, 1].map(|half| PatchAt { cell, half }));
        patches.filter(|at| patch_exists(&self.dem, at.cell[1] as usize, at.cell[0] as usize, at.half))
    }

    /// A patch in metres from the north-west corner of its cell, with the gradients that are told of rows and columns.
    pub(super) fn patch(&self, at: PatchAt, gradient: impl Fn([u32; 2]) -> DVec2) -> Patch {
        let place = |[r, c]: [u32; 2]| self.dem.position(c as usize, r as usize);
        let (low, corners) = (place(at.cell), at.corners());
        let normals = corners.map(|sample| (-gradient(sample)).extend(1.0).normalize());
        Patch::new(corners.map(|sample| place(sample) - low), normals)
    }

    /// The gradient at a row and column.
    pub(super) fn gradient_at(&self, [r, c]: [u32; 2]) -> DVec2 {
        self.gradient(c as usize, r as usize)
    }

    /// What is found at the patches of squares of cells, on every core where the DEM allows it.
    pub(super) fn look<T: Send>(
        &self,
        mut squares: Vec<Cells>,
        look: impl Fn(&Self, PatchAt) -> Option<T> + Sync,
    ) -> Result<Vec<T>> {
        squares.sort_unstable_by_key(|cells| (cells.block(), *cells));
        let blocks: Vec<&[Cells]> = squares.chunk_by(|a, b| a.block() == b.block()).collect();
        let over = |block: &&[Cells]| {
            let [row, column] = block[0].block().map(|at| at * BLOCK);
            let part = self.in_memory([column, row], BLOCK)?;
            let patches = block.iter().flat_map(|cells| part.patches_of(*cells));
            Ok(patches.filter_map(|at| look(&part, at)).collect::<Vec<_>>())
        };
        let found: Result<Vec<Vec<T>>> = match self.dem.is_parallel() {
            true => blocks.par_iter().map(over).collect(),
            false => blocks.iter().map(over).collect(),
        };
        Ok(found?.into_iter().flatten().collect())
    }
}

impl PatchAt {
    /// Row and column of its corners, counter-clockwise from the north-west.
    pub(super) fn corners(self) -> [[u32; 2]; 3] {
        let [r, c] = self.cell;
        if self.half == 0 { [[r, c], [r + 1, c], [r + 1, c + 1]] } else { [[r, c], [r + 1, c + 1], [r, c + 1]] }
    }
}

/// A patch as seen from above: its control points in cells, by [`Patch::index`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground([DVec2; 10]);

/// Corners of the quarters of a triangle, as weights of its own.
const QUARTERS: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5]],
    [[0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 0.5]],
    [[0.5, 0.0, 0.5], [0.0, 0.5, 0.5], [0.0, 0.0, 1.0]],
    [[0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]],
];

impl Ground {
    pub(super) fn of(patch: &Patch, cell: DVec2) -> Self {
        Self(patch.control().map(|p| p.truncate() / cell))
    }

    /// Whether the Jacobian is 0 or less anywhere.
    pub(super) fn folds(&self) -> bool {
        !self.is_plain() && reaches_zero(&self.jacobian(), HALVINGS)
    }

    /// Whether neither it nor a facet of it, at any level, folds.
    pub(super) fn is_upright(&self) -> bool {
        self.is_plain() || self.facets_are_upright(CELL_STEPS) && !reaches_zero(&self.jacobian(), HALVINGS)
    }

    /// Whether no facet of it folds, from the one of its own three corners down to those of so many subdivisions.
    fn facets_are_upright(&self, subdivisions: u32) -> bool {
        let [a, b, c] = [0, 3, 9].map(|corner| self.0[corner]);
        let is_upright = (b - a).perp_dot(c - a) > 0.0;
        let below = || QUARTERS.iter().all(|quarter| self.part(quarter).facets_are_upright(subdivisions / 2));
        self.is_plain() || is_upright && (subdivisions == 1 || below())
    }

    /// Whether each pair of differences of its control points, along two sides, spans ground.
    fn is_plain(&self) -> bool {
        let [first, second] = self.along();
        first.iter().all(|a| second.iter().all(|b| a.perp_dot(*b) > 0.0))
    }

    /// Differences of the control points from the first corner on towards the second and towards the third, three times, by
    /// [`QUADRATIC`].
    fn along(&self) -> [[DVec2; 6]; 2] {
        let at = |[j, k]: [usize; 2]| self.0[Patch::index(j, k)];
        [[1, 0], [0, 1]].map(|way| QUADRATIC.map(|[j, k]| (at([j + way[0], k + way[1]]) - at([j, k])) * 3.0))
    }

    /// The same patch over a part of its triangle, by the blossom of its cubic (Farin 1986).
    fn part(&self, [a, b, c]: &[[f64; 3]; 3]) -> Self {
        let blossom = |weights: [&[f64; 3]; 3]| {
            let mut points = self.0;
            for (degree, [a, b, c]) in (0..3).rev().zip(weights) {
                for [j, k] in (0..=degree).flat_map(|k| (0..=degree - k).map(move |j| [j, k])) {
                    let at = |j, k| points[Patch::index(j, k)];
                    points[Patch::index(j, k)] = at(j, k) * *a + at(j + 1, k) * *b + at(j, k + 1) * *c;
                }
            }
            points[0]
        };
        let of = [
            [a, a, a],
            [a, a, b],
            [a, b, b],
            [b, b, b],
            [a, a, c],
            [a, b, c],
            [b, b, c],
            [a, c, c],
            [b, c, c],
            [c, c, c],
        ];
        Self(of.map(blossom))
    }

    /// The Jacobian, of a flat patch 1: Bernstein coefficients of degree 4, in the order of [`index`].
    fn jacobian(&self) -> [f64; 15] {
        let [first, second] = self.along();
        let mut coefficients = [0.0; 15];
        for (p, a) in QUADRATIC.into_iter().zip(first) {
            for (q, b) in QUADRATIC.into_iter().zip(second) {
                let at = [p[0] + q[0], p[1] + q[1]];
                coefficients[index(at[0], at[1])] += a.perp_dot(b) * (ways(2, p) * ways(2, q) / ways(4, at));
            }
        }
        coefficients
    }
}

impl Fold {
    /// Of a patch that folds, `low` being the north-west corner of its cell, from which it is measured.
    fn of(at: PatchAt, patch: &Patch, low: DVec3) -> Self {
        let ground = |[a, b, c]: [DVec3; 3]| (b - a).truncate().perp_dot((c - a).truncate());
        let flat = ground([0, 3, 9].map(|corner| patch.control()[corner]));
        let vertices = (0..=LOOKED).flat_map(|j| (0..=LOOKED - j).map(move |k| [LOOKED - j - k, j, k]));
        let weights = vertices.map(|weights| weights.map(|weight| f64::from(weight) / f64::from(LOOKED)));
        let looked = weights.map(|weights| (ground(patch.derivatives(weights)) / flat, weights));
        let (ground, weights) = looked.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
        Self { at, ground, place: (low + patch.point(weights)).truncate() }
    }
}

/// The second and third exponents of Bernstein polynomials of degree 2.
const QUADRATIC: [[usize; 2]; 6] = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [0, 2]];

/// Place of the coefficient with the exponents 4 - j - k, j, k.
fn index(j: usize, k: usize) -> usize {
    [0, 5, 9, 12, 14][k] + j
}

/// In how many ways `n` things fall into three heaps of n - j - k, j and k.
fn ways(n: usize, [j, k]: [usize; 2]) -> f64 {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    factorial(n) / (factorial(n - j - k) * factorial(j) * factorial(k))
}

/// Whether a polynomial with these coefficients is 0 or less somewhere on its triangle, which is halved up to so many times.
fn reaches_zero(coefficients: &[f64; 15], halvings: u32) -> bool {
    let corners = [index(0, 0), index(4, 0), index(0, 4)];
    if coefficients.iter().all(|c| *c > 0.0) {
        return false;
    }
    halvings == 0
        || corners.iter().any(|corner| coefficients[*corner] <= 0.0)
        || halved(coefficients).iter().any(|half| reaches_zero(half, halvings - 1))
}

/// The coefficients on both halves of a triangle, cut from its third corner to the middle of the side between the first two, by
/// de Casteljau's algorithm. The side that was halved last is halved no more before the others.
fn halved(coefficients: &[f64; 15]) -> [[f64; 15]; 2] {
    let (mut first, mut second) = ([0.0; 15], [0.0; 15]);
    for k in 0..5 {
        let degree = 4 - k;
        let mut row: [f64; 5] = from_fn(|j| if j <= degree { coefficients[index(j, k)] } else { 0.0 });
        for step in 0..=degree {
            // Corners of the halves: third, first, middle; second, third, middle.
            first[index(degree - step, step)] = row[0];
            second[index(k, step)] = row[degree - step];
            for j in 0..degree - step {
                row[j] = 0.5 * (row[j] + row[j + 1]);
            }
        }
    }
    [first, second]
}
