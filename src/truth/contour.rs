//! The lines of a level: convex edges between toward and away facets, and edges with one facet, which is toward.
//!
//! Each cell owns the edges inside it and those of its east and south sides; a ring of cells without patches around the
//! grid owns the outermost ones. Cells of which all facets are proven to face one way, and whose neighbours to the east
//! and south face the same way, own no line and are passed over.

use glam::DVec3;
use rayon::prelude::*;

use super::Truth;
use super::cell::{Cell, point, vertices};
use super::facing::{Facing, halves_toward, is_toward, of_patch};
use super::page::{Projection, TruthLine, TruthPiece};
use super::sight::{Blocker, Sight};
use super::terrain::Terrain;
use crate::surface::Level;
use crate::view::Camera;

/// Rays end this far off the surface, in lengths of the edge.
pub(super) const NUDGE: f64 = 0.05;
/// Lines nearer than this are not drawn, in cells: as the frames do it.
const NEAR: f64 = 1.0 / 1024.0;

/// A facet, vertices in metres from the eye, counter-clockwise from above.
type Facet = [DVec3; 3];

/// What bounds prove of the two patches of every cell on the page, with a ring of cells without patches around the grid;
/// `None` off the page.
struct Facings {
    columns: usize,
    of: Vec<Option<[Facing; 2]>>,
}

/// What a row of cells adds.
#[derive(Default)]
struct Found {
    pieces: Vec<TruthPiece>,
    facets: u64,
    rays: u64,
    blocker: Blocker,
}

impl Terrain<'_> {
    /// The lines that `camera` sees, at a level. Cost: see [`super`].
    pub fn truth(&self, camera: &Camera, level: Level) -> Truth {
        let page = self.page(camera);
        let facings = self.facings(camera.eye, &page);
        let sight = Sight { terrain: self, eye: camera.eye, level: level.subdivisions() };
        let rows = self.surface.dem().rows() as isize;
        let found: Vec<Found> = (-1..rows - 1).into_par_iter().map(|r| sight.row(r, &facings, &page)).collect();
        let mut truth = Truth { level, size: [camera.width, camera.height], pieces: Vec::new(), facets: 0, rays: 0 };
        for row in found {
            truth.pieces.extend(row.pieces);
            truth.facets += row.facets;
            truth.rays += row.rays;
        }
        truth
    }

    pub(super) fn page(&self, camera: &Camera) -> Projection {
        Projection::new(camera, self.surface.dem().cell().min_element() * NEAR)
    }

    /// Whether a cell may show on the page.
    pub(super) fn may_show(&self, c: isize, r: isize, eye: DVec3, page: &Projection) -> bool {
        self.bounding_box(0, c, r, eye).is_some_and(|bounds| page.may_show(&bounds.corners()))
    }

    fn facings(&self, eye: DVec3, page: &Projection) -> Facings {
        let [columns, rows] = self.grid(0).map(|n| n as isize);
        let row = |r: isize| {
            (-1..=columns).map(move |c| {
                self.may_show(c, r, eye, page).then(|| {
                    let cell = Cell::new(self.surface, eye, c, r);
                    [0, 1].map(|half| of_patch(cell.patches[half].as_ref(), half))
                })
            })
        };
        Facings { columns: columns as usize + 2, of: (-1..=rows).into_par_iter().flat_map_iter(row).collect() }
    }
}

impl Facings {
    fn at(&self, c: isize, r: isize) -> Option<[Facing; 2]> {
        self.of[(r + 1) as usize * self.columns + (c + 1) as usize]
    }

    /// Whether a line that shows may run along an edge that cell (c, r) owns.
    fn may_own_line(&self, c: isize, r: isize) -> bool {
        let [own, east, south] = [self.at(c, r), self.at(c + 1, r), self.at(c, r + 1)];
        if own.or(east).or(south).is_none() {
            return false;
        }
        let [own, east, south] = [own, east, south].map(|of| of.unwrap_or([Facing::Mixed; 2]));
        let around = [own[0], own[1], east[0], south[1]];
        around[0] == Facing::Mixed || around.iter().any(|facing| *facing != around[0])
    }
}

/// The facets of a cell at a level, and those of its neighbours along its east and south sides.
struct Facets<'a> {
    level: u32,
    own: &'a Cell,
    east: &'a Cell,
    south: &'a Cell,
    /// Vertices of each patch, (level + 1)^2, row by row; those beyond the diagonal are not used.
    vertices: [Vec<DVec3>; 2],
    /// Of both halves of (level + 1)^2 quads, row by row: `None` where there is no facet, else whether it is toward.
    toward: Vec<[Option<bool>; 2]>,
}

