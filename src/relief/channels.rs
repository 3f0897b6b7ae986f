//! Where so much land gathers that water runs in a bed: a forest of samples, each with the one below it.
//!
//! Orders are Strahler's (1957: where two streams of the highest order meet it grows by one) and Shreve's (1966: the number of sources
//! above). Cost: a pass over the grid, then a few over the channels; 16 bytes a channel's sample.

use super::area::Area;
use super::bits::{Bits, Ranked};
use super::flow::Flow;

/// No number of a node.
pub const NO_NODE: u32 = u32::MAX;

/// Samples with at least some area, numbered by rows.
#[derive(Debug, Clone)]
pub struct Channels {
    /// Where each lies in the grid.
    pub samples: Vec<u32>,
    /// The next below, [`NO_NODE`] at an outlet.
    pub down: Vec<u32>,
    /// All, each after those above it.
    pub order: Vec<u32>,
    /// The number of a sample.
    pub numbers: Ranked,
}

/// Orders of the streams at each node.
#[derive(Debug, Clone, PartialEq)]
pub struct Orders {
    /// Strahler's.
    pub strahler: Vec<u8>,
    /// Shreve's: how many sources lie above.
    pub shreve: Vec<u32>,
}

impl Channels {
    /// Of a flow: where at least `least` samples gather.
    pub fn of(flow: &Flow, area: &Area, least: u32) -> Self {
        Self::among(flow, |i| area.cells[i] >= least.max(1), |_| true)
    }

    /// Of a flow: the samples that belong, each with the one below unless the forest is cut there.
    pub fn among(flow: &Flow, belongs: impl Fn(usize) -> bool, goes_on: impl Fn(usize) -> bool) -> Self {
        let frame = flow.frame();
        let mut bits = Bits::none(frame.samples());
        let samples: Vec<u32> = frame.indices().filter(|i| belongs(*i)).map(|i| i as u32).collect();
        samples.iter().for_each(|i| bits.take(*i as usize));
        let numbers = bits.ranked();
        let below = |i: usize| flow.down(i).filter(|_| goes_on(i)).and_then(|down| numbers.number(down));
        let down: Vec<u32> = samples.iter().map(|i| below(*i as usize).map_or(NO_NODE, |down| down as u32)).collect();
        let order = downwards(&down);
        Self { samples, down, order, numbers }
    }

    /// Orders where those with at least `least` samples are the channels.
    pub fn orders(&self, area: &Area, least: u32) -> Orders {
        let mut strahler = vec![0_u8; self.samples.len()];
        let mut shreve = vec![0_u32; self.samples.len()];
        for node in self.order.iter().map(|node| *node as usize) {
            if area.cells[self.samples[node] as usize] < least {
                continue;
            }
            // Until here `strahler` is of the highest above, doubled, and odd where there are two of it.
            let (above, is_joined) = (strahler[node] >> 1, strahler[node] & 1);
            strahler[node] = if above == 0 { 1 } else { above + is_joined };
            shreve[node] = shreve[node].max(1);
            if let Some(down) = self.below(node) {
                let (own, there) = (strahler[node], strahler[down] >> 1);
                strahler[down] = match own.cmp(&there) {
                    std::cmp::Ordering::Less => strahler[down],
                    std::cmp::Ordering::Equal => own << 1 | 1,
                    std::cmp::Ordering::Greater => own << 1,
                };
                shreve[down] += shreve[node];
            }
        }
        Orders { strahler, shreve }
    }

    /// The node below.
    pub fn below(&self, node: usize) -> Option<usize> {
        Some(self.down[node]).filter(|down| *down != NO_NODE).map(|down| down as usize)
    }
}

/// The nodes of a forest, each before the one below it.
fn downwards(down: &[u32]) -> Vec<u32> {
    let mut waits = vec![0_u8; down.len()];
    down.iter().filter(|below| **below != NO_NODE).for_each(|below| waits[*below as usize] += 1);
    let mut order = Vec::with_capacity(down.len());
    order.extend((0..down.len() as u32).filter(|node| waits[*node as usize] == 0));
    let mut next = 0;
    while let Some(node) = order.get(next) {
        next += 1;
        let below = down[*node as usize];
        if below != NO_NODE {
            waits[below as usize] -= 1;
            if waits[below as usize] == 0 {
                order.push(below);
            }
        }
    }
    order
}
