//! Heights that cannot be, told from a tally of a file's numbers: marks for no data that nobody declared, numbers below
//! zero that wrapped round, units that are not metres.
//!
//! A mark is one exact number at an end of the range that stands far from all others: farther than a tenth of their
//! range, and ten times as far as they stand from one another. The largest number of the type is one, and -9999 where
//! nothing is lower, or nothing else is there; so is what is off the Earth in every unit. On Earth no land is outside -11 100 to 8 900 m. Not handled: marks amid the heights, such as a sea of
//! -1, and what was smeared by a warp before the file was written, but for what is off the Earth.

use gdal::raster::GdalDataType;

use super::elevation::{EARTH, Elevation, Reading};
use super::stored::shown;
use super::tally::{Beyond, Tally};
use crate::error::{Message, MessagePart, Setting};
use crate::geo::{Encoding, Nodata};
use crate::message;

/// A gap this large against the range of all others sets a number apart …
const OF_RANGE: f64 = 0.1;
/// … where it is so many times the distance between the others next to it.
const OF_SPACING: f64 = 10.0;
/// Distinct numbers that there must be beside it: land of two or three heights is a drawing, not a measurement.
const OTHERS: usize = 3;
/// The usual mark of those who cannot write one that is impossible.
const USUAL: f64 = -9999.0;
/// Most numbers named one by one.
const NAMED: usize = 4;
/// Units smaller than the metre: their names as settings have them, and metres.
const UNITS: [(&str, f64); 3] = [("dm", 0.1), ("cm", 0.01), ("mm", 0.001)];
/// Metres of a foot.
const FOOT: f64 = 0.3048;
/// Metres that a DEM must reach for a unit to be likely.
const LOWEST_TOP: f64 = 30.0;

/// One file's numbers on trial.
struct FileTrial<'a> {
    tally: &'a Tally,
    elevation: &'a Elevation,
    /// Numbers not yet told to be marks, from the outermost on.
    low: Vec<(f64, u64)>,
    high: Vec<(f64, u64)>,
    marks: Vec<(f64, u64)>,
    wrapped: bool,
    /// Of the numbers that pass for marks by their size alone, below and above zero, those that are heights in some unit.
    huge: [Beyond; 2],
}

/// What is assumed of numbers that hardly are heights, each with what to do, to stand behind "assumed that".
pub(super) fn doubts(tally: &Tally, elevation: &Elevation) -> Vec<Message> {
    let mut trial = FileTrial::new(tally, elevation);
    let wrapped = trial.wrapped();
    trial.take_marks();
    let (marked, outside) = (trial.marked(), trial.outside());
    wrapped.into_iter().chain(marked).chain(outside).collect()
}

/// The numbers that are heights as far as files say, and probably marks.
pub(super) fn marks(tally: &Tally, elevation: &Elevation) -> Vec<f64> {
    let mut trial = FileTrial::new(tally, elevation);
    // Numbers that wrapped round are none.
    trial.wrapped();
    trial.take_marks();
    trial.marks.into_iter().map(|(number, _)| number).collect()
}

/// What to ask for where numbers lost their sign.
fn signed() -> MessagePart {
    Setting::Encoding.at(Encoding::Signed.name())
}

/// Units other than the metre in which all numbers are heights on Earth, if there are any, and how high they reach then.
pub(super) fn other_units(tally: &Tally, elevation: &Elevation) -> Option<Message> {
    let trial = FileTrial::new(tally, elevation);
    let huge = trial.huge();
    if huge == [0; 2] { None } else { trial.units(huge) }
}

/// The numbers that are voids by their impossible value alone, as nodata: one by one, or as ranges where they are too
/// many. Those left out that are heights in another unit.
pub(super) fn sentinels(tally: &Tally, elevation: &Elevation) -> Vec<[f64; 2]> {
    let is_sentinel = |number: f64| elevation.reading(number) == Reading::Sentinel;
    let both = tally.low.iter().chain(&tally.high);
    let mut found: Vec<_> = both.filter(|(number, _)| is_sentinel(*number)).copied().collect();
    found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    found.dedup();
    let trial = FileTrial::new(tally, elevation);
    let is_height =
        |number: f64| (0..2).any(|i| trial.huge()[i] > 0 && (number > 0.0) == (i == 1) && !trial.is_off(number));
    found.retain(|(number, _)| !is_height(*number));
    let heights = trial.huge().iter().sum::<u64>();
    let known = found.iter().map(|(_, count)| *count).sum::<u64>() + heights;
    let typed = |number: f64| shown(number, elevation.kind()).parse().unwrap_or(number);
    if known == tally.marks as u64 && found.len() <= NAMED {
        return found.iter().map(|(number, _)| [typed(*number); 2]).collect();
    }
    let sides = [0, 1].map(|i| (trial.huge()[i] == 0 && tally.huge[i].count > 0).then_some(tally.huge[i]));
    sides.into_iter().flatten().map(|side| [side.least, side.greatest].map(typed)).collect()
}

