//! Bounds of the surface over squares of every size, and how far facets leave it there.
//!
//! Method: PN facets of level n leave their patch by at most its [`Patch::bulge`] / n^2; facets coarser than the grid are
//! measured against every sample they pass, and the bulge of the patches below them is added. A square that holds voids,
//! or is cut by an edge of the DEM between its vertices, has no coarse facets: its deviation is infinite. Cost: two
//! patches a cell, then one look at each sample for every coarser level. Memory: 1.4 bytes a sample.

use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;

use super::Surface;
use super::lattice::{CELL_STEPS, CHUNK_QUADS, patches_of_row};
use super::patch::Patch;
use crate::dem::Dem;

/// Lattice units between vertices of a chunk that fills a square of the finest layer.
pub const FINEST_STEP: u32 = FINEST_CELLS as u32 * CELL_STEPS / CHUNK_QUADS;
/// Cells along a square of the finest layer.
const FINEST_CELLS: usize = 4;
/// Layer of the squares that a chunk of level 1 fills.
const LEVEL_1: usize = 3;
/// Cells between vertices of the coarsest level.
const COARSEST_CELLS: usize = 64;

/// Squares of 4, 8, 16 ... cells, each layer a grid from the north-west, up to one square or 64 cells between vertices.
#[derive(Debug, Clone)]
pub struct Pyramid {
    layers: Vec<Layer>,
    samples: [usize; 2],
    cell: DVec2,
}

#[derive(Debug, Clone)]
struct Layer {
    columns: usize,
    squares: Vec<Square>,
}

/// Where the surface over a square lies, metres.
#[derive(Debug, Clone, Copy)]
pub struct Relief {
    /// Exaggerated height below all of it.
    pub low: f32,
    /// Above all of it; below `low` where there is none.
    pub high: f32,
    /// How far it reaches beyond the square on the map.
    pub beyond: f32,
}

/// What is known of a square, metres.
#[derive(Debug, Clone, Copy)]
struct Square {
    /// Exaggerated height below all its patches; above `high` where it has none.
    low: f32,
    high: f32,
    /// How far its patches leave their flat triangles.
    bulge: f32,
    /// How far the facets of a chunk that fills it leave the surface; of squares up to 32 cells, those of level 1.
    deviation: f32,
    slopes: Slopes,
    /// NaN where it has voids; only of squares up to 32 cells.
    fences: Fences,
}

/// Rows and columns of samples that cross a square, metres.
#[derive(Debug, Clone, Copy)]
pub struct Fences {
    /// The least height of the row whose least height is largest.
    pub along_east: f32,
    /// The same of columns.
    pub along_north: f32,
}

/// Least and largest slopes of a surface, dz/d east and dz/d north.
#[derive(Debug, Clone, Copy)]
pub struct Slopes {
    /// Least, east and north.
    pub least: Vec2,
    /// Largest, east and north.
    pub largest: Vec2,
}

impl Fences {
    const NONE: Self = Self { along_east: f32::NAN, along_north: f32::NAN };
}

impl Slopes {
    const NONE: Self = Self { least: Vec2::INFINITY, largest: Vec2::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), largest: self.largest.max(other.largest) }
    }
}

impl Square {
    const EMPTY: Self = Self {
        low: f32::INFINITY,
        high: f32::NEG_INFINITY,
        bulge: 0.0,
        deviation: 0.0,
        slopes: Slopes::NONE,
        fences: Fences::NONE,
    };

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            bulge: self.bulge.max(other.bulge),
            deviation: self.deviation.max(other.deviation),
            slopes: self.slopes.with(other.slopes),
            fences: Fences::NONE,
        }
    }
}

