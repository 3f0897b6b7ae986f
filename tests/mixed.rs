//! Lattices of several levels: grown at random, so that tests meet every way in which chunks can lie side by side.

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::surface::Lattice;
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_QUADS, NORTH, Role, SOUTH, WEST};
use hachure::door::surface::quadtree::{NO_SLOT, Splits};
use hachure::door::surface::{Chunk, LatticePoint};

use crate::scenes::{Random, hashed};

/// What a random lattice is to be.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Cells across and down.
    pub cells: [usize; 2],
    /// Lattice units between vertices of the coarsest and of the finest chunks, before neighbours are evened out.
    pub steps: [u32; 2],
    /// Of so many squares one is not split, 0: all are.
    pub rarity: u32,
    /// Void samples in ten thousand, and a block as wide as a third of the DEM, at most 36.
    pub voids: u32,
}

/// Splits squares at random, but those that must not be coarse always.
pub struct Chance<'a> {
    /// Below the lattice.
    pub dem: &'a Dem,
    /// What decides.
    pub random: &'a mut Random,
    /// What lattice it is to be.
    pub kind: Kind,
}

impl Splits for Chance<'_> {
    fn splits(&mut self, corner: [u32; 2], size: u32) -> bool {
        let step = size / CHUNK_QUADS;
        step > CELL_STEPS && !may_be_coarse(self.dem, corner, step)
            || step > self.kind.steps[1] && self.random.below(self.kind.rarity) != 0
    }

    fn stands_among_equals(&self, corner: [u32; 2], size: u32) -> bool {
        size == CELL_STEPS * CHUNK_QUADS && has_void(self.dem, corner, CELL_STEPS)
    }

    fn done(&mut self, _: [u32; 2], _: u32, _: bool) {}
}

/// Whether a square has no void in it and no edge of the DEM between the vertices of its chunk.
pub fn may_be_coarse(dem: &Dem, corner: [u32; 2], step: u32) -> bool {
    let size = step * CHUNK_QUADS;
    let last = [dem.columns(), dem.rows()].map(|n| (n as u32 - 1) * CELL_STEPS);
    let cut = (0..2).any(|i| (corner[i]..corner[i] + size).contains(&last[i]) && last[i] % step != 0);
    !cut && !has_void(dem, corner, step)
}

/// Whether a square of whole cells holds a void, on its sides too: by a look at each sample.
pub fn has_void(dem: &Dem, corner: [u32; 2], step: u32) -> bool {
    let samples = |axis: usize, samples: usize| {
        let first = corner[axis] / CELL_STEPS;
        (first..=first + step * CHUNK_QUADS / CELL_STEPS).take_while(move |at| (*at as usize) < samples)
    };
    samples(1, dem.rows()).any(|r| samples(0, dem.columns()).any(|c| dem.height(c as usize, r as usize).is_none()))
}

/// A flat DEM with random voids.
pub fn flat(kind: Kind, random: &mut Random) -> Dem {
    let [columns, rows] = kind.cells.map(|n| n + 1);
    let [left, top] = [random.below(columns as u32), random.below(rows as u32)].map(|at| at as usize);
    let size = (columns.min(rows) / 3).min(36);
    let block = |c: usize, r: usize| (left..left + size).contains(&c) && (top..top + size).contains(&r);
    let void = |i: usize, random: &mut Random| {
        kind.voids > 0 && (random.below(10_000) < kind.voids || block(i % columns, i / columns))
    };
    let heights = (0..columns * rows).map(|i| if void(i, random) { f32::NAN } else { 0.0 }).collect();
    Dem::from_heights(columns, DVec2::ONE, DVec2::ZERO, heights)
}

/// A random lattice of all chunks that hold a facet, but for one in `dropped` (0: all).
pub fn lattice(dem: &Dem, kind: Kind, dropped: u32, random: &mut Random) -> Lattice {
    let from = [0, 1].map(|axis| f64::from(random.below(kind.cells[axis] as u32 * CELL_STEPS)));
    let salt = random.bits();
    let keep = |origin: [u32; 2], step| {
        let seed = (u64::from(origin[0]) << 32 | u64::from(origin[1])) ^ u64::from(salt) << 16;
        let drops = dropped > 0 && hashed(seed) * f64::from(dropped) < 1.0;
        (!drops && holds_facet(dem, origin, step)).then_some(Role::Seen)
    };
    let tree = Lattice::grow(dem, kind.steps[0], from, &mut Chance { dem, random, kind }).expect("few chunks");
    Lattice::adaptive(dem, tree, keep).expect("few chunks")
}

