//! Curved PN triangles in f64: the surface every picture is measured against.
//!
//! Vlachos, Peters, Boyd, Mitchell 2001, "Curved PN Triangles", section 3: a cubic Bezier triangle whose edge control
//! points lie in the tangent planes of the nearer corner. Only the geometry is cubic; facing comes from the facets.
//! Cost: about 150 operations a point. It does not handle creases: one sample has one normal.

use glam::DVec3;

use super::lattice::{CELL_STEPS, LatticePoint, patch_exists};
use super::normals::gradients;
use crate::dem::Dem;

/// A DEM with its vertex normals: everything a place on the surface depends on.
#[derive(Debug, Clone)]
pub struct Surface {
    dem: Dem,
    gradients: Vec<[f32; 2]>,
}

impl Surface {
    /// Computes the normals of `dem`.
    pub fn new(dem: Dem) -> Self {
        Self { gradients: gradients(&dem), dem }
    }

    /// The grid below the surface.
    pub fn dem(&self) -> &Dem {
        &self.dem
    }

    /// Gradient of each sample, see [`gradients`].
    pub fn gradients(&self) -> &[[f32; 2]] {
        &self.gradients
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
            let [p, q] = self.gradients[r * self.dem.columns() + c].map(f64::from);
            normals[i] = DVec3::new(-p, -q, 1.0).normalize();
        }
        Some(pn_point(points, normals, weights))
    }

    /// Height of the level-1 mesh in exaggerated metres under a place given in columns and rows; `None` over voids
    /// and outside.
    pub fn mesh_height(&self, column: f64, row: f64) -> Option<f64> {
        let inside = |x: f64, samples: usize| x >= 0.0 && x <= (samples - 1) as f64;
        if !inside(column, self.dem.columns()) || !inside(row, self.dem.rows()) {
            return None;
        }
        let c = (column as usize).min(self.dem.columns() - 2);
        let r = (row as usize).min(self.dem.rows() - 2);
        let (u, v) = (column - c as f64, row - r as f64);
        let below = v >= u;
        if !patch_exists(&self.dem, c, r, usize::from(!below)) {
            return None;
        }
        let height = |c: usize, r: usize| f64::from(self.dem.heights()[r * self.dem.columns() + c]);
        let third = if below { height(c, r + 1) } else { height(c + 1, r) };
        Some(height(c, r) * (1.0 - u.max(v)) + height(c + 1, r + 1) * u.min(v) + third * (u - v).abs())
    }
}

/// The point of the PN triangle with barycentric `weights`. A corner of weight 0 has no influence.
pub fn pn_point(p: [DVec3; 3], n: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    // The control point a third of the way from corner i to corner j, moved into i's tangent plane.
    let edge = |i: usize, j: usize| p[i] + ((p[j] - p[i]) - n[i] * (p[j] - p[i]).dot(n[i])) / 3.0;
    let pairs = [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)];
    let mut sum = DVec3::ZERO;
    for i in 0..3 {
        sum += p[i] * weights[i].powi(3);
    }
    let mut mean = DVec3::ZERO;
    for (i, j) in pairs.into_iter().filter(|&(i, j)| weights[i] > 0.0 && weights[j] > 0.0) {
        sum += edge(i, j) * (3.0 * weights[i] * weights[i] * weights[j]);
        mean += edge(i, j) / 6.0;
    }
    let product = 6.0 * weights[0] * weights[1] * weights[2];
    if product > 0.0 { sum + (mean * 1.5 - (p[0] + p[1] + p[2]) / 6.0) * product } else { sum }
}
