//! Lines that do not cross: each ends where it comes near one that lies already.
//!
//! Lines are laid one after the other. A line whose beginning is near another begins where it has left that; it ends on the first
//! that it comes near to, after which it would run beside it, no matter which one its water meets in the end. Cost: a look at a
//! few cells a place; 4 bytes a cell while they are laid. Not handled: a line that comes near itself.

use glam::DVec2;

use super::frame::FramedGrid;
use super::trace::{CurvePlace, SPACING};

/// How near two lines come before they join, cells: so near that they could cross between two places.
const NEAR: f64 = 0.6;
/// How far the end of a branch may lie from the one that it joins, cells.
const FAR: f64 = 2.0;
/// How near another a line runs beside it, cells.
const BESIDE: f64 = 2.5;
/// Over how many places the end of a line bends to the one that it joins.
const BEND: usize = 6;

/// No place.
const NOTHING: u32 = u32::MAX;

/// A place of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Joint {
    /// Which line.
    pub line: u32,
    /// Which of its places.
    pub place: u32,
}

/// A line that lies.
#[derive(Debug)]
pub(super) struct Laid {
    /// At least two.
    pub places: Vec<CurvePlace>,
    /// The place of another that the last one is.
    pub joint: Option<Joint>,
    /// How many of its places are not beside lines that lay before.
    pub free: usize,
}

/// Lines by the cells that they run through.
#[derive(Debug)]
pub(super) struct Net {
    /// All, as they were laid.
    pub lines: Vec<Laid>,
    /// Columns and rows.
    size: [usize; 2],
    /// The last place in each cell, or [`NOTHING`].
    cells: Vec<u32>,
    /// All places, each with the one before it in its cell.
    places: Vec<(Joint, u32)>,
}

impl Net {
    /// No line on a grid.
    pub(super) fn new(frame: FramedGrid) -> Self {
        Self {
            lines: Vec::new(),
            size: frame.size,
            cells: vec![NOTHING; frame.size[0] * frame.size[1]],
            places: Vec::new(),
        }
    }

    /// Lays a line where it is not near another, if it is anywhere not, and tells whether it did. Whether it joins one in the
    /// end is known.
    pub(super) fn lay(&mut self, mut line: Vec<CurvePlace>, is_branch: bool) -> bool {
        let Some(first) = line.iter().position(|place| self.near(place.at, NEAR).is_none()) else { return false };
        line.drain(..first);
        let meets = line.iter().position(|place| self.near(place.at, NEAR).is_some());
        if let Some(meets) = meets {
            line.truncate(meets + 1);
        }
        let end = line.last().map_or(DVec2::ZERO, |place| place.at);
        let radius = if is_branch { FAR } else { NEAR };
        let joint = self.near(end, radius);
        if let Some(joint) = joint {
            self.bend(&mut line, joint);
        }
        let lies = line.len() >= 2;
        if lies {
            self.keep(line, joint);
        }
        lies
    }

    /// Moves the end of a line onto its joint, and what comes before it less and less.
    fn bend(&self, line: &mut Vec<CurvePlace>, joint: Joint) {
        let to = self.lines[joint.line as usize].places[joint.place as usize].at;
        let last = line.len() - 1;
        let by = to - line[last].at;
        let bend = BEND.min(last);
        for k in 0..=bend {
            let share = 1.0 - k as f64 / (bend + 1) as f64;
            line[last - k].at += by * (share * share);
        }
        line[last].at = to;
        let close = |pair: &[CurvePlace]| pair[0].at.distance(pair[1].at) < SPACING / 4.0;
        while line.len() > 2 && close(&line[line.len() - 2..]) {
            line.remove(line.len() - 2);
        }
    }

    fn keep(&mut self, places: Vec<CurvePlace>, joint: Option<Joint>) {
        let is_free = |place: &&CurvePlace| self.around(place.at, BESIDE).all(|(distance, _)| distance >= BESIDE);
        let free = places.iter().filter(is_free).count();
        for (k, place) in places.iter().enumerate() {
            let at = Joint { line: self.lines.len() as u32, place: k as u32 };
            let [c, r] = self.cell(place.at);
            let before = std::mem::replace(&mut self.cells[r * self.size[0] + c], self.places.len() as u32);
            self.places.push((at, before));
        }
        self.lines.push(Laid { places, joint, free });
    }

    /// The nearest place of all lines, nearer than a radius.
    fn near(&self, at: DVec2, radius: f64) -> Option<Joint> {
        let within = self.around(at, radius).filter(|(distance, _)| *distance < radius);
        within.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, joint)| joint)
    }

    /// The places in all cells within a radius, and some beyond, with their distances.
    fn around(&self, at: DVec2, radius: f64) -> impl Iterator<Item = (f64, Joint)> + '_ {
        let [west, north] = self.cell(at - radius);
        let [east, south] = self.cell(at + radius);
        let cells = (north..=south).flat_map(move |r| &self.cells[r * self.size[0] + west..=r * self.size[0] + east]);
        let in_cell = |first: &u32| {
            std::iter::successors(self.places.get(*first as usize), |(_, next)| self.places.get(*next as usize))
        };
        cells.flat_map(in_cell).map(move |(joint, _)| {
            let place = self.lines[joint.line as usize].places[joint.place as usize];
            (place.at.distance(at), *joint)
        })
    }

    /// Column and row of the cell of a place; the nearest beyond the grid.
    fn cell(&self, at: DVec2) -> [usize; 2] {
        let [columns, rows] = self.size;
        [(at.x.max(0.0) as usize).min(columns - 1), (at.y.max(0.0) as usize).min(rows - 1)]
    }
}
