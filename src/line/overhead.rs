//! The lines of a DEM as seen from straight above: a plan, orthographic, true to scale.
//!
//! These are its rims, the border of the DEM and of its voids, and lines on its land. Method: rim edges are laid so that the land lies on
//! their left, and followed from end to end; where four of them meet at a sample, the sharpest turn to the left keeps land
//! that touches by a corner apart. Heights play no part there, nor does exaggeration. Lines on
//! the land are [shown](super::detail) as far as the scale shows their relief, and give way to stronger ones. Cost: some look-ups for each rim edge.

use glam::{DVec2, DVec3, UVec2};
use rustc_hash::FxHashMap;

use super::detail::{From, Land};
use super::hachures::{self, Viewer};
use super::identity::{Held, key, names};
use super::laid::{check_length, on_lattice};
use super::simplify::needed;
use super::tone::toned;
use super::way::{LandWay, WayPoint};
use super::{Chain, ChainPoint, Economy, Id, Line, Lines, Recession, economised};
use crate::dem::Dem;
use crate::error::{Result, Setting};
use crate::message;
use crate::plan::Hachures;
use crate::surface::rim::{RimEdge, rim};

/// Points that lie within this of the rest are left out, px: those between two corners.
const STRAIGHT: f64 = 1e-6;

/// A sample, by column and row.
type Sample = [u32; 2];

/// A frame over the land.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overhead {
    /// Metres of the world, its middle in the middle of the frame: west, south, east and north.
    pub area: [f64; 4],
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Pixels for each metre.
    pub px_per_metre: f64,
}

impl Overhead {
    /// The plan of a DEM: its rims.
    ///
    /// # Errors
    /// As [`Dem::survey`].
    pub fn lines(&self, dem: &Dem) -> Result<Lines> {
        let ([west, .., north], cell, [width, height]) = (dem.extent(), dem.cell(), self.size);
        let point = |[column, row]: Sample| {
            let world = DVec2::new(west + f64::from(column) * cell.x, north - f64::from(row) * cell.y);
            let (place, line, world) = (self.place(world), Line::Border, world.extend(0.0));
            ChainPoint { place, line, depth: 1.0, behind: 0.0, world, crowd: 0, weight: 1.0, black: 1.0 }
        };
        let chain = |ring: Vec<Sample>| {
            let id = Id(u64::from(ring[0][1]) << 32 | u64::from(ring[0][0]));
            let mut points: Vec<ChainPoint> = ring.iter().map(|sample| point(*sample)).collect();
            points.push(points[0]);
            let places: Vec<DVec3> = points.iter().map(|point| point.place.extend(0.0)).collect();
            let kept = needed(&places, STRAIGHT);
            Chain { id: Some(id), points: kept[..kept.len() - 1].iter().map(|i| points[*i]).collect(), closed: true }
        };
        Ok(Lines {
            width,
            height,
            eye: self.middle().extend(f64::INFINITY),
            chains: rings(&rim(dem)?).into_iter().map(chain).collect(),
            hidden: Vec::new(),
            recession: Recession::of(std::iter::once((1.0, 1.0))),
            own: Vec::new(),
        })
    }

    /// Lines on the land, `min_gap` px apart, and hachures.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) where they are longer than those of a view may be; as [`hachures::hatched`].
    pub fn land(&self, land: &Land, min_gap: f64, hachures: Option<&Hachures>) -> Result<Vec<Chain>> {
        let lines: Vec<LandWay> =
            land.ways(From::Above(self.px_per_metre)).into_iter().flat_map(|way| self.about(way)).collect();
        let strokes = match land.slopes().zip(hachures) {
            Some((slopes, look)) => hachures::hatched(slopes, look, Viewer::Above(self))?.ways,
            None => Vec::new(),
        };
        let length = |way: &LandWay| {
            way.points.windows(2).map(|pair| (pair[1].world - pair[0].world).truncate().length()).sum::<f64>()
        };
        let px = lines.iter().chain(&strokes).map(length).sum::<f64>() * self.px_per_metre;
        check_length(px as usize, message!["use ", Setting::Scale.with_value(), " with a larger N"])?;
        let lines = economised(&self.chains(&lines), &Economy { min_jump: 0.0, min_gap });
        let strokes = hachures.map_or(Vec::new(), |look| toned(self.chains(&strokes), &lines, look));
        Ok([lines, strokes].concat())
    }

