//! What of chains lies nearest to a place of the page.
//!
//! Cost: a look at each point.

use glam::DVec2;

use super::along::between;
use super::{Chain, ChainPoint};

/// The nearest place of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Near {
    /// Which chain of those that were looked at.
    pub chain: usize,
    /// What it is there, as strong as the nearer of its two points.
    pub point: ChainPoint,
    /// How far off, px.
    pub px: f64,
}

/// The nearest place of each chain that comes within `reach` px of a place of the page, in the order of the chains.
pub(crate) fn near(chains: &[Chain], place: DVec2, reach: f64) -> Vec<Near> {
    let of_chain = |(number, chain): (usize, &Chain)| {
        let nearest = chain.pairs().map(|pair| nearest(pair, place)).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(point, px)| Near { chain: number, point, px })
    };
    chains.iter().enumerate().filter_map(of_chain).filter(|near| near.px <= reach).collect()
}

fn nearest([a, b]: [&ChainPoint; 2], place: DVec2) -> (ChainPoint, f64) {
    let share = share_nearest(a.place, b.place, place);
    let weight = if share < 0.5 { a.weight } else { b.weight };
    let point = ChainPoint { weight, ..between(a, b, share) };
    (point, point.place.distance(place))
}

/// The share of the way from `a` to `b` that lies nearest to a place.
pub(crate) fn share_nearest(a: DVec2, b: DVec2, place: DVec2) -> f64 {
    let way = b - a;
    let share = (place - a).dot(way) / way.length_squared();
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
}
