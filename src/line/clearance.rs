//! Clearance: of two lines that run side by side too near each other the weaker yields.
//!
//! Method: samples of lines are taken from the strongest to the weakest; each yields to the one that presses hardest of
//! those before it: `its weight * how near * how parallel * how much stronger`, every factor continuous and 0 where the
//! rule begins, so that neither the order of samples nor the cut of lines into samples shows. A line that has faded presses
//! no one. Lines that cross or end on each other, and what follows along one line, do not run side by side.
//!
//! The skyline yields to no one. But a raster sees no land between two crests a pixel apart: of two with sky behind them that
//! run side by side, the surface on the same hand, the nearer has land behind it, and yields. Chains run with their surface
//! on the left, as [curves](super::curve) do.
//!
//! Source: the rule of halftoning by strokes (Salisbury et al. 1994: a stroke is drawn where the page has room), here
//! without its order of arrival. Cost: a look at the samples within the gap. Does not
//! handle: many weak lines beside a strong one that press no harder than one of them.

use glam::Vec2;

use super::cells::Cells;

/// Samples differ in rank by this where the weaker yields wholly: a factor of 1.3 in jump.
const RANK: f32 = 0.25;
/// Cosines of the angle between two lines up to which they cross, and from which they run side by side: 60 and 30 degrees.
const SIDE_BY_SIDE: [f32; 2] = [0.5, 0.866];
/// Differences in ln depth up to which a skyline is the same, and from which the farther one says that the nearer has land
/// behind it, not sky.
const COVERED: [f32; 2] = [0.0005, 0.002];
/// What lies ahead on the line's own way counts as this many times as far: it is not beside.
const AHEAD: f32 = 2.0;
/// Along one line, gaps between samples up to which they are neighbours, and from which they are strangers.
const STRANGERS: [f32; 2] = [3.0, 6.0];

/// A piece of a line, about straight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Its middle on the page, px.
    pub place: Vec2,
    /// Unit vector along the line.
    pub along: Vec2,
    /// Half its length, px.
    pub half: f32,
    /// Which chain it is of.
    pub chain: u32,
    /// Where on the chain it is, px from its start.
    pub arc: f32,
    /// Length of the chain where it is closed, else infinite, px.
    pub round: f32,
    /// To the nearer end of the chain, px; infinite where it is closed.
    pub end: f32,
    /// How strong it is: the higher yields not to the lower.
    pub rank: f32,
    /// Its weight where it is alone, 0 to 1.
    pub alone: f32,
    /// How far it is skyline, 0 to 1: that share yields to no one.
    pub skyline: f32,
    /// ln depth: larger is nearer.
    pub log_depth: f32,
    /// How far it keeps from lines that bound the surface, in gaps.
    pub berth: f32,
    /// Whether it bounds the surface.
    pub bounds: bool,
}

/// Weights of samples whose lines keep `gap` px apart, 0 to 1, in the order of the samples.
pub(crate) fn weights(samples: &[Sample], gap: f32) -> Vec<f32> {
    let widest = samples.iter().map(|sample| sample.berth).fold(1.0, f32::max);
    let longest = samples.iter().map(|sample| sample.half).fold(0.0, f32::max);
    let places: Vec<Vec2> = samples.iter().map(|sample| sample.place).collect();
    let cells = Cells::new(&places, gap * widest + longest);
    // Neighbours on the page are neighbours in memory.
    let sorted: Vec<Sample> = cells.list.iter().map(|&i| samples[i as usize]).collect();
    let mut order: Vec<u32> = (0..sorted.len() as u32).filter(|&i| sorted[i as usize].alone > 0.0).collect();
    order.sort_unstable_by(|&a, &b| sorted[b as usize].rank.total_cmp(&sorted[a as usize].rank).then(a.cmp(&b)));
    let mut weights = vec![0.0; sorted.len()];
    for i in order {
        let sample = &sorted[i as usize];
        // Those to come have no weight yet.
        let harder = |pressure: f32, j: usize| match weights[j] > pressure {
            true => pressure.max(weights[j] * sample.pressed_by(&sorted[j], gap)),
            false => pressure,
        };
        let pressure = if gap > 0.0 { cells.about(sample.place).flatten().fold(0.0, harder) } else { 0.0 };
        weights[i as usize] = sample.alone * (1.0 - pressure);
    }
    let mut given = vec![0.0; samples.len()];
    cells.list.iter().zip(weights).for_each(|(&i, weight)| given[i as usize] = weight);
    given
}

/// Which sample presses one of them hardest, and how hard, 0 to 1, where all have these weights: the one that it yields to.
pub(crate) fn presses(samples: &[Sample], weights: &[f32], i: usize, gap: f32) -> Option<(usize, f32)> {
    let sample = &samples[i];
    // Weaker ones had no weight yet when it yielded.
    let stronger = |j: &usize| *j != i && samples[*j].rank >= sample.rank && weights[*j] > 0.0;
    let press = |j: usize| (j, weights[j] * sample.pressed_by(&samples[j], gap));
    let pressing = (0..samples.len()).filter(stronger).map(press).filter(|(_, pressure)| *pressure > 0.0);
    // Of those that press alike the nearest.
    let apart = |j: usize| samples[j].place.distance(sample.place);
    let hardest = pressing.max_by(|a, b| a.1.total_cmp(&b.1).then_with(|| apart(b.0).total_cmp(&apart(a.0))));
    hardest.filter(|_| gap > 0.0)
}

impl Sample {
    /// How hard a stronger sample of full weight presses, 0 to 1.
    fn pressed_by(&self, other: &Self, gap: f32) -> f32 {
        // Most of what is near goes on along the same line.
        let strange = self.strangeness(other, gap);
        if strange <= 0.0 {
            return 0.0;
        }
        let to = self.way_to(other);
        let keeps = if other.bounds { gap * self.berth } else { gap };
        let nearer = 1.0 - smoothstep([keeps / 2.0, keeps], to.length());
        let cos = self.along.dot(other.along);
        let stronger = smoothstep([0.0, RANK], other.rank - self.rank) * smoothstep(SIDE_BY_SIDE, cos.abs());
        // The surface lies on the left, what is behind on the right.
        let outside = smoothstep([gap / 8.0, gap * 0.375], to.y) * smoothstep(SIDE_BY_SIDE, cos);
        let covered = other.skyline * outside * smoothstep(COVERED, self.log_depth - other.log_depth);
        strange * nearer * (stronger + (covered - stronger) * self.skyline)
    }

    /// The shortest way on the page to the other piece: along the line, counted as farther than it is, and to its right; px.
    fn way_to(&self, other: &Self) -> Vec2 {
        let own = |v: Vec2| Vec2::new(v.dot(self.along) * AHEAD, self.along.perp_dot(v));
        let (to, half) = (own(other.place - self.place), own(other.along * other.half));
        let t = (-to.dot(half) / half.length_squared().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
        to + half * t
    }

    /// 0 for neighbours along one line and for the ends of two, which go on into each other; 1 for samples of two lines.
    fn strangeness(&self, other: &Self, gap: f32) -> f32 {
        if self.chain != other.chain {
            return smoothstep([gap / 4.0, gap], self.end.max(other.end));
        }
        let arc = (self.arc - other.arc).abs();
        smoothstep(STRANGERS.map(|gaps| gaps * gap), arc.min(self.round - arc))
    }
}

/// 0 up to the first edge, 1 from the second on, smooth between.
pub(crate) fn smoothstep([low, high]: [f32; 2], x: f32) -> f32 {
    let t = ((x - low) / (high - low).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
