//! Bounds of the surface over squares of every size, and how far facets leave it there.
//!
//! Method: PN facets of level n leave their patch by its [`Patch::bulge`](super::patch::Patch::bulge); facets coarser than the grid are
//! measured against every sample they pass, and the bulge of the patches below them is added. A square that holds voids,
//! or is cut by an edge of the DEM between its vertices, has no coarse facets: its deviation is infinite. Cost: two
//! patches a cell, then one look at each sample for every coarser level. Memory: 2.3 bytes a
//! sample, 0.6 of large DEMs.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::bounds::{self, Bounds, Corners};
use super::lattice::{CELL_STEPS, CHUNK_QUADS};
use super::patch::{Surface, SurfaceBand};
use super::slopes::Slopes;
use crate::dem::{Dem, Samples};
use crate::error::Result;

/// Cells along a square of the finest layer.
const FINEST_CELLS: usize = 4;
/// The same for DEMs of so many samples and more, so that a pyramid takes no more memory than what is held of them.
const FINEST_CELLS_OF_LARGE: (usize, usize) = (8, 1 << 25);
/// Cells along a chunk of level 1.
const LEVEL_1_CELLS: usize = CHUNK_QUADS as usize;
/// Cells between vertices of the coarsest level.
const COARSEST_CELLS: usize = 64;

/// Squares of 4, 8, 16 ... cells, each layer a grid from the north-west, up to one square or 64 cells between vertices.
#[derive(Debug, Clone)]
pub struct Pyramid {
    layers: Vec<PyramidLayer>,
    samples: [usize; 2],
    cell: DVec2,
}

/// A pyramid in the making, from bands of its surface.
pub(crate) struct PyramidBuilder(Pyramid);

#[derive(Debug, Clone)]
struct PyramidLayer {
    columns: usize,
    /// Cells along a square.
    size: usize,
    squares: Vec<Square>,
}

/// Where the surface over a square lies, metres.
#[derive(Debug, Clone, Copy)]
pub struct SquareBounds {
    /// Exaggerated height below all of it.
    pub low: f32,
    /// Above all of it; below `low` where there is none.
    pub high: f32,
    /// How far it reaches beyond the square on the map.
    pub beyond: f32,
}

/// What is known of a square, metres.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct Square {
    /// Exaggerated height below all its patches; above `high` where it has none.
    low: f32,
    high: f32,
    /// How far its patches leave their flat triangles.
    bulge: f32,
    /// How far the facets of a chunk that fills it leave the surface; of squares up to 32 cells, those of level 1.
    deviation: f32,
    /// NaN where it has voids; only of squares up to 32 cells.
    fences: Fences,
    slopes: Slopes,
}

/// Rows and columns of samples that cross a square, metres.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Fences {
    /// The least height of the row whose least height is largest.
    pub along_east: f32,
    /// The same of columns.
    pub along_north: f32,
}

impl Fences {
    const NONE: Self = Self { along_east: f32::NAN, along_north: f32::NAN };
}

impl Square {
    const EMPTY: Self = Self {
        low: f32::INFINITY,
        high: f32::NEG_INFINITY,
        bulge: 0.0,
        deviation: 0.0,
        fences: Fences::NONE,
        slopes: Slopes::NONE,
    };

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            bulge: self.bulge.max(other.bulge),
            deviation: self.deviation.max(other.deviation),
            fences: Fences::NONE,
            slopes: self.slopes.with(other.slopes),
        }
    }
}

impl Pyramid {
    /// Bounds a surface, on every core, band by band.
    ///
    /// # Errors
    /// As [`Surface::bands`].
    pub fn new(surface: &Surface) -> Result<Self> {
        let mut pyramid = PyramidBuilder::new(surface.dem());
        for band in surface.bands(PyramidBuilder::HALO) {
            pyramid.take(&band?)?;
        }
        Ok(pyramid.finish())
    }

    /// The squares over a DEM, nothing known of them.
    fn unknown(dem: &Dem) -> Self {
        let samples = [dem.columns(), dem.rows()];
        let (large, many) = FINEST_CELLS_OF_LARGE;
        let finest = if samples[0] * samples[1] >= many { large } else { FINEST_CELLS };
        let cells = samples.map(|samples| samples - 1);
        let longest = cells[0].max(cells[1]);
        let needed =
            |size: &usize| *size <= LEVEL_1_CELLS || *size / 2 < longest && *size <= COARSEST_CELLS * LEVEL_1_CELLS;
        let sizes = std::iter::successors(Some(finest), |size| Some(2 * size)).take_while(needed);
        Self { layers: sizes.map(|size| PyramidLayer::new(cells, size)).collect(), samples, cell: dem.cell() }
    }

