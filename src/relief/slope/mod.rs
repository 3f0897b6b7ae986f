//! Lines down the slope of the land, each with a rank: hachures are drawn from the first of them.
//!
//! Method: evenly spaced streamlines (Jobard, Lefer 1997) of the gradient of the PN surface, in levels whose spacing falls by
//! the square root of 2, from 32 cells to an eighth. Lines of a level are placed where those of all before it leave room, so that
//! lines have a rank, and every point of one knows the spacing up to which it may be drawn: its `room`. Seeds are tried in the
//! order of a blue-noise tile (`tile`), so that the first are far apart.
//!
//! Room of a place of a line: how far it is to the nearest line of lower rank that itself has more room than that, and so is there
//! whenever lines so far apart are drawn: across that line, and ahead of its ends twice as far, for rows of strokes show no gaps. The places with room for a spacing keep that from each other, and those of
//! a wider spacing are among those of a narrower one.
//!
//! Lines are made block by block where enough of the land asks for them, and [kept](Slopes::kept_in). A block depends on the blocks of coarser levels in its reach and on
//! those beside it that have an earlier phase, of four (`level`): its lines are the same, to the last bit, whatever was asked
//! for before, on as many threads as there are.
//!
//! Lines that stand far apart on the map run down land [at half the scale](halved), and a half of that, and so on: on the land as it is they
//! would follow what no page shows of it. Each scale has lines of its own, from the widest spacing on.
//!
//! Distances are those of the map of the DEM, on which samples lie evenly: where the surface bends sideways between samples,
//! places lie up to a tenth of a cell beside. Cost: about 3 us a point on a core, 32 bytes a point; a million samples down to a
//! spacing of one cell have 1.6 million points. Not handled: land that folds over itself, where lines end; lines longer than 10 of
//! their spacings, of which each level has its own pieces; room at the last place of a line, where others may come nearer from
//! ahead than across.

mod block;
mod halved;
mod kept;
mod land;
mod level;
mod made;
mod neighbours;
mod seeds;
mod stops;
mod tile;
mod trace;

use glam::{DVec2, Vec2};

pub(crate) use made::Needed;
pub use made::{Need, Slopes};

/// When slope lines end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeRules {
    /// Least slope of the land as it is, without exaggeration, degrees.
    pub min_slope: f64,
    /// A line ends where its way on the map has turned by more than this from that at its seed, degrees.
    pub max_turn: f64,
}

/// A point of a slope line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopePoint {
    /// Column and row of the DEM, fractional: the place on the lattice of patches.
    pub at: DVec2,
    /// Metres of the exaggerated world: on the PN surface, or of land at a smaller scale on the cells of the land itself.
    pub height: f32,
    /// Gradient there of the PN surface that the line runs down, exaggerated metres for a metre east and for one north: dz/dx, dz/dy.
    pub gradient: Vec2,
    /// How far it is, across, to the nearest line that is there when lines so far apart are drawn, metres on the map; at most
    /// the spacing of the level before, of level 0 four of its own.
    pub room: f32,
}

/// A line down the slope, from its highest point to its lowest.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeLine {
    /// Made of its rank alone: level, block, number in it.
    pub id: u64,
    /// At least two, about half of the level's spacing apart but at most half a cell of that surface.
    pub points: Vec<SlopePoint>,
}

/// The slope lines that begin in one block of one level.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeBlock {
    /// Of the spacing: 0 is the widest.
    pub level: u32,
    /// Column and row of the block among those of its level.
    pub at: [u32; 2],
    /// By rank.
    pub lines: Vec<SlopeLine>,
    /// Of each line, the least and the most column and row.
    boxes: Vec<[DVec2; 2]>,
}

impl SlopeBlock {
    /// Points of all its lines.
    pub fn points(&self) -> usize {
        self.lines.iter().map(|line| line.points.len()).sum()
    }
}
