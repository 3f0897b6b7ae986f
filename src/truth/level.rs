//! The level at which no visible cell's edge is longer than a pixel.

use glam::DVec3;
use rayon::prelude::*;

use super::cell::Cell;
use super::contour::NUDGE;
use super::page::Projection;
use super::sight::{Blocker, Sight};
use super::terrain::Terrain;
use crate::surface::lattice::CELL_STEPS;
use crate::surface::{Level, Patch};
use crate::view::Camera;

/// What other stages and tests look into.
#[doc(hidden)]
impl Terrain<'_> {
    /// The least level at which no edge of a facet in a visible cell is longer than a pixel, 64 at most, the sides of
    /// cells taken as straight and divided evenly on the page; `None` where no cell is visible. A cell counts as visible
    /// if a ray reaches one of its corners or its middle past the facets of level 1. Cost: projecting every cell, then
    /// rays until the first visible one of them, the longest first.
    pub fn level_for(&self, camera: &Camera) -> Option<Level> {
        let page = self.page(camera);
        let [columns, rows] = self.grid(0).map(|n| n as u32);
        let cell = |c: u32, r: u32| Cell::new(self.surface, camera.eye, c as isize, r as isize);
        let row = |r: u32| {
            let shown = (0..columns).filter(|c| self.may_show(*c as isize, r as isize, camera.eye, &page));
            shown.map(|c| (longest_edge(&cell(c, r), &page), c, r)).collect::<Vec<_>>()
        };
        let mut longest: Vec<(f32, u32, u32)> = (0..rows).into_par_iter().flat_map_iter(row).collect();
        longest.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.2, a.1).cmp(&(b.2, b.1))));
        let sight = Sight { terrain: self, eye: camera.eye, level: 1 };
        let off = self.surface.dem().cell().min_element() * NUDGE;
        let (length, ..) = longest.into_iter().find(|&(_, c, r)| is_visible(&cell(c, r), &sight, off))?;
        Level::new((length.min(CELL_STEPS as f32).ceil().max(1.0) as u32).next_power_of_two())
    }
}

/// Longest straight line between corners of a cell, px, rounded up.
fn longest_edge(cell: &Cell, page: &Projection) -> f32 {
    let corners = cell.patches.iter().flatten().map(corners);
    let edges = corners.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let longest = edges.map(|edge| page.edge_length(edge)).fold(0.0, f64::max);
    (longest as f32).next_up()
}

fn is_visible(cell: &Cell, sight: &Sight<'_>, off: f64) -> bool {
    let places = cell.patches.iter().flatten().flat_map(|patch| {
        let [a, b, c] = corners(patch);
        let up = (b - a).cross(c - a).normalize_or_zero() * off;
        [a, b, c, (a + b + c) / 3.0].map(|place| place + up)
    });
    places.into_iter().any(|place| sight.reaches(place, &mut Blocker::default()))
}

fn corners(patch: &Patch) -> [DVec3; 3] {
    let control = patch.control();
    [control[0], control[3], control[9]]
}
