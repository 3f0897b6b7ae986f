//! Planes fitted to blocks of samples, and the surface that they make together.

use std::ops::Add;

use crate::dem::window::Window;

/// Blocks along a side of a facet.
const SIDE: usize = 4;
/// Share of a block's area, squared, that must be in the spread of a facet's samples: else they lie on a line.
const SPREAD: f64 = 1e-6;

/// Sums over samples, with x and y in samples from some point: those of 1, x, y, xx, xy, yy, z, xz, yz, zz.
#[derive(Debug, Clone, Copy, Default)]
struct Sums([f64; 10]);

impl Sums {
    fn of(x: f64, y: f64, z: f64) -> Self {
        Self([1.0, x, y, x * x, x * y, y * y, z, x * z, y * z, z * z])
    }

    /// The same from a point that lies so far west and north of the first one.
    fn from(&self, east: f64, south: f64) -> Self {
        let Self([n, x, y, xx, xy, yy, z, xz, yz, zz]) = *self;
        Self([
            n,
            x + east * n,
            y + south * n,
            xx + 2.0 * east * x + east * east * n,
            xy + east * y + south * x + east * south * n,
            yy + 2.0 * south * y + south * south * n,
            z,
            xz + east * z,
            yz + south * z,
            zz,
        ])
    }
}

impl Add for Sums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

/// A plane about the common corner of its middle blocks.
#[derive(Debug, Clone, Copy)]
struct Facet {
    /// Metres at that corner.
    height: f64,
    /// Metres a sample to the east and to the south.
    slopes: [f64; 2],
    /// Square metres of its samples about it.
    variance: f64,
    /// Samples as a share of those of whole blocks; 0 where there is no plane.
    share: f64,
}

/// The facets about all corners of a window's blocks, row by row from the north-west.
#[derive(Debug)]
pub(super) struct Facets {
    window: Window,
    sides: [usize; 2],
    /// Column and row of the first block, counted in blocks of the DEM.
    first: [usize; 2],
    columns: usize,
    facets: Vec<Facet>,
}

impl Facets {
    /// Fits planes to 4 x 4 blocks of `sides` columns and rows of a window's `heights`.
    pub(super) fn fitted(heights: &[f32], window: Window, sides: [usize; 2]) -> Self {
        let first = [0, 1].map(|i| window.first[i] / sides[i]);
        let blocks = [0, 1].map(|i| (window.first[i] + window.size[i]).div_ceil(sides[i]) - first[i]);
        let mut sums = vec![Sums::default(); blocks[0] * blocks[1]];
        let middle = sides.map(|side| (side as f64 - 1.0) / 2.0);
        for (r, row) in heights.chunks_exact(window.size[0]).enumerate() {
            let (block, south) = place(r + window.first[1], first[1], sides[1]);
            for (c, height) in row.iter().enumerate().filter(|(_, height)| height.is_finite()) {
                let (column, east) = place(c + window.first[0], first[0], sides[0]);
                let sum = &mut sums[block * blocks[0] + column];
                *sum = *sum + Sums::of(east as f64 - middle[0], south as f64 - middle[1], f64::from(*height));
            }
        }
        let columns = blocks[0] + 1;
        let corners = joined(&sums, blocks, sides);
        let whole = (SIDE * SIDE * sides[0] * sides[1]) as f64;
        let spread = SPREAD * ((sides[0] * sides[1]) as f64).powi(2);
        let facets = corners.iter().map(|sums| fit(sums, whole, spread)).collect();
        Self { window, sides, first, columns, facets }
    }

    /// The weighted mean of the facets about each sample; `heights` where there is none. A facet's weight is its variance,
    /// `least` square metres more, to the power of `-power`.
    pub(super) fn surface(&self, heights: &[f32], power: i32, least: f64) -> Vec<f32> {
        let weights: Vec<_> =
            self.facets.iter().map(|facet| facet.share * (facet.variance + least).powi(-power)).collect();
        let near = self.sides.map(nearness);
        let mut surface = Vec::with_capacity(heights.len());
        for (r, row) in heights.chunks_exact(self.window.size[0]).enumerate() {
            let (block, south) = place(r + self.window.first[1], self.first[1], self.sides[1]);
            for (c, height) in row.iter().enumerate() {
                let (column, east) = place(c + self.window.first[0], self.first[0], self.sides[0]);
                let smooth = self.mean([column, block], [east, south], [&near[0][east], &near[1][south]], &weights);
                surface.push(smooth.filter(|_| height.is_finite()).unwrap_or(*height));
            }
        }
        surface
    }

