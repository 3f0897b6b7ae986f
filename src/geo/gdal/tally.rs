//! What the numbers of a file look like, counted as they are read: enough to tell marks and mistaken units from heights.
//!
//! Two tallies of parts make that of the whole, exactly, whatever the order: the outermost distinct numbers of the whole
//! are among those of the parts. Cost: a few comparisons a sample.

use std::collections::BTreeMap;

use super::elevation::{Elevation, Reading};
use super::grain::Grain;

/// Distinct numbers that are kept at each end.
const KEPT: usize = 16;

/// Tallies of the files of a layer, by their place in it; of those that were read.
pub(super) type Tallies = BTreeMap<usize, Tally>;

/// Figures of numbers as the file has them, those declared void left out.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    /// Samples, voids among them.
    pub samples: u64,
    /// Numbers that are void by their impossible value alone.
    pub marks: usize,
    /// The least numbers, from the least on, each with its count.
    pub low: Vec<(f64, u64)>,
    /// The greatest numbers, from the greatest on, each with its count.
    pub high: Vec<(f64, u64)>,
    /// Numbers whose metres are below and above all land of the planet.
    pub outside: [Beyond; 2],
    /// Of the marks, those below and those above zero.
    pub huge: [Beyond; 2],
    /// Numbers in the upper half of the unsigned type that wraps round.
    pub upper: Beyond,
    /// The greatest number in its lower half.
    pub below: f64,
    /// Of which step they may be multiples, marks left out.
    pub grain: Grain,
    half: f64,
    limits: [f64; 2],
}

/// Numbers beyond a limit: how many, the least and the greatest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beyond {
    pub count: u64,
    pub least: f64,
    pub greatest: f64,
}

impl Beyond {
    pub(super) const NONE: Self = Self { count: 0, least: f64::INFINITY, greatest: f64::NEG_INFINITY };

    fn add(&mut self, number: f64) {
        *self = self.with(Self { count: 1, least: number, greatest: number });
    }

    pub(super) fn with(self, other: Self) -> Self {
        let (least, greatest) = (self.least.min(other.least), self.greatest.max(other.greatest));
        Self { count: self.count + other.count, least, greatest }
    }
}

impl Tally {
    /// Of no samples, under the rules of `elevation`.
    pub(super) fn new(elevation: &Elevation) -> Self {
        Self {
            samples: 0,
            marks: 0,
            low: Vec::with_capacity(KEPT + 1),
            high: Vec::with_capacity(KEPT + 1),
            outside: [Beyond::NONE; 2],
            huge: [Beyond::NONE; 2],
            upper: Beyond::NONE,
            below: f64::NEG_INFINITY,
            grain: Grain::new(),
            half: elevation.modulus() / 2.0,
            limits: elevation.limits(),
        }
    }

    /// Counts a sample, void or not.
    pub(super) fn add(&mut self, number: f64, reading: Reading) {
        self.samples += 1;
        if matches!(reading, Reading::Metres(_)) {
            self.grain.add(number);
        }
        match reading {
            Reading::Void => return,
            Reading::Metres(metres) if metres < self.limits[0] => self.outside[0].add(number),
            Reading::Metres(metres) if metres > self.limits[1] => self.outside[1].add(number),
            Reading::Metres(_) => {}
            Reading::Sentinel => {
                self.marks += 1;
                self.huge[usize::from(number > 0.0)].add(number);
            }
        }
        if number >= self.half {
            self.upper.add(number);
        } else {
            self.below = self.below.max(number);
        }
        add(&mut self.low, (number, 1), |a, b| a < b);
        add(&mut self.high, (number, 1), |a, b| a > b);
    }

    /// Takes over those of other samples of the same file.
    pub(super) fn merge(&mut self, other: &Self) {
        self.samples += other.samples;
        self.marks += other.marks;
        for (mine, theirs) in self.outside.iter_mut().zip(other.outside) {
            *mine = mine.with(theirs);
        }
        for (mine, theirs) in self.huge.iter_mut().zip(other.huge) {
            *mine = mine.with(theirs);
        }
        self.upper = self.upper.with(other.upper);
        self.below = self.below.max(other.below);
        self.grain.merge(&other.grain);
        other.low.iter().for_each(|entry| add(&mut self.low, *entry, |a, b| a < b));
        other.high.iter().for_each(|entry| add(&mut self.high, *entry, |a, b| a > b));
    }
}

/// Takes over tallies of other samples.
pub(super) fn merge(all: &mut Tallies, of_part: Tallies) {
    for (place, tally) in of_part {
        all.entry(place).and_modify(|known| known.merge(&tally)).or_insert(tally);
    }
}

/// Counts numbers in a list of the outermost ones, `outer` before others.
fn add(list: &mut Vec<(f64, u64)>, (number, count): (f64, u64), outer: impl Fn(f64, f64) -> bool) {
    if list.len() == KEPT && outer(list[KEPT - 1].0, number) {
        return;
    }
    let place = list.iter().position(|(known, _)| !outer(*known, number)).unwrap_or(list.len());
    match list.get_mut(place).filter(|(known, _)| *known == number) {
        Some((_, known)) => *known += count,
        None => {
            list.insert(place, (number, count));
            list.truncate(KEPT);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_the_whole() {
        let number = |i: u64| ((i * i * 7919) % 97) as f64 * 300.0 - 900.0;
        let of = |range: std::ops::Range<u64>| {
            let mut tally = Tally::new(&Elevation::plain());
            range.for_each(|i| tally.add(number(i), Elevation::plain().reading(number(i))));
            tally
        };
        let whole = of(0..1000);
        let mut parts = of(600..1000);
        parts.merge(&of(0..123));
        parts.merge(&of(123..600));
        assert_eq!((&parts.low, &parts.high), (&whole.low, &whole.high));
        assert_eq!((parts.outside, parts.samples), (whole.outside, 1000));
        assert!(whole.low.is_sorted_by(|a, b| a.0 < b.0) && whole.high.is_sorted_by(|a, b| a.0 > b.0));
        assert!(whole.outside[1].count > 0 && whole.outside[0].count == 0);
    }
}