impl<'a> FileTrial<'a> {
    fn new(tally: &'a Tally, elevation: &'a Elevation) -> Self {
        let heights = |list: &[(f64, u64)]| {
            let sound = |(number, _): &&(f64, u64)| matches!(elevation.reading(*number), Reading::Metres(_));
            list.iter().filter(sound).copied().collect::<Vec<_>>()
        };
        let (low, high) = (heights(&tally.low), heights(&tally.high));
        let mut trial =
            Self { tally, elevation, low, high, marks: Vec::new(), wrapped: false, huge: [Beyond::NONE; 2] };
        trial.huge = [trial.rest(&tally.low, 0), trial.rest(&tally.high, 1)];
        trial
    }

    /// Whether a number is off the Earth in every unit.
    fn is_off(&self, number: f64) -> bool {
        let smallest = UNITS[UNITS.len() - 1].1;
        !self.is_on_earth(number, number, smallest)
    }

    /// Of the numbers on a side that pass for marks by their size, those that are on Earth in some unit; `list` goes from
    /// the outermost inward.
    fn rest(&self, list: &[(f64, u64)], side: usize) -> Beyond {
        let all = self.tally.huge[side];
        let off: u64 = list.iter().take_while(|(number, _)| self.is_off(*number)).map(|(_, count)| count).sum();
        let next = list.iter().map(|(number, _)| *number).find(|number| !self.is_off(*number));
        let next = next
            .filter(|number| self.elevation.reading(*number) == Reading::Sentinel && (*number > 0.0) == (side == 1));
        match next {
            Some(_) if off == 0 => all,
            Some(least) if side == 0 => Beyond { count: all.count - off.min(all.count), least, ..all },
            Some(greatest) => Beyond { count: all.count - off.min(all.count), greatest, ..all },
            None => Beyond::NONE,
        }
    }

    /// Numbers in the upper half of an unsigned type, none near the middle: they were below zero.
    fn wrapped(&mut self) -> Option<Message> {
        let Tally { upper, below, high, .. } = self.tally;
        let modulus = self.elevation.modulus();
        let distinct = high.iter().filter(|(number, _)| *number >= modulus / 2.0).count();
        let whole = upper.least.fract() == 0.0 && upper.greatest < modulus;
        // Two may be two marks, unless the others go down to zero.
        let through_zero = self.low.first().is_some_and(|(least, _)| (0.0..below * OF_RANGE).contains(least));
        let several = distinct >= OTHERS || (distinct == 2 && through_zero);
        if !several || !whole || self.elevation.is_signed() || upper.least - below.max(0.0) < modulus / 2.0 {
            return None;
        }
        self.wrapped = true;
        self.high = vec![(*below, 1)];
        let [least, greatest] = [upper.least, upper.greatest].map(|number| number - modulus);
        let heights = format!("{} from {} to {} are heights", self.share(upper.count), upper.least, upper.greatest);
        let like = format!(" (they look like {least} to {greatest}, stored without a sign; if they are, add ");
        Some(message![heights, like, signed(), ")"])
    }

    /// Moves numbers that stand apart from the ends of the range to `marks`, until neither end has one.
    fn take_marks(&mut self) {
        loop {
            let [Some(low), Some(high)] = [self.low.first(), self.high.first()].map(|end| end.map(|end| end.0)) else {
                return;
            };
            if low == high && low == USUAL && self.marks.is_empty() {
                self.marks.push(self.low.remove(0));
                self.high.clear();
            }
            if low >= high {
                return;
            }
            let (at_low, at_high) = (self.is_mark(&self.low, high), !self.wrapped && self.is_mark(&self.high, low));
            if at_high {
                self.marks.push(self.high.remove(0));
            } else if at_low {
                self.marks.push(self.low.remove(0));
            } else {
                return;
            }
        }
    }

