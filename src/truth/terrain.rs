//! A surface with bounds of its cells, ready to be looked at from any eye.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::cell::Cell;
use crate::surface::Surface;

/// Where the patches of a node lie: heights, and how far they reach beyond the node's footprint on the map. Metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// Exaggerated.
    pub low: f32,
    /// Below `low` where there is no patch.
    pub high: f32,
    pub beyond: f32,
}

impl Bounds {
    const NOTHING: Self = Self { low: f32::INFINITY, high: f32::NEG_INFINITY, beyond: 0.0 };

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), beyond: self.beyond.max(other.beyond) }
    }
}

/// A surface with a quadtree of bounds: 12 bytes a cell, and a third of that for the nodes above.
pub struct Terrain<'a> {
    /// What it bounds.
    pub surface: &'a Surface,
    /// Cells first, then nodes of 2 x 2, 4 x 4 ... of them, up to one.
    layers: Vec<TerrainLayer>,
}

struct TerrainLayer {
    columns: usize,
    rows: usize,
    nodes: Vec<Bounds>,
}

/// A box with axes along east, north and up, metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Box3 {
    pub low: DVec3,
    pub high: DVec3,
}

impl<'a> Terrain<'a> {
    /// Bounds all cells, on every core.
    pub fn new(surface: &'a Surface) -> Self {
        let (columns, rows) = (surface.dem().columns() - 1, surface.dem().rows() - 1);
        let nodes = (0..rows).into_par_iter().flat_map_iter(|r| (0..columns).map(move |c| bounds(surface, c, r)));
        let mut layers = vec![TerrainLayer { columns, rows, nodes: nodes.collect() }];
        while let Some(below) = layers.last().filter(|layer| layer.nodes.len() > 1) {
            layers.push(below.halved());
        }
        Self { surface, layers }
    }

    /// How many layers the quadtree has; the last is one node.
    pub(super) fn layers(&self) -> usize {
        self.layers.len()
    }

    /// Columns and rows of nodes in a layer.
    pub(super) fn grid(&self, layer: usize) -> [usize; 2] {
        [self.layers[layer].columns, self.layers[layer].rows]
    }

    /// The box of a node in metres from `eye`; `None` outside the grid and where there is no patch.
    pub(super) fn bounding_box(&self, layer: usize, c: isize, r: isize, eye: DVec3) -> Option<Box3> {
        let nodes = &self.layers[layer];
        if !(0..nodes.columns as isize).contains(&c) || !(0..nodes.rows as isize).contains(&r) {
            return None;
        }
        let (c, r) = (c as usize, r as usize);
        let Bounds { low, high, beyond } = nodes.nodes[r * nodes.columns + c];
        if low > high {
            return None;
        }
        let dem = self.surface.dem();
        let size = 1 << layer;
        let end = |i: usize, samples: usize| ((i + 1) * size).min(samples - 1) as f64;
        let origin = dem.position(0, 0).truncate() - eye.truncate();
        let (west, north) = (origin.x + (c * size) as f64 * dem.cell().x, origin.y - (r * size) as f64 * dem.cell().y);
        let east = origin.x + end(c, dem.columns()) * dem.cell().x;
        let south = origin.y - end(r, dem.rows()) * dem.cell().y;
        let beyond = DVec2::splat(f64::from(beyond));
        Some(Box3 {
            low: (DVec2::new(west, south) - beyond).extend(f64::from(low) - eye.z),
            high: (DVec2::new(east, north) + beyond).extend(f64::from(high) - eye.z),
        })
    }
}

impl TerrainLayer {
    /// The layer of nodes twice as wide.
    fn halved(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let node = |i: usize| {
            let (c, r) = (i % columns * 2, i / columns * 2);
            let inside = [(c, r), (c + 1, r), (c, r + 1), (c + 1, r + 1)];
            let inside = inside.into_iter().filter(|&(c, r)| c < self.columns && r < self.rows);
            inside.map(|(c, r)| self.nodes[r * self.columns + c]).fold(Bounds::NOTHING, Bounds::with)
        };
        Self { columns, rows, nodes: (0..columns * rows).map(node).collect() }
    }
}

impl Box3 {
    /// The eight corners.
    pub(super) fn corners(&self) -> [DVec3; 8] {
        let pick = |bit: bool, low: f64, high: f64| if bit { high } else { low };
        [0, 1, 2, 3, 4, 5, 6, 7].map(|i: u8| {
            let (l, h) = (self.low, self.high);
            DVec3::new(pick(i & 1 > 0, l.x, h.x), pick(i & 2 > 0, l.y, h.y), pick(i & 4 > 0, l.z, h.z))
        })
    }
}

/// Bounds of a cell: its control points hold its patches.
fn bounds(surface: &Surface, c: usize, r: usize) -> Bounds {
    let dem = surface.dem();
    // Relative to its north-west sample on the map, so that f32 holds how far it reaches.
    let corner = dem.position(c, r).with_z(0.0);
    let cell = Cell::new(surface, corner, c as isize, r as isize);
    let size = dem.cell();
    let points = cell.patches.iter().flatten().flat_map(|patch| patch.control());
    points.fold(Bounds::NOTHING, |all, p| {
        let beyond = (-p.x).max(p.x - size.x).max(p.y).max(-size.y - p.y).max(0.0);
        let z = p.z as f32;
        all.with(Bounds { low: z.next_down(), high: z.next_up(), beyond: (beyond as f32).next_up() })
    })
}