    /// All that is known, in parts, to be kept with the DEM.
    pub fn bytes(&self) -> impl Iterator<Item = &[u8]> {
        self.layers.iter().map(|layer| bytemuck::cast_slice(&layer.squares))
    }

    /// A pyramid of `dem` from what was kept, which `fill` puts where it is told, part by part.
    ///
    /// # Errors
    /// Those of `fill`.
    pub fn from_bytes<E>(
        dem: &Dem,
        mut fill: impl FnMut(&mut [u8]) -> std::result::Result<(), E>,
    ) -> std::result::Result<Self, E> {
        let mut pyramid = Self::unknown(dem);
        pyramid.layers.iter_mut().try_for_each(|layer| fill(bytemuck::cast_slice_mut(&mut layer.squares)))?;
        Ok(pyramid)
    }

    /// Layer of the squares that a chunk of level 1 fills.
    fn level_1(&self) -> usize {
        (LEVEL_1_CELLS / self.layers[0].size).ilog2() as usize
    }

    /// Lattice units between vertices of a chunk that fills a square of the finest layer.
    pub fn finest_step(&self) -> u32 {
        self.layers[0].size as u32 * CELL_STEPS / CHUNK_QUADS
    }

    /// Lattice units between the vertices of the coarsest chunks.
    pub fn coarsest_step(&self) -> u32 {
        CELL_STEPS << (self.layers.len() - 1 - self.level_1())
    }

    /// How far the facets of the chunk at `origin` leave the surface, metres; infinite where it must not be.
    pub fn deviation(&self, origin: [u32; 2], step: u32) -> f64 {
        let Square { bulge, deviation, .. } = self.square(origin, step);
        let (limit, flat, share) = (f64::from(bulge), f64::from(deviation), f64::from(step) / f64::from(CELL_STEPS));
        // Second differences change linearly over a patch, and facets see more and more of one end.
        if share >= 1.0 { flat } else { (limit + (flat - limit) * share) * share * share }
    }

    /// Between which heights the surface of the chunk at `origin` lies, and how far it reaches beyond its square.
    pub fn relief(&self, origin: [u32; 2], step: u32) -> SquareBounds {
        let Square { low, high, bulge, .. } = self.square(origin, step);
        SquareBounds { low, high, beyond: bulge }
    }

    /// Lowest and highest slope dz/d east and dz/d north of the sides of facets of the chunk at `origin`.
    pub fn slopes(&self, origin: [u32; 2], step: u32) -> [DVec2; 2] {
        self.square(origin, step).slopes.range()
    }

    /// Squares of the finest layer whose patches leave their flat triangles by more than so many metres: row and column of their
    /// north-west cells, and cells along their sides.
    pub(super) fn bent(&self, metres: f64) -> impl Iterator<Item = ([u32; 2], u32)> {
        let PyramidLayer { columns, size, squares } = &self.layers[0];
        let bends = move |(i, square): (usize, &Square)| {
            let first = [i / columns, i % columns].map(|at| (at * size) as u32);
            (f64::from(square.bulge) > metres).then_some((first, *size as u32))
        };
        squares.iter().enumerate().filter_map(bends)
    }

    /// The fences across the square of the chunk at `origin`, of at most 32 cells; `None` where it has voids.
    pub fn fences(&self, origin: [u32; 2], step: u32) -> Option<Fences> {
        Some(self.square(origin, step).fences).filter(|fences| !fences.along_east.is_nan())
    }

    /// Lowest and highest corner of a box around the chunk at `origin`: metres east and north of sample (0, 0),
    /// exaggerated height. `None` where it has no patch.
    pub fn bounds(&self, origin: [u32; 2], step: u32) -> Option<[DVec3; 2]> {
        let square = self.square(origin, step);
        let cells = |lattice: u32, axis: usize| {
            (f64::from(lattice) / f64::from(CELL_STEPS)).min((self.samples[axis] - 1) as f64) * self.cell[axis]
        };
        let beyond = f64::from(square.bulge);
        let end = origin.map(|at| at + CHUNK_QUADS * step);
        let low = DVec3::new(cells(origin[0], 0) - beyond, -cells(end[1], 1) - beyond, f64::from(square.low));
        let high = DVec3::new(cells(end[0], 0) + beyond, -cells(origin[1], 1) + beyond, f64::from(square.high));
        (square.low <= square.high).then_some([low, high])
    }

