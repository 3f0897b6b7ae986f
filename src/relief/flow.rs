//! Which way water goes from every sample, over the land as it is: each pit is left by a way through its rim.
//!
//! Water goes the steepest way down, so each pit, or sample of a flat, has a catchment. As the flood reaches pits, lowest first, each
//! catchment is tied to one that drains already, where the flood came in: the way from there down to the pit is turned round, so
//! water leaves along the bottom of the valley, or the crest, that leads to the pass (carving; Soille, Vogt and Colombo 2003; the
//! flood by Barnes, Lehman and Mulla 2014). No height changes, so no fall has to be made up on flats, which f32 could not
//! hold. A catchment is a tree, turned to another root and tied once to what drains: no cycle can close. A seed
//! without a lower neighbour is an outlet at once; one that has some becomes an outlet when its catchment leaves there.
//!
//! Cost: a pass for directions, one for catchments, the flood; 1 byte a sample that stays, 5 more on the way. Not handled: two
//! ways out of one pit.

use super::bits::Bits;
use super::flood::flood;
use super::frame::FramedGrid;
use super::steepest::{NONE, OUTLET, VOID, steepest};

/// Where water may end.
#[derive(Debug, Clone, Copy)]
pub enum Ends<'a> {
    /// At voids, which frame the grid too, and in this sea.
    Rim(&'a Bits),
    /// At these samples, at least one of each piece of land, and where the land falls to a void that is not of this sea.
    At {
        /// The samples.
        tops: &'a Bits,
        /// Voids beyond which there is no more land.
        sea: &'a Bits,
    },
}

/// Directions of all samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Flow {
    frame: FramedGrid,
    steps: [usize; 8],
    to: Vec<u8>,
}

/// Flow in the making.
struct Carver {
    flow: Flow,
    /// The pit or outlet to which the steepest way leads from each sample.
    catchments: Vec<u32>,
    /// Those of which the whole catchment drains.
    drains: Bits,
}

impl Flow {
    /// Over framed heights, NaN at voids.
    pub fn of(frame: FramedGrid, heights: &[f32], ends: Ends<'_>) -> Self {
        let mut flow = Self { frame, steps: frame.steps(), to: steepest(frame, heights) };
        let mut drains = Bits::none(frame.samples());
        let seeds = flow.seeds(heights, ends, &mut drains);
        drains.iter().for_each(|end| flow.to[end] = OUTLET);
        let mut carver = Carver { catchments: flow.catchments(), flow, drains };
        flood(frame, heights, seeds.iter(), |sample, parents| {
            if carver.flow.to[sample] == NONE {
                carver.leave(sample, parents);
            }
        });
        carver.flow
    }

    /// From where the flood comes; `outlets` gets those at which water ends at once.
    fn seeds(&self, heights: &[f32], ends: Ends<'_>, outlets: &mut Bits) -> Bits {
        let mut seeds = Bits::none(self.to.len());
        for i in self.frame.indices().filter(|i| self.is_land(*i)) {
            let is_end = match ends {
                Ends::Rim(sea) => sea.has(i) || self.is_rim(i) && (self.to[i] == NONE || self.falls_out(heights, i)),
                Ends::At { tops, sea } => {
                    let around = self.steps.iter().any(|step| sea.has(i.wrapping_add(*step)));
                    tops.has(i) || !around && self.is_rim(i) && self.falls_out(heights, i)
                }
            };
            if is_end {
                outlets.take(i);
            }
            if is_end || matches!(ends, Ends::Rim(_)) && self.is_rim(i) {
                seeds.take(i);
            }
        }
        seeds
    }

    /// Whether the land falls most steeply to a void, were it to go on beyond as it comes from the other side: water would run along
    /// the rim else.
    fn falls_out(&self, heights: &[f32], i: usize) -> bool {
        let distances = self.frame.distances();
        let fall = |k: usize| f64::from(heights[i] - heights[i.wrapping_add(self.steps[k])]) / distances[k];
        let within = self.direction(i).map_or(0.0, fall);
        (0..8).any(|k| heights[i.wrapping_add(self.steps[k])].is_nan() && -fall((k + 4) % 8) > within)
    }

    /// Whether a sample of the land is beside a void or at the grid's edge.
    pub fn is_rim(&self, i: usize) -> bool {
        self.steps.iter().any(|step| self.to[i.wrapping_add(*step)] == VOID)
    }

