//! Vertex normals, once, on every core.
//!
//! The normal of a sample is the normalised sum of the cross products of its incident facets of level 1. On a grid each
//! of these is (cell area) x (-p, -q, 1) with (p, q) the facet's gradient, so the sum has the direction of the *mean
//! gradient* and is stored as such: two numbers, no square root, exact for planes. Facets with a void corner contribute
//! nothing. Cost: 6 facets a sample.

use rayon::prelude::*;

use crate::dem::Dem;

/// Column and row steps of the two other corners of the six facets around a sample: first the one reached along the
/// row or the diagonal, counter-clockwise from above. Cells are split along NW-SE.
const INCIDENT: [[(i64, i64); 2]; 6] = [
    [(1, 0), (0, -1)],   // the SW facet of the north-east cell
    [(0, -1), (-1, -1)], // the NE facet of the north-west cell
    [(-1, -1), (-1, 0)], // the SW facet of the north-west cell
    [(-1, 0), (0, 1)],   // the NE facet of the south-west cell
    [(0, 1), (1, 1)],    // the SW facet of the south-east cell
    [(1, 1), (1, 0)],    // the NE facet of the south-east cell
];

/// Gradient (dz/d east, dz/d north) of each sample, in the order of `dem.heights()`; the normal is (-p, -q, 1)
/// normalised. (0, 0) at voids and where every incident facet has a void corner.
pub fn gradients(dem: &Dem) -> Vec<[f32; 2]> {
    (0..dem.rows())
        .into_par_iter()
        .flat_map_iter(|r| (0..dem.columns()).map(move |c| gradient(dem, c as i64, r as i64)))
        .collect()
}

fn gradient(dem: &Dem, c: i64, r: i64) -> [f32; 2] {
    let height = |dc: i64, dr: i64| {
        let (c, r) = (c + dc, r + dr);
        let inside = c >= 0 && r >= 0 && c < dem.columns() as i64 && r < dem.rows() as i64;
        inside.then(|| dem.height(c as usize, r as usize)).flatten().map(f64::from)
    };
    let Some(h) = height(0, 0) else { return [0.0; 2] };
    let cell = dem.cell();
    let (mut sum, mut count) = ([0.0; 2], 0);
    for [a, b] in INCIDENT {
        let (Some(ha), Some(hb)) = (height(a.0, a.1), height(b.0, b.1)) else { continue };
        // Both steps in metres, x east and y north; the plane through them has gradient (p, q).
        let (ax, ay, az) = (a.0 as f64 * cell.x, -a.1 as f64 * cell.y, ha - h);
        let (bx, by, bz) = (b.0 as f64 * cell.x, -b.1 as f64 * cell.y, hb - h);
        let area = ax * by - ay * bx;
        sum[0] += (az * by - bz * ay) / area;
        sum[1] += (ax * bz - bx * az) / area;
        count += 1;
    }
    if count == 0 { [0.0; 2] } else { sum.map(|s| (s / f64::from(count)) as f32) }
}
