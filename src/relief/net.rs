//! Lines that do not cross: each ends where it comes near one that lies already.
//!
//! Lines are laid longest first. A line whose beginning is near another begins where it has left that; it ends on the first
//! that it comes near to, after which it would run beside it, no matter which one its water meets in the end. Cost: a few hashes a place.
//! Not handled: a line that comes near itself.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::trace::{Place, SPACING};

/// How near two lines come before they join, cells: so near that they could cross between two places.
const NEAR: f64 = 0.6;
/// How far the end of a branch may lie from the one that it joins, cells.
const FAR: f64 = 2.0;
/// Over how many places the end of a line bends to the one that it joins.
const BEND: usize = 6;

/// A place of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joint {
    /// Which line.
    pub line: u32,
    /// Which of its places.
    pub place: u32,
}

/// Lines by the cells that they run through.
#[derive(Debug, Default)]
pub struct Net {
    /// All that lie, each with the place of another that its last one is.
    pub lines: Vec<(Vec<Place>, Option<Joint>)>,
    /// The last place in each cell.
    cells: FxHashMap<[i32; 2], u32>,
    /// All places, each with the one before it in its cell.
    places: Vec<(Joint, Option<u32>)>,
}

impl Net {
    /// Lays a line, if it is anywhere not near another. Whether it joins one in the end is known.
    pub fn lay(&mut self, mut line: Vec<Place>, is_branch: bool) {
        let Some(first) = line.iter().position(|place| self.near(place.at, NEAR).is_none()) else { return };
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
        if line.len() >= 2 {
            self.keep(line, joint);
        }
    }

    /// Moves the end of a line onto its joint, and what comes before it less and less.
    fn bend(&self, line: &mut Vec<Place>, joint: Joint) {
        let to = self.lines[joint.line as usize].0[joint.place as usize].at;
        let last = line.len() - 1;
        let by = to - line[last].at;
        let bend = BEND.min(last);
        for k in 0..=bend {
            let share = 1.0 - k as f64 / (bend + 1) as f64;
            line[last - k].at += by * (share * share);
        }
        line[last].at = to;
        let close = |pair: &[Place]| pair[0].at.distance(pair[1].at) < SPACING / 4.0;
        while line.len() > 2 && close(&line[line.len() - 2..]) {
            line.remove(line.len() - 2);
        }
    }

    fn keep(&mut self, line: Vec<Place>, joint: Option<Joint>) {
        for (k, place) in line.iter().enumerate() {
            let at = Joint { line: self.lines.len() as u32, place: k as u32 };
            let number = self.places.len() as u32;
            let before = self.cells.insert(cell(place.at), number);
            self.places.push((at, before));
        }
        self.lines.push((line, joint));
    }

    /// The nearest place of all lines, within a radius.
    fn near(&self, at: DVec2, radius: f64) -> Option<Joint> {
        let [west, north] = cell(at - radius);
        let [east, south] = cell(at + radius);
        let mut nearest = (radius, None);
        for r in north..=south {
            for c in west..=east {
                let mut next = self.cells.get(&[c, r]).copied();
                while let Some((joint, before)) = next.map(|next| self.places[next as usize]) {
                    let place = self.lines[joint.line as usize].0[joint.place as usize];
                    let distance = place.at.distance(at);
                    if distance < nearest.0 {
                        nearest = (distance, Some(joint));
                    }
                    next = before;
                }
            }
        }
        nearest.1
    }
}

fn cell(at: DVec2) -> [i32; 2] {
    [at.x.floor() as i32, at.y.floor() as i32]
}
