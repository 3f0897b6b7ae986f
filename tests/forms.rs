//! Surfaces that mathematics knows, and the lines it draws of them: the truth of the closed-form tests.
//!
//! A form is a height z = f(x, y) with its gradient. Its contour is where the normal is square to the line of sight,
//! F(p) = (eye.z - f) - grad f . (eye - p) = 0 on the map. Method: signs of F on a fine grid of the map, crossings by
//! bisection, pieces halved (each middle brought back to F = 0 by secants) to a quarter pixel; a piece is visible if
//! the straight line to the eye never dips below f over the DEM. That also drops concave contours, which hide
//! themselves. Nothing of the renderer is used but the camera's projection. Cost: some 2 000 heights a piece.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::LatticePoint;
use hachure::surface::{Level, Surface};
use hachure::truth::Truth;
use hachure::view::Camera;

use crate::judged::{piece, truth};
use crate::tolerances::TRUTH_PIECE_PX;

/// Easting and northing of the middle of every form: large, as in any CRS, so that lost digits show.
pub const MIDDLE: DVec2 = DVec2::new(325_000.0, 4_118_000.0);
/// Heights looked at on the way from the eye to a piece.
const RAY_STEPS: u32 = 2000;
/// Cells of the map on which F is sampled, along each axis.
const MAP_CELLS: usize = 700;

/// A height field about [`MIDDLE`] over a square of samples.
pub struct Form {
    /// What messages call it.
    pub name: &'static str,
    /// Height in metres at metres east and north of the middle.
    pub height: fn(DVec2) -> f64,
    /// Its gradient.
    pub gradient: fn(DVec2) -> DVec2,
    /// Distance in metres of a point of the contour from a closed form of it, for an eye; both about the middle.
    pub residual: fn(DVec3, DVec3) -> f64,
    /// Samples along each side, odd.
    pub samples: usize,
    /// Metres between samples.
    pub cell: f64,
}

/// A piece of contour, at most [`TRUTH_PIECE_PX`] long on the page.
pub struct FormPiece {
    /// Its ends on the map, metres from the middle.
    pub map: [DVec2; 2],
    /// Its ends on the page, px.
    pub ends: [DVec2; 2],
    /// Its middle in space, metres about the middle of the form.
    pub middle: DVec3,
}

impl Form {
    /// Half the side of the square, metres.
    pub fn half(&self) -> f64 {
        (self.samples / 2) as f64 * self.cell
    }

    /// The form as a DEM, void where `exists` (given column and row) says so.
    pub fn dem(&self, exists: impl Fn(usize, usize) -> bool) -> Dem {
        let height = |c: usize, r: usize| {
            let p = DVec2::new(c as f64, -(r as f64)) * self.cell + DVec2::new(-self.half(), self.half());
            if exists(c, r) { (self.height)(p) as f32 } else { f32::NAN }
        };
        let n = self.samples;
        let heights = (0..n * n).map(|i| height(i % n, i / n)).collect();
        Dem::from_heights(n, DVec2::splat(self.cell), MIDDLE + DVec2::new(-self.half(), self.half()), heights)
    }

    /// The point of the form above a place of the map.
    pub fn point(&self, p: DVec2) -> DVec3 {
        p.extend((self.height)(p))
    }

    /// n . (eye - P) for the normal n with z = 1: positive is toward.
    pub fn facing(&self, p: DVec2, eye: DVec3) -> f64 {
        eye.z - (self.height)(p) - (self.gradient)(p).dot(eye.truncate() - p)
    }

    /// Whether the straight line from the eye to a point stays above the form wherever `exists`.
    pub fn sees(&self, eye: DVec3, point: DVec3, exists: &dyn Fn(DVec2) -> bool) -> bool {
        let slack = 1e-9 * eye.distance(point);
        (1..RAY_STEPS).all(|i| {
            let p = eye.lerp(point, f64::from(i) / f64::from(RAY_STEPS));
            !exists(p.truncate()) || p.z >= (self.height)(p.truncate()) - slack
        })
    }

    /// The visible contours on the page, and their points about the middle.
    pub fn contours(&self, camera: &Camera) -> (Truth, Vec<DVec3>) {
        let eye = about_middle(camera.eye);
        let on_map = |p: DVec2| p.abs().max_element() <= self.half();
        let (mut pieces, mut points) = (Vec::new(), Vec::new());
        for FormPiece { ends, middle, .. } in self.all_contours(camera) {
            if self.sees(eye, middle, &on_map) {
                pieces.push(piece(ends, camera.project(from_middle(middle)).1));
                points.push(middle);
            }
        }
        (truth([camera.width, camera.height], pieces), points)
    }

