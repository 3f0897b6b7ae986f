//! The step of which all numbers of a file are multiples, found as they are read.
//!
//! Two ways, both of parts that make the whole exactly: the greatest common divisor in twentieths of the file's unit, for
//! whole numbers, tenths and their multiples, and in half feet of either kind, for feet that were stored as metres; and all
//! distinct numbers, while they are few, for maps of 8 bits that were spread over the relief. Stored in 32 bits a tenth is no
//! tenth: a number counts as a multiple that is one to within its rounding. Cost: a few operations a sample; after some
//! hundred samples without a step a look at a few flags. Not handled: steps finer than these, and others or beside a
//! constant part of more than [`MOST`] levels.

/// The finest steps that are looked for in all numbers: a twentieth, half an international and half a US survey foot. The
/// first counts that all numbers are multiples of.
const FINEST: [f64; 3] = [0.05, 0.1524, 600.0 / 3937.0];
/// Distinct numbers that are kept.
const MOST: usize = 256;
/// Fewer distinct numbers say nothing of a step: a plain and a tableland are multiples of their difference.
const LEVELS: usize = 6;
/// Whole numbers by their type are known to be a step apart; fewer of them have no stairs.
const WHOLE_LEVELS: usize = 2;
/// Nor do fewer samples: a handful of whole numbers is a coincidence, or too small to have stairs.
const SAMPLES: u64 = 1024;
/// Distinct numbers at each end that may be marks: what the others have in common is known without them.
const ENDS: usize = 4;
/// How far a number in 32 bits may be from the one meant, as a share of it: half a unit in its last place.
const ROUNDING: f64 = 6e-8;
/// The same in steps, at most: beyond it every number would be a multiple.
const LARGEST_ROUNDING: f64 = 0.02;
/// Added and taken away again, it rounds numbers below 2 to the power of 51 to whole ones.
const TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// Of which step the numbers of some samples may be multiples.
#[derive(Debug, Clone)]
pub(super) struct Grain {
    /// In each of the units of [`FINEST`]; 0 while all numbers are 0, `None` once one is no multiple.
    divisors: [Option<u64>; 3],
    /// All distinct numbers, the least first; `None` once they are more than [`MOST`].
    distinct: Option<Vec<f64>>,
    /// The least numbers, from the least on, and the greatest, from the greatest on; they count for nothing above.
    ends: [Vec<f64>; 2],
    last: f64,
    samples: u64,
}

/// What a file's numbers say of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Found {
    /// All are multiples of it, in the file's unit.
    Step(f64),
    /// Too few or too much alike to tell; all are multiples of this, 0 where all are 0.
    Unsure(f64),
    /// There is none.
    None,
}

impl Grain {
    /// Of no samples.
    pub(super) fn new() -> Self {
        Self {
            divisors: [Some(0); 3],
            distinct: Some(Vec::new()),
            ends: [(); 2].map(|()| Vec::with_capacity(ENDS + 1)),
            last: f64::NAN,
            samples: 0,
        }
    }

    /// Counts a number.
    #[inline]
    pub(super) fn add(&mut self, number: f64) {
        self.samples += 1;
        if number != self.last && self.may_have() {
            self.last = number;
            self.place(number);
        }
    }

    /// Puts a number among those at the ends, or counts it and what has to make room there.
    fn place(&mut self, number: f64) {
        let [low, high] = &self.ends;
        let is_inner = |end: &[f64]| end.len() == ENDS;
        if is_inner(low) && is_inner(high) && low[ENDS - 1] < number && number < high[ENDS - 1] {
            return self.count(number);
        }
        let inner =
            [end_with(&mut self.ends[0], number, |a, b| a < b), end_with(&mut self.ends[1], number, |a, b| a > b)];
        for number in inner.into_iter().flatten() {
            if self.ends.iter().all(|end| !end.contains(&number)) {
                self.count(number);
            }
        }
    }

    /// Counts a number that is no mark.
    #[inline]
    fn count(&mut self, number: f64) {
        for (divisor, unit) in self.divisors.iter_mut().zip(FINEST) {
            *divisor = divisor.and_then(|divisor| common(divisor, number / unit));
        }
        self.distinct = self.distinct.take().and_then(|distinct| with(distinct, number));
    }

    /// Takes over other samples of the same file.
    pub(super) fn merge(&mut self, other: &Self) {
        self.samples += other.samples;
        for (mine, theirs) in self.divisors.iter_mut().zip(other.divisors) {
            *mine = mine.zip(theirs).map(|(a, b)| greatest_common(a, b));
        }
        self.distinct = match (self.distinct.take(), &other.distinct) {
            (Some(mine), Some(theirs)) => theirs.iter().try_fold(mine, |list, number| with(list, *number)),
            _ => None,
        };
        other.ends.iter().flatten().for_each(|number| self.place(*number));
    }

