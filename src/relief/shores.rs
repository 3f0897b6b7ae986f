//! Where land and flat water meet.
//!
//! Method: marching squares (Lorensen, Cline 1987, in the plane) between samples of water and of land. A shore crosses the
//! side of a cell where the land's slope beyond it comes down to the water; then each crossing moves along its own side until
//! the line is smooth, see `smooth`. A shore that keeps its sides crosses neither itself nor another. Cost: linear in the
//! samples and in the crossings. Of a DEM that stays in its file shores are found on blocks of samples, see `blocks`. Not
//! handled: water that is no [`FlatWater`]; within a cell of a void a shore ends.

mod blocks;
mod smooth;

use std::ops::Range;

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::{FlatWater, LineKind, SurfaceLine, SurfacePoint};
use crate::dem::{Dem, Samples};
use crate::error::Result;
use smooth::smooth;

/// The smallest islands and lakes that have a shore, and the shortest shore that ends somewhere: cells, squared and in a row.
const LEAST_AREA: f64 = 8.0;
const LEAST_LENGTH: f64 = 4.0;
/// Where on the side of a cell a shore may cross, from the land to the water, before it is smoothed.
const CROSSINGS: [f64; 2] = [0.15, 0.85];
/// No side of a cell.
const NONE: u32 = u32::MAX;

/// Flat water and its shores.
#[derive(Debug, Clone, PartialEq)]
pub struct Shores {
    /// Which samples are water.
    pub water: FlatWater,
    /// Its rim, where that is land: closed, or from where it leaves the DEM or meets a void to where it does so again.
    pub lines: Vec<SurfaceLine>,
}

/// A side of a cell that a shore crosses.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    /// Its north or west end, and the step to the other one.
    from: DVec2,
    step: DVec2,
    /// Where it is crossed, 0 to 1.
    at: f64,
}

impl Crossing {
    fn place(self) -> DVec2 {
        self.from + self.step * self.at
    }
}

/// Samples between which shores are looked for.
struct ShoreGrid<'a> {
    water: &'a FlatWater,
    samples: &'a Samples,
    /// How much of each block is water, where samples stand for blocks.
    shares: Option<&'a [f32]>,
    columns: usize,
    rows: usize,
}

impl Shores {
    /// Of a held DEM whose heights are multiplied by `exaggeration`.
    ///
    /// # Errors
    /// As [`Dem::held`].
    pub fn of(dem: &Dem, exaggeration: f64) -> Result<Self> {
        let water = FlatWater::of(dem, exaggeration)?;
        let lines = rims(dem, &water, None)?;
        Ok(Self { water, lines })
    }
}

/// The rims of water; `shares` as of [`ShoreGrid`].
fn rims(dem: &Dem, water: &FlatWater, shares: Option<&[f32]>) -> Result<Vec<SurfaceLine>> {
    let grid = ShoreGrid { water, samples: dem.held()?, shares, columns: dem.columns(), rows: dem.rows() };
    let chains = chains(&grid.links()).into_iter();
    let lines = chains.filter_map(|(sides, closed)| {
        let mut crossings: Vec<Crossing> = sides.into_iter().map(|side| grid.crossing(side)).collect();
        smooth(&mut crossings, closed);
        line(&crossings, closed, dem.cell())
    });
    Ok(lines.collect())
}

/// What other stages and tests look into.
#[doc(hidden)]
impl FlatWater {
    /// Blanks what of a line lies in the water.
    pub fn blank(&self, line: &mut SurfaceLine) {
        for point in &mut line.points {
            let [c, r] = point.at.round().to_array().map(|at| at.max(0.0) as usize);
            if self.is_water(c, r) {
                point.across = [f32::NAN; 3];
            }
        }
    }
}