    /// Whether there is land.
    pub fn is_land(&self, i: usize) -> bool {
        self.to[i] != VOID
    }

    /// Where water goes from here, `None` at an outlet and where there is no land.
    pub fn down(&self, i: usize) -> Option<usize> {
        self.steps.get(usize::from(self.to[i])).map(|step| i.wrapping_add(*step))
    }

    /// The number of the neighbour to which it goes.
    pub fn direction(&self, i: usize) -> Option<usize> {
        Some(usize::from(self.to[i])).filter(|k| *k < 8)
    }

    /// Whether water ends here where it must not: at a pit that was not left.
    pub fn is_stuck(&self, i: usize) -> bool {
        self.to[i] == NONE
    }

    /// Numbers of the neighbours from which water comes, and where they are.
    pub fn donors(&self, i: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let around = self.steps.iter().enumerate().map(move |(k, step)| (k, i.wrapping_add(*step)));
        around.filter(|(k, from)| usize::from(self.to[*from]) == (k + 4) % 8)
    }

    /// Its grid.
    pub fn frame(&self) -> FramedGrid {
        self.frame
    }

    /// Where the way down ends, of each sample; pits are not left yet.
    fn catchments(&self) -> Vec<u32> {
        const UNKNOWN: u32 = u32::MAX;
        let mut ends = vec![UNKNOWN; self.to.len()];
        for first in self.frame.indices().filter(|i| self.to[*i] != VOID) {
            let mut i = first;
            while let (UNKNOWN, Some(next)) = (ends[i], self.down(i)) {
                i = next;
            }
            let end = if ends[i] == UNKNOWN { i as u32 } else { ends[i] };
            let mut i = first;
            while ends[i] == UNKNOWN {
                ends[i] = end;
                i = self.down(i).unwrap_or(i);
            }
        }
        ends
    }
}

impl Carver {
    /// Lets the catchment of a pit drain, and before it those that the flood came through and that do not.
    fn leave(&mut self, pit: usize, parents: &[u8]) {
        while !self.has_left(pit) {
            let mut last = pit;
            loop {
                let k = usize::from(parents[last]);
                let Some(next) = self.flow.steps.get(k).map(|step| last.wrapping_add(*step)) else {
                    // A seed with lower neighbours, over which it runs out.
                    self.turn(last, OUTLET);
                    break;
                };
                if self.has_left(next) {
                    self.tie(last, k);
                    break;
                }
                last = next;
            }
        }
    }

    fn has_left(&self, i: usize) -> bool {
        self.drains.has(self.catchments[i] as usize)
    }

    /// Ties a catchment to the neighbour d of one of its samples, or another that is in the way.
    ///
    /// ```text
    ///  from   d     a would go to d, but water goes `from` here `onto` there. Where that drains, a goes `onto` there. Else that
    ///      \ /      catchment, which may be the same, goes from `onto` to d. Either way is along a side, which crosses nothing.
    ///      / \
    ///     a  onto
    /// ```
    fn tie(&mut self, a: usize, k: usize) {
        let Flow { steps, to, .. } = &self.flow;
        let beside = |turn: usize| a.wrapping_add(steps[(k + turn) % 8]);
        // The neighbours on both sides of d, and by how much a step from one to the other is turned against k.
        let crosses = |(side, turn): &(usize, usize)| usize::from(to[beside(*side)]) == (k + turn) % 8;
        let crossing = [(7, 2), (1, 6)].into_iter().find(|way| k % 2 == 1 && crosses(way));
        let Some((from, _)) = crossing else { return self.turn(a, k as u8) };
        let onto = beside(8 - from);
        if self.has_left(onto) {
            self.turn(a, ((k + 8 - from) % 8) as u8);
        } else {
            // From the one side of d to d is as from a to the other side.
            self.turn(onto, ((k + from) % 8) as u8);
        }
    }

    /// Turns the way from a sample down to its pit round, and lets it leave by a direction.
    fn turn(&mut self, first: usize, direction: u8) {
        self.drains.take(self.catchments[first] as usize);
        let (mut i, mut direction) = (first, direction);
        loop {
            let before = std::mem::replace(&mut self.flow.to[i], direction);
            let Some(step) = self.flow.steps.get(usize::from(before)) else { return };
            i = i.wrapping_add(*step);
            direction = (before + 4) % 8;
        }
    }
}