    /// Whether there may still be a step.
    #[inline]
    pub(super) fn may_have(&self) -> bool {
        self.distinct.is_some() || self.divisors.iter().any(Option::is_some)
    }

    /// What the samples say, `marks` left out; `is_whole`: their type holds whole numbers alone, so that 1 is a step where there are too few
    /// levels for a larger one, as on polders and in crops.
    pub(super) fn found(&self, marks: &[f64], is_whole: bool) -> Found {
        let mut all = self.clone();
        let is_height = |number: &&f64| !marks.contains(*number);
        self.ends.iter().flatten().filter(is_height).for_each(|number| all.count(*number));
        all.said(is_whole)
    }

    /// What the numbers say that were counted.
    fn said(&self, is_whole: bool) -> Found {
        let spread = || self.distinct.as_deref().and_then(evenly_spread);
        let fewer = |levels| self.distinct.as_ref().is_some_and(|distinct| distinct.len() < levels);
        let few = self.samples < SAMPLES || fewer(LEVELS);
        let units = self.divisors.into_iter().zip(FINEST);
        match units.filter_map(|(divisor, unit)| Some(divisor? as f64 * unit)).next() {
            Some(_) if is_whole && few && self.samples >= SAMPLES && !fewer(WHOLE_LEVELS) => Found::Step(1.0),
            Some(step) if few => Found::Unsure(step),
            // Whole steps beside a constant part have a smaller divisor.
            Some(step) => Found::Step(spread().map_or(step, |spread| spread.max(step))),
            None if few => Found::None,
            None => spread().map_or(Found::None, Found::Step),
        }
    }
}

/// The greatest common divisor with a number, both in the same unit; `None` where it is no multiple of that.
#[inline]
fn common(divisor: u64, times: f64) -> Option<u64> {
    let whole = (times + TO_WHOLE) - TO_WHOLE;
    // Beyond, there is nothing behind the point.
    let is_whole = times.abs() < 1e15 && (times - whole).abs() <= (times.abs() * ROUNDING).min(LARGEST_ROUNDING);
    let whole = whole.abs() as u64;
    is_whole.then(|| match divisor {
        1.. if whole.is_multiple_of(divisor) => divisor,
        _ => greatest_common(divisor, whole),
    })
}