impl Pyramid {
    /// Bounds a surface, on every core.
    pub fn new(surface: &Surface) -> Self {
        let dem = surface.dem();
        let (columns, rows) = ((dem.columns() - 1).div_ceil(FINEST_CELLS), (dem.rows() - 1).div_ceil(FINEST_CELLS));
        let squares = (0..rows).into_par_iter().flat_map_iter(|y| finest_row(surface, y, columns)).collect();
        let mut layers = vec![Layer { columns, squares }];
        fence(dem, &mut layers[0], FINEST_CELLS);
        let longest = dem.columns().max(dem.rows()) - 1;
        loop {
            let layer = layers.len();
            let (size, quad) = (FINEST_CELLS << layer, 1 << layer.saturating_sub(LEVEL_1));
            if layer > LEVEL_1 && (size / 2 >= longest || quad > COARSEST_CELLS) {
                break;
            }
            let mut halved = layers[layer - 1].halved();
            if layer > LEVEL_1 {
                measure(dem, &mut halved, size, quad);
            } else {
                fence(dem, &mut halved, size);
            }
            layers.push(halved);
        }
        Self { layers, samples: [dem.columns(), dem.rows()], cell: dem.cell() }
    }

    /// Lattice units between the vertices of the coarsest chunks.
    pub fn coarsest_step(&self) -> u32 {
        CELL_STEPS << (self.layers.len() - 1 - LEVEL_1)
    }

    /// How far the facets of the chunk at `origin` leave the surface, metres; infinite where it must not be.
    pub fn deviation(&self, origin: [u32; 2], step: u32) -> f64 {
        let flat = f64::from(self.square(origin, step).deviation);
        if step >= CELL_STEPS { flat } else { flat * (f64::from(step) / f64::from(CELL_STEPS)).powi(2) }
    }

    /// Between which heights the surface of the chunk at `origin` lies, and how far it reaches beyond its square.
    pub fn relief(&self, origin: [u32; 2], step: u32) -> Relief {
        let Square { low, high, bulge, .. } = self.square(origin, step);
        Relief { low, high, beyond: bulge }
    }

    /// Between which slopes the surface of the chunk at `origin` lies.
    pub fn slopes(&self, origin: [u32; 2], step: u32) -> Slopes {
        self.square(origin, step).slopes
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
        // A chunk of level 1 is 32 cells wide.
        let layer = (step / 2).max(FINEST_CELLS as u32).ilog2() - FINEST_CELLS.ilog2();
        let size = (FINEST_CELLS << layer) as u32 * CELL_STEPS;
        let [x, y] = origin.map(|at| (at / size) as usize);
        let layer = &self.layers[layer as usize];
        layer.squares.get(y * layer.columns + x).copied().filter(|_| x < layer.columns).unwrap_or(Square::EMPTY)
    }
}

impl Layer {
    /// The layer of squares twice as wide.
    fn halved(&self) -> Self {
        let rows = self.squares.len() / self.columns;
        let (columns, halved_rows) = (self.columns.div_ceil(2), rows.div_ceil(2));
        let square = |i: usize| {
            let (x, y) = (i % columns * 2, i / columns * 2);
            let inside = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let inside = inside.into_iter().filter(|&(x, y)| x < self.columns && y < rows);
            inside.map(|(x, y)| self.squares[y * self.columns + x]).fold(Square::EMPTY, Square::with)
        };
        Self { columns, squares: (0..columns * halved_rows).map(square).collect() }
    }
}

/// Row `y` of the finest layer.
fn finest_row(surface: &Surface, y: usize, columns: usize) -> Vec<Square> {
    let dem = surface.dem();
    let mut squares = vec![Square::EMPTY; columns];
    for r in y * FINEST_CELLS..((y + 1) * FINEST_CELLS).min(dem.rows() - 1) {
        for (c, exists) in patches_of_row(dem, r).enumerate() {
            let square = &mut squares[c / FINEST_CELLS];
            for half in (0..2).filter(|half| exists[*half]) {
                *square = square.with(of_patch(&surface.patch(c, r, half), half));
            }
        }
    }
    squares
}

fn of_patch(patch: &Patch, half: usize) -> Square {
    let heights = patch.control().map(|p| p.z as f32);
    let bulge = (patch.bulge() as f32).next_up();
    Square {
        low: heights.into_iter().fold(f32::INFINITY, f32::min).next_down(),
        high: heights.into_iter().fold(f32::NEG_INFINITY, f32::max).next_up(),
        bulge,
        deviation: bulge,
        slopes: slopes(patch, half),
        fences: Fences::NONE,
    }
}

