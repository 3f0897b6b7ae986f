//! How far chains are from truth: polylines on the page, no pixels between.
//!
//! A chain is looked at every quarter pixel of its length on the page. Precision is the share of its length within 1 px of a
//! piece of truth, recall the share of truth's length within 1 px of a chain: of lines, without the half pixel that is
//! added for the centres of pixels. Distances are exact, from R-trees of pieces and of the chains' sides. Cost: a microsecond
//! a look and a piece of truth.

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::Line as Segment;
use rstar::{PointDistance, RTree};

use super::{Agreement, Judge, Offsets, share_within, sum, summary};
use crate::truth::TruthPiece;
use crate::view::cut::{Step, steps};

/// Lines within this of each other agree, px.
const AGREES: f64 = 1.0;
/// Shorter chains are short, px.
const SHORT: f64 = 6.0;

/// How far chains are from truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainScores {
    /// Chains on the page.
    pub count: usize,
    /// Their length on the page, px.
    pub length: f64,
    /// Share of them with less than 6 px of length on the page; 0 without chains.
    pub short: f64,
    /// Distances from truth, by length; `None` of chains without length.
    pub offsets: Option<Offsets>,
    /// Within 1 px.
    pub agreement: Agreement,
}

impl Judge<'_> {
    /// Measures chains on the same page: the corners of each, px, of a closed one the first again at its end; a dot is one
    /// corner.
    pub fn measure_chains(&self, chains: &[Vec<DVec2>]) -> ChainScores {
        let looks: Vec<Vec<(DVec2, f64)>> = chains.par_iter().map(|chain| self.looks(chain)).collect();
        let looks: Vec<_> = looks.into_iter().filter(|looks| !looks.is_empty()).collect();
        let short = looks.iter().filter(|looks| sum(looks.iter().map(|(_, length)| *length)) < SHORT).count();
        let offset = |(place, length): &(DVec2, f64)| (self.distance(*place), *length);
        let offsets: Vec<_> = looks.par_iter().flat_map_iter(|looks| looks.iter().map(offset)).collect();
        let agreement = Agreement { precision: share_within(AGREES, &offsets), recall: self.recalled(chains) };
        ChainScores {
            count: looks.len(),
            length: sum(offsets.iter().map(|(_, length)| *length)),
            short: short as f64 / looks.len().max(1) as f64,
            offsets: summary(offsets),
            agreement,
        }
    }

    /// Where a chain is looked at on the page, and how much of its length each look stands for.
    fn looks(&self, chain: &[DVec2]) -> Vec<(DVec2, f64)> {
        let of_side = |[a, b]: [DVec2; 2]| {
            let look = move |step: Step| (a.lerp(b, step.middle), step.length);
            steps(self.truth.size, a, b).map(look)
        };
        sides(chain).flat_map(of_side).collect()
    }

    /// Share of truth's length within 1 px of a chain.
    pub(crate) fn recalled(&self, chains: &[Vec<DVec2>]) -> f64 {
        let segment = |[a, b]: [DVec2; 2]| Segment::new(a.to_array(), b.to_array());
        let lines = RTree::bulk_load(chains.iter().flat_map(|chain| sides(chain)).map(segment).collect());
        let to_chain = |piece: &&TruthPiece| {
            let middle = piece.middle().to_array();
            let nearest = lines.nearest_neighbor(middle);
            (nearest.map_or(f64::INFINITY, |line| line.distance_2(&middle).sqrt()), piece.length())
        };
        let pieces: Vec<&TruthPiece> = self.truth.on_page().collect();
        share_within(AGREES, &pieces.par_iter().map(to_chain).collect::<Vec<_>>())
    }
}

/// The straight sides of a chain; of a dot one without length.
fn sides(chain: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    let dot = chain.first().filter(|_| chain.len() == 1).map(|place| [*place; 2]);
    chain.windows(2).map(|pair| [pair[0], pair[1]]).chain(dot)
}
