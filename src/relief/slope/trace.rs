//! A line from its seed, up and down the slope.
//!
//! Method: the midpoint rule (Runge-Kutta of second order) in steps of a quarter of a cell on the lattice. Cost: two places a step,
//! and the room of each point.

use glam::DVec2;

use super::SlopePoint;
use super::land::{LandPlace, Walker};
use super::level::Blocks;
use super::neighbours::Neighbours;

/// Longest step, the smaller side of a cell.
const STEP: f64 = 0.25;
/// Least part of a step at the end of a line's reach.
const LEAST_STEP: f64 = 1e-3;
/// How far before a crest or a channel a line ends, the smaller side of a cell.
const SHORT: f64 = 0.1;
/// Least room with which a line goes on, spacings: it is not drawn there with the spacing of its level, but with that of the next
/// two, and others keep away from it.
const LEAST_ROOM: f64 = 0.5;
/// Shortest line, spacings.
const SHORTEST: f64 = 0.5;

/// Makes lines of a level.
#[derive(Debug)]
pub(super) struct Tracer<'a> {
    walker: Walker<'a>,
    spacing: f64,
    reach: f64,
    most_room: f32,
    step: f64,
    /// Steps from point to point.
    steps: usize,
    /// Metres before a crest or a channel.
    short: f64,
}

/// Where a step leads.
enum Step {
    On(LandPlace),
    End(LandPlace),
}

impl<'a> Tracer<'a> {
    /// Of lines of a level.
    pub(super) fn new(walker: Walker<'a>, blocks: &Blocks, level: u32) -> Self {
        let between = blocks.point_step(level);
        let steps = (between / (STEP * blocks.unit)).ceil();
        Self {
            walker,
            spacing: blocks.spacing(level),
            reach: blocks.reach(level),
            most_room: blocks.most_room(level) as f32,
            step: between / steps,
            steps: steps as usize,
            short: SHORT * blocks.unit,
        }
    }

    /// The line through a seed among others; none where it may not begin or gets too short.
    pub(super) fn line(&mut self, others: &Neighbours, seed: DVec2) -> Option<Vec<SlopePoint>> {
        if !others.leave(seed, self.spacing as f32) || !self.walker.land.may_slope(seed) {
            return None;
        }
        let seed = self.walker.place(seed).filter(|seed| self.walker.land.allows(seed, seed))?;
        let (mut points, up) = self.half(others, &seed, -1.0);
        points.reverse();
        points.push(self.point(&seed, others.room(seed.at, self.most_room, 0.0)));
        let (rest, down) = self.half(others, &seed, 1.0);
        points.extend(rest);
        (points.len() > 1 && up + down >= SHORTEST * self.spacing).then_some(points)
    }

    /// Points from a seed on down (`sign` 1) or up (-1), and how far they lead, metres.
    fn half(&mut self, others: &Neighbours, seed: &LandPlace, sign: f64) -> (Vec<SlopePoint>, f64) {
        let mut points = Vec::new();
        // Of the last point and of the last place.
        let (mut kept, mut here) = (*seed, *seed);
        let (mut walked, mut length, mut steps, mut goes_on) = (0.0, 0.0, 0, true);
        while goes_on {
            let step = self.step.min(self.reach - walked);
            let next = if step > LEAST_STEP * self.step { self.step(&here, sign * step, seed) } else { None };
            goes_on = matches!(next, Some(Step::On(_)));
            if let Some(Step::On(next) | Step::End(next)) = next {
                walked += next.at.distance(here.at);
                here = next;
                steps += 1;
            }
            if steps == self.steps || !goes_on && here.at != kept.at {
                let least = (LEAST_ROOM * self.spacing) as f32;
                let room = others.room(here.at, self.most_room, least);
                // Steps that pass beside the end of a crest may be cut short by it.
                if room < least || self.walker.land.met([kept.at, here.at]).is_some() {
                    break;
                }
                points.push(self.point(&here, room));
                (kept, length, steps) = (here, walked, 0);
            }
        }
        (points, length)
    }

    /// A step of so many metres downhill; none where a line must not go on.
    fn step(&mut self, here: &LandPlace, metres: f64, seed: &LandPlace) -> Option<Step> {
        let goes_on = |next: &LandPlace| next.downhill.dot(here.downhill) > 0.0;
        let middle = self.walker.place(here.at + here.downhill * (metres / 2.0)).filter(goes_on)?;
        let to = here.at + middle.downhill * metres;
        if let Some(share) = self.walker.land.met([here.at, to]) {
            let share = share - self.short / metres.abs();
            let end = (share > 0.0).then(|| self.walker.place(here.at.lerp(to, share))).flatten()?;
            return self.walker.land.allows(&end, seed).then_some(Step::End(end));
        }
        let next = self.walker.place(to).filter(goes_on)?;
        self.walker.land.allows(&next, seed).then_some(Step::On(next))
    }

    fn point(&self, place: &LandPlace, room: f32) -> SlopePoint {
        let at = self.walker.land.samples(place.at);
        let height = self.walker.land.height(place).unwrap_or(place.height) as f32;
        SlopePoint { at, height, gradient: place.gradient.as_vec2(), room }
    }
}
