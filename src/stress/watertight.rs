//! The f64 mesh a frame should show, and which pixels of it are missing.
//!
//! A pinhole is a pixel without a facet though five rays, through its centre and a little to each side, all hit the
//! mesh beyond the near plane. Rays meet facets as Moeller, Trumbore 1997 compute it, borders included. Facets are
//! clipped to the near plane only to know which pixels to try: their boxes on the page, enlarged by one pixel.
//! Cost: one division a facet and pixel of its box that is still uncovered.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::surface::lattice::CHUNK_FACETS;
use crate::surface::{Lattice, Surface};
use crate::view::Camera;

/// How far from its centre the rays about it go through a pixel, unless told otherwise, px: places on the page are rounded to
/// 1/256 px, so that a pixel which five rays hit has a facet over its centre.
pub const RAY_PX: f64 = 1.0 / 64.0;

/// A facet's corners in world metres.
pub type Facet = [DVec3; 3];

/// Every facet that exists, by the f64 surface.
pub fn facets(surface: &Surface, lattice: &Lattice) -> Vec<Facet> {
    let count = lattice.chunks().len() as u32 * CHUNK_FACETS;
    let corners = |id| lattice.facet(id).map(|at| surface.position(at));
    (0..count).into_par_iter().map(corners).filter_map(|[a, b, c]| Some([a?, b?, c?])).collect()
}

/// Column and row of each pinhole, and how many uncovered pixels were tried. `depths`: bits of the depth of each pixel, 0 where
/// there is none; the side rays go through it `ray_px` off its centre.
pub fn pinholes(facets: &[Facet], camera: &Camera, near: f64, depths: &[u32], ray_px: f64) -> (Vec<[u32; 2]>, usize) {
    let [right, up, forward] = camera.axes();
    let steps = [DVec2::ZERO, DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|d| d * ray_px + 0.5);
    let mut hits = vec![0_u8; depths.len()];
    for facet in facets {
        let corners = facet.map(|p| p - camera.eye);
        let seen = corners.map(|p| DVec3::new(p.dot(right), p.dot(up), p.dot(forward)));
        let Some([x, y]) = pixels_of(seen, camera, near) else { continue };
        for row in y[0]..y[1] {
            for column in x[0]..x[1] {
                let i = (row * camera.width + column) as usize;
                if depths[i] != 0 || hits[i] == 31 {
                    continue;
                }
                for (k, step) in steps.iter().enumerate() {
                    let ray = camera.ray(DVec2::new(f64::from(column), f64::from(row)) + step);
                    let hit = distance(corners, ray).is_some_and(|along| along >= near);
                    hits[i] |= u8::from(hit) << k;
                }
            }
        }
    }
    let places = (0..).zip(&hits).filter(|(_, hit)| **hit == 31);
    let places = places.map(|(i, _): (u32, _)| [i % camera.width, i / camera.width]).collect();
    (places, depths.iter().filter(|d| **d == 0).count())
}

/// Ranges of columns and rows that a facet in camera space (right, up, forward) may touch.
fn pixels_of(corners: Facet, camera: &Camera, near: f64) -> Option<[[u32; 2]; 2]> {
    let centre = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let mut reach = |p: DVec3| {
        let place = centre + DVec2::new(p.x, -p.y) * (camera.focal() / p.z);
        low = low.min(place);
        high = high.max(place);
    };
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        if p.z >= near {
            reach(p);
        }
        if (p.z >= near) != (q.z >= near) {
            reach(p.lerp(q, (near - p.z) / (q.z - p.z)).with_z(near));
        }
    }
    if low.x > high.x {
        return None;
    }
    let range = |low: f64, high: f64, size: u32| {
        let to = |place: f64| place.clamp(0.0, f64::from(size)) as u32;
        [to((low - 1.0).floor()), to((high + 1.0).ceil())]
    };
    Some([range(low.x, high.x, camera.width), range(low.y, high.y, camera.height)])
}

/// Where a ray from the origin meets a facet, in lengths of the ray; `None` where it misses.
pub fn distance([a, b, c]: Facet, ray: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.cross(ac);
    let volume = ab.dot(across);
    if volume == 0.0 {
        return None;
    }
    let u = (-a).dot(across) / volume;
    let along = (-a).cross(ab);
    let v = ray.dot(along) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(along) / volume)
}
