//! A better order of strokes from a good one.
//!
//! Local search (Croes 1958, 2-opt; Or 1976): a run of strokes is drawn the other way round, or up to three strokes are drawn
//! elsewhere, where that makes the way through the air shorter. As Bentley 1992 has it, only those changes are looked at
//! that bring an end to one of its [`NEAR`] nearest, and after a change only the ends whose ways it changed are looked at
//! again. Runs longer than [`LONGEST`] stay as they are.
//!
//! Cost: the neighbours, and [`WORK`] strokes moved for each one there is, at most; about what the first order took.

use std::collections::VecDeque;

use glam::DVec2;
use rayon::prelude::*;

use super::nearest::Nearest;
use super::order::Visit;
use crate::ink::Stroke;

/// Ends that an end is brought to.
const NEAR: usize = 8;
/// Most strokes that a change moves.
const LONGEST: usize = 50_000;
/// Most strokes moved in all, for each stroke.
const WORK: usize = 3000;
/// Strokes that are drawn elsewhere, at most.
const SHIFTED: usize = 3;
/// Least way that a change must save, mm: more than rounding.
const SAVED: f64 = 1e-9;

/// An end of a stroke: twice its number in the first order, and one more for the end that was last there. Number 0 is the
/// place where the pen starts.
type End = usize;

fn other(end: End) -> End {
    end ^ 1
}

/// The strokes in their order.
struct Tour {
    /// Of each end.
    places: Vec<DVec2>,
    /// The end at which each begins.
    begins: Vec<End>,
    /// Where in the order each stands.
    at: Vec<usize>,
}

/// A change of the order, of strokes from one place in it to another, both included.
#[derive(Debug, Clone, Copy)]
enum Change {
    /// They are drawn backwards.
    Turn([usize; 2]),
    /// They are drawn elsewhere, so that `end` of one of them comes to lie beside `beside`.
    Shift { strokes: [usize; 2], end: End, beside: End },
}

/// What a change saves, mm, and the ends whose ways it changes.
type Gain = (f64, Change, [Option<End>; 6]);

/// The order with less way through the air, which begins at a place.
pub(super) fn improved(strokes: &[Stroke], visits: Vec<Visit>, from: DVec2) -> Vec<Visit> {
    let ends = visits.iter().flat_map(|visit| visit.ends);
    let mut tour = Tour {
        places: [from, from].into_iter().chain(ends).collect(),
        begins: (0..=visits.len()).map(|stroke| 2 * stroke).collect(),
        at: (0..=visits.len()).collect(),
    };
    tour.improve();
    let visit = |&begin: &End| match (visits[begin / 2 - 1], begin % 2) {
        (visit, 0) => visit,
        (visit, _) => visit.turned(strokes),
    };
    tour.begins[1..].iter().map(visit).collect()
}

impl Tour {
    fn improve(&mut self) {
        let near = self.near();
        let mut work = WORK * self.at.len();
        let mut open: VecDeque<End> = (1..self.places.len()).collect();
        let mut is_open = vec![true; self.places.len()];
        while let Some(end) = open.pop_front() {
            is_open[end] = false;
            let gains = near[end].iter().flat_map(|&beside| self.gains(end, beside as End));
            let best = gains.filter(|gain| gain.0 > SAVED).reduce(|a, b| if b.0 > a.0 { b } else { a });
            let Some((_, change, ends)) = best else { continue };
            let moved = self.make(change);
            for end in ends.into_iter().flatten() {
                if !std::mem::replace(&mut is_open[end], true) {
                    open.push_back(end);
                }
            }
            work = work.saturating_sub(moved);
            if work == 0 {
                break;
            }
        }
    }

    /// The nearest ends of other strokes; where there are fewer, the end itself.
    fn near(&self) -> Vec<[u32; NEAR]> {
        let mut tree = Nearest::new(self.places.iter().copied());
        // Nothing leads to where the pen starts, but from there.
        tree.remove(0);
        let near = |end: End| {
            let found = tree.find(self.places[end], NEAR, f64::INFINITY, |near| near as End / 2 != end / 2);
            std::array::from_fn(|i| found.get(i).map_or(end as u32, |&(_, near)| near))
        };
        (0..self.places.len()).into_par_iter().map(near).collect()
    }

    /// The end at which the stroke at a place in the order begins, and the one at which it ends.
    fn ends(&self, at: usize) -> [End; 2] {
        [self.begins[at], other(self.begins[at])]
    }

    fn is_begin(&self, end: End) -> bool {
        self.begins[self.at[end / 2]] == end
    }

