//! Spheres around chunks, for leaving out what cannot be seen.
//!
//! A PN patch lies in the hull of its control points. These leave the flat patch by at most half the largest
//! |dz - p dx - q dy| of its edges, taken with the gradient (p, q) of either end: edge points by a third of it, the
//! centre point by half. Cost: three edges a sample of each chunk.

use glam::DVec3;
use rayon::prelude::*;

use super::lattice::{CELL_STEPS, CHUNK_QUADS, Chunk};
use super::{Lattice, Surface};

/// Room for rounding: of the radius, and of a cell.
const SLACK: f64 = 0.01;

/// Centre and radius of a sphere around each chunk, by slot: metres east and north of sample (0, 0), exaggerated
/// height, radius.
pub fn spheres(surface: &Surface, lattice: &Lattice) -> Vec<[f32; 4]> {
    lattice.chunks().par_iter().map(|chunk| sphere(surface, chunk)).collect()
}

fn sphere(surface: &Surface, chunk: &Chunk) -> [f32; 4] {
    let dem = surface.dem();
    let span = |axis: usize, samples: usize| {
        let first = (chunk.origin[axis] / CELL_STEPS) as usize;
        let end = (chunk.origin[axis] + CHUNK_QUADS * chunk.step).div_ceil(CELL_STEPS) as usize;
        first..=end.min(samples - 1)
    };
    let origin = dem.position(0, 0).with_z(0.0);
    let (mut low, mut high, mut bulge) = (DVec3::INFINITY, DVec3::NEG_INFINITY, 0.0_f64);
    for r in span(1, dem.rows()) {
        for c in span(0, dem.columns()) {
            let p = dem.position(c, r) - origin;
            low = low.min(p);
            high = high.max(p);
            for (c2, r2) in [(c + 1, r), (c, r + 1), (c + 1, r + 1)] {
                if c2 < dem.columns() && r2 < dem.rows() {
                    let edge = dem.position(c2, r2) - origin - p;
                    bulge = bulge.max(deviation(surface, c, r, edge)).max(deviation(surface, c2, r2, edge));
                }
            }
        }
    }
    let centre = (low + high) / 2.0;
    let radius = ((high - low).length() / 2.0 + bulge / 2.0) * (1.0 + SLACK) + dem.cell().max_element() * SLACK;
    centre.extend(radius).as_vec4().to_array()
}

/// How far an edge leaves the tangent plane of one of its ends, metres, measured upwards.
fn deviation(surface: &Surface, c: usize, r: usize, edge: DVec3) -> f64 {
    (edge.z - surface.gradient(c, r).dot(edge.truncate())).abs()
}
