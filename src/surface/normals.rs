//! Vertex normals, on every core: of a held DEM once, of a filed one where they are asked for.
//!
//! The normal of a sample is the normalised sum of the cross products of its incident facets of level 1. On a grid each
//! of these is (cell area) x (-p, -q, 1) with (p, q) the facet's gradient, so the sum has the direction of the *mean
//! gradient* and is stored as such: two numbers, no square root, exact for planes. Facets with a void corner contribute
//! nothing. Cost: 6 facets a sample; memory beside the result: three rows a core.

use std::borrow::Cow;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::limits::Limits;
use crate::dem::{Dem, Samples};
use crate::error::Result;

/// Steps east and north to the six neighbours of a sample, counter-clockwise from above; two in a row share a facet
/// with it. Cells are split along NW-SE.
const NEIGHBOURS: [DVec2; 6] = [
    DVec2::new(1.0, 0.0),
    DVec2::new(0.0, 1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::new(-1.0, 0.0),
    DVec2::new(0.0, -1.0),
    DVec2::new(1.0, -1.0),
];

/// Samples whose gradients one core computes at least: fewer are not worth handing over.
const LEAST: usize = 4096;

/// Gradients of a window of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradients {
    first: [usize; 2],
    size: [usize; 2],
    /// All dz/d east, then all dz/d north, row-major: two arrays, for each must fit one binding on the device.
    of: [Vec<f32>; 2],
}

impl Gradients {
    /// All dz/d east, then all dz/d north, row-major from the window's north-west; the normal is (-p, -q, 1) normalised.
    /// (0, 0) at voids and where every incident facet has a void corner.
    pub fn components(&self) -> [&[f32]; 2] {
        self.of.each_ref().map(Vec::as_slice)
    }

    /// All dz/d east, then all dz/d north, of the window's samples of row `r` of the DEM; nothing outside.
    pub(super) fn row(&self, r: usize) -> [&[f32]; 2] {
        let columns = self.size[0];
        let first = r.wrapping_sub(self.first[1]).saturating_mul(columns);
        self.of.each_ref().map(|of| of.get(first..first.saturating_add(columns)).unwrap_or_default())
    }

    /// The same with those of some samples limited.
    pub(super) fn limited(mut self, limits: &Limits) -> Self {
        let ([first_c, first_r], [columns, rows]) = (self.first, self.size);
        for r in first_r..first_r + rows {
            for (c, share) in limits.of_row(r, first_c..first_c + columns) {
                let i = (r - first_r) * columns + (c - first_c);
                self.of.iter_mut().for_each(|of| of[i] *= share);
            }
        }
        self
    }

    /// dz/d east and dz/d north of sample (c, r) of the DEM, `None` outside the window.
    pub fn get(&self, c: usize, r: usize) -> Option<DVec2> {
        let [c, r] = [c.wrapping_sub(self.first[0]), r.wrapping_sub(self.first[1])];
        let inside = c < self.size[0] && r < self.size[1];
        inside.then(|| DVec2::from_array(self.of.each_ref().map(|of| f64::from(of[r * self.size[0] + c]))))
    }
}

/// The gradients of a window of `size` columns and rows, cut to the DEM: bit by bit those of the whole. Of a filed DEM,
/// the window and one sample around it are read.
///
/// # Errors
/// As [`Dem::window`].
pub fn gradients(dem: &Dem, first: [usize; 2], size: [usize; 2]) -> Result<Gradients> {
    let samples = match dem.held() {
        Ok(samples) => Cow::Borrowed(samples),
        Err(_) => Cow::Owned(with_one_around(dem, first, size)?),
    };
    Ok(of_samples(&samples, first, cut(dem, first, size), dem.cell()))
}

/// The samples of a window and one around it.
pub(super) fn with_one_around(dem: &Dem, first: [usize; 2], size: [usize; 2]) -> Result<Samples> {
    let low = first.map(|at| at.saturating_sub(1));
    dem.window(low, [0, 1].map(|i| (first[i] + size[i]).saturating_add(1) - low[i]))
}

/// As many columns and rows from `first` on as the DEM has.
pub(super) fn cut(dem: &Dem, first: [usize; 2], size: [usize; 2]) -> [usize; 2] {
    let samples = [dem.columns(), dem.rows()];
    [0, 1].map(|i| size[i].min(samples[i].saturating_sub(first[i])))
}

/// The gradients of a window whose samples and those around it, where there are any, are among `samples`.
pub(super) fn of_samples(samples: &Samples, first: [usize; 2], size: [usize; 2], cell: DVec2) -> Gradients {
    let [mut east, mut north] = [(); 2].map(|()| vec![0.0; size[0] * size[1]]);
    let columns = size[0].max(1);
    let rows = east.par_chunks_exact_mut(columns).zip(north.par_chunks_exact_mut(columns)).enumerate();
    rows.with_min_len(LEAST.div_ceil(columns)).for_each(|(row, (east, north))| {
        let r = first[1] + row;
        let rows = [r.wrapping_sub(1), r, r + 1].map(|r| padded_row(samples, first[0], size[0], r));
        let [above, here, below] = rows.each_ref().map(|row| row.windows(3));
        let blocks = above.zip(here).zip(below).map(|((above, here), below)| [above, here, below]);
        for ((p, q), block) in east.iter_mut().zip(north).zip(blocks) {
            [*p, *q] = gradient(block, cell);
        }
    });
    Gradients { first, size, of: [east, north] }
}

/// Heights of `columns` samples of row `r` from column `first` on, with one more at either end; NaN where there is none.
fn padded_row(samples: &Samples, first: usize, columns: usize, r: usize) -> Vec<f64> {
    let mut row = vec![f64::NAN; columns + 2];
    let west = usize::from(first > samples.first()[0]);
    for (padded, height) in row[1 - west..].iter_mut().zip(samples.row_from(first - west, r)) {
        *padded = height.map_or(f64::NAN, f64::from);
    }
    row
}

/// Gradient at the middle of a block of 3 x 3 heights, rows from the north; NaN where there is none.
fn gradient([above, here, below]: [&[f64]; 3], cell: DVec2) -> [f32; 2] {
    let around = [here[2], above[1], above[0], here[0], below[1], below[2]];
    let step = |k: usize| (NEIGHBOURS[k % 6] * cell).extend(around[k % 6] - here[1]);
    let mut sum = DVec3::ZERO;
    for k in 0..6 {
        // Downwards: (cell area) x (p, q, -1). A void corner makes p NaN.
        let normal = step(k + 1).cross(step(k));
        sum += if normal.x.is_nan() { DVec3::ZERO } else { normal };
    }
    if sum.z == 0.0 { [0.0; 2] } else { (sum.truncate() / -sum.z).as_vec2().to_array() }
}
