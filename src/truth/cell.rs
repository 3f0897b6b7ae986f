//! One cell of the surface, evaluated on demand: its two patches, in metres from the eye.
//!
//! Corners of patches stand in the order of the lattice: 0 (NW, SW, SE), 1 (NW, SE, NE). A place in a cell is (u, v), u
//! east and v south, 0 to 1.

use glam::DVec3;

use crate::surface::lattice::patch_exists;
use crate::surface::{Patch, Surface};

/// The patches of a cell, those that exist.
pub(super) struct Cell {
    pub patches: [Option<Patch>; 2],
}

impl Cell {
    /// Cell (c, r), relative to `eye`; without patches outside the grid.
    pub(super) fn new(surface: &Surface, eye: DVec3, c: isize, r: isize) -> Self {
        let dem = surface.dem();
        let inside = |i: isize, samples: usize| (0..samples as isize - 1).contains(&i);
        if !inside(c, dem.columns()) || !inside(r, dem.rows()) {
            return Self { patches: [None; 2] };
        }
        let (c, r) = (c as usize, r as usize);
        let corner = |dc: usize, dr: usize| {
            let normal = (-surface.gradient(c + dc, r + dr)).extend(1.0).normalize();
            (dem.position(c + dc, r + dr) - eye, normal)
        };
        let corners = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
        Self { patches: [0, 1].map(|half| patch_exists(dem, c, r, half).then(|| Patch::of_cell(corners, half))) }
    }
}

/// The point of patch 0 or 1 of a cell at (u, v).
pub(super) fn point(patch: &Patch, half: usize, [u, v]: [f64; 2]) -> DVec3 {
    patch.point(if half == 0 { [1.0 - v, v - u, u] } else { [1.0 - u, v, u - v] })
}

/// The vertices of a facet of half `half` in the quad with north-west corner (i, j), in quads of that size:
/// counter-clockwise from above.
pub(super) fn vertices(half: usize, i: u32, j: u32) -> [[u32; 2]; 3] {
    if half == 0 { [[i, j], [i, j + 1], [i + 1, j + 1]] } else { [[i, j], [i + 1, j + 1], [i + 1, j]] }
}
