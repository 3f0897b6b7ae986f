//! The steps of which the heights of a DEM's files are multiples, in metres.

use std::fmt::Write;

use super::assumed::Tallied;
use super::doubt::marks;
use super::grain::Found;
use crate::error::{Message, Setting};
use crate::message;

/// Finer steps, in metres, are none: nobody sees their stairs.
const LEAST: f64 = 0.1;
/// How far a step may be from a whole number of others, as a share of those.
const WHOLE: f64 = 1e-6;

/// The step of each file by its place in the layer, metres; 0 where it has none.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Steps(Vec<f64>);

impl Steps {
    /// Of `count` files, of which some numbers are tallied, each by its place; `None` where none has a step. A file that is
    /// too flat to tell has the step of another that its numbers are multiples of: a tile of sea beside others.
    pub(super) fn of<'a>(
        count: usize,
        tallied: impl Iterator<Item = (usize, &'a Tallied<'a>)> + Clone,
    ) -> Option<Self> {
        let found = |file: &Tallied<'_>| match file
            .tally
            .grain
            .found(&marks(file.tally, file.elevation), file.elevation.is_whole())
        {
            Found::Step(step) => Found::Step(file.elevation.metres_between(step)),
            Found::Unsure(step) => Found::Unsure(file.elevation.metres_between(step)),
            Found::None => Found::None,
        };
        let sure = |file: &Tallied<'_>| match found(file) {
            Found::Step(step) if step >= LEAST * (1.0 - WHOLE) => Some(step),
            _ => None,
        };
        let finest = tallied.clone().filter_map(|(_, file)| sure(file)).min_by(f64::total_cmp)?;
        let is_multiple = |step: f64| (step / finest - (step / finest).round()).abs() <= WHOLE * step / finest;
        // Of a file without a number nothing is drawn.
        let mut steps = vec![finest; count];
        for (place, file) in tallied {
            steps[place] = match found(file) {
                Found::Unsure(step) if is_multiple(step) => finest,
                _ => sure(file).unwrap_or(0.0),
            };
        }
        Some(Self(steps))
    }

    /// From the steps of all files, metres.
    pub(super) fn from_metres(steps: Vec<f64>) -> Self {
        Self(steps)
    }

    /// Those of all files, metres.
    pub(super) fn metres(&self) -> &[f64] {
        &self.0
    }

    /// Half the step of all files, where they have the same; metres.
    pub(super) fn common_half(&self) -> Option<f32> {
        let first = *self.0.first()?;
        self.0.iter().all(|step| *step == first).then_some((first / 2.0) as f32)
    }

    /// Half the step of a file, metres.
    pub(super) fn half(&self, place: usize) -> f32 {
        (self.0[place] / 2.0) as f32
    }

    /// What is drawn instead of stairs.
    pub(super) fn words(&self) -> Message {
        let mut steps: Vec<_> = self.0.iter().copied().filter(|step| *step > 0.0).collect();
        let (with, all) = (steps.len(), self.0.len());
        steps.sort_unstable_by(f64::total_cmp);
        steps.dedup();
        let of = if with < all { format!(" of {with} of {all} files") } else { String::new() };
        let within = match *steps.as_slice() {
            [step] => format!("{} m", digits(step / 2.0)),
            _ => "half of that".to_owned(),
        };
        let steps = steps.into_iter().map(digits).collect::<Vec<_>>().join(" or ");
        let what = format!(
            "heights{of} are multiples of {steps} m: drawn is the smoothest surface within {within} of them (as they are: "
        );
        message![what, Setting::KeepSteps, ")"]
    }
}

/// With at most five significant digits.
fn digits(metres: f64) -> String {
    let decimals = (4.0 - metres.log10().floor()).clamp(0.0, 6.0) as usize;
    let mut text = String::new();
    // A string takes all that is written.
    let _ = write!(text, "{metres:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::gdal::elevation::Elevation;
    use crate::geo::gdal::tally::Tally;

    fn tally(numbers: impl Fn(usize) -> f64) -> Tally {
        let mut tally = Tally::new(&Elevation::plain());
        (0..2000).map(numbers).for_each(|number| tally.add(number, Elevation::plain().reading(number)));
        tally
    }

    fn steps(tallies: &[&Tally]) -> Option<Vec<f64>> {
        let (elevation, path) = (Elevation::plain(), std::path::Path::new("a.tif"));
        let files: Vec<_> = tallies.iter().map(|tally| Tallied { path, elevation: &elevation, tally }).collect();
        Steps::of(files.len(), files.iter().enumerate()).map(|steps| steps.0)
    }

    #[test]
    fn files_that_are_too_flat_to_tell_have_the_step_of_others() {
        let whole = tally(|i| (i % 40) as f64);
        let fives = tally(|i| (i % 40 * 5) as f64);
        let (sea, plain, float) = (tally(|_| 0.0), tally(|_| 7.5), tally(|i| (i as f64).sqrt()));
        assert_eq!(steps(&[&whole, &sea, &plain, &float, &fives]), Some(vec![1.0, 1.0, 0.0, 0.0, 5.0]));
        assert_eq!(steps(&[&float, &sea, &plain]), None);
        let fine = tally(|i| (i % 40) as f64 * 0.01);
        assert_eq!(steps(&[&fine]), None, "nobody sees it");
    }

    #[test]
    fn marks_that_nobody_declared_hide_no_step() {
        let tens = |i: usize| (i % 40 * 10) as f64;
        let marked = tally(|i| if i < 9 { -9999.0 } else { tens(i) });
        assert_eq!(steps(&[&marked]), Some(vec![10.0]));
        let odd = tally(|i| if i < 9 { 199.0 } else { tens(i) });
        assert_eq!(steps(&[&odd]), Some(vec![1.0]), "these are heights");
    }

    #[test]
    fn steps_in_words() {
        let told = |steps: &[f64]| Steps(steps.to_vec()).words().to_string();
        let end = "within 0.5 m of them (as they are: keep steps)";
        assert_eq!(told(&[1.0, 1.0]), format!("heights are multiples of 1 m: drawn is the smoothest surface {end}"));
        assert!(told(&[0.3048, 0.0, 10.0]).starts_with("heights of 2 of 3 files are multiples of 0.3048 or 10 m: "));
        assert!(told(&[0.3048, 0.0, 10.0]).contains("within half of that"));
    }
}
