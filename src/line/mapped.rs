//! The lines of a page on the map: visible runs as polylines on the surface, with heights of the land.
//!
//! Places on the map are those of the chains; heights are those of the surface of the DEM without exaggeration, laid on it
//! ([`Drape`]) so that the lines lie on it between their points too: what a page simplifies, its facets included, is no matter here.
//! Orders of streams are those of the nearest lines of the land. Cost: some points for each cell that a line passes.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Line as Segment};
use rstar::{PointDistance, RTree};

use super::{Chain, ChainPoint, Id, Land, Line, Lines};
use crate::error::Result;
use crate::relief::LineKind;
use crate::surface::{Drape, Surface};

/// How far a line may leave the surface, cells.
const TOLERANCE: f64 = 0.003;
/// How far from a line of the land a chain of it may run, cells: it bends between its points.
const OF_LINE: f64 = 1.0;
/// Points of a chain that are asked which line of the land they are of.
const ASKED: usize = 16;

/// A run of a line without a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct MappedLine {
    /// What it draws.
    pub line: Line,
    /// The chain that it is of.
    pub id: Option<Id>,
    /// Which run of that, from 0 on.
    pub piece: u32,
    /// Strahler's order of a stream, of an own line what its file says of its weight.
    pub order: Option<u8>,
    /// Metres of the world without exaggeration; at least two, of a closed line the last is the first.
    pub points: Vec<DVec3>,
}

impl MappedLine {
    /// Metres along it.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Metres from a place of the world without exaggeration to its nearest point.
    pub fn distance(&self, from: DVec3) -> f64 {
        self.points.iter().map(|point| point.distance(from)).fold(f64::INFINITY, f64::min)
    }
}

/// What of seen lines is drawn, on a surface without exaggeration; `land` are the lines on it.
///
/// # Errors
/// As [`Surface::part`].
pub fn mapped(lines: &Lines, land: Option<&Land>, surface: &Surface) -> Result<Vec<MappedLine>> {
    let cell = surface.dem().cell().min_element();
    let orders = Orders::of(land, OF_LINE * cell);
    let of_chain = |chain: &Chain| -> Result<Vec<MappedLine>> {
        let drape = Drape::new(surface, TOLERANCE * cell);
        let (line, order) = (chain.line(), orders.order(chain));
        let runs = (0..).zip(runs(chain)).map(|(piece, run)| {
            let points = drape.line(&run)?;
            Ok(MappedLine { line, id: chain.id, piece, order, points })
        });
        runs.collect()
    };
    let mapped: Result<Vec<Vec<MappedLine>>> = match surface.dem().is_parallel() {
        true => lines.chains.par_iter().map(of_chain).collect(),
        false => lines.chains.iter().map(of_chain).collect(),
    };
    Ok(mapped?.into_iter().flatten().filter(|mapped| mapped.points.len() > 1).collect())
}

/// The parts of a chain that have weight, on the map.
fn runs(chain: &Chain) -> Vec<Vec<DVec2>> {
    let mut points: Vec<&ChainPoint> = chain.points.iter().collect();
    let blank = points.iter().position(|point| point.weight <= 0.0);
    if chain.closed {
        points.rotate_left(blank.unwrap_or(0));
        points.extend(points.first().copied());
    }
    let parts = points.chunk_by(|a, b| a.weight > 0.0 || b.weight > 0.0);
    let drawn = parts.filter(|part| part.len() > 1);
    drawn.map(|part| part.iter().map(|point| point.world.truncate()).collect()).collect()
}

/// A piece of a line of the land, with what draws that and its order.
type LandPiece = GeomWithData<Segment<[f64; 2]>, (Line, u8, usize)>;

/// Orders of lines of the land, by where they run.
struct Orders {
    pieces: RTree<LandPiece>,
    /// How far off one is no longer the same line, metres.
    reach: f64,
}

impl Orders {
    fn of(land: Option<&Land>, reach: f64) -> Self {
        let mut pieces = Vec::new();
        for (number, (line, world)) in land.into_iter().flat_map(Land::iter).enumerate() {
            let kind = match line.kind {
                LineKind::Drainage => Line::Drainage,
                LineKind::Own(layer) => Line::Own(layer),
                LineKind::Shore | LineKind::Ridge => continue,
            };
            let closing = line.closed.then(|| [world[world.len() - 1], world[0]]);
            let pairs = world.windows(2).map(|pair| [pair[0], pair[1]]).chain(closing);
            let piece = |pair: [DVec3; 2]| {
                let [from, to] = pair.map(|end| end.truncate().to_array());
                LandPiece::new(Segment::new(from, to), (kind, line.order, number))
            };
            pieces.extend(pairs.map(piece));
        }
        Self { pieces: RTree::bulk_load(pieces), reach }
    }

    /// The order of the line of the land that a chain runs along: that to which most of some of its points are nearest.
    fn order(&self, chain: &Chain) -> Option<u8> {
        let line = chain.line();
        if !matches!(line, Line::Drainage | Line::Own(_)) {
            return None;
        }
        let every = chain.points.len().div_ceil(ASKED);
        let nearest = |point: &ChainPoint| {
            let at = point.world.truncate().to_array();
            let near = self.pieces.nearest_neighbor_iter(at).find(|piece| piece.data.0 == line)?;
            (near.distance_2(&at) <= self.reach * self.reach).then_some((near.data.2, near.data.1))
        };
        // Its ends may lie as near to what it joins.
        let inner = chain.points.iter().skip(every / 2).step_by(every);
        let mut votes: Vec<(usize, u8)> = inner.filter_map(nearest).collect();
        votes.sort_unstable();
        votes.chunk_by(|a, b| a == b).max_by_key(|votes| votes.len()).map(|votes| votes[0].1)
    }
}
