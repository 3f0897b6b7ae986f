//! Regions of equal heights in the making, and which of them are water.
//!
//! A region is water if it is large ([`LEAST`]), if hardly any of its shore leads down ([`OUTLETS`]: a lake has one), and if
//! along rows or along columns it is much wider than the terraces at its shores ([`WIDER`]). The floor of a rounded hollow is
//! not, whatever step and slope: next to one with the section of a parabola lies a terrace of a fifth of its width at least.
//! The reach of a river is much wider than its banks, but its end upstream is as long as itself: where rows and columns
//! disagree, water has no open end ([`ENDS`]). The sea, at exactly 0, may have more of its shore below; where no run of it
//! ends at a shore it is believed.

use super::EqualHeights;

/// Fewest samples of a body of water: smaller ones are gone on a page, and as likely a hollow.
const LEAST: u64 = 64;
/// One in so many edges of its shore may lead down.
const OUTLETS: u64 = 16;
/// The same of the sea: mud and noise lie below 0 along its shores. On a slope it is every other one.
const MUD: u64 = 4;
/// How many times as wide as the next terrace a run of water is; shorter runs tell nothing.
const WIDER: u32 = 8;
/// Edges that lead down or out of sight, times shore, in samples: a quarter of the mean width, which is twice the samples
/// by the shore.
const ENDS: u64 = 2;
/// No region, no run.
pub(super) const NONE: u32 = u32::MAX;

/// Equal heights that hang together, as far as rows were seen.
#[derive(Debug, Clone, Copy)]
struct Region {
    /// The region that it became part of; itself otherwise.
    parent: u32,
    /// The last row that has a run of it; [`NONE`] where no more can come.
    row: u32,
    height: f32,
    /// First and last of its runs.
    runs: [u32; 2],
    samples: u64,
    /// Edges to other heights, those of them to lower ones, and those to voids and beyond the DEM.
    shore: u64,
    down: u64,
    rim: u64,
    /// Along rows and columns: samples of runs that end at higher ground, once for each end, and those much wider than the
    /// terrace there.
    ends: [u64; 2],
    steep: [u64; 2],
    /// Columns where the terrace at its end is not all seen, and parts of it that are named by such.
    held: u32,
}

/// Where a run ends at a terrace: its length, the width of the terrace, and whether that was seen to its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending {
    pub length: u32,
    pub width: u32,
    pub is_seen: bool,
}

/// Regions that are open, with their runs; what is closed makes room for others.
#[derive(Default)]
pub(super) struct Regions {
    all: Vec<Region>,
    free: Vec<u32>,
    /// Those that became part of others since the last row.
    joined: Vec<u32>,
    /// Row, columns, and the next run of the region.
    runs: Vec<[u32; 4]>,
    free_runs: Vec<u32>,
    /// Row and columns of water that was found.
    water: Vec<[u32; 3]>,
}

impl Region {
    fn is_water(&self) -> bool {
        let is_sea = self.height == 0.0;
        let is_level = self.samples >= LEAST && self.down * if is_sea { MUD } else { OUTLETS } <= self.shore;
        let is_wide = |axis: &usize| 2 * self.steep[*axis] >= self.ends[*axis];
        let mut shown = [0, 1].into_iter().filter(|axis| self.ends[*axis] > 0);
        let has_ends = ENDS * (self.down + self.rim) * self.shore > self.samples;
        let is_believed = match self.ends {
            [0, 0] => is_sea,
            _ if has_ends && !is_sea => shown.all(|axis| is_wide(&axis)),
            _ => shown.any(|axis| is_wide(&axis)),
        };
        is_level && is_believed
    }
}

impl Regions {
    /// A region of this run alone.
    pub(super) fn add(&mut self, row: u32, run: EqualHeights) -> u32 {
        let node = [row, run.first, run.end, NONE];
        let node = put(&mut self.runs, &mut self.free_runs, node);
        let (runs, samples) = ([node; 2], u64::from(run.end - run.first));
        let region = Region {
            parent: NONE,
            row,
            height: run.height,
            runs,
            samples,
            shore: 0,
            down: 0,
            rim: 0,
            ends: [0; 2],
            steep: [0; 2],
            held: 0,
        };
        put(&mut self.all, &mut self.free, region)
    }

    /// The region that this one is part of by now.
    pub(super) fn root(&mut self, mut region: u32) -> u32 {
        while self.all[region as usize].parent != NONE {
            let parent = self.all[region as usize].parent;
            let beyond = self.all[parent as usize].parent;
            // One that columns hold is held by its parent's account.
            if beyond != NONE && self.all[region as usize].row != NONE {
                self.all[region as usize].parent = beyond;
            }
            region = parent;
        }
        region
    }