impl ShoreGrid<'_> {
    /// For each side of a cell that a shore crosses, the sides that it crosses before and after it.
    fn links(&self) -> FxHashMap<u32, [u32; 2]> {
        let mut links = FxHashMap::default();
        let mut link = |a: u32, b: u32| {
            for (side, other) in [(a, b), (b, a)] {
                let beside = links.entry(side).or_insert([NONE; 2]);
                beside[usize::from(beside[0] != NONE)] = other;
            }
        };
        for r in 0..self.rows - 1 {
            for c in 0..self.columns - 1 {
                // North-west, north-east, south-east, south-west.
                let corners = [[c, r], [c + 1, r], [c + 1, r + 1], [c, r + 1]];
                let is_water = corners.map(|[c, r]| self.water.is_water(c, r));
                if is_water == [is_water[0]; 4] || corners.iter().any(|[c, r]| self.height(*c, *r).is_nan()) {
                    continue;
                }
                // North, east, south, west; a shore crosses those whose ends differ.
                let sides = [self.across(c, r), self.down(c + 1, r), self.across(c, r + 1), self.down(c, r)];
                let crossed = |k: usize| is_water[k] != is_water[(k + 1) % 4];
                if (0..4).all(crossed) {
                    // Water on a diagonal is two waters: each has its corner, between the sides before and after it.
                    (0..4).filter(|k| is_water[*k]).for_each(|k| link(sides[(k + 3) % 4], sides[k]));
                } else {
                    let mut two = (0..4).filter(|k| crossed(*k));
                    if let (Some(one), Some(other)) = (two.next(), two.next()) {
                        link(sides[one], sides[other]);
                    }
                }
            }
        }
        links
    }

    /// The side from sample (c, r) to the one east of it.
    fn across(&self, c: usize, r: usize) -> u32 {
        2 * (r * self.columns + c) as u32
    }

    /// The side from sample (c, r) to the one south of it.
    fn down(&self, c: usize, r: usize) -> u32 {
        self.across(c, r) + 1
    }

    /// Where the slope of the land comes down to the water on a side, or half of the ground is water.
    fn crossing(&self, side: u32) -> Crossing {
        let (i, is_down) = ((side / 2) as usize, side % 2 == 1);
        let (c, r) = (i % self.columns, i / self.columns);
        let [dc, dr] = if is_down { [0, 1] } else { [1, 0] };
        let height = |k: isize| {
            let [c, r] = [c as isize + k * dc, r as isize + k * dr];
            if c < 0 || r < 0 { f32::NAN } else { self.height(c as usize, r as usize) }
        };
        let is_water_first = self.water.is_water(c, r);
        let (level, land, beyond) = match is_water_first {
            true => (height(0), height(1), height(2)),
            false => (height(1), height(0), height(-1)),
        };
        if let Some(shares) = self.shares {
            let ends = [shares[i], shares[if is_down { i + self.columns } else { i + 1 }]];
            let [wet, dry] = if is_water_first { ends } else { [ends[1], ends[0]] };
            // Only as low as this is there water in dry land, in less than half of it.
            let dry = if land == level { dry.min(0.49) } else { 0.0 };
            let from_land = f64::from((0.5 - dry) / (wet.max(0.5) - dry)).clamp(CROSSINGS[0], CROSSINGS[1]);
            let at = if is_water_first { 1.0 - from_land } else { from_land };
            return Crossing { from: DVec2::new(c as f64, r as f64), step: DVec2::new(dc as f64, dr as f64), at };
        }
        // NaN where nothing lies beyond.
        let from_land = f64::from((land - level) / (beyond - land));
        let from_land = if land > level && beyond > land { from_land.clamp(CROSSINGS[0], CROSSINGS[1]) } else { 0.5 };
        let at = if is_water_first { 1.0 - from_land } else { from_land };
        Crossing { from: DVec2::new(c as f64, r as f64), step: DVec2::new(dc as f64, dr as f64), at }
    }

    /// NaN at voids and outside.
    fn height(&self, c: usize, r: usize) -> f32 {
        self.samples.height(c, r).unwrap_or(f32::NAN)
    }
}

/// Sides one after another as shores cross them, and whether each shore is closed: first those that end somewhere.
fn chains(links: &FxHashMap<u32, [u32; 2]>) -> Vec<(Vec<u32>, bool)> {
    let mut sides: Vec<u32> = links.keys().copied().collect();
    sides.sort_by_key(|side| (links[side][1] != NONE, *side));
    let mut seen = rustc_hash::FxHashSet::default();
    let mut chains = Vec::new();
    for start in sides {
        if !seen.insert(start) {
            continue;
        }
        let (mut chain, mut next) = (vec![start], links[&start][0]);
        while next != NONE && seen.insert(next) {
            let before = chain[chain.len() - 1];
            chain.push(next);
            let [a, b] = links[&next];
            next = if a == before { b } else { a };
        }
        chains.push((chain, links[&start][1] != NONE));
    }
    chains
}

/// A shore as a line; `None` where it is too small.
fn line(crossings: &[Crossing], closed: bool, cell: DVec2) -> Option<SurfaceLine> {
    let at: Vec<DVec2> = crossings.iter().map(|crossing| crossing.place()).collect();
    let edges: Range<usize> = if closed { 0..at.len() } else { 1..at.len() };
    let before = |i: usize| at[(i + at.len() - 1) % at.len()];
    let cells: f64 = edges.clone().map(|i| before(i).distance(at[i])).sum();
    let area: f64 = edges.clone().map(|i| before(i).perp_dot(at[i])).sum::<f64>() / 2.0;
    if at.len() < 2 || if closed { area.abs() < LEAST_AREA } else { cells < LEAST_LENGTH } {
        return None;
    }
    let length: f64 = edges.map(|i| ((at[i] - before(i)) * cell).length()).sum();
    let point =
        |at: &DVec2| SurfacePoint { at: *at, across: [f32::INFINITY; 3], length: length as f32, drop: f32::INFINITY };
    let points = at.iter().map(point).collect();
    Some(SurfaceLine { kind: LineKind::Shore, order: 1, points, closed, joins: None })
}
