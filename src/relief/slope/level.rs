//! Levels of spacing, and the blocks in which lines of a level are made.
//!
//! A block is a square of 12 spacings. Its lines reach 5 spacings out of it and look as far as their most room for others. Blocks
//! of a level are made in four phases, by whether their column and row are odd:
//!
//! ```text
//! 0 1 0 1     between two blocks of a phase lies another: 12 spacings, of which the lines
//! 2 3 2 3     of both cross 10 at most. The 2 that are left are more than their most room,
//! 0 1 0 1     1.42: blocks of a phase do not know each other, and can be made at once.
//! ```
//!
//! Room of level 0 alone is told up to four spacings, for land so far that strokes stand farther apart than its lines: there those
//! of two blocks of a phase may come nearer to each other than they tell.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec2;

/// How many levels there are.
pub(super) const LEVELS: u32 = 17;
/// Spacing of level 0, cells; that of each next is less by the square root of 2.
const WIDEST: f64 = 32.0;
/// Side of a block, spacings of its level.
pub(super) const SIDE: f64 = 12.0;
/// How far a line goes from its seed, each way, spacings of its level.
const REACH: f64 = 5.0;

/// A block of a level. Blocks come in the order of their levels, rows and columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct BlockAt {
    /// Of the spacing.
    pub level: u32,
    /// From the north.
    pub row: u32,
    /// From the west.
    pub column: u32,
}

impl BlockAt {
    /// Blocks of a level are made in the order of their phases.
    pub(super) fn phase(self) -> u32 {
        self.row % 2 * 2 + self.column % 2
    }

    /// Whether it is made before another.
    pub(super) fn is_before(self, other: Self) -> bool {
        (self.level, self.phase()) < (other.level, other.phase())
    }

    /// The part of ids that all its lines share; the lowest 16 bits are left to them.
    pub(super) fn id(self) -> u64 {
        u64::from(self.level) << 56 | u64::from(self.row) << 36 | u64::from(self.column) << 16
    }

    /// The four blocks that it is made of, two levels below.
    pub(super) fn quarters(self) -> impl Iterator<Item = Self> {
        let Self { level, row, column } = self;
        (0..4).map(move |k| Self { level: level + 2, row: row * 2 + k / 2, column: column * 2 + k % 2 })
    }
}

/// The blocks over a DEM. Places are metres on the map from its north-west sample, x east and y south.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocks {
    /// The smaller side of a cell, metres.
    pub unit: f64,
    /// The south-east sample.
    pub extent: DVec2,
}

impl Blocks {
    /// Spacing of a level, metres: the same on every machine to the last bit.
    pub(super) fn spacing(&self, level: u32) -> f64 {
        let octave = WIDEST * self.unit / f64::from(1 << (level / 2));
        if level.is_multiple_of(2) { octave } else { octave * FRAC_1_SQRT_2 }
    }

    /// How far lines of a level go from their seeds, metres.
    pub(super) fn reach(&self, level: u32) -> f64 {
        REACH * self.spacing(level)
    }

    /// The most room that is told of lines of a level, metres: the spacing of the level before, of level 0 four of its own.
    pub(super) fn most_room(&self, level: u32) -> f64 {
        level.checked_sub(1).map_or(4.0 * self.spacing(0), |before| self.spacing(before))
    }

    /// Metres from point to point of lines of a level.
    pub(super) fn point_step(&self, level: u32) -> f64 {
        (self.spacing(level) / 2.0).clamp(self.unit / 4.0, self.unit / 2.0)
    }

    /// Low and high corner of a block.
    pub(super) fn square(&self, at: BlockAt) -> [DVec2; 2] {
        let side = SIDE * self.spacing(at.level);
        let low = DVec2::new(f64::from(at.column), f64::from(at.row)) * side;
        [low, low + side]
    }

    /// Where the lines that begin in a block may be.
    pub(super) fn reached(&self, at: BlockAt) -> [DVec2; 2] {
        grown(self.square(at), self.reach(at.level))
    }

    /// Where lines may be that the room of a block's lines depends on.
    pub(super) fn seen(&self, at: BlockAt) -> [DVec2; 2] {
        grown(self.reached(at), self.most_room(at.level))
    }

    /// All blocks of a level.
    pub(super) fn of(&self, level: u32) -> impl Iterator<Item = BlockAt> + use<> {
        self.within(level, [DVec2::ZERO, self.extent])
    }

    /// Blocks that lines of a block depend on.
    pub(super) fn needs(&self, at: BlockAt) -> impl Iterator<Item = BlockAt> {
        let (blocks, seen) = (*self, self.seen(at));
        let of_level = move |level| blocks.within(level, grown(seen, blocks.reach(level)));
        (0..=at.level).flat_map(of_level).filter(move |other| other.is_before(at))
    }

    /// Blocks of a level that a rectangle overlaps.
    pub(super) fn within(&self, level: u32, [low, high]: [DVec2; 2]) -> impl Iterator<Item = BlockAt> + use<> {
        let side = SIDE * self.spacing(level);
        let last = (self.extent / side).ceil().max(DVec2::ONE) - 1.0;
        let [first, last] =
            [(low / side).floor(), (high / side).ceil() - 1.0].map(|at| at.clamp(DVec2::ZERO, last).as_uvec2());
        (first.y..=last.y).flat_map(move |row| (first.x..=last.x).map(move |column| BlockAt { level, row, column }))
    }
}

/// A rectangle with a margin.
fn grown([low, high]: [DVec2; 2], by: f64) -> [DVec2; 2] {
    [low - by, high + by]
}
