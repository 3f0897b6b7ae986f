//! Why economy leaves a line as much weight as it does at a place.
//!
//! Method: weights are those of [economy](super::economy), by the same functions; what a line would be without the rule of jumps is what
//! they say without it. So no reason is told that did not apply. Cost: that of economy, and for each place a look at all samples.

use glam::DVec2;

use super::clearance::{self, Sample};
use super::economy::{lengths, sampled, samples};
use super::{Chain, Economy};

/// What decided the weight of a point of a line, each as a factor from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Merit {
    /// By how much farther lies what is behind; of lines on the land by how strongly the page shows them.
    pub by_jump: f64,
    /// By the length of line about it.
    pub by_length: f64,
    /// That length, px, as far as it counts.
    pub length: f64,
    /// Lengths up to which a line is left out, and from which it is whole, px.
    pub lengths: [f64; 2],
    /// To what stronger line it yields, if to any.
    pub yields: Option<Yielded>,
}

/// A stronger line near by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Yielded {
    /// Which of the chains.
    pub to: usize,
    /// How far off its nearest place that presses is, px.
    pub apart: f64,
    /// The share of the weight that is left.
    pub left: f64,
}

/// What decides the weights of chains where they pass nearest to places, each given with the number of its chain.
pub(crate) fn merits(chains: &[Chain], economy: &Economy, places: &[(usize, DVec2)]) -> Vec<Merit> {
    let (chains, of_chains) = sampled(chains, economy);
    let firsts: Vec<usize> = of_chains
        .iter()
        .scan(0, |first, samples| {
            *first += samples.len();
            Some(*first - samples.len())
        })
        .collect();
    let all: Vec<Sample> = of_chains.concat();
    let weights = clearance::weights(&all, economy.min_gap as f32);
    let merit = |&(number, place): &(usize, DVec2)| {
        let chain = &chains[number];
        let apart = |i: usize| chain.points[i].place.distance(place);
        let i = (0..chain.points.len()).min_by(|a, b| apart(*a).total_cmp(&apart(*b))).unwrap_or(0);
        let sample = &all[firsts[number] + i];
        let of_land = chain.line().is_of_land();
        let without_jumps = samples(chain, number as u32, &Economy { min_jump: 0.0, ..*economy })[i].alone;
        let (length, lengths) = lengths(chain, i, economy);
        let by_jump = match of_land {
            true => chain.points[i].weight.into(),
            false if without_jumps > 0.0 => f64::from(sample.alone / without_jumps),
            false => 1.0,
        };
        let share = |of: f64| if of > 0.0 { f64::from(sample.alone) / of } else { 1.0 };
        let by_length = if of_land { share(by_jump) } else { without_jumps.into() };
        let pressing = clearance::presses(&all, &weights, firsts[number] + i, economy.min_gap as f32);
        let yields = pressing.map(|(j, pressure)| Yielded {
            to: all[j].chain as usize,
            apart: f64::from(all[j].place.distance(sample.place)),
            left: f64::from(1.0 - pressure),
        });
        Merit { by_jump, by_length, length, lengths, yields }
    };
    places.iter().map(merit).collect()
}