    /// All contours before the eye, seen or not.
    pub fn all_contours(&self, camera: &Camera) -> Vec<FormPiece> {
        let (eye, half) = (about_middle(camera.eye), self.half());
        // A little beyond the DEM, and off the samples: an apex stands on a sample and has no gradient.
        let side = 2.0 * half / (MAP_CELLS - 3) as f64;
        let at = |i: usize, j: usize| DVec2::new(i as f64 - 0.63, j as f64 - 0.47) * side - half;
        let on_map = |p: DVec2| p.abs().max_element() <= half;
        let sign: Vec<Vec<bool>> =
            (0..MAP_CELLS).map(|j| (0..MAP_CELLS).map(|i| self.facing(at(i, j), eye) > 0.0).collect()).collect();
        let mut pieces = Vec::new();
        for (j, i) in (0..MAP_CELLS - 1).flat_map(|j| (0..MAP_CELLS - 1).map(move |i| (j, i))) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let crossings: Vec<DVec2> = (0..4)
                .map(|k| (corners[k], corners[(k + 1) % 4]))
                .filter(|(a, b)| sign[a.1][a.0] != sign[b.1][b.0])
                .map(|(a, b)| self.crossing(at(a.0, a.1), at(b.0, b.1), eye))
                .collect();
            for pair in crossings.chunks_exact(2) {
                self.pieces(pair[0], pair[1], camera, &mut pieces);
            }
        }
        pieces.retain(|piece| on_map(piece.middle.truncate()));
        pieces
    }

    /// Where F changes its sign between two places, by bisection.
    fn crossing(&self, mut a: DVec2, mut b: DVec2, eye: DVec3) -> DVec2 {
        let toward = self.facing(a, eye) > 0.0;
        for _ in 0..60 {
            let middle = a.midpoint(b);
            if (self.facing(middle, eye) > 0.0) == toward { a = middle } else { b = middle }
        }
        a.midpoint(b)
    }

    /// Halves a piece of contour until it is short on the page.
    fn pieces(&self, a: DVec2, b: DVec2, camera: &Camera, found: &mut Vec<FormPiece>) {
        let eye = about_middle(camera.eye);
        let middle = self.onto_contour(a.midpoint(b), (b - a).perp(), eye);
        let [pa, pb] = [a, b].map(|p| camera.project(from_middle(self.point(p))));
        if pa.1 <= 0.0 || pb.1 <= 0.0 {
            return;
        }
        if pa.0.distance(pb.0) <= TRUTH_PIECE_PX || a.distance(b) < 1e-9 {
            found.push(FormPiece { map: [a, b], ends: [pa.0, pb.0], middle: self.point(middle) });
        } else {
            self.pieces(a, middle, camera, found);
            self.pieces(middle, b, camera, found);
        }
    }

    /// The place with F = 0 nearest to `p` along a direction, by secants.
    pub fn onto_contour(&self, p: DVec2, along: DVec2, eye: DVec3) -> DVec2 {
        let value = |t: f64| self.facing(p + along * t, eye);
        let (mut t0, mut t1) = (0.0, 1e-3);
        for _ in 0..8 {
            let (f0, f1) = (value(t0), value(t1));
            if f1 == f0 {
                break;
            }
            (t0, t1) = (t1, t1 - f1 * (t1 - t0) / (f1 - f0));
        }
        p + along * t1.clamp(-1.0, 1.0)
    }

    /// Largest distance on the page, px, between the facets of `surface` at a level and the form: at their corners and
    /// in the middle of their sides and of themselves, square to the form.
    pub fn deviation(&self, surface: &Surface, level: Level, camera: &Camera) -> f64 {
        let n = (self.samples - 1) * level.subdivisions() as usize + 1;
        let vertex = |i: usize| LatticePoint { y: (i / n) as u32 * level.step(), x: (i % n) as u32 * level.step() };
        let vertices: Vec<DVec3> =
            (0..n * n).map(|i| about_middle(surface.position(vertex(i)).expect("no voids"))).collect();
        let off = |p: DVec3| {
            let (_, distance) = camera.project(from_middle(p));
            let slope = (self.gradient)(p.truncate()).length_squared();
            let metres = (p.z - (self.height)(p.truncate())).abs() / (1.0 + slope).sqrt();
            if distance > 0.0 { metres * camera.focal() / distance } else { 0.0 }
        };
        let quads = (0..n - 1).flat_map(|r| (0..n - 1).map(move |c| r * n + c));
        let quad = |i: usize| {
            let [nw, ne, sw, se] = [i, i + 1, i + n, i + n + 1].map(|i| vertices[i]);
            let middles =
                [(nw + sw + se) / 3.0, (nw + se + ne) / 3.0, nw.midpoint(se), nw.midpoint(sw), nw.midpoint(ne)];
            middles.into_iter().chain([nw, se]).map(off).fold(0.0, f64::max)
        };
        quads.map(quad).fold(0.0, f64::max)
    }
}

/// World to metres about the middle.
pub fn about_middle(p: DVec3) -> DVec3 {
    p - MIDDLE.extend(0.0)
}

/// Metres about the middle to world.
pub fn from_middle(p: DVec3) -> DVec3 {
    p + MIDDLE.extend(0.0)
}
