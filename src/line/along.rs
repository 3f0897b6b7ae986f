//! Measures along chains: steps, arcs, averages over what lies before and after.
//!
//! Method: an average weighs what lies `a` px away along the chain by exp(-a / reach), which one pass forward and one
//! backward sum up exactly. It has no edge at which a point falls out of a window: points that move a little move averages
//! a little. Cost: two passes along the chain.

use glam::DVec2;

use super::clearance::smoothstep;
use super::{Chain, ChainPoint};

/// A chain with the lengths along it.
pub(super) struct Along<'a> {
    chain: &'a Chain,
    /// From each point to the next, px: as many as points, the last to the first of a closed chain and 0 of an open one.
    steps: Vec<f64>,
    /// To each point from the first, px.
    pub arcs: Vec<f64>,
    /// Of the whole chain, px.
    pub length: f64,
}

impl<'a> Along<'a> {
    /// Measures a chain.
    pub(super) fn new(chain: &'a Chain) -> Self {
        let steps: Vec<f64> = (0..chain.points.len()).map(|i| step(chain, i)).collect();
        let mut length = 0.0;
        let mut measure = |step: &f64| {
            length += step;
            length - step
        };
        let arcs = steps.iter().map(&mut measure).collect();
        Self { chain, steps, arcs, length }
    }

    /// Half of the line to the points before and after, px: what of the chain a point stands for, to either side.
    pub(super) fn half(&self, i: usize) -> f64 {
        (self.before(i) + self.steps[i]) / 4.0
    }

    /// How much of the chain there is on both sides of a point, px, on each at most `most`.
    pub(super) fn reach(&self, i: usize, most: f64) -> f64 {
        match self.chain.closed {
            true => self.length.min(2.0 * most),
            false => self.arcs[i].min(most) + (self.length - self.arcs[i]).min(most),
        }
    }

    /// To the nearer end, px; infinite in a closed chain.
    pub(super) fn end(&self, i: usize) -> f64 {
        if self.chain.closed { f64::INFINITY } else { self.arcs[i].min(self.length - self.arcs[i]) }
    }

    /// The direction from the point before to the one after, as long as the way between.
    pub(super) fn direction(&self, i: usize) -> DVec2 {
        let (points, n) = (&self.chain.points, self.steps.len());
        let [before, after] = match self.chain.closed {
            true => [(i + n - 1) % n, (i + 1) % n],
            false => [i.saturating_sub(1), (i + 1).min(n - 1)],
        };
        points[after].place - points[before].place
    }

    /// Values at the points, averaged along the chain by length over about `reach` px to both sides.
    pub(super) fn averaged<const N: usize>(&self, values: &[[f64; N]], reach: f64) -> Vec<[f64; N]> {
        let n = values.len();
        let mass: Vec<f64> = (0..n).map(|i| self.half(i).max(f64::MIN_POSITIVE)).collect();
        let weighed = |i: usize| values[i].map(|value| value * mass[i]);
        let mut sums: Vec<([f64; N], f64)> = (0..n).map(|i| (weighed(i), mass[i])).collect();
        for backward in [false, true] {
            let (mut sum, mut total) = ([0.0; N], 0.0);
            // Round a closed chain twice, so that its first point knows its last.
            let rounds = if self.chain.closed { 2 } else { 1 };
            for turn in 0..rounds * n {
                let i = if backward { n - 1 - turn % n } else { turn % n };
                let step = if backward { self.steps[i] } else { self.before(i) };
                let fade = (-step / reach).exp();
                for ((sum, all), own) in sum.iter_mut().zip(&mut sums[i].0).zip(weighed(i)) {
                    *sum *= fade;
                    *all += if turn + n >= rounds * n { *sum } else { 0.0 };
                    *sum += own;
                }
                total *= fade;
                sums[i].1 += if turn + n >= rounds * n { total } else { 0.0 };
                total += mass[i];
            }
        }
        sums.into_iter().map(|(sum, total)| sum.map(|sum| sum / total)).collect()
    }

    /// Values at the points, each spread along the chain: whole up to `near` px, fading until `far`; the largest counts.
    pub(super) fn spread(&self, values: &[f64], [near, far]: [f64; 2]) -> Vec<f64> {
        let fading = |way: f64| 1.0 - fade([near, far], way);
        let most = values.iter().copied().fold(0.0, f64::max);
        let from = |i: usize| {
            // Most points have the most there is.
            if values[i] >= most {
                return most;
            }
            let sides = [false, true].map(|backward| self.from(i, backward).take_while(|(_, way)| *way < far));
            let spread = sides.into_iter().flatten().map(|(j, way)| values[j] * fading(way));
            spread.fold(values[i], f64::max)
        };
        (0..values.len()).map(from).collect()
    }

    /// The points before or after one, with the way there, px.
    fn from(&self, i: usize, backward: bool) -> impl Iterator<Item = (usize, f64)> {
        let n = self.steps.len();
        let most = match (self.chain.closed, backward) {
            (true, _) => n - 1,
            (false, true) => i,
            (false, false) => n - 1 - i,
        };
        let mut way = 0.0;
        (1..=most).map(move |k| {
            let j = if backward { (i + n - k) % n } else { (i + k) % n };
            way += if backward { self.steps[j] } else { self.before(j) };
            (j, way)
        })
    }

    /// Whether what the chain draws from a point on, or up to it, is such.
    pub(super) fn draws(&self, i: usize, is_such: impl Fn(&ChainPoint) -> bool) -> bool {
        let points = &self.chain.points;
        let before = if i > 0 || self.chain.closed { (i + points.len() - 1) % points.len() } else { i };
        is_such(&points[i]) || is_such(&points[before])
    }

    /// From the point before to this one, px.
    fn before(&self, i: usize) -> f64 {
        let n = self.steps.len();
        // The last step of an open chain is 0.
        self.steps[(i + n - 1) % n]
    }
}

/// The chain with more points between those that lie more than `longest` px apart.
pub(super) fn stepped(chain: &Chain, longest: f64) -> Chain {
    let next = |i: usize| chain.points.get(i + 1).or(chain.points.first().filter(|_| chain.closed));
    let points = chain.points.iter().enumerate().flat_map(|(i, a)| {
        let b = next(i).unwrap_or(a);
        let steps = (a.place.distance(b.place) / longest).ceil().max(1.0);
        (0..steps as u32).map(move |s| between(a, b, f64::from(s) / steps))
    });
    Chain { points: points.collect(), ..*chain }
}

/// The point at share `t` of the way from a to b on the page. Depth is linear there along a straight line of the world.
pub(super) fn between(a: &ChainPoint, b: &ChainPoint, t: f64) -> ChainPoint {
    if t == 0.0 {
        return *a;
    }
    let [of_a, of_b] = [(1.0 - t) * f64::from(a.depth), t * f64::from(b.depth)];
    let depth = of_a + of_b;
    let world = (a.world * of_a + b.world * of_b) / depth;
    ChainPoint { place: a.place.lerp(b.place, t), depth: depth as f32, world, ..*a }
}

/// From a point to the next, px.
fn step(chain: &Chain, i: usize) -> f64 {
    let next = chain.points.get(i + 1).or(chain.points.first().filter(|_| chain.closed));
    next.map_or(0.0, |next| next.place.distance(chain.points[i].place))
}

/// 0 up to the first edge, 1 from the second on, smooth between.
pub(super) fn fade([low, high]: [f64; 2], x: f64) -> f64 {
    f64::from(smoothstep([low as f32, high as f32], x as f32))
}