/// Slopes of the control polygon east and north, between which those of the patch and of its facets lie but for its
/// bending sideways.
fn slopes(patch: &Patch, half: usize) -> Slopes {
    // Corners 0, 1, 2 of patch 0 are NW, SW, SE, of patch 1 NW, SE, NE.
    let (east, north) = if half == 0 { ([1, 2], [1, 0]) } else { ([0, 2], [1, 2]) };
    let (east, north) = (patch.differences(east), patch.differences(north));
    let slopes = east.into_iter().zip(north).map(|(e, n)| DVec2::new(e.z / e.x, n.z / n.y).as_vec2());
    slopes.fold(Slopes::NONE, |all, slope| all.with(Slopes { least: slope, largest: slope }))
}

/// Finds the fences of a layer's squares of `size` cells.
fn fence(dem: &Dem, layer: &mut Layer, size: usize) {
    let columns = layer.columns;
    layer.squares.par_chunks_mut(columns).enumerate().for_each(|(y, squares)| {
        for (x, square) in squares.iter_mut().enumerate() {
            square.fences = fences(dem, [x * size, y * size], size);
        }
    });
}

fn fences(dem: &Dem, [c, r]: [usize; 2], size: usize) -> Fences {
    if c + size >= dem.columns() || r + size >= dem.rows() {
        return Fences::NONE;
    }
    let mut along_east = f32::NEG_INFINITY;
    let mut columns = [f32::INFINITY; (FINEST_CELLS << LEVEL_1) + 1];
    for row in r..=r + size {
        let first = row * dem.columns() + c;
        let (heights, valid) = (&dem.heights()[first..=first + size], &dem.valid()[first..=first + size]);
        if !valid.iter().all(|v| *v) {
            return Fences::NONE;
        }
        along_east = along_east.max(heights.iter().copied().fold(f32::INFINITY, f32::min));
        columns.iter_mut().zip(heights).for_each(|(least, height)| *least = least.min(*height));
    }
    Fences { along_east, along_north: columns[..=size].iter().copied().fold(f32::NEG_INFINITY, f32::max) }
}

/// Measures the deviations of a layer's chunks: squares of `size` cells whose facets have sides of `quad` cells.
fn measure(dem: &Dem, layer: &mut Layer, size: usize, quad: usize) {
    let columns = layer.columns;
    layer.squares.par_chunks_mut(columns).enumerate().for_each(|(y, squares)| {
        for (x, square) in squares.iter_mut().enumerate() {
            let first = [x * size, y * size];
            square.deviation = if is_whole(dem, first, size, quad) {
                square.bulge + farthest_sample(dem, first, size, quad)
            } else {
                f32::INFINITY
            };
        }
    });
}

/// Whether the samples of a square are all valid, and the edges of the DEM between its vertices.
fn is_whole(dem: &Dem, [c, r]: [usize; 2], size: usize, quad: usize) -> bool {
    let fits = |first: usize, samples: usize| first + size < samples || (samples - 1 - first).is_multiple_of(quad);
    let last = |first: usize, samples: usize| (first + size).min(samples - 1);
    let row = |r: usize| &dem.valid()[r * dem.columns() + c..=r * dem.columns() + last(c, dem.columns())];
    // A square beyond the samples has no patch.
    c + 1 >= dem.columns()
        || r + 1 >= dem.rows()
        || fits(c, dem.columns()) && fits(r, dem.rows()) && (r..=last(r, dem.rows())).all(|r| row(r).iter().all(|v| *v))
}

/// Largest vertical distance between a sample of a square and the facet over or under it, metres.
fn farthest_sample(dem: &Dem, [first_c, first_r]: [usize; 2], size: usize, quad: usize) -> f32 {
    let rows = (first_r..(first_r + size).min(dem.rows() - 1)).step_by(quad);
    let columns = || (first_c..(first_c + size).min(dem.columns() - 1)).step_by(quad);
    let mut farthest = 0.0_f32;
    for r in rows {
        for c in columns() {
            farthest = farthest.max(farthest_of_quad(dem, c, r, quad));
        }
    }
    farthest
}

/// The same within the quad of `side` cells at sample (c, r).
fn farthest_of_quad(dem: &Dem, c: usize, r: usize, side: usize) -> f32 {
    let row = |r: usize| &dem.heights()[r * dem.columns() + c..][..=side];
    let ([nw, .., ne], [sw, .., se]) = (row(r), row(r + side)) else { return 0.0 };
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
