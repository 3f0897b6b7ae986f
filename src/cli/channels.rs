//! How much land makes a channel, in words: what was tried, and what is taken.

use crate::dem::Dem;
use crate::error::Result;
use crate::relief::threshold::{AreaTrial, ENOUGH, LIMIT, found};
use crate::relief::{Relief, auto_cells};

/// The area that channels of a DEM begin with and why, and a line for each that was tried.
///
/// # Errors
/// As [`Relief::of`].
pub(super) fn told(dem: &Dem) -> Result<String> {
    let relief = Relief::of(dem, 1.0)?;
    Ok(lines(&relief.trials(), relief.grid().frame.area()))
}

/// The same of trials of cells of so many square metres.
fn lines(trials: &[AreaTrial], cell: f64) -> String {
    let of = |cells: u32| format!("{cells} cells, {} km2", short(f64::from(cells) * cell / 1e6));
    let found = found(trials);
    let taken = auto_cells(found);
    let why = match found.map(|trial| trial.cells) {
        None if trials.is_empty() => {
            let [first, higher] = ENOUGH;
            format!("the least, for the land has under {first} streams of the first order or {higher} of higher ones")
        }
        None => "the least, for never twice in a row streams of the first order fall as far as higher ones".to_owned(),
        Some(cells) if cells < taken => format!("the least, for streams tell less: {}", of(cells)),
        Some(cells) if cells > taken => format!("the most, for streams tell more: {}", of(cells)),
        Some(_) => "the first from which streams of the first order fall as far as higher ones".to_owned(),
    };
    let mut lines = format!("channels   from {} on: {why}", of(taken));
    if !trials.is_empty() {
        lines +=
            &format!("; Student's t of the difference of their mean falls has to lie between -{LIMIT} and {LIMIT}");
    }
    for (n, AreaTrial { cells, streams: [first, higher], t }) in (1..).zip(trials) {
        let mark = if found.is_some_and(|trial| trial.cells == *cells) { ", from here on" } else { "" };
        lines += &format!(
            "\ntrial {n:<4} {}: streams {first} of order 1, {higher} of higher ones, t {t:.2}{mark}",
            of(*cells)
        );
    }
    lines
}

/// A number above 0 by its first three digits.
fn short(number: f64) -> String {
    let decimals = (2.0 - number.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{number:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_is_said_with_why() {
        let told = |trials: &[(u32, f64)]| {
            let trial = |(cells, t): &(u32, f64)| AreaTrial { cells: *cells, streams: [100, 30], t: *t };
            lines(&trials.iter().map(trial).collect::<Vec<_>>(), 400.0)
        };
        for (trials, words) in [
            (&[][..], "from 25 cells, 0.0100 km2 on: the least, for the land has under 20 streams"),
            (&[(10, 5.0), (17, 1.0), (28, -2.0)], "from 25 cells, 0.0100 km2 on: the least, for never twice in a row"),
            (
                &[(10, 1.0), (17, -1.0)],
                "from 25 cells, 0.0100 km2 on: the least, for streams tell less: 10 cells, 0.00400",
            ),
            (
                &[(28, 1.0), (47, 1.9)],
                "from 28 cells, 0.0112 km2 on: the first from which streams of the first order fall",
            ),
            (
                &[(217, 1.0), (362, 0.0)],
                "from 100 cells, 0.0400 km2 on: the most, for streams tell more: 217 cells, 0.0868",
            ),
        ] {
            let said = told(trials);
            assert!(said.starts_with(&format!("channels   {words}")), "{said}");
            assert_eq!(said.lines().count(), trials.len() + 1, "{said}");
            assert_eq!(said.contains("Student"), !trials.is_empty(), "{said}");
        }
        assert_eq!([0.000_025, 0.0378, 12.34, 1234.5].map(short), ["0.0000250", "0.0378", "12.3", "1234"]);
    }
}
