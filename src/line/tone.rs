//! How broad hachures are, once it is known what of them the eye sees: as broad as makes their tone.
//!
//! Of the paper between a stroke and those beside it half belongs to it, and the share of black of that is its width: by the gap
//! that is there, not by that which was wanted, and by how much of the strokes about it runs out or is cut. A stroke ends half a
//! spacing short of silhouettes and lines of the land that lie no farther than it does, is a little finer at its top, and runs out
//! at its foot. All measures are continuous in the places
//! of strokes: those that come or go take their share of the paper as they get their width.
//!
//! Source: Lehmann (1799) for widths by gaps. Cost: a look at what lies within two spacings of each piece of stroke. Does not
//! handle: strokes that cross.

use std::f32::consts::PI;

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
/// Most paper that belongs to a stroke, gaps: at the rim of what is hatched there is no more ink for the bare land beside it.
const MOST_PAPER: f64 = 1.5;
/// A stroke finds more ink about it than there is, for it is there itself: so much more, on cones.
const OWN: f64 = 1.07;
/// Cosine of the angle to a stroke from which it runs beside: 40 degrees.
const BESIDE: f32 = 0.77;
/// Strokes whose ln depth differs by more lie on other land.
const OTHER_LAND: f32 = 0.2;
/// Distances from a line up to which a stroke is left out, and from which it is whole, spacings.
const SHORT_OF: [f64; 2] = [0.3, 0.7];
/// A line this much farther than a stroke, in ln depth, does not stop it.
const IN_FRONT: f32 = 0.02;
/// Lengths over which strokes broaden at their tops and run out at their feet, spacings; at most these parts of the stroke.
const TAPER: [f64; 2] = [0.4, 1.4];
const MOST_TAPER: [f64; 2] = [0.15, 0.35];
/// By how much of the share that is to be black tapers are shorter: in deep shadow strokes run into each other.
const DARK: f64 = 0.95;

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
pub(crate) fn toned(strokes: Vec<Chain>, lines: &[Chain], look: &Hachures) -> Vec<Chain> {
    let longest = (STEP * look.least_apart()).max(LEAST_STEP);
    let lines: Vec<Chain> = lines.par_iter().map(|chain| stepped(chain, longest)).collect();
    let lines = Passing::new(&lines, SHORT_OF[1] * look.spacing);
    let shaped = |stroke: &Chain| shaped(stepped(stroke, longest), &lines, look);
    let strokes: Vec<Chain> = strokes.par_iter().map(shaped).collect();
    let others = Passing::new(&strokes, REACH * look.spacing);
    let toned = |(number, stroke): (usize, &Chain)| widened(number as u32, stroke, &others, look);
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

/// A stroke as strong as it is shown, short of lines and run out at its ends.
fn shaped(stroke: Chain, lines: &Passing, look: &Hachures) -> Chain {
    let along = Along::new(&stroke);
    let apart: Vec<f64> = stroke.points.iter().map(|point| look.apart(point.black.into())).collect();
    let mean = apart.iter().sum::<f64>() / apart.len().max(1) as f64;
    let black = stroke.points.iter().map(|point| f64::from(point.black)).sum::<f64>() / apart.len().max(1) as f64;
    let taper = [0, 1].map(|end| {
        let wanted = TAPER[end] * mean * (1.0 - DARK * black);
        wanted.min(MOST_TAPER[end] * along.length).max(f64::MIN_POSITIVE)
    });
    let own = samples(0, &stroke);
    let short = fade(look.shortest.map(|spacings| spacings * mean), along.length);
    let point = |(i, point): (usize, &ChainPoint)| {
        let [top, foot] = [along.arcs[i] / taper[0], (along.length - along.arcs[i]) / taper[1]];
        let shape = short * runs_out(top) * runs_out(foot) * room(&own[i], lines, apart[i]);
        ChainPoint { weight: point.weight * shape as f32, ..*point }
    };
    Chain { points: stroke.points.iter().enumerate().map(point).collect(), ..stroke }
}

/// The stroke as broad as makes its tone among the others.
fn widened(number: u32, stroke: &Chain, others: &Passing, look: &Hachures) -> Chain {
    let along = Along::new(stroke);
    let own = samples(number, stroke);
    let paper =
        |(sample, point): (&Sample, &ChainPoint)| [paper(sample, others, look.apart(point.black.into()), look.spacing)];
    let papers: Vec<[f64; 1]> = own.iter().zip(&stroke.points).map(paper).collect();
    let papers = along.averaged(&papers, look.spacing);
    let point = |(point, [paper]): (&ChainPoint, &[f64; 1])| {
        let width = f64::from(point.weight) * f64::from(point.black) * paper / look.broadest;
        ChainPoint { weight: width.min(1.0) as f32, ..*point }
    };
    Chain { points: stroke.points.iter().zip(&papers).map(point).collect(), ..*stroke }
}

/// Width at a share of a taper.
fn runs_out(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * (2.0 - t)
}

/// The paper that belongs to a stroke, across, px: half of what lies between it and its neighbours, and a share of what lies before
/// the ends of strokes about it, for these run out.
fn paper(sample: &Sample, others: &Passing, apart: f64, spacing: f64) -> f64 {
    let (alone, reach) = ((ALONE * apart) as f32, (REACH * spacing) as f32);
    let (mut sides, mut density) = ([alone; 2], 0.0);
    for other in others.about(sample.place) {
        if (sample.log_depth - other.log_depth).abs() > OTHER_LAND {
            continue;
        }
        let to = other.place - sample.place;
        // Length of full strokes on a square px, the nearer the more.
        let near = (1.0 - to.length_squared() / (reach * reach)).max(0.0);
        density += other.weight * 2.0 * other.half * near * near * 3.0 / (PI * reach * reach);
        let is_beside = other.chain != sample.chain
            && sample.along.dot(to).abs() <= other.half + sample.half
            && sample.along.dot(other.along).abs() >= BESIDE;
        if is_beside {
            let across = sample.along.perp_dot(to);
            let side = &mut sides[usize::from(across > 0.0)];
            *side = side.min(alone + (across.abs() - alone).min(0.0) * other.weight);
        }
    }
    let gap = f64::midpoint(sides[0].into(), sides[1].into());
    (OWN / f64::from(density.max(f32::MIN_POSITIVE))).clamp(gap, MOST_PAPER * gap)
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
