//! How far a mask is from truth. Definitions: precision is the share of inked pixels whose centre lies within k + 0.5 px of
//! a piece of truth, recall the share of truth's length within k + 0.5 px of an inked centre, F their harmonic mean.
//!
//! Truth's length runs to and fro where a line lies aslant to the grid; its pixels do not: recall by pixels is the share of the
//! pixels of truth, drawn one pixel wide, that have ink within k + 0.5 px, centre to centre. Chains have figures of their
//! own: [`ChainScores`].
//!
//! Distances are exact, from an R-tree of pieces and one of inked centres. Cost: a microsecond a pixel and a piece. A
//! share of nothing is whole: without ink precision is 1, recall and F are 0.

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::Line as Segment;
use rstar::{PointDistance, RTree};

pub use self::chains::ChainScores;
use super::{Mask, Truth, TruthPiece};

mod chains;

/// Distances k at which [`Scores::at`] holds figures, px.
pub const DISTANCES: [f64; 4] = [0.5, 1.0, 2.0, 3.0];
/// Half a pixel is added to every distance: a line through a pixel lies that far from its centre.
const HALF: f64 = 0.5;
/// The distance of gaps and bands, px.
const WITHIN: f64 = 1.0 + HALF;
/// Ink wholly farther from truth is spurious, px.
const SPURIOUS: f64 = 2.0 + HALF;
/// Missed truth pixels that make a gap.
const GAP: usize = 3;
/// 8-connected sets with fewer pixels are fragments.
pub const FRAGMENT: usize = 6;
/// Bands of depth, a third of truth's length each.
const BANDS: usize = 3;

/// Precision, recall and F.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Share of ink near truth.
    pub precision: f64,
    /// Share of truth near ink.
    pub recall: f64,
}

impl Agreement {
    /// Harmonic mean of the two.
    pub fn f(&self) -> f64 {
        let sum = self.precision + self.recall;
        if sum > 0.0 { 2.0 * self.precision * self.recall / sum } else { 0.0 }
    }
}

/// How far a mask is from truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Scores {
    /// At each of [`DISTANCES`].
    pub at: [Agreement; DISTANCES.len()],
    /// At 1 px in bands of depth: near, middle, far.
    pub bands: [BandScore; BANDS],
    /// 8-connected sets of at least 3 missed truth pixels.
    pub gaps: usize,
    /// 8-connected sets of ink wholly farther than 2.5 px from truth.
    pub spurious: usize,
    /// Mean of the two directed mean distances, px; `None` without ink.
    pub chamfer: Option<f64>,
    /// Larger of the two directed 95 % distances, px; `None` without ink.
    pub h95: Option<f64>,
    /// Share of 8-connected sets of ink with fewer than 6 pixels.
    pub fragments: f64,
    /// Share of the pixels of truth, drawn one pixel wide, that have ink within 1 px.
    pub pixel_recall: f64,
}

impl Scores {
    /// The agreement at 1 px.
    pub fn agreement(&self) -> Agreement {
        self.at[1]
    }
}

/// A band of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandScore {
    /// Metres along the view axis where it ends; infinite for the last.
    pub to: f64,
    /// Length of its truth, px.
    pub length: f64,
    /// Its inked pixels.
    pub inked: usize,
    /// Its ink against all truth, its truth against all ink.
    pub agreement: Agreement,
}

/// Distances of places from truth, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offsets {
    /// Mean.
    pub mean: f64,
    /// Half are no farther.
    pub median: f64,
    /// 95 % are no farther.
    pub p95: f64,
}

/// Truth ready to judge masks.
pub struct Judge<'a> {
    truth: &'a Truth,
    lines: RTree<Segment<[f64; 2]>>,
    /// Truth drawn one pixel wide.
    drawn: Mask,
    /// Where bands of depth end, metres; all but the last.
    bands: [f64; BANDS - 1],
}

impl<'a> Judge<'a> {
    /// `None` where no line is on the page: then there is nothing to judge by.
    pub fn new(truth: &'a Truth) -> Option<Self> {
        let segment = |piece: &TruthPiece| Segment::new(piece.ends[0].to_array(), piece.ends[1].to_array());
        let mut depths: Vec<_> = truth.on_page().map(|piece| (piece.distance, piece.length())).collect();
        let length = truth.length();
        depths.sort_by(|a, b| a.0.total_cmp(&b.0));
        let bands = [1.0, 2.0].map(|k| quantile(&depths, k / BANDS as f64 * length));
        let lines = RTree::bulk_load(truth.pieces.iter().map(segment).collect());
        (length > 0.0).then(|| Self { truth, lines, drawn: Mask::of_truth(truth), bands })
    }

    /// Distance of a place on the page from the nearest line, px.
    pub fn distance(&self, place: DVec2) -> f64 {
        let place = place.to_array();
        self.lines.nearest_neighbor(place).map_or(f64::INFINITY, |line| line.distance_2(&place).sqrt())
    }

    /// Distances of places from truth; `None` without places.
    pub fn offsets(&self, places: &[DVec2]) -> Option<Offsets> {
        let distances: Vec<_> = places.par_iter().map(|place| (self.distance(*place), 1.0)).collect();
        summary(distances)
    }

