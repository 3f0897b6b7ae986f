//! The drawn surface below a way over the map: its height at stations, and the highest it gets from one to the next.
//!
//! The way is followed in chords of at most half a cell. Each is cut with every facet of the level whose cell lies within one
//! cell of it, for patches bend sideways: along a chord a facet is a straight line, so that the highest of its cut's ends is
//! the highest of it, and nothing between samples is missed. By as much as the way bows out beside the chord the steepest of
//! the facets may be higher: that is added. Cost: the facets of each cell near the way, once, and about sixteen cells a
//! chord. Not handled: land that drivers round higher (micrometres), and a station in a void has no height.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::curve::Curve;
use crate::error::Result;
use crate::surface::lattice::CELL_STEPS;
use crate::surface::{LatticePoint, Level, Surface};

/// Most stations along a way.
const MOST_STATIONS: f64 = 262_144.0;
/// Chords that one thread follows, and samples are read for, at once.
const TOGETHER: usize = 64;
/// Vertices that are kept of cells passed.
const KEPT_VERTICES: usize = 1 << 18;
/// What the bow of a way is more than at its middle, at most.
const BOW: f64 = 1.5;
/// Facets hold their own edges, whatever is rounded.
const EDGE: f64 = 1e-9;

/// Heights of the ground along a way, exaggerated metres.
#[derive(Debug, Clone)]
pub(super) struct Ground {
    /// At stations equally far apart from the start to the end; `None` over voids and outside.
    pub stations: Vec<Option<f64>>,
    /// The highest from each station to the next.
    pub peaks: Vec<Option<f64>>,
}

/// A stretch of the way, and what is below it.
#[derive(Debug, Clone, Copy, Default)]
struct Below {
    start: Option<f64>,
    end: Option<f64>,
    peak: Option<f64>,
}

impl Ground {
    /// Below a way.
    ///
    /// # Errors
    /// As [`Surface::part`], of a surface whose samples stay in their file.
    pub(super) fn below(curve: &Curve, surface: &Surface, level: Level) -> Result<Self> {
        let length = curve.length();
        let step = surface.dem().cell().min_element() / 2.0;
        let count = (length / step).ceil().clamp(1.0, MOST_STATIONS);
        let chords = (length / count / step).ceil().max(1.0);
        let ways = Ways { curve, chord: length / (count * chords), level };
        let all = (count * chords) as usize;
        let groups: Vec<_> = (0..all).step_by(TOGETHER).map(|first| first..(first + TOGETHER).min(all)).collect();
        // Files are read in order, on this thread.
        let below: Vec<Vec<Below>> = match surface.dem().is_filed() {
            true => groups.into_iter().map(|group| ways.below(surface, group)).collect::<Result<_>>()?,
            false => groups.into_par_iter().map(|group| ways.below(surface, group)).collect::<Result<_>>()?,
        };
        let below: Vec<Below> = below.concat();
        let between = below.chunks(chords as usize);
        let peaks =
            between.clone().map(|chords| chords.iter().filter_map(|below| below.peak).reduce(f64::max)).collect();
        let starts = between.filter_map(|chords| Some(chords.first()?.start));
        let stations = starts.chain(below.last().map(|below| below.end)).collect();
        Ok(Self { stations, peaks })
    }

    /// Heights at the stations, straight over what has none; `None` where none has.
    pub(super) fn filled(&self) -> Option<Vec<f64>> {
        let known: Vec<(usize, f64)> =
            self.stations.iter().enumerate().filter_map(|(i, height)| Some((i, (*height)?))).collect();
        let height = |i: usize| {
            let next = known.partition_point(|(at, _)| *at < i);
            match (next.checked_sub(1).and_then(|before| known.get(before)), known.get(next)) {
                (Some((a, low)), Some((b, high))) => Some(low + (high - low) * (i - a) as f64 / (b - a) as f64),
                (Some((_, height)), None) | (None, Some((_, height))) => Some(*height),
                (None, None) => None,
            }
        };
        (0..self.stations.len()).map(height).collect()
    }
}

/// Chords of a way over a surface of a level.
struct Ways<'a> {
    curve: &'a Curve,
    /// Metres of each.
    chord: f64,
    level: Level,
}

impl Ways<'_> {
    fn below(&self, surface: &Surface, chords: Range<usize>) -> Result<Vec<Below>> {
        let places: Vec<DVec2> = (chords.start..=chords.end).map(|i| self.curve.place(i as f64 * self.chord)).collect();
        let part;
        let surface = match surface.dem().is_filed() {
            true => {
                let Some([first, size]) = window(surface, &places) else {
                    return Ok(vec![Below::default(); chords.len()]);
                };
                part = surface.part(first, size)?;
                &part
            }
            false => surface,
        };
        let mut cells = Cells { surface, level: self.level, vertices: BTreeMap::new() };
        let middles = chords.map(|i| self.curve.place((i as f64 + 0.5) * self.chord));
        Ok(places.windows(2).zip(middles).map(|(ends, middle)| cells.below([ends[0], middle, ends[1]])).collect())
    }
}