    /// The least square that holds a chunk.
    fn square(&self, origin: [u32; 2], step: u32) -> Square {
        let layer = (step / self.finest_step()).max(1).ilog2();
        let size = (self.layers[layer as usize].size) as u32 * CELL_STEPS;
        let [x, y] = origin.map(|at| (at / size) as usize);
        let layer = &self.layers[layer as usize];
        layer.squares.get(y * layer.columns + x).copied().filter(|_| x < layer.columns).unwrap_or(Square::EMPTY)
    }
}

impl PyramidBuilder {
    /// Rows around a band that must be there.
    pub(crate) const HALO: usize = 1;

    /// Of a DEM, nothing known yet.
    pub(crate) fn new(dem: &Dem) -> Self {
        Self(Pyramid::unknown(dem))
    }

    /// Takes in the next rows.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) where the band is not in memory.
    pub(crate) fn take(&mut self, SurfaceBand { rows, surface }: &SurfaceBand<'_>) -> Result<()> {
        let (cells, level_1) = (self.0.samples.map(|samples| samples - 1), self.0.level_1());
        let (layers, samples) = (&mut self.0.layers, surface.dem().held()?);
        layers[0].bound(surface, samples, rows);
        layers[..=level_1].iter_mut().for_each(|layer| layer.fence(samples, rows));
        layers[level_1 + 1..].iter_mut().for_each(|layer| layer.measure(samples, rows, cells));
        Ok(())
    }

    /// The pyramid, when all rows have been taken in.
    pub(crate) fn finish(self) -> Pyramid {
        let Self(mut pyramid) = self;
        let level_1 = pyramid.level_1();
        for number in 1..pyramid.layers.len() {
            let (below, above) = pyramid.layers.split_at_mut(number);
            above[0].gather(&below[number - 1], number > level_1);
        }
        pyramid
    }
}

impl PyramidLayer {
    /// Squares of `size` cells over so many, nothing known of them.
    fn new(cells: [usize; 2], size: usize) -> Self {
        let [columns, rows] = cells.map(|cells| cells.div_ceil(size));
        Self { columns, size, squares: vec![Square::EMPTY; columns * rows] }
    }

    /// The rows of squares that have one of these rows of cells, and the first row of each.
    fn rows(&mut self, rows: &Range<usize>) -> impl IndexedParallelIterator<Item = (usize, &mut [Square])> {
        let (columns, size) = (self.columns, self.size);
        let (first, end) = (rows.start / size, rows.end.div_ceil(size).min(self.squares.len() / columns));
        let squares = &mut self.squares[(first * columns).min(end * columns)..end * columns];
        squares.par_chunks_mut(columns).enumerate().map(move |(y, squares)| ((first + y) * size, squares))
    }

    /// Takes in the patches of these rows of cells.
    fn bound(&mut self, surface: &Surface, samples: &Samples, rows: &Range<usize>) {
        let (size, cell, whole) = (self.size, surface.dem().cell(), samples.voids() == 0);
        self.rows(rows).for_each(|(first, squares)| {
            let mut columns = vec![Bounds::NONE; surface.dem().columns() - 1];
            let cells = first.max(rows.start)..(first + size).min(rows.end).min(surface.dem().rows() - 1);
            let mut north = Corners::of(surface, samples, cells.start);
            for r in cells {
                let south = Corners::of(surface, samples, r + 1);
                let exists = (!whole).then(|| samples.patches(r).collect::<Vec<_>>());
                bounds::take_row(&mut columns, [&north, &south], cell, exists.as_deref());
                north = south;
            }
            for (square, columns) in squares.iter_mut().zip(columns.chunks(size)) {
                *square = square.with(columns.iter().copied().fold(Bounds::NONE, Bounds::with).into());
            }
        });
    }

    /// Finds the fences of squares that lie in these rows whole.
    fn fence(&mut self, samples: &Samples, rows: &Range<usize>) {
        let size = self.size;
        self.rows(rows).for_each(|(first, squares)| {
            for (x, square) in squares.iter_mut().enumerate() {
                square.fences = fences(samples, [x * size, first], size);
            }
        });
    }

