//! Economy: which lines are drawn, and how strongly.
//!
//! "Parsimonious use of linework" (Mower 2015): a line says that something lies behind, and says it only where there is
//! room. Method: each point of a chain has a weight from 0 to 1, the product of three fades: by its jump, how much farther
//! than the line lies what is behind it; by the length of line about it; by its [clearance](super::clearance) from
//! stronger lines. Strength goes by jump, length and kind. Measures are averaged along the chain, so that a line fades
//! over some pixels where they leap; the skyline has weight 1 and yields to no one. Every step is continuous in place and
//! jump: when the eye moves a little, weights change a little.
//!
//! Cost: 40 000 points in some 10 ms. Does not handle: chains that fall apart or join from one frame to the next, beyond
//! what their length says.

use glam::FloatExt;
use rayon::prelude::*;

use super::along::{Along, stepped};
use super::clearance::{self, Sample, smoothstep};
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
/// How far a line runs on where its jump ends or the sky does, of the length over which it is averaged.
const RUN_OUT: f64 = 3.0;
/// Along a chain, measures are averaged over about this many gaps to either side.
const SOFT: f64 = 1.0;
/// Longest piece of a chain between two points with weights: gaps, and px where the gap is small.
const STEP: f64 = 0.5;
const LEAST_STEP: f64 = 1.5;
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

impl Economy {
    /// Jumps under this say little of the land, as a share of the distance.
    pub const MIN_JUMP: f64 = 0.01;

    /// Gap on a page of 1600 px across, px; wider pages have wider pens and gaps, in proportion.
    pub const MIN_GAP: f64 = 3.0;

    /// The economy of a page this many pixels wide.
    pub fn for_page(width: u32) -> Self {
        Self { min_jump: Self::MIN_JUMP, min_gap: Self::MIN_GAP * f64::from(width) / 1600.0 }
    }
}

/// The chains with weights, and with more points between those far from each other.
pub fn economised(chains: &[Chain], economy: &Economy) -> Vec<Chain> {
    let longest = (STEP * economy.min_gap).max(LEAST_STEP);
    let mut chains: Vec<Chain> = chains.par_iter().map(|chain| stepped(chain, longest)).collect();
    let samples = |(i, chain): (usize, &Chain)| samples(chain, i as u32, economy);
    let samples: Vec<Vec<Sample>> = chains.par_iter().enumerate().map(samples).collect();
    let weights = clearance::weights(&samples.concat(), economy.min_gap as f32);
    let points = chains.iter_mut().flat_map(|chain| &mut chain.points);
    points.zip(weights).for_each(|(point, weight)| point.weight = weight);
    chains
}

/// A chain's points by their own merit; `index` tells it from others.
fn samples(chain: &Chain, index: u32, economy: &Economy) -> Vec<Sample> {
    let Economy { min_jump, min_gap } = *economy;
    let along = Along::new(chain);
    // Lengths are told in gaps, were they ever so narrow.
    let unit = min_gap.max(LEAST_GAP);
    let soft = (SOFT * min_gap).max(LEAST_STEP);
    let measures = |(i, point): (usize, &ChainPoint)| {
        let direction = along.direction(i);
        let by_jump = if min_jump > 0.0 { fade([min_jump, 2.0 * min_jump], point.jump()) } else { 1.0 };
        [by_jump, rank(point, min_jump), direction.x, direction.y]
    };
    let measured: Vec<_> = chain.points.iter().enumerate().map(measures).collect();
    let averaged = along.averaged(&measured, soft);
    // A line runs on for some pixels where its jump ends, and fades there.
    let jumps: Vec<f64> = averaged.iter().map(|measures| measures[0]).collect();
    let jumps = along.spread(&jumps, RUN_OUT * soft);
    let is_skyline = |i: usize| f64::from(u8::from(along.draws(i, |point| point.behind == 0.0)));
    let skylines: Vec<f64> = (0..jumps.len()).map(is_skyline).collect();
    let skylines = along.spread(&skylines, RUN_OUT * soft);
    let sample = |(i, point): (usize, &ChainPoint)| {
        let [_, by_rank, x, y] = averaged[i];
        let long = along.reach(i, LONG * unit).max(unit / 2.0);
        let by_jump = fade([0.0, 1.0], jumps[i]);
        let by_length = fade(LENGTHS.map(|gaps| gaps * unit), long);
        let skyline = fade([0.0, 1.0], skylines[i]);
        let by_length_rank = LENGTH_SHARE * (long / (2.0 * LONG * unit)).ln();
        // Of skylines the farthest is the true one.
        let by_sky = SKYLINE_RANK - SKYLINE_SHARE * point.log_depth();
        Sample {
            place: point.place.as_vec2(),
            along: glam::DVec2::new(x, y).normalize_or_zero().as_vec2(),
            half: along.half(i) as f32,
            chain: index,
            arc: along.arcs[i] as f32,
            round: if chain.closed { along.length as f32 } else { f32::INFINITY },
            rank: (by_rank + by_length_rank).lerp(by_sky, skyline) as f32,
            alone: 1.0.lerp(by_jump * by_length, 1.0 - skyline) as f32,
            skyline: skyline as f32,
            log_depth: point.log_depth() as f32,
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

/// 0 up to the first edge, 1 from the second on, smooth between.
fn fade([low, high]: [f64; 2], x: f64) -> f64 {
    f64::from(smoothstep([low as f32, high as f32], x as f32))
}
