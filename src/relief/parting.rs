//! How far the waters on two sides of a ridge run before they meet.
//!
//! Both are followed down to where they run in beds, and from there by whole branches: the one whose branch ends with less land
//! above it goes on, for what lies below has more (lowest common ancestor by paths; Sleator and Tarjan 1983). Cost: a few steps a ridge's
//! sample. Waters that meet before both run in beds were one all the time: else any two rills side by side would part.
//! Those that never meet, on coasts and at the DEM's edge, part as far as the shorter of them runs: faces that drain straight to
//! the sea have no beds. Not handled: waters that meet beyond the DEM's edge.

use super::area::Area;
use super::branches::Branch;
use super::channels::Channels;
use super::flow::Flow;

/// Water that parts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Parting {
    /// Metres that the shorter of two flows runs until they meet; 0 of waters that do not part.
    pub length: f32,
    /// Metres that it falls on the way.
    pub drop: f32,
}

/// Beds, their branches, and how far they lead.
#[derive(Debug)]
pub(super) struct Beds<'a> {
    flow: &'a Flow,
    heights: &'a [f32],
    channels: Channels,
    /// Of each node.
    branch: Vec<u32>,
    /// Metres from each node to where its water ends.
    left: Vec<f32>,
    /// Of each branch.
    ends: Vec<End>,
}

/// Where a branch ends.
#[derive(Debug)]
struct End {
    /// Its last sample.
    sample: usize,
    /// Samples above that.
    cells: u32,
    /// The node that it joins.
    joins: Option<u32>,
}

/// Water on its way to a bed.
struct WaterRun {
    sample: usize,
    metres: f32,
    node: Option<usize>,
}

impl<'a> Beds<'a> {
    /// Of a flow over heights; all channels and the branches into which they are cut.
    pub(super) fn new(
        flow: &'a Flow,
        area: &Area,
        heights: &'a [f32],
        channels: Channels,
        branches: &[Branch],
    ) -> Self {
        let metres = flow.frame().distances().map(|metres| metres as f32);
        let mut branch = vec![0; channels.samples.len()];
        for (number, of) in (0..).zip(branches) {
            of.nodes.iter().for_each(|node| branch[*node as usize] = number);
        }
        let mut left = vec![0.0_f32; channels.samples.len()];
        for node in channels.order.iter().rev().map(|node| *node as usize) {
            if let (Some(below), Some(k)) = (channels.below(node), flow.direction(channels.samples[node] as usize)) {
                left[node] = left[below] + metres[k];
            }
        }
        let end = |branch: &Branch| {
            let sample = branch.nodes.last().map_or(0, |node| channels.samples[*node as usize] as usize);
            End { sample, cells: area.cells[sample], joins: branch.joins }
        };
        let ends = branches.iter().map(end).collect();
        Self { flow, heights, channels, branch, left, ends }
    }

    /// Whether a bed lies at a sample.
    pub(super) fn is_bed(&self, sample: usize) -> bool {
        self.channels.numbers.number(sample).is_some()
    }

    /// Whether a step to the neighbour of a number crosses a bed.
    pub(super) fn crosses(&self, sample: usize, k: usize) -> bool {
        let steps = self.flow.frame().steps();
        // Beds from one neighbour beside that to the other.
        let mut beside =
            [(7, 2), (1, 6)].into_iter().map(|(side, turn)| (sample.wrapping_add(steps[(k + side) % 8]), turn));
        k % 2 == 1 && beside.any(|(from, turn)| self.flow.direction(from) == Some((k + turn) % 8) && self.is_bed(from))
    }

    /// How the waters of two samples part.
    pub(super) fn parting(&self, sides: [usize; 2]) -> Parting {
        let runs = sides.map(|side| self.run(side));
        let whole = |run: &WaterRun| run.metres + run.node.map_or(0.0, |node| self.left[node]);
        let end = |run: &WaterRun| run.node.map_or(run.sample, |node| self.outlet(node));
        let ends = [end(&runs[0]), end(&runs[1])];
        let mut metres = [whole(&runs[0]), whole(&runs[1])];
        let mut lowest = ends;
        if ends[0] == ends[1] {
            let [Some(a), Some(b)] = [runs[0].node, runs[1].node] else { return Parting::default() };
            let meet = self.meet(a, b).filter(|meet| *meet != a && *meet != b);
            let Some(meet) = meet else { return Parting::default() };
            metres = metres.map(|metres| metres - self.left[meet]);
            lowest = [self.channels.samples[meet] as usize; 2];
        }
        let shorter = usize::from(metres[1] < metres[0]);
        let drop = self.heights[sides[shorter]] - self.heights[lowest[shorter]];
        Parting { length: metres[shorter], drop: drop.max(0.0) }
    }

    /// Down to a bed, or to where the water ends before.
    fn run(&self, mut sample: usize) -> WaterRun {
        let distances = self.flow.frame().distances();
        let mut metres = 0.0;
        loop {
            let node = self.channels.numbers.number(sample);
            match (node, self.flow.direction(sample), self.flow.down(sample)) {
                (None, Some(k), Some(down)) => {
                    metres += distances[k] as f32;
                    sample = down;
                }
                _ => return WaterRun { sample, metres, node },
            }
        }
    }

    /// The node at which two meet.
    fn meet(&self, mut a: usize, mut b: usize) -> Option<usize> {
        loop {
            let branches = [self.branch[a], self.branch[b]];
            if branches[0] == branches[1] {
                return Some(if self.left[a] < self.left[b] { a } else { b });
            }
            let [of_a, of_b] = branches.map(|branch| &self.ends[branch as usize]);
            if of_a.cells <= of_b.cells {
                a = of_a.joins? as usize;
            } else {
                b = of_b.joins? as usize;
            }
        }
    }

    /// The sample where the water of a node ends.
    fn outlet(&self, node: usize) -> usize {
        let mut branch = &self.ends[self.branch[node] as usize];
        while let Some(next) = branch.joins {
            branch = &self.ends[self.branch[next as usize] as usize];
        }
        branch.sample
    }
}