    /// The end from which the pen comes to this one, or to which it goes.
    fn joined(&self, end: End) -> Option<End> {
        let at = self.at[end / 2];
        match self.is_begin(end) {
            true => at.checked_sub(1).map(|before| self.ends(before)[1]),
            false => self.begins.get(at + 1).copied(),
        }
    }

    /// Way between two ends; none behind the last stroke.
    fn way(&self, a: impl Into<Option<End>>, b: impl Into<Option<End>>) -> f64 {
        a.into().zip(b.into()).map_or(0.0, |(a, b)| self.places[a].distance(self.places[b]))
    }

    /// The changes that bring one end beside another that is nearer than what it is joined to now.
    fn gains(&self, end: End, beside: End) -> Vec<Gain> {
        if beside == end || self.way(end, beside) >= self.way(end, self.joined(end)) {
            return Vec::new();
        }
        let counts = 1..=SHIFTED;
        let shifts = counts.flat_map(|count| [self.shift(end, beside, count), self.shift(beside, end, count)]);
        shifts.chain([self.turn(end, beside)]).flatten().collect()
    }

    /// The strokes between two ends turned, so that these come to lie beside each other.
    fn turn(&self, a: End, b: End) -> Option<Gain> {
        let is_begin = self.is_begin(a);
        let [low, high] = [self.at[a / 2].min(self.at[b / 2]), self.at[a / 2].max(self.at[b / 2])];
        if is_begin != self.is_begin(b) || high - low > LONGEST {
            return None;
        }
        let [next_a, next_b] = [self.joined(a), self.joined(b)];
        let before = self.way(a, next_a) + self.way(b, next_b);
        let after = self.way(a, b) + self.way(next_a, next_b);
        let turned = if is_begin { [low, high - 1] } else { [low + 1, high] };
        Some((before - after, Change::Turn(turned), [Some(a), Some(b), next_a, next_b, None, None]))
    }

    /// So many strokes, from that of `end` on, drawn elsewhere, so that this end comes to lie beside another.
    fn shift(&self, end: End, beside: End, count: usize) -> Option<Gain> {
        let at = self.at[end / 2];
        let is_begin = self.is_begin(end);
        let [low, high] = if is_begin { [at, at + count - 1] } else { [(at + 1).checked_sub(count)?, at] };
        let target = self.at[beside / 2];
        let is_possible = low > 0 && high < self.begins.len() && !(low..=high).contains(&target);
        if !is_possible || target.abs_diff(at) > LONGEST {
            return None;
        }
        // The other end of them, and what the three are joined to.
        let far = if is_begin { self.ends(high)[1] } else { self.ends(low)[0] };
        let [next, behind, beyond] = [end, far, beside].map(|end| self.joined(end));
        if [next, behind].contains(&Some(beside)) {
            return None;
        }
        let before = self.way(end, next) + self.way(far, behind) + self.way(beside, beyond);
        let after = self.way(end, beside) + self.way(far, beyond) + self.way(next, behind);
        let change = Change::Shift { strokes: [low, high], end, beside };
        Some((before - after, change, [Some(end), Some(far), Some(beside), next, behind, beyond]))
    }

    /// Makes a change; returns how many strokes it moved.
    fn make(&mut self, change: Change) -> usize {
        let [low, high] = match change {
            Change::Turn(turned) => {
                self.turn_back(turned);
                turned
            }
            Change::Shift { strokes, end, beside } => self.move_beside(strokes, end, beside),
        };
        for at in low..=high {
            self.at[self.begins[at] / 2] = at;
        }
        high + 1 - low
    }

    fn turn_back(&mut self, [low, high]: [usize; 2]) {
        let turned = &mut self.begins[low..=high];
        turned.reverse();
        turned.iter_mut().for_each(|begin| *begin = other(*begin));
    }

    /// Moves strokes so that one of their ends lies beside another; returns what part of the order that changed.
    fn move_beside(&mut self, [low, high]: [usize; 2], end: End, beside: End) -> [usize; 2] {
        let count = high + 1 - low;
        let comes_before = self.is_begin(beside);
        // Where the first stroke behind the gap stands to which they come.
        let gap = self.at[beside / 2] + usize::from(!comes_before);
        let (changed, moved) = if gap > high {
            self.begins[low..gap].rotate_left(count);
            ([low, gap - 1], [gap - count, gap - 1])
        } else {
            self.begins[gap..=high].rotate_right(count);
            ([gap, high], [gap, gap + count - 1])
        };
        let touching = if comes_before { self.ends(moved[1])[1] } else { self.ends(moved[0])[0] };
        if touching != end {
            self.turn_back(moved);
        }
        changed
    }
}
