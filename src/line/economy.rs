//! Economy: which lines are drawn, and how strongly.
//!
//! "Parsimonious use of linework" (Mower 2015): a line says that something lies behind, and says it only where there is
//! room. Method: each point of a chain has a weight from 0 to 1, the product of three fades: by its jump, how much farther
//! than the line lies what is behind it; by the length of line about it; by its [`clearance`] from
//! stronger lines. Strength goes by jump, length and kind. Measures are averaged along the chain, so that a line fades
//! over some pixels where they leap; the skyline has weight 1 and yields to no one. Every step is continuous in place and
//! jump: when the eye moves a little, weights change a little.
//!
//! Cost: some passes along each chain, and that of clearance. Does not handle: chains that fall apart or join from one
//! frame to the next, beyond what their length says.

use glam::{DVec2, FloatExt};
use rayon::prelude::*;

use super::along::{Along, fade, stepped};
use super::clearance::{self, Sample};
use super::{Chain, ChainPoint, Line};

/// Lengths of line, in gaps, up to which it is left out and from which it is whole.
const LENGTHS: [f64; 2] = [1.0, 4.0];
/// Length about a point to either side beyond which a line is no stronger for being longer, gaps.
const LONG: f64 = 20.0;
/// What length weighs beside jump in strength: a line of 4 gaps is as strong as a long one of half its jump.
const LENGTH_SHARE: f64 = 0.3;
/// What nearness weighs: of two lines at one distance and at twice that, the nearer is as strong as of 1.2 times the jump.
const DEPTH_SHARE: f64 = 0.3;
/// How much stronger than an occluding line of equal jump and length a border is, in ln jump.
const BORDER_RANK: f64 = 0.1;
/// How strong the skyline is; all else is below 0.1.
const SKYLINE_RANK: f64 = 1.0;
/// How much stronger a skyline is for being farther, for each unit of ln depth.
const SKYLINE_SHARE: f64 = 0.01;
/// How strong a line on the land is, and how much stronger one of full weight: all boundaries of the surface are stronger.
const LAND_RANK: f64 = -40.0;
const LAND_SHARE: f64 = 4.0;
/// How far a ridge keeps from a silhouette beside it, gaps: both say the same.
const RIDGE_BERTH: f32 = 2.5;
/// Where its jump or the sky ends, a line runs on whole for the first of these and fades until the second, gaps.
const RUN_OUT: [f64; 2] = [1.0, 3.0];
/// Along a chain, directions are averaged over about the first of these to either side, jumps over the second, gaps.
const SOFT: [f64; 2] = [1.0, 1.0];
/// Averages of 0 and 1 up to which all is 0, and from which all is 1.
const TAILS: [f64; 2] = [0.05, 0.95];
/// Least length of either, px: what lies behind is known by pixels, and trembles by as much.
const LEAST_SOFT: [f64; 2] = [1.5, 3.0];
/// Least length to run on, px.
const LEAST_RUN: f64 = 1.5;
/// Longest piece of a chain between two points with weights: gaps, and px where the gap is small. Longer ones miss where a line
/// has room beside it or none: it would be drawn as points happen to lie.
const STEP: f64 = 0.5;
const LEAST_STEP: f64 = 1.0;
/// Least unit of lengths, px.
const LEAST_GAP: f64 = 0.1;

/// How sparing lines are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Economy {
    /// Distance of what lies behind a line over its own, less 1: up to this a line is left out, from twice this on it is
    /// drawn whole. 0 draws all.
    pub min_jump: f64,
    /// Of two lines nearer to each other than this the weaker yields, px. 0 leaves all their place.
    pub min_gap: f64,
}

/// The chains with weights, and with more points between those far from each other.
pub fn economised(chains: &[Chain], economy: &Economy) -> Vec<Chain> {
    let (mut chains, samples) = sampled(chains, economy);
    let weights = clearance::weights(&samples.concat(), economy.min_gap as f32);
    let points = chains.iter_mut().flat_map(|chain| &mut chain.points);
    points.zip(weights).for_each(|(point, weight)| point.weight = weight);
    chains
}

/// The chains with more points between those far from each other, and all these by their own merit.
pub(super) fn sampled(chains: &[Chain], economy: &Economy) -> (Vec<Chain>, Vec<Vec<Sample>>) {
    let longest = (STEP * economy.min_gap).max(LEAST_STEP);
    let chains: Vec<Chain> = chains.par_iter().map(|chain| stepped(chain, longest)).collect();
    let samples = |(i, chain): (usize, &Chain)| samples(chain, i as u32, economy);
    let samples = chains.par_iter().enumerate().map(samples).collect();
    (chains, samples)
}