    /// The parts of a way on the page and a little beside it.
    fn about(&self, way: LandWay) -> Vec<LandWay> {
        let LandWay { line, mut points, closed } = way;
        points.extend(closed.then(|| points[0]));
        let is_beside = |pair: &[WayPoint]| {
            let [a, b] = [pair[0], pair[1]].map(|end| end.world.truncate());
            self.is_beside([a.min(b), a.max(b)])
        };
        let beside: Vec<bool> = points.windows(2).map(is_beside).collect();
        if closed && beside.iter().all(|is_beside| !is_beside) {
            points.pop();
            return vec![LandWay { line, points, closed }];
        }
        let mut first = 0;
        let part = |steps: &[bool]| {
            let from = first;
            first += steps.len();
            (!steps[0]).then(|| LandWay { line, points: points[from..=first].to_vec(), closed: false })
        };
        beside.chunk_by(|a, b| a == b).filter_map(part).collect()
    }

    /// Whether nothing in a box of the map, by its low and high corner, plays a part on the page.
    pub(super) fn is_beside(&self, [low, high]: [DVec2; 2]) -> bool {
        let ([west, south, east, north], beside) = (self.area, hachures::BESIDE / self.px_per_metre);
        low.x > east + beside || high.x < west - beside || low.y > north + beside || high.y < south - beside
    }

    fn middle(&self) -> DVec2 {
        let [west, south, east, north] = self.area;
        DVec2::new(west + east, south + north) / 2.0
    }

    /// The chains of lines on the land, as strong as they are shown.
    fn chains(&self, ways: &[LandWay]) -> Vec<Chain> {
        let chain = |way: &LandWay| {
            let point = |&WayPoint { world, weight, black, .. }: &WayPoint| {
                let place = self.place(world.truncate());
                ChainPoint { place, line: way.line, depth: 1.0, behind: 1.0, world, crowd: 0, weight, black }
            };
            let points: Vec<ChainPoint> = way.points.iter().map(point).collect();
            let holds = |(pair, point): (&[ChainPoint], &WayPoint)| {
                let step = pair[1].place - pair[0].place;
                Held { key: key(on_lattice(point.at), step), length: step.length() }
            };
            let held = points.windows(2).zip(&way.points).map(holds).collect::<Vec<_>>();
            (Chain { id: None, points, closed: way.closed }, held)
        };
        let (mut chains, held): (Vec<Chain>, Vec<_>) = ways.iter().map(chain).unzip();
        chains.iter_mut().zip(names(&held)).for_each(|(chain, id)| chain.id = id.map(Id::of_land));
        chains
    }

    /// Where a place of the world stands, px.
    pub(super) fn place(&self, world: DVec2) -> DVec2 {
        let frame = UVec2::from(self.size).as_dvec2() / 2.0;
        frame + (world - self.middle()) * DVec2::new(1.0, -1.0) * self.px_per_metre
    }
}

/// Rim edges as rings of samples, land on the left as seen from above, in the order of their first samples.
fn rings(rim: &[RimEdge]) -> Vec<Vec<Sample>> {
    let mut edges: Vec<[Sample; 2]> = rim.iter().map(directed).collect();
    edges.sort_unstable_by_key(|[[column, row], to]| (*row, *column, *to));
    let mut leaving: FxHashMap<Sample, Vec<usize>> = FxHashMap::default();
    for (i, [from, _]) in edges.iter().enumerate() {
        leaving.entry(*from).or_default().push(i);
    }
    // Counted clockwise from the way back: the land to the left lies between.
    let turn = |way: [Sample; 2], next: &usize| {
        let [back, on] = [clockwise(way[1], way[0]), clockwise(edges[*next][0], edges[*next][1])];
        (on + 7 - back) % 8
    };
    let next = |i: usize| leaving.get(&edges[i][1])?.iter().copied().min_by_key(|next| turn(edges[i], next));
    let mut is_done = vec![false; edges.len()];
    let mut rings = Vec::new();
    for first in 0..edges.len() {
        let mut at = Some(first);
        let mut ring = Vec::new();
        while let Some(i) = at.filter(|i| !is_done[*i]) {
            is_done[i] = true;
            ring.push(edges[i][0]);
            at = next(i);
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// An edge from its start to its end, the patch that has it on its left.
fn directed(edge: &RimEdge) -> [Sample; 2] {
    let [column, row] = edge.sample;
    // A patch goes round NW, SW, SE or NW, SE, NE.
    let (end, leads_back) = match (edge.direction, edge.half) {
        (0, half) => ([column + 1, row], half == 1),
        (1, half) => ([column, row + 1], half == 1),
        (_, half) => ([column + 1, row + 1], half == 0),
    };
    if leads_back { [end, edge.sample] } else { [edge.sample, end] }
}

/// The direction from a sample to one beside it: 0 north, 1 north-east, 2 east … 7 north-west.
fn clockwise(from: Sample, to: Sample) -> usize {
    match [0, 1].map(|axis| i64::from(to[axis]) - i64::from(from[axis])) {
        [0, -1] => 0,
        [1, -1] => 1,
        [1, 0] => 2,
        [1, 1] => 3,
        [0, 1] => 4,
        [-1, 1] => 5,
        [-1, 0] => 6,
        _ => 7,
    }
}