    /// Makes two regions one.
    pub(super) fn join(&mut self, one: u32, other: u32) {
        let [one, other] = [one, other].map(|region| self.root(region));
        if one == other {
            return;
        }
        let from = self.all[other as usize];
        let onto = &mut self.all[one as usize];
        self.runs[onto.runs[1] as usize][3] = from.runs[0];
        onto.runs[1] = from.runs[1];
        onto.row = onto.row.max(from.row);
        onto.samples += from.samples;
        onto.shore += from.shore;
        onto.down += from.down;
        onto.rim += from.rim;
        for axis in 0..2 {
            onto.ends[axis] += from.ends[axis];
            onto.steep[axis] += from.steep[axis];
        }
        self.all[other as usize].parent = one;
        self.joined.push(other);
    }

    /// Counts so many edges between two runs of different heights; one may be void.
    pub(super) fn shore(&mut self, runs: [&EqualHeights; 2], edges: u32) {
        for (run, other) in [(runs[0], runs[1]), (runs[1], runs[0])] {
            if run.region == NONE {
                continue;
            }
            let (root, edges) = (self.root(run.region), u64::from(edges));
            let region = &mut self.all[root as usize];
            if other.region == NONE {
                region.rim += edges;
            } else {
                region.shore += edges;
                region.down += if other.height < run.height { edges } else { 0 };
            }
        }
    }

    /// Counts the end of a run of a region along rows (0) or columns (1).
    pub(super) fn end(&mut self, region: u32, axis: usize, Ending { length, width, is_seen }: Ending) {
        let is_steep = length / WIDER >= width;
        if length < WIDER || is_steep && !is_seen {
            return;
        }
        let root = self.root(region);
        let region = &mut self.all[root as usize];
        region.ends[axis] += u64::from(length);
        region.steep[axis] += if is_steep { u64::from(length) } else { 0 };
    }

    /// The region, to be known until it is let go; `None` where a run of that length tells nothing.
    pub(super) fn hold(&mut self, region: u32, length: u32) -> Option<u32> {
        (length >= WIDER).then(|| {
            let root = self.root(region);
            self.all[root as usize].held += 1;
            root
        })
    }

    /// Ends a [`Self::hold`].
    pub(super) fn let_go(&mut self, region: u32) {
        let mut at = region;
        while at != NONE {
            let region = &mut self.all[at as usize];
            region.held -= 1;
            if region.held > 0 || region.row != NONE {
                return;
            }
            let parent = region.parent;
            if parent == NONE {
                self.decide(at);
            }
            self.free.push(at);
            at = parent;
        }
    }

    /// Closes a region that is no part of another, and ended before row `row`. It may be named by several runs.
    pub(super) fn close_before(&mut self, region: u32, row: u32) {
        let Some(open) = self.all.get_mut(region as usize).filter(|open| open.parent == NONE && open.row < row) else {
            return;
        };
        open.row = NONE;
        if open.held == 0 {
            self.decide(region);
            self.free.push(region);
        }
    }

    /// Makes room for its runs; they go to the water if it is some.
    fn decide(&mut self, region: u32) {
        let region = &self.all[region as usize];
        let is_water = region.is_water();
        let mut run = region.runs[0];
        while run != NONE {
            let [row, first, end, next] = self.runs[run as usize];
            if is_water {
                self.water.push([row, first, end]);
            }
            self.free_runs.push(run);
            run = next;
        }
    }

    /// Forgets those that became part of others, but for those that are held.
    pub(super) fn release(&mut self) {
        for region in std::mem::take(&mut self.joined) {
            let joined = &mut self.all[region as usize];
            if joined.held == 0 {
                self.free.push(region);
            } else {
                joined.row = NONE;
                let parent = joined.parent;
                self.all[parent as usize].held += 1;
            }
        }
    }

    /// Row and columns of the water that was found.
    pub(super) fn into_water(self) -> Vec<[u32; 3]> {
        self.water
    }
}

/// Puts an item in a free place, or in a new one, and says where.
fn put<T>(list: &mut Vec<T>, free: &mut Vec<u32>, item: T) -> u32 {
    match free.pop() {
        Some(place) => {
            list[place as usize] = item;
            place
        }
        None => {
            list.push(item);
            list.len() as u32 - 1
        }
    }
}