/// How long a line about a point counts, px, and the lengths up to which it is left out and from which it is whole.
pub(super) fn lengths(chain: &Chain, i: usize, economy: &Economy) -> (f64, [f64; 2]) {
    let unit = unit(economy);
    (long(&Along::new(chain), i, unit), LENGTHS.map(|gaps| gaps * unit))
}

/// Lengths are told in gaps, were they ever so narrow.
fn unit(economy: &Economy) -> f64 {
    economy.min_gap.max(LEAST_GAP)
}

fn long(along: &Along, i: usize, unit: f64) -> f64 {
    along.reach(i, LONG * unit).max(unit / 2.0)
}

/// A chain's points by their own merit; `index` tells it from others.
pub(super) fn samples(chain: &Chain, index: u32, economy: &Economy) -> Vec<Sample> {
    let Economy { min_jump, min_gap } = *economy;
    let along = Along::new(chain);
    let soft = [0, 1].map(|what| (SOFT[what] * min_gap).max(LEAST_SOFT[what]));
    let runs_out = RUN_OUT.map(|gaps| (gaps * min_gap).max(LEAST_RUN));
    let direction = |i: usize| along.direction(i).to_array();
    let directions: Vec<_> = (0..chain.points.len()).map(direction).collect();
    let directions = along.averaged(&directions, soft[0]);
    let is_of_land = chain.line().is_of_land();
    let measures = |point: &ChainPoint| {
        if is_of_land {
            return [point.weight.into(), LAND_RANK + LAND_SHARE * f64::from(point.weight)];
        }
        let by_jump = if min_jump > 0.0 { fade([min_jump, 2.0 * min_jump], point.jump()) } else { 1.0 };
        [by_jump, rank(point, min_jump)]
    };
    let measures: Vec<_> = chain.points.iter().map(measures).collect();
    let measures = along.averaged(&measures, soft[1]);
    let by_jump: Vec<f64> = match is_of_land {
        true => chain.points.iter().map(|point| point.weight.into()).collect(),
        // Averages have long tails.
        false => {
            let by_jump: Vec<f64> = measures.iter().map(|measures| fade(TAILS, measures[0])).collect();
            along.spread(&by_jump, runs_out)
        }
    };
    let is_skyline =
        |i: usize| f64::from(u8::from(along.draws(i, |point| point.behind == 0.0 && !point.line.is_of_land())));
    let skyline: Vec<f64> = (0..chain.points.len()).map(is_skyline).collect();
    let skyline = along.spread(&skyline, runs_out);
    let unit = unit(economy);
    let sample = |(i, point): (usize, &ChainPoint)| {
        let long = long(&along, i, unit);
        let by_length = fade(LENGTHS.map(|gaps| gaps * unit), long);
        let rank = measures[i][1] + LENGTH_SHARE * (long / (2.0 * LONG * unit)).ln();
        // Of skylines the farthest is the true one.
        let rank_of_sky = SKYLINE_RANK - SKYLINE_SHARE * point.log_depth();
        Sample {
            place: point.place.as_vec2(),
            along: DVec2::from(directions[i]).normalize_or_zero().as_vec2(),
            half: along.half(i) as f32,
            chain: index,
            arc: along.arcs[i] as f32,
            round: if chain.closed { along.length as f32 } else { f32::INFINITY },
            end: along.end(i) as f32,
            rank: rank.lerp(rank_of_sky, skyline[i]) as f32,
            alone: (by_jump[i] * by_length).lerp(1.0, skyline[i]) as f32,
            skyline: skyline[i] as f32,
            log_depth: point.log_depth() as f32,
            berth: if point.line == Line::Ridge { RIDGE_BERTH } else { 1.0 },
            bounds: !is_of_land,
        }
    };
    chain.points.iter().enumerate().map(sample).collect()
}

/// Strength by jump and kind, as a logarithm: of the share of the way to what is behind that lies beyond the line, which is
/// the jump where that is small and 1 for sky.
fn rank(point: &ChainPoint, min_jump: f64) -> f64 {
    let kind = if point.line == Line::Border { BORDER_RANK } else { 0.0 };
    // What falls under half the least jump is not drawn.
    kind + DEPTH_SHARE * point.log_depth() + point.relief().max(min_jump / 2.0).max(1e-6).ln()
}