impl<'a> Facets<'a> {
    fn new(level: u32, [own, east, south]: [&'a Cell; 3]) -> Self {
        let side = level + 1;
        let vertices = [0, 1].map(|half| {
            own.patches[half].as_ref().map_or(Vec::new(), |patch| {
                let place = |i: u32| [i % side, i / side].map(|k| f64::from(k) / f64::from(level));
                let used = |[u, v]: [f64; 2]| if half == 0 { v >= u } else { u >= v };
                let vertex = |at| if used(at) { point(patch, half, at) } else { DVec3::ZERO };
                (0..side * side).map(|i| vertex(place(i))).collect()
            })
        });
        let toward = vec![[None; 2]; (side * side) as usize];
        let mut facets = Self { level, own, east, south, vertices, toward };
        facets.face();
        facets
    }

    /// Decides facing, once for each facet.
    fn face(&mut self) {
        let (n, side) = (self.level as usize, self.level as usize + 1);
        for j in 0..n {
            for (patch, columns) in [(0, 0..j), (1, j + 1..n)] {
                let vertices = &self.vertices[patch];
                for i in if vertices.is_empty() { 0..0 } else { columns } {
                    let [nw, sw] = [j * side + i, (j + 1) * side + i];
                    let quad = [vertices[nw], vertices[sw], vertices[sw + 1], vertices[nw + 1]];
                    self.toward[nw] = halves_toward(quad).map(Some);
                }
            }
        }
        for k in 0..self.level {
            let ends = [(0, k, k), (1, k, k), (0, self.level, k), (1, k, self.level)];
            for (half, i, j) in ends {
                let toward = self.facet(half, i, j).map(|facet| is_toward(half, facet));
                self.toward[j as usize * side + i as usize][half] = toward;
            }
        }
    }

    /// Facet of half `half` in quad (i, j); quads run on by one into the neighbours to the east and south.
    fn facet(&self, half: usize, i: u32, j: u32) -> Option<Facet> {
        let n = self.level;
        let vertices = vertices(half, i, j);
        if i < n && j < n {
            // On the diagonal each half belongs to its own patch.
            let patch = if i == j { half } else { usize::from(i > j) };
            self.own.patches[patch].as_ref()?;
            return Some(vertices.map(|[x, y]| self.vertices[patch][(y * (n + 1) + x) as usize]));
        }
        let (cell, patch) = if i == n { (self.east, 0) } else { (self.south, 1) };
        let patch_there = cell.patches[patch].as_ref()?;
        let there = |k: u32| f64::from(if k >= n { k - n } else { k }) / f64::from(n);
        let place = |[x, y]: [u32; 2]| {
            if i == n { [there(x), f64::from(y) / f64::from(n)] } else { [f64::from(x) / f64::from(n), there(y)] }
        };
        Some(vertices.map(|at| point(patch_there, patch, place(at))))
    }

    /// Calls `visit` with the two sides of every edge the cell owns where facing flips or one facet is missing.
    fn each_line(&self, mut visit: impl FnMut([Option<Side>; 2])) {
        let side = |half, i, j, opposite| {
            let toward = self.toward(half, i, j)?;
            self.facet(half, i, j).map(|facet| Side { facet, opposite, toward })
        };
        for j in 0..self.level {
            for i in 0..self.level {
                let [below, above] = [0, 1].map(|half| self.toward(half, i, j));
                if below != above {
                    visit([side(0, i, j, 1), side(1, i, j, 2)]);
                }
                if above != self.toward(0, i + 1, j) {
                    visit([side(1, i, j, 0), side(0, i + 1, j, 2)]);
                }
                if below != self.toward(1, i, j + 1) {
                    visit([side(0, i, j, 0), side(1, i, j + 1, 1)]);
                }
            }
        }
    }

    fn toward(&self, half: usize, i: u32, j: u32) -> Option<bool> {
        self.toward[(j * (self.level + 1) + i) as usize][half]
    }
}

/// A facet as one side of an edge: the one across from its vertex `opposite`.
struct Side {
    facet: Facet,
    opposite: usize,
    toward: bool,
}

impl Side {
    fn edge(&self) -> [DVec3; 2] {
        [1, 2].map(|k| self.facet[(self.opposite + k) % 3])
    }

    /// Up from the facet, as long as twice its area.
    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.facet;
        (b - a).cross(c - a)
    }
}

impl Sight<'_> {
    /// The lines that the cells of row `r` own.
    fn row(&self, r: isize, facings: &Facings, page: &Projection) -> Found {
        let mut found = Found::default();
        let columns = self.terrain.grid(0)[0] as isize;
        for c in (-1..columns).filter(|&c| facings.may_own_line(c, r)) {
            let cell = |dc, dr| Cell::new(self.terrain.surface, self.eye, c + dc, r + dr);
            let (own, east, south) = (cell(0, 0), cell(1, 0), cell(0, 1));
            let facets = Facets::new(self.level, [&own, &east, &south]);
            found.facets += facets.toward.iter().flatten().flatten().count() as u64;
            facets.each_line(|sides| self.line(sides, page, &mut found));
        }
        found
    }

    /// The visible pieces of an edge where facing flips or one facet is missing.
    fn line(&self, sides: [Option<Side>; 2], page: &Projection, found: &mut Found) {
        let (edge, up, line) = match sides {
            [Some(a), Some(b)] => {
                let (toward, away) = if a.toward { (a, b) } else { (b, a) };
                let edge = toward.edge();
                // A concave edge is hidden by the facet that faces the eye.
                if toward.normal().dot(away.facet[away.opposite] - edge[0]) >= 0.0 {
                    return;
                }
                (edge, toward.normal().normalize_or_zero() + away.normal().normalize_or_zero(), TruthLine::Contour)
            }
            [Some(only), None] | [None, Some(only)] if only.toward => (only.edge(), only.normal(), TruthLine::Border),
            _ => return,
        };
        let nudge = up.normalize_or_zero() * (NUDGE * edge[0].distance(edge[1]));
        let Found { pieces, rays, blocker, .. } = found;
        let sees = |place| {
            *rays += 1;
            self.reaches(place + nudge, blocker)
        };
        page.pieces(edge, line, sees, pieces);
    }
}
