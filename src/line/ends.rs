//! Which ends of chains are free: neither on another line, behind which this one goes on, nor at the edge of the page.
//!
//! Cost: a look among the nearest pieces of line for each end.

use glam::DVec2;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Line as Piece};

use super::{Chain, Line};

/// How near to a line an end lies on it, px.
const ON_LINE: f64 = 1.5;
/// Least weight of a line on which others end.
const LEAST_WEIGHT: f32 = 0.25;
/// Along its own chain an end lies on what is at least this far away, px.
const ALONG: f64 = 6.0;

/// For each chain of a page of so many pixels across and down, whether its first and its last point are free ends. A closed
/// one has none, nor has a hachure. What bounds the surface ends on nothing that lies on the land: its strokes are the same with and without.
pub fn free(chains: &[Chain], [width, height]: [u32; 2]) -> Vec<[bool; 2]> {
    let page = DVec2::new(width.into(), height.into());
    let drawn: Vec<Line> = chains.iter().map(Chain::line).collect();
    // Hachures have ends of their own.
    let lines = chains.iter().enumerate().filter(|(index, _)| drawn[*index] != Line::Hachure);
    let tree = RTree::bulk_load(lines.flat_map(|(index, chain)| pieces(index, chain)).collect());
    let of_land: Vec<bool> = drawn.iter().map(|line| line.is_of_land()).collect();
    let is_free = |index: usize, backward: bool| {
        let chain = &chains[index];
        let Some(end) = (if backward { chain.points.last() } else { chain.points.first() }) else { return false };
        let at = end.place;
        let on_edge = at.cmplt(DVec2::splat(ON_LINE)).any() || at.cmpgt(page - ON_LINE).any();
        let mut near = tree.locate_within_distance(at.to_array(), ON_LINE * ON_LINE);
        let length = chain.length();
        let own_way = |arc: f64| if backward { length - arc } else { arc };
        let is_other = |piece: &Of| {
            let counts = of_land[index] || !of_land[piece.data.0];
            counts && (piece.data.0 != index || own_way(piece.data.1) > ALONG)
        };
        drawn[index] != Line::Hachure && !chain.closed && !on_edge && !near.any(is_other)
    };
    (0..chains.len()).map(|index| [false, true].map(|backward| is_free(index, backward))).collect()
}

/// A piece of line, of which chain it is, and how far along that it lies, px.
type Of = GeomWithData<Piece<[f64; 2]>, (usize, f64)>;

fn pieces(index: usize, chain: &Chain) -> Vec<Of> {
    let mut arc = 0.0;
    let piece = |[a, b]: [&super::ChainPoint; 2]| {
        arc += a.place.distance(b.place);
        let middle = arc - a.place.distance(b.place) / 2.0;
        let shown = a.weight.max(b.weight) >= LEAST_WEIGHT;
        shown.then(|| GeomWithData::new(Piece::new(a.place.to_array(), b.place.to_array()), (index, middle)))
    };
    chain.pairs().filter_map(piece).collect()
}