/// First sample and size of what facets within a cell of these places depend on; `None` outside.
fn window(surface: &Surface, places: &[DVec2]) -> Option<[[usize; 2]; 2]> {
    let dem = surface.dem();
    let size = [dem.columns(), dem.rows()];
    let at: Vec<DVec2> = places.iter().map(|place| dem.grid_place(*place).floor()).collect();
    let low = at.iter().copied().reduce(DVec2::min)? - 1.0;
    let high = at.iter().copied().reduce(DVec2::max)? + 3.0;
    let first = [0, 1].map(|i| low[i].clamp(0.0, size[i] as f64) as usize);
    let end = [0, 1].map(|i| high[i].clamp(0.0, size[i] as f64) as usize);
    (0..2).all(|i| first[i] < end[i]).then(|| [first, [0, 1].map(|i| end[i] - first[i])])
}

/// Cells of a surface as they are passed.
struct Cells<'a> {
    surface: &'a Surface,
    level: Level,
    /// Of a cell, by column and row, row by row.
    vertices: BTreeMap<[u32; 2], Vec<Option<DVec3>>>,
}

impl Cells<'_> {
    /// Below a stretch from the first of three places over the second to the third.
    fn below(&mut self, [from, middle, to]: [DVec2; 3]) -> Below {
        let bow = BOW * middle.distance((from + to) / 2.0);
        let dem = self.surface.dem();
        let ends = [dem.grid_place(from), dem.grid_place(to)];
        let cells = [dem.columns(), dem.rows()].map(|samples| samples as f64 - 1.0);
        let low = (ends[0].min(ends[1]).floor() - 1.0).max(DVec2::ZERO);
        let high = ends[0].max(ends[1]).floor() + 2.0;
        let range = |i: usize| low[i] as u32..high[i].clamp(low[i].min(cells[i]), cells[i]) as u32;
        let (mut below, mut steepest) = (Below::default(), 0.0_f64);
        let higher = |a: Option<f64>, b: f64| Some(a.map_or(b, |a| a.max(b)));
        for (column, row) in range(1).flat_map(|row| range(0).map(move |column| (column, row))) {
            self.facets([column, row], [from, to], &mut |facet| {
                let Some(([first, last], [low, high], slope)) = cut(facet, from, to) else { return };
                below.peak = higher(below.peak, low.max(high));
                steepest = steepest.max(slope);
                if first <= 0.0 {
                    below.start = higher(below.start, low);
                }
                if last >= 1.0 {
                    below.end = higher(below.end, high);
                }
            });
        }
        below.peak = below.peak.map(|peak| peak + bow * steepest);
        below
    }

    /// Hands over the facets of a cell that may lie below a chord.
    fn facets(&mut self, cell: [u32; 2], [from, to]: [DVec2; 2], take: &mut impl FnMut([DVec3; 3])) {
        let (n, step) = (self.level.subdivisions(), self.level.step());
        if self.vertices.len() * ((n + 1) * (n + 1)) as usize > KEPT_VERTICES {
            self.vertices.clear();
        }
        let surface = self.surface;
        let vertices = self.vertices.entry(cell).or_insert_with(|| {
            let [x, y] = cell.map(|at| at * CELL_STEPS);
            let at = |i: u32| LatticePoint { x: x + i % (n + 1) * step, y: y + i / (n + 1) * step };
            (0..(n + 1) * (n + 1)).map(|i| surface.position(at(i))).collect()
        });
        let (low, high) = (from.min(to), from.max(to));
        let vertex = |i: u32, j: u32| vertices[(j * (n + 1) + i) as usize];
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            for [b, c] in [[(0, 1), (1, 1)], [(1, 1), (1, 0)]] {
                let corners = [vertex(i, j), vertex(i + b.0, j + b.1), vertex(i + c.0, j + c.1)];
                let [Some(p), Some(q), Some(r)] = corners else { continue };
                let (least, most) = (p.min(q).min(r).truncate(), p.max(q).max(r).truncate());
                if least.cmple(high).all() && most.cmpge(low).all() {
                    take([p, q, r]);
                }
            }
        }
    }
}

/// The shares of a chord at which it enters and leaves a facet, its heights there, and how steep it is; `None` beside it.
fn cut([p, q, r]: [DVec3; 3], from: DVec2, to: DVec2) -> Option<([f64; 2], [f64; 2], f64)> {
    let (u, v) = (q.truncate() - p.truncate(), r.truncate() - p.truncate());
    let area = u.perp_dot(v);
    let shares = |place: DVec2| {
        let w = place - p.truncate();
        let (b, c) = (w.perp_dot(v) / area, u.perp_dot(w) / area);
        [1.0 - b - c, b, c]
    };
    let (start, end) = (shares(from), shares(to));
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (a, b) in start.into_iter().zip(end) {
        let (a, b) = (a + EDGE, b + EDGE);
        if a < 0.0 && b < 0.0 {
            return None;
        }
        if a < 0.0 {
            first = first.max(a / (a - b));
        } else if b < 0.0 {
            last = last.min(a / (a - b));
        }
    }
    let height = |t: f64| {
        let [_, b, c] = [0, 1, 2].map(|i| start[i] + (end[i] - start[i]) * t);
        p.z + (q.z - p.z) * b + (r.z - p.z) * c
    };
    let slope = DVec2::new((q.z - p.z) * v.y - (r.z - p.z) * u.y, (r.z - p.z) * u.x - (q.z - p.z) * v.x) / area;
    (first <= last && area != 0.0).then(|| ([first, last], [height(first), height(last)], slope.length()))
}
