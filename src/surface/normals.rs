//! Vertex normals, once, on every core.
//!
//! The normal of a sample is the normalised sum of the cross products of its incident facets of level 1. On a grid each
//! of these is (cell area) x (-p, -q, 1) with (p, q) the facet's gradient, so the sum has the direction of the *mean
//! gradient* and is stored as such: two numbers, no square root, exact for planes. Facets with a void corner contribute
//! nothing. Cost: 6 facets a sample; memory beside the result: three rows a core.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::dem::Dem;

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

/// Gradient of each sample, all dz/d east, then all dz/d north, in the order of `dem.heights()`; the normal is
/// (-p, -q, 1) normalised. (0, 0) at voids and where every incident facet has a void corner.
///
/// Two arrays, for each must fit one binding on the device.
pub fn gradients(dem: &Dem) -> [Vec<f32>; 2] {
    let columns = dem.columns();
    let [mut east, mut north] = [(); 2].map(|()| vec![0.0; dem.heights().len()]);
    let rows = east.par_chunks_exact_mut(columns).zip(north.par_chunks_exact_mut(columns)).enumerate();
    rows.for_each(|(r, (east, north))| {
        let rows = [r.wrapping_sub(1), r, r + 1].map(|r| padded_row(dem, r));
        let [above, here, below] = rows.each_ref().map(|row| row.windows(3));
        let blocks = above.zip(here).zip(below).map(|((above, here), below)| [above, here, below]);
        for ((p, q), block) in east.iter_mut().zip(north).zip(blocks) {
            [*p, *q] = gradient(block, dem.cell());
        }
    });
    [east, north]
}

/// Heights of row `r` with one more sample at either end; NaN where there is none.
fn padded_row(dem: &Dem, r: usize) -> Vec<f64> {
    let mut row = vec![f64::NAN; dem.columns() + 2];
    if r < dem.rows() {
        let span = r * dem.columns()..(r + 1) * dem.columns();
        let samples = dem.heights()[span.clone()].iter().zip(&dem.valid()[span]);
        for (padded, (height, valid)) in row[1..].iter_mut().zip(samples) {
            *padded = if *valid { f64::from(*height) } else { f64::NAN };
        }
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