    /// The mean height of the sixteen facets about a sample, which lies at `within` of a block.
    fn mean(&self, block: [usize; 2], within: [usize; 2], near: [&[f64; SIDE]; 2], weights: &[f64]) -> Option<f32> {
        let (mut sum, mut total) = (0.0, 0.0);
        let rows = self.facets.len() / self.columns;
        let from = |i: usize, k: usize| within[i] as f64 + 0.5 - (k as f64 - 1.0) * self.sides[i] as f64;
        for k in 0..SIDE {
            // The corner north of the block is the block's own row of corners.
            let Some(row) = (block[1] + k).checked_sub(1).filter(|row| *row < rows) else { continue };
            let south = from(1, k);
            for j in 0..SIDE {
                let Some(column) = (block[0] + j).checked_sub(1).filter(|at| *at < self.columns) else { continue };
                let at = row * self.columns + column;
                let (facet, weight) = (&self.facets[at], weights[at] * near[0][j] * near[1][k]);
                sum += weight * (facet.height + facet.slopes[0] * from(0, j) + facet.slopes[1] * south);
                total += weight;
            }
        }
        (total > 0.0).then(|| (sum / total) as f32)
    }
}

/// The block of a place, counted from the first one, and where in it the place lies.
fn place(at: usize, first: usize, side: usize) -> (usize, usize) {
    (at / side - first, at % side)
}

/// For each place in a block how near it is to the corners one block before it, at it, and after it: 1 to 0.
fn nearness(side: usize) -> Vec<[f64; SIDE]> {
    let near = |within: usize, k: usize| {
        let off = (within as f64 + 0.5) / side as f64 - (k as f64 - 1.0);
        1.0 - (off / 2.0).powi(2)
    };
    (0..side).map(|within| std::array::from_fn(|k| near(within, k))).collect()
}

/// Sums over the 4 x 4 blocks about each corner of blocks, from that corner: along rows, then along columns.
fn joined(sums: &[Sums], [columns, rows]: [usize; 2], sides: [usize; 2]) -> Vec<Sums> {
    let off = |i: usize, k: usize| (k as f64 - 1.5) * sides[i] as f64;
    let mut along = Vec::with_capacity((columns + 1) * rows);
    for row in sums.chunks_exact(columns) {
        along.extend((0..=columns).map(|corner| {
            let blocks = (0..SIDE).filter_map(|k| Some((k, row.get((corner + k).checked_sub(2)?)?)));
            blocks.fold(Sums::default(), |sum, (k, block)| sum + block.from(off(0, k), 0.0))
        }));
    }
    let mut both = Vec::with_capacity((columns + 1) * (rows + 1));
    for corner in 0..=rows {
        both.extend((0..=columns).map(|column| {
            let row = |k: usize| (corner + k).checked_sub(2).filter(|row| *row < rows);
            let blocks = (0..SIDE).filter_map(|k| Some((k, along[row(k)? * (columns + 1) + column])));
            blocks.fold(Sums::default(), |sum, (k, block)| sum + block.from(0.0, off(1, k)))
        }));
    }
    both
}

/// The plane of least squares; none through three samples or fewer, or samples along a line.
fn fit(Sums([n, x, y, xx, xy, yy, z, xz, yz, zz]): &Sums, whole: f64, spread: f64) -> Facet {
    let [x, y, z] = [x, y, z].map(|sum| sum / n);
    let (xx, xy, yy) = (xx / n - x * x, xy / n - x * y, yy / n - y * y);
    let (xz, yz, zz) = (xz / n - x * z, yz / n - y * z, zz / n - z * z);
    let area = xx * yy - xy * xy;
    if *n <= 3.0 || area <= spread {
        return Facet { height: 0.0, slopes: [0.0; 2], variance: 0.0, share: 0.0 };
    }
    let slopes = [(xz * yy - yz * xy) / area, (yz * xx - xz * xy) / area];
    let rest = (zz - slopes[0] * xz - slopes[1] * yz).max(0.0);
    let height = z - slopes[0] * x - slopes[1] * y;
    Facet { height, slopes, variance: rest * n / (n - 3.0), share: n / whole }
}