fn holds_facet(dem: &Dem, origin: [u32; 2], step: u32) -> bool {
    let size = step * CHUNK_QUADS;
    let cells = |axis: usize, samples: usize| {
        let end = (origin[axis] + size).div_ceil(CELL_STEPS) as usize;
        (origin[axis] / CELL_STEPS) as usize..end.min(samples - 1)
    };
    let inside =
        |v: u32, w: u32| v < (dem.columns() as u32 - 1) * CELL_STEPS && w < (dem.rows() as u32 - 1) * CELL_STEPS;
    inside(origin[0], origin[1])
        && cells(1, dem.rows()).any(|r| {
            cells(0, dem.columns()).any(|c| {
                // A chunk may lie in one half of a cell alone.
                let sub = [0, 1].map(|axis| origin[axis].saturating_sub([c, r][axis] as u32 * CELL_STEPS));
                let below = sub[0] < (sub[1] + size).min(CELL_STEPS);
                let above = sub[1] < (sub[0] + size).min(CELL_STEPS);
                (below && patch(dem, c, r, 0)) || (above && patch(dem, c, r, 1))
            })
        })
}

fn patch(dem: &Dem, c: usize, r: usize, half: usize) -> bool {
    let third = [(c, r + 1), (c + 1, r)][half];
    [(c, r), (c + 1, r + 1), third].into_iter().all(|(c, r)| dem.height(c, r).is_some())
}

/// Whether the patch of a facet is there: by the corners of the cell and half in which its middle lies.
pub fn exists(dem: &Dem, vertices: [LatticePoint; 3]) -> bool {
    let [x, y] = [vertices.map(|v| v.x), vertices.map(|v| v.y)].map(|v| v.iter().map(|at| u64::from(*at)).sum::<u64>());
    let last = [dem.columns(), dem.rows()].map(|n| (n as u32 - 1) * CELL_STEPS);
    let cell = 3 * u64::from(CELL_STEPS);
    vertices.iter().all(|v| v.x <= last[0] && v.y <= last[1])
        && patch(dem, (x / cell) as usize, (y / cell) as usize, usize::from(x % cell > y % cell))
}

/// Corner and size of every leaf of a lattice's tree with its slot, read as a shader reads it.
pub fn leaves(lattice: &Lattice) -> Vec<([u32; 2], u32, u32)> {
    const INNER: u32 = 1 << 31;
    let (tree, mut found) = (lattice.tree(), Vec::new());
    let [across, down] = tree.roots();
    let corner = |root: u32| [root % across * tree.root_size(), root / across * tree.root_size()];
    let mut open: Vec<_> = (0..across * down).rev().map(|root| (root, corner(root), tree.root_size())).collect();
    while let Some((node, [x, y], size)) = open.pop() {
        let value = tree.nodes()[node as usize];
        if value == NO_SLOT || value & INNER == 0 {
            found.push(([x, y], size, value));
            continue;
        }
        let half = size / 2;
        for (k, corner) in [[x, y], [x + half, y], [x, y + half], [x + half, y + half]].into_iter().enumerate().rev() {
            open.push(((value & !INNER) + k as u32, corner, half));
        }
    }
    found
}

/// How many levels a lattice has, and how many of its sides lie beside a coarser chunk.
pub fn variety(lattice: &Lattice) -> [usize; 2] {
    let mut steps: Vec<u32> = lattice.chunks().iter().map(|chunk| chunk.step).collect();
    steps.sort_unstable();
    steps.dedup();
    [steps.len(), lattice.chunks().iter().map(|chunk: &Chunk| chunk.coarser.count_ones() as usize).sum()]
}

/// The sides of a square on which a coarser one lies, by their bits.
pub fn sides(square: ([u32; 2], u32), larger: impl Fn([i64; 2]) -> bool) -> u32 {
    let ([x, y], size) = (square.0.map(i64::from), i64::from(square.1));
    let beyond = [[x, y - 1], [x + size, y], [x, y + size], [x - 1, y]];
    (0..4).filter(|k| larger(beyond[*k as usize])).map(|k| [NORTH, 2, SOUTH, WEST][k as usize]).sum()
}