    /// Measures how far the facets of chunks that fill the squares leave the samples of these rows.
    fn measure(&mut self, samples: &Samples, rows: &Range<usize>, cells: [usize; 2]) {
        let (size, quad, whole) = (self.size, self.size / LEVEL_1_CELLS, samples.voids() == 0);
        self.rows(rows).for_each(|(first, squares)| {
            for r in (first.max(rows.start)..(first + size).min(rows.end).min(cells[1])).step_by(quad) {
                for c in (0..cells[0]).step_by(quad) {
                    let square = &mut squares[c / size];
                    square.deviation = square.deviation.max(deviation_of_quad(samples, [c, r], quad, whole));
                }
            }
        });
    }

    /// Takes in what is known of the squares of half the size; and whether deviations are measured, above their bulges.
    fn gather(&mut self, below: &Self, measured: bool) {
        let rows = below.squares.len() / below.columns;
        for (i, square) in self.squares.iter_mut().enumerate() {
            let (x, y) = (i % self.columns * 2, i / self.columns * 2);
            let inside = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let inside = inside.into_iter().filter(|&(x, y)| x < below.columns && y < rows);
            let all = inside.map(|(x, y)| below.squares[y * below.columns + x]).fold(Square::EMPTY, Square::with);
            let deviation = if measured { square.deviation + all.bulge } else { all.deviation };
            *square = Square { deviation, fences: square.fences, ..all };
        }
    }
}

impl From<Bounds> for Square {
    fn from(Bounds { low, high, limit, flat, least_slopes, most_slopes }: Bounds) -> Self {
        if low > high {
            return Self::EMPTY;
        }
        Self {
            low: (low as f32).next_down(),
            high: (high as f32).next_up(),
            bulge: (limit as f32).next_up(),
            deviation: flat as f32,
            fences: Fences::NONE,
            slopes: Slopes::between(least_slopes, most_slopes),
        }
    }
}

/// The fences of the square of `size` cells at sample (c, r); none where it has voids or leaves the samples.
fn fences(samples: &Samples, [c, r]: [usize; 2], size: usize) -> Fences {
    let mut along_east = f32::NEG_INFINITY;
    let mut columns = [f32::INFINITY; LEVEL_1_CELLS + 1];
    for row in r..=r + size {
        let (mut lowest, mut found) = (f32::INFINITY, 0);
        for (least, height) in columns[..=size].iter_mut().zip(samples.row_from(c, row).map_while(|height| height)) {
            lowest = lowest.min(height);
            *least = least.min(height);
            found += 1;
        }
        if found <= size {
            return Fences::NONE;
        }
        along_east = along_east.max(lowest);
    }
    Fences { along_east, along_north: columns[..=size].iter().copied().fold(f32::NEG_INFINITY, f32::max) }
}

/// Largest vertical distance between a sample and the facet over or under it, within the quad of `side` cells at sample
/// (c, r), metres; infinite where it has voids or leaves the samples.
fn deviation_of_quad(samples: &Samples, [c, r]: [usize; 2], side: usize, whole: bool) -> f32 {
    let ([first_c, first_r], [width, height]) = (samples.first(), samples.size());
    let (c, r) = (c - first_c, r - first_r);
    let void = |r: usize| samples.row_from(c + first_c, r + first_r).take(side + 1).any(|height| height.is_none());
    if c + side >= width || r + side >= height || !whole && (r..=r + side).any(void) {
        return f32::INFINITY;
    }
    let row = |r: usize| &samples.heights()[r * width + c..][..=side];
    let ([nw, .., ne], [sw, .., se]) = (row(r), row(r + side)) else { return f32::INFINITY };
    let share = 1.0 / side as f32;
    let (east_above, east_below) = ((ne - nw) * share, (se - sw) * share);
    let mut farthest = 0.0_f32;
    for v in 0..=side {
        // Below the diagonal from the west side, above it from the diagonal on.
        let down = v as f32 * share;
        let west = nw + (sw - nw) * down;
        let (below, above) = row(r + v).split_at(v);
        for (u, z) in below.iter().enumerate() {
            farthest = farthest.max((west + east_below * u as f32 - z).abs());
        }
        let diagonal = west + east_below * v as f32;
        for (u, z) in above.iter().enumerate() {
            farthest = farthest.max((diagonal + east_above * u as f32 - z).abs());
        }
    }
    farthest
}