    /// Measures a mask of the same page against truth, and truth against the mask.
    pub fn measure<'m>(&'m self, mask: &'m Mask) -> Measured<'m> {
        let centres = RTree::bulk_load(mask.inked.iter().map(|p| p.centre().to_array()).collect());
        let to_ink = |piece: &&TruthPiece| {
            let middle = piece.middle().to_array();
            centres.nearest_neighbor(middle).map_or(f64::INFINITY, |centre| centre.distance_2(&middle).sqrt())
        };
        let pieces: Vec<&TruthPiece> = self.truth.on_page().collect();
        Measured {
            judge: self,
            mask,
            to_truth: mask.inked.par_iter().map(|p| self.distance(p.centre())).collect(),
            to_ink: pieces.par_iter().map(to_ink).collect(),
            pieces,
        }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl<'a> Judge<'a> {
    /// Distances of the pieces of another truth from this one, by length; `None` where it has none on the page.
    pub fn offsets_of(&self, other: &Truth) -> Option<Offsets> {
        let pieces: Vec<_> = other.on_page().collect();
        let distances = pieces.par_iter().map(|piece| (self.distance(piece.middle()), piece.length()));
        summary(distances.collect())
    }
}

/// A mask and truth with their distances from each other.
pub struct Measured<'a> {
    judge: &'a Judge<'a>,
    mask: &'a Mask,
    /// Of each inked pixel, px.
    to_truth: Vec<f64>,
    pieces: Vec<&'a TruthPiece>,
    /// Of each piece, px; infinite without ink.
    to_ink: Vec<f64>,
}

impl Measured<'_> {
    /// Every figure.
    pub fn scores(&self) -> Scores {
        let (chamfer, h95) = match (summary(self.ink(|_| true)), summary(self.lines(|_| true))) {
            (Some(ink), Some(line)) => (Some((ink.mean + line.mean) / 2.0), Some(ink.p95.max(line.p95))),
            _ => (None, None),
        };
        let far = |component: &&Vec<usize>| component.iter().all(|&i| self.to_truth[i] > SPURIOUS);
        let gaps = self.missed().components();
        Scores {
            at: DISTANCES.map(|k| self.agreement(k + HALF, |_| true)),
            bands: [0, 1, 2].map(|band| self.band(band)),
            gaps: gaps.iter().filter(|component| component.len() >= GAP).count(),
            spurious: self.mask.components().iter().filter(far).count(),
            chamfer,
            h95,
            fragments: self.mask.fragments(FRAGMENT),
            pixel_recall: self.judge.drawn.beside(self.mask),
        }
    }

    /// Whether each inked pixel lies within 1 px of truth, in the order of the mask.
    pub fn agrees(&self) -> impl Iterator<Item = bool> {
        self.to_truth.iter().map(|distance| *distance <= WITHIN)
    }

    fn band(&self, band: usize) -> BandScore {
        let ends = &self.judge.bands;
        let holds = |distance: f64| ends.iter().filter(|end| distance > **end).count() == band;
        BandScore {
            to: ends.get(band).copied().unwrap_or(f64::INFINITY),
            length: sum(self.lines(holds).iter().map(|(_, length)| *length)),
            inked: self.ink(holds).len(),
            agreement: self.agreement(WITHIN, holds),
        }
    }

    /// Within so many px, of ink and lines at depths that `holds`.
    fn agreement(&self, within: f64, holds: impl Fn(f64) -> bool) -> Agreement {
        Agreement {
            precision: share_within(within, &self.ink(&holds)),
            recall: share_within(within, &self.lines(&holds)),
        }
    }

    /// Distances of inked pixels at depths that `holds`, each of weight 1.
    fn ink(&self, holds: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
        let inked = self.mask.inked.iter().zip(&self.to_truth).filter(|(p, _)| holds(p.distance));
        inked.map(|(_, distance)| (*distance, 1.0)).collect()
    }

    /// Distances of pieces at depths that `holds`, each of the weight of its length.
    fn lines(&self, holds: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
        let pieces = self.pieces.iter().zip(&self.to_ink).filter(|(p, _)| holds(p.distance));
        pieces.map(|(piece, distance)| (*distance, piece.length())).collect()
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Measured<'_> {
    /// The pixels of truth, drawn one pixel wide, that have no ink within 1 px.
    pub fn missed(&self) -> Mask {
        let missed = self.pieces.iter().zip(&self.to_ink).filter(|(_, distance)| **distance > WITHIN);
        Mask::of_pieces(self.mask.size, missed.map(|(piece, _)| *piece))
    }
}

/// 0 of nothing, where `Iterator::sum` has -0.
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |sum, value| sum + value)
}

/// Share of the weights whose distance is at most `within`; 1 of nothing.
fn share_within(within: f64, weighted: &[(f64, f64)]) -> f64 {
    let all = sum(weighted.iter().map(|(_, weight)| *weight));
    let near = sum(weighted.iter().filter(|(distance, _)| *distance <= within).map(|(_, weight)| *weight));
    if all > 0.0 { near / all } else { 1.0 }
}

/// Of weighted distances; `None` of nothing.
fn summary(mut weighted: Vec<(f64, f64)>) -> Option<Offsets> {
    let all: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    let mean = weighted.iter().map(|(distance, weight)| distance * weight).sum::<f64>() / all;
    weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [median, p95] = [0.5, 0.95].map(|share| quantile(&weighted, share * all));
    (all > 0.0).then_some(Offsets { mean, median, p95 })
}

/// The least value up to which the weights of sorted values add up to `weight`; 0 of nothing.
fn quantile(sorted: &[(f64, f64)], weight: f64) -> f64 {
    let mut sum = 0.0;
    let reached = sorted.iter().find(|(_, w)| {
        sum += w;
        sum >= weight
    });
    reached.or(sorted.last()).map_or(0.0, |(value, _)| *value)
}
