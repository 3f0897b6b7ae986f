//! How high the eye is along its way: as asked, and never below the ground and its clearance.
//!
//! Heights above the ground are counted from a mean of it under a triangle (see `mean`), so that the eye does
//! not bob over every sample. Where that, or a height that was given, is lower than the ground and the clearance, the eye is
//! lifted by a smooth function that is nowhere less than what is missing: what is missing from each station to the next, the
//! highest of it within a window, and of that the mean over the same window (a dilation and then a mean no wider than it).
//! So the floor holds at every metre of the way, not at frames alone, and the lift has a slope without jumps; its bend is at
//! most four times what is missing over the square of the half window. Cost: four searches a height.

use super::curve::Curve;
use super::ground::Ground;
use super::mean::{Beyond, Pieces, beyond};
use super::monotone::Monotone;

/// What rounding may take from the clearance: metres.
const ROUNDED: f64 = 2e-6;

/// How the eye's height is given along its way.
#[derive(Debug, Clone)]
pub(super) enum Base {
    /// Exaggerated metres, by the moment.
    Given(Monotone),
    /// Above the smoothed ground, by the moment.
    AboveGround(Smooth, Monotone),
}

/// The ground, smoothed.
#[derive(Debug, Clone)]
pub(super) struct Smooth {
    pieces: Pieces,
    half: f64,
}

impl Smooth {
    /// The mean of the ground over `half` metres to both sides; `None` where there is no ground.
    pub(super) fn of(ground: &Ground, curve: &Curve, half: f64) -> Option<Self> {
        let (heights, length) = (ground.filled()?, curve.length());
        let step = length / (heights.len().max(2) - 1) as f64;
        let nodes: Vec<_> = heights.into_iter().enumerate().map(|(i, height)| (i as f64 * step, height)).collect();
        let how = if curve.is_closed() { Beyond::Again(0.0) } else { Beyond::Turned };
        Some(Self { pieces: Pieces::new(beyond(&nodes, length, how)), half: half.min(length / 2.0) })
    }

    /// Exaggerated metres.
    pub(super) fn at(&self, metres: f64) -> f64 {
        self.pieces.mean(metres, self.half)
    }

    /// How far it may lie below the lowest of both ends and the middle of a stretch of so many metres.
    fn dip(&self, step: f64) -> f64 {
        4.0 * self.pieces.range() / (self.half * self.half) * step * step / 32.0
    }
}

impl Base {
    /// Exaggerated metres at a moment, so many metres along the way.
    fn at(&self, moment: f64, metres: f64) -> f64 {
        match self {
            Self::Given(heights) => heights.at(moment),
            Self::AboveGround(ground, heights) => ground.at(metres) + heights.at(moment),
        }
    }

    /// The lowest it gets over a stretch of so many metres from moment to moment; `knots` are moments at which it may turn.
    fn lowest(&self, [from, to]: [f64; 2], [first, last]: [f64; 2], knots: &[f64]) -> f64 {
        let between =
            knots[knots.partition_point(|knot| *knot < first)..].iter().copied().take_while(|knot| *knot <= last);
        let moments = [first, last].into_iter().chain(between);
        match self {
            Self::Given(heights) => moments.map(|moment| heights.at(moment)).fold(f64::INFINITY, f64::min),
            Self::AboveGround(ground, heights) => {
                let above = moments.map(|moment| heights.at(moment)).fold(f64::INFINITY, f64::min);
                let ground_there =
                    [from, (from + to) / 2.0, to].map(|at| ground.at(at)).into_iter().fold(f64::INFINITY, f64::min);
                above + ground_there - ground.dip(to - from)
            }
        }
    }
}

/// Heights along a way.
#[derive(Debug, Clone)]
pub(super) struct Heights {
    base: Base,
    /// Nothing where none is missing.
    lift: Option<(Pieces, f64)>,
    /// Metres that are missing where most are.
    pub missing: f64,
    /// Whether there is ground anywhere below.
    pub over_land: bool,
}

impl Heights {
    /// Of a base over ground with so much clearance; `moments` are those at which the eye comes to and leaves a place so many
    /// metres along, `knots` those at which the base may turn, `half` the half window of lifts.
    pub(super) fn new(
        base: Base,
        ground: &Ground,
        curve: &Curve,
        clearance: f64,
        half: f64,
        moments: impl Fn(f64) -> [f64; 2],
        knots: &[f64],
    ) -> Self {
        let step = curve.length() / ground.peaks.len() as f64;
        let missing = ground.peaks.iter().enumerate().map(|(i, peak)| {
            let Some(peak) = peak else { return 0.0 };
            let (from, to) = (i as f64 * step, (i + 1) as f64 * step);
            let lowest = base.lowest([from, to], [moments(from)[0], moments(to)[1]], knots);
            (peak + clearance + ROUNDED - lowest).max(0.0)
        });
        let missing: Vec<f64> = missing.collect();
        let most = missing.iter().copied().fold(0.0, f64::max);
        let lift = (most > 0.0).then(|| {
            let reach = (half / step).ceil() as usize + 1;
            let highest = highest_within(&missing, reach, curve.is_closed());
            let nodes: Vec<_> = highest
                .iter()
                .enumerate()
                .flat_map(|(i, lift)| [(i as f64 * step, *lift), ((i + 1) as f64 * step, *lift)])
                .collect();
            match curve.is_closed() {
                true => (Pieces::new(beyond(&nodes, curve.length(), Beyond::Again(0.0))), half),
                false => (Pieces::new(nodes), half),
            }
        });
        Self { base, lift, missing: most, over_land: ground.peaks.iter().any(Option::is_some) }
    }

    /// Exaggerated metres at a moment, so many metres along the way.
    pub(super) fn at(&self, moment: f64, metres: f64) -> f64 {
        let lift = self.lift.as_ref().map_or(0.0, |(pieces, half)| pieces.mean(metres, *half));
        self.base.at(moment, metres) + lift
    }
}

/// The highest of the numbers up to `reach` places before and after each (van Herk 1992: running maxima of blocks, from
/// both sides), so that the cost does not grow with the window.
fn highest_within(numbers: &[f64], reach: usize, closed: bool) -> Vec<f64> {
    let (count, width) = (numbers.len(), 2 * reach + 1);
    let number = |i: usize| match (closed, i.checked_sub(reach)) {
        (true, _) => numbers[(i + count * (reach / count + 1) - reach) % count],
        (false, Some(i)) => numbers.get(i).copied().unwrap_or(0.0),
        (false, None) => 0.0,
    };
    let all = count + 2 * reach;
    let (mut before, mut after) = (vec![0.0; all], vec![0.0; all]);
    for i in 0..all {
        before[i] = if i % width == 0 { number(i) } else { number(i).max(before[i - 1]) };
    }
    for i in (0..all).rev() {
        after[i] = if i + 1 == all || (i + 1) % width == 0 { number(i) } else { number(i).max(after[i + 1]) };
    }
    (0..count).map(|i| after[i].max(before[i + 2 * reach])).collect()
}