fn greatest_common(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Puts a number into an end, `outer` before others, and gives the one that has no place there.
fn end_with(end: &mut Vec<f64>, number: f64, outer: impl Fn(f64, f64) -> bool) -> Option<f64> {
    let place = end.iter().position(|known| !outer(*known, number)).unwrap_or(end.len());
    if end.get(place) != Some(&number) {
        end.insert(place, number);
    }
    if end.len() > ENDS { end.pop() } else { None }
}

/// The list with one more number; `None` where it is full.
fn with(mut list: Vec<f64>, number: f64) -> Option<Vec<f64>> {
    let place = list.partition_point(|known| *known < number);
    if list.get(place) != Some(&number) {
        list.insert(place, number);
    }
    (list.len() <= MOST).then_some(list)
}

/// The step between sorted numbers that are all whole steps apart.
fn evenly_spread(numbers: &[f64]) -> Option<f64> {
    let [low, .., high] = *numbers else { return None };
    let least = numbers.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    // The least gap has the rounding of two numbers, all of it together that of two in many.
    let step = (high - low) / ((high - low) / least).round();
    let rounding = 2.0 * ROUNDING * low.abs().max(high.abs()) / step;
    let is_whole = |number: &f64| {
        let times = (number - low) / step;
        (times - times.round()).abs() <= rounding
    };
    (rounding < LARGEST_ROUNDING && numbers.iter().all(is_whole)).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of many numbers about those of a valley, made by `of` from heights that are no multiples of anything.
    fn of(of: impl Fn(f64) -> f64) -> Grain {
        let mut grain = Grain::new();
        (0..5000).for_each(|i| grain.add(of(700.0 + 350.0 * (f64::from(i) * 0.37).sin() + f64::from(i) * 0.013)));
        grain
    }

    fn rounded(step: f64) -> impl Fn(f64) -> f64 {
        move |height| f64::from(((height / step).round() * step) as f32)
    }

    fn step(grain: &Grain) -> Option<f64> {
        match grain.found(&[], false) {
            Found::Step(step) => Some(step),
            _ => None,
        }
    }

    #[test]
    fn steps_are_found_whatever_they_are() {
        for true_step in [0.05, 0.1, 0.5, 1.0, 2.0, 2.5, 5.0, 10.0, 20.0, 50.0, 100.0] {
            let found = step(&of(rounded(true_step))).unwrap_or(0.0);
            assert!((found - true_step).abs() < 1e-9, "{found}, not {true_step}");
        }
        // A map of 8 bits spread over the relief, stairs of a third, and whole steps beside a constant part.
        for true_step in [777.7 / 255.0, 100.0 / 3.0, 10.0] {
            let found = step(&of(|height| f64::from((123.4 + (height / true_step).round() * true_step) as f32)));
            assert!(found.is_some_and(|found| (found - true_step).abs() < 1e-5), "{found:?}, not {true_step}");
        }
    }

    #[test]
    fn feet_are_found_in_metres() {
        for foot in [0.3048, 1200.0 / 3937.0] {
            let feet = of(rounded(foot));
            assert!(feet.distinct.is_none(), "more levels than are kept");
            let found = step(&feet).unwrap_or(0.0);
            assert!((found - foot).abs() < 1e-9, "{found}, not {foot}");
            let tens = step(&of(rounded(10.0 * foot))).unwrap_or(0.0);
            assert!((tens - 10.0 * foot).abs() < 1e-5, "{tens}, not ten of {foot}");
        }
    }

    #[test]
    fn what_has_no_step_has_none() {
        assert_eq!(of(|height| f64::from(height as f32)).found(&[], false), Found::None);
        assert!(!of(|height| f64::from(height as f32)).may_have(), "and that is known early");
        let mut one_odd = of(rounded(1.0));
        one_odd.add(412.3301);
        assert_eq!(one_odd.found(&[], false), Found::None, "one number is no multiple");
        assert_eq!(of(rounded(0.01)).found(&[], false), Found::None, "too fine to be told from none");
    }

    #[test]
    fn few_levels_or_samples_say_nothing() {
        assert_eq!(of(|_| 250.0).found(&[], false), Found::Unsure(250.0));
        assert_eq!(of(|_| 0.0).found(&[], false), Found::Unsure(0.0));
        assert_eq!(of(|height| if height > 700.0 { 900.0 } else { 300.0 }).found(&[], false), Found::Unsure(300.0));
        let mut few = Grain::new();
        (100..112).for_each(|height| few.add(f64::from(height)));
        assert_eq!(few.found(&[], false), Found::Unsure(1.0));
    }

    #[test]
    fn whole_numbers_by_their_type_are_a_step_apart() {
        let polder = of(|height| (height / 300.0).round());
        assert_eq!(polder.found(&[], false), Found::Unsure(1.0));
        assert_eq!(polder.found(&[], true), Found::Step(1.0));
        let tableland = of(|height| if height > 700.0 { 900.0 } else { 300.0 });
        assert_eq!(tableland.found(&[], true), Found::Step(1.0), "which their difference is not");
        assert_eq!(of(|_| 250.0).found(&[], true), Found::Unsure(250.0), "there are no stairs");
        assert_eq!(of(rounded(10.0)).found(&[], true), Found::Step(10.0));
    }

    #[test]
    fn marks_are_no_multiples() {
        let mut marked = of(rounded(10.0));
        marked.add(-9999.0);
        marked.add(2347.0);
        assert_eq!(step(&marked), Some(1.0));
        assert_eq!(marked.found(&[-9999.0, 2347.0], false), Found::Step(10.0));
        assert_eq!(marked.found(&[-9999.0], false), Found::Step(1.0), "the other is none");
        // Whichever comes first.
        let mut first = Grain::new();
        first.add(-9999.0);
        first.add(2347.0);
        first.merge(&of(rounded(10.0)));
        assert_eq!(first.found(&[-9999.0, 2347.0], true), Found::Step(10.0));
    }

    #[test]
    fn parts_make_the_whole() {
        let number = |i: u64| if i < 3000 { (i % 400 * 4) as f64 } else { (i % 400 * 6) as f64 + 0.5 };
        let part = |range: std::ops::Range<u64>| {
            let mut grain = Grain::new();
            range.for_each(|i| grain.add(number(i)));
            grain
        };
        let mut parts = part(4000..6000);
        parts.merge(&part(0..1000));
        parts.merge(&part(1000..4000));
        assert_eq!(parts.found(&[], false), part(0..6000).found(&[], false));
        assert_eq!((step(&part(0..3000)), step(&parts)), (Some(4.0), Some(0.5)));
    }
}
