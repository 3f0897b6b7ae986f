//! How broad hachures are, once it is known what of them the eye sees: as broad as makes their tone.
//!
//! Of the paper between a stroke and those beside it half belongs to it, and the share of black of that is its width: by the gap
//! that is there, not by that which was wanted. A stroke ends half a spacing short of silhouettes and lines of the land that lie
//! no farther than it does, and is a little finer at its top, and runs out at its foot. All measures are continuous in the places
//! of strokes: those that come or go take their share of the paper as they get their width.
//!
//! Source: Lehmann (1799) for widths by gaps. Cost: a look at what lies within two spacings of each piece of stroke. Does not
//! handle: strokes that cross.

use glam::Vec2;
use rayon::prelude::*;

use super::along::{Along, fade, stepped};
use super::cells::Cells;
use super::{Chain, ChainPoint};
use crate::plan::Hachures;

/// Longest piece of a stroke between two looks, spacings, and px where that is small.
const STEP: f64 = 0.5;
const LEAST_STEP: f64 = 1.0;
/// Farthest neighbour, and the paper to one side of a stroke without one, spacings.
const REACH: f64 = 2.0;
const ALONE: f64 = 1.3;
/// Cosine of the angle to a stroke from which it runs beside: 40 degrees.
const BESIDE: f32 = 0.77;
/// Strokes whose ln depth differs by more lie on other land.
const OTHER_LAND: f32 = 0.2;
/// Distances from a line up to which a stroke is left out, and from which it is whole, spacings.
const SHORT_OF: [f64; 2] = [0.3, 0.7];
/// A line this much farther than a stroke, in ln depth, does not stop it.
const IN_FRONT: f32 = 0.02;
/// Lengths over which strokes broaden at their tops and run out at their feet, spacings; of short ones at most half.
const TAPER: [f64; 2] = [0.5, 2.0];

/// A place on the page where a stroke or a line passes.
#[derive(Debug, Clone, Copy)]
struct Sample {
    place: Vec2,
    /// Unit vector along.
    along: Vec2,
    /// Half its length, px.
    half: f32,
    log_depth: f32,
    weight: f32,
    chain: u32,
}

/// The strokes of hachures with their widths as shares of the broadest stroke, beside the lines of a page.
pub fn toned(strokes: Vec<Chain>, lines: &[Chain], look: &Hachures) -> Vec<Chain> {
    let longest = (STEP * look.least_apart()).max(LEAST_STEP);
    let strokes: Vec<Chain> = strokes.par_iter().map(|chain| stepped(chain, longest)).collect();
    let others = Passing::new(&strokes, REACH * look.spacing);
    let lines: Vec<Chain> = lines.par_iter().map(|chain| stepped(chain, longest)).collect();
    let lines = Passing::new(&lines, SHORT_OF[1] * look.spacing);
    let toned = |(chain, stroke): (usize, &Chain)| toned_stroke(chain as u32, stroke, &others, &lines, look);
    strokes.par_iter().enumerate().map(toned).collect()
}

/// Places of lines, to look up what is near.
struct Passing {
    samples: Vec<Sample>,
    cells: Cells,
}

impl Passing {
    fn new(chains: &[Chain], reach: f64) -> Self {
        let samples = |(number, chain): (usize, &Chain)| samples(number as u32, chain);
        let samples: Vec<Sample> = chains.par_iter().enumerate().flat_map_iter(samples).collect();
        let places: Vec<Vec2> = samples.iter().map(|sample| sample.place).collect();
        let longest = samples.iter().map(|sample| sample.half).fold(0.0, f32::max);
        let cells = Cells::new(&places, reach as f32 + longest);
        // Neighbours on the page are neighbours in memory.
        let samples = cells.list.iter().map(|&i| samples[i as usize]).collect();
        Self { samples, cells }
    }

    fn about(&self, place: Vec2) -> impl Iterator<Item = &Sample> {
        self.cells.about(place).flat_map(|range| &self.samples[range])
    }
}

fn samples(number: u32, chain: &Chain) -> Vec<Sample> {
    let along = Along::new(chain);
    let sample = |(i, point): (usize, &ChainPoint)| Sample {
        place: point.place.as_vec2(),
        along: along.direction(i).normalize_or_zero().as_vec2(),
        half: along.half(i) as f32,
        log_depth: point.log_depth() as f32,
        weight: point.weight,
        chain: number,
    };
    chain.points.iter().enumerate().map(sample).collect()
}

fn toned_stroke(number: u32, stroke: &Chain, others: &Passing, lines: &Passing, look: &Hachures) -> Chain {
    let along = Along::new(stroke);
    let own = samples(number, stroke);
    let apart: Vec<f64> = stroke.points.iter().map(|point| look.apart(point.black.into())).collect();
    let gaps: Vec<[f64; 1]> = own.iter().zip(&apart).map(|(sample, apart)| [gap(sample, others, *apart)]).collect();
    let mean = apart.iter().sum::<f64>() / apart.len().max(1) as f64;
    let gaps = along.averaged(&gaps, mean);
    let taper = TAPER.map(|spacings| (spacings * mean).min(along.length / 2.0).max(f64::MIN_POSITIVE));
    let point = |(i, point): (usize, &ChainPoint)| {
        let [top, foot] = [along.arcs[i] / taper[0], (along.length - along.arcs[i]) / taper[1]];
        let ends = runs_out(top) * runs_out(foot);
        let width = f64::from(point.black) * gaps[i][0] / look.broadest;
        let weight = f64::from(point.weight) * room(&own[i], lines, apart[i]) * width * ends;
        ChainPoint { weight: weight.min(1.0) as f32, ..*point }
    };
    Chain { points: stroke.points.iter().enumerate().map(point).collect(), ..*stroke }
}

/// Width at a share of a taper.
fn runs_out(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * (2.0 - t)
}

/// The paper that belongs to a stroke, across, px: half of what lies between it and its neighbours.
fn gap(sample: &Sample, others: &Passing, apart: f64) -> f64 {
    let alone = (ALONE * apart) as f32;
    let mut sides = [alone; 2];
    for other in others.about(sample.place) {
        let to = other.place - sample.place;
        let across = sample.along.perp_dot(to);
        let is_beside = other.chain != sample.chain
            && sample.along.dot(to).abs() <= other.half + sample.half
            && sample.along.dot(other.along).abs() >= BESIDE
            && (sample.log_depth - other.log_depth).abs() <= OTHER_LAND;
        if is_beside {
            let side = &mut sides[usize::from(across > 0.0)];
            *side = side.min(alone + (across.abs() - alone).min(0.0) * other.weight);
        }
    }
    f64::from(sides[0] + sides[1]) / 2.0
}

/// How far a stroke is clear of lines in front of it, 0 to 1.
fn room(sample: &Sample, lines: &Passing, apart: f64) -> f64 {
    let pressed = |line: &Sample| {
        let to = line.place - sample.place;
        // To the nearest place of its piece.
        let off = line.along * (-line.along.dot(to)).clamp(-line.half, line.half);
        let is_in_front = line.log_depth >= sample.log_depth - IN_FRONT;
        let distance = f64::from((to + off).length());
        if is_in_front {
            f64::from(line.weight.min(1.0)) * (1.0 - fade(SHORT_OF.map(|s| s * apart), distance))
        } else {
            0.0
        }
    };
    1.0 - lines.about(sample.place).map(pressed).fold(0.0, f64::max)
}