    /// Whether the first number of `list`, which goes from one end of the range inward, is no height; `far` is the other
    /// end.
    fn is_mark(&self, list: &[(f64, u64)], far: f64) -> bool {
        let [(number, count), others @ ..] = list else { return false };
        if self.is_last_of_type(*number) {
            return true;
        }
        let Some((next, _)) = others.first() else { return false };
        let (gap, range) = ((next - number).abs(), (far - next).abs());
        if *number == USUAL && *number < *next && (*count > 1 || gap > range / 2.0) {
            return true;
        }
        let spacing = match others {
            [_, .., (last, _)] => (last - next).abs() / (others.len() - 1) as f64,
            _ => range,
        };
        let apart = gap > OF_RANGE * range && (gap > OF_SPACING * spacing || gap > range);
        *count > 1 && others.len() >= OTHERS && apart
    }

    /// The largest number of an integer type; 0, the smallest of an unsigned one, is a height like others.
    fn is_last_of_type(&self, number: f64) -> bool {
        match self.elevation.kind() {
            GdalDataType::UInt16 => !self.elevation.is_signed() && number == f64::from(u16::MAX),
            GdalDataType::Int16 => number == f64::from(i16::MAX),
            GdalDataType::UInt32 => !self.elevation.is_signed() && number == f64::from(u32::MAX),
            GdalDataType::Int32 => number == f64::from(i32::MAX) || number == f64::from(i32::MIN),
            _ => false,
        }
    }

    fn marked(&self) -> Option<Message> {
        if self.marks.is_empty() {
            return None;
        }
        let each = |(number, count): &(f64, u64)| format!("{} of exactly {}", self.share(*count), self.shown(*number));
        let marks = self.marks.iter().map(each).collect::<Vec<_>>().join(" and ");
        let ends = [self.low.first(), self.high.first()].map(|end| end.map_or(f64::NAN, |end| end.0));
        let none = ends[0].is_nan();
        let [low, high] = ends.map(|end| self.shown(end));
        let all = match low == high {
            _ if none => "there are no others".to_owned(),
            true => format!("all others are {low}"),
            false => format!("all others are {low} to {high}"),
        };
        let mut clause = message![
            format!("{marks} are heights ({all}; if they mark missing data, add "),
            Setting::Nodata.at(self.nodata(&[]))
        ];
        let minus = self.elevation.modulus() - 1.0;
        let wrapped =
            self.marks.iter().any(|(number, _)| *number == minus) && self.low.first().is_some_and(|end| end.0 == 0.0);
        if wrapped {
            clause.push(message![", if they are -1 without its sign, ", signed()]);
        }
        clause.push(")");
        Some(clause)
    }

    /// What is left outside all land of the Earth.
    fn outside(&self) -> Option<Message> {
        let huge = self.huge();
        let sides = [self.beyond(0, huge), self.beyond(1, huge)];
        let (mut clauses, mut ranges, mut all) = (Vec::new(), Vec::new(), 0);
        for (side, (count, numbers)) in sides.iter().enumerate() {
            let (Some((least, _)), Some((greatest, _))) = (numbers.first(), numbers.last()) else { continue };
            let known = numbers.iter().map(|(_, count)| count).sum::<u64>() == *count;
            let one_by_one = known && numbers.len() <= NAMED;
            ranges.extend(numbers.iter().filter(|_| one_by_one).map(|(number, _)| [*number; 2]));
            ranges.extend((!one_by_one).then_some([*least, *greatest]));
            let span = [least, greatest].map(|number| self.shown(*number));
            let span = if least == greatest { span[0].clone() } else { span.join(" to ") };
            let word = ["below", "above"][side];
            clauses.push(format!("{} of {span}, {word} all land on Earth ({} m),", self.share(*count), EARTH[side]));
            all += count;
        }
        if clauses.is_empty() {
            return None;
        }
        let units = self.units(huge);
        let nodata = message!["if they are no heights, add ", Setting::Nodata.at(self.nodata(&ranges))];
        // Whatever the unit, where most are land in metres the others may be none.
        let few = all < self.tally.samples / 2;
        let remedy = match units {
            Some(units) if few => message!["if it is another, add ", units, "; ", nodata],
            Some(units) => message!["if it is another, add ", units],
            None => nodata,
        };
        Some(message![format!("{} are heights in the right unit (", clauses.join(" and ")), remedy, ")"])
    }

    /// How many numbers lie below (0) or above (1) all land on Earth, marks left out, and the outermost of them from the
    /// least on, each with its count where that is known. `huge` are those that pass for marks by their size alone.
    fn beyond(&self, side: usize, huge: [u64; 2]) -> (u64, Vec<(f64, u64)>) {
        let metres = |number: f64| match self.elevation.reading(number) {
            Reading::Metres(metres) => metres,
            _ => f64::NAN,
        };
        let is_beyond = |number: f64| if side == 0 { metres(number) < EARTH[0] } else { metres(number) > EARTH[1] };
        let marked: u64 = self.marks.iter().filter(|(number, _)| is_beyond(*number)).map(|(_, count)| count).sum();
        let of = self.tally.outside[side];
        let wrapped = if self.wrapped && side == 1 { self.tally.upper.count } else { 0 };
        let count = of.count.saturating_sub(marked + wrapped);
        let ends = self.low.iter().chain(&self.high).filter(|(number, _)| is_beyond(*number)).copied();
        let mut numbers: Vec<_> = if count > 0 { ends.collect() } else { Vec::new() };
        let mut further = Vec::new();
        if count > 0 {
            further.extend([of.least, of.greatest]);
        }
        let sign = if self.elevation.is_depth() { 1 - side } else { side };
        if huge[sign] > 0 {
            further.extend([self.huge[sign].least, self.huge[sign].greatest]);
        }
        further.retain(|number| !numbers.iter().chain(&self.marks).any(|(known, _)| known == number));
        if self.wrapped {
            further.retain(|number| *number < self.tally.upper.least);
        }
        numbers.extend(further.into_iter().map(|number| (number, 0)));
        numbers.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        numbers.dedup();
        (count + huge[sign], numbers)
    }

    /// How many numbers below and above zero that pass for marks by their size alone are many different ones, as heights
    /// in a small unit are.
    fn huge(&self) -> [u64; 2] {
        let (Tally { low, high, .. }, huge) = (self.tally, self.huge);
        let within = |list: &[(f64, u64)], of: Beyond| {
            list.iter().filter(|(number, _)| (of.least..=of.greatest).contains(number)).count()
        };
        let distinct = [within(low, huge[0]), within(high, huge[1])];
        let smallest = UNITS[UNITS.len() - 1].1;
        let fits = self.is_on_earth(huge[0].least, huge[1].greatest, smallest) && self.elevation.is_plain_metres();
        [0, 1].map(|side| if fits && distinct[side] > OTHERS { huge[side].count } else { 0 })
    }

    /// Whether numbers from `least` to `greatest` of a unit of so many metres are on Earth; beyond them is nothing.
    fn is_on_earth(&self, least: f64, greatest: f64, metres: f64) -> bool {
        let (least, greatest) = (least.min(0.0) * metres, greatest.max(0.0) * metres);
        let [low, high] = if self.elevation.is_depth() { [-greatest, -least] } else { [least, greatest] };
        low >= EARTH[0] && high <= EARTH[1]
    }

    /// Units in which all that is left is on Earth, each with how far it reaches.
    fn units(&self, huge: [u64; 2]) -> Option<Message> {
        if !self.elevation.is_plain_metres() {
            return None;
        }
        let greatest = self.high.first().map_or(f64::NEG_INFINITY, |end| end.0);
        let greatest = if huge[1] > 0 { self.huge[1].greatest } else { greatest };
        let least = self.low.first().map_or(f64::INFINITY, |end| end.0);
        let least = if huge[0] > 0 { self.huge[0].least } else { least };
        let farthest = greatest.max(-least);
        let likely = |metres: f64| self.is_on_earth(least, greatest, metres) && farthest * metres > LOWEST_TOP;
        let units = UNITS.into_iter().chain([("ft", FOOT)]).filter(|(_, metres)| likely(*metres));
        let far = if greatest >= -least { greatest } else { least };
        let told = units
            .map(|(unit, metres)| message![Setting::ElevationUnit.at(unit), format!(": up to {:.1} m", far * metres)]);
        told.reduce(|first, other| message![first, ", or ", other])
    }

    /// What to give as nodata: what was said before, the marks, and `more`.
    fn nodata(&self, more: &[[f64; 2]]) -> Nodata {
        let as_shown = |number: f64| self.shown(number).parse().unwrap_or(number);
        let marks: Vec<_> = self.marks.iter().map(|(number, _)| [as_shown(*number); 2]).collect();
        let more: Vec<_> = more.iter().map(|range| range.map(as_shown)).collect();
        self.elevation.said().with(&marks).with(&more)
    }

    /// So many samples and their share.
    fn share(&self, count: u64) -> String {
        let percent = 100.0 * count as f64 / self.tally.samples.max(1) as f64;
        let few = if percent < 0.1 { "under 0.1".to_owned() } else { format!("{percent:.1}") };
        format!("{count} {} ({few} %)", if count == 1 { "sample" } else { "samples" })
    }

    fn shown(&self, number: f64) -> String {
        shown(number, self.elevation.kind())
    }
}
