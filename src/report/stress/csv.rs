//! All promises as CSV: a row a promise, beside the error and the time of the method that it is of.

use std::io::{self, Write};

use crate::stress::{Check, Outcome};

/// Names of the columns.
const NAMES: [&str; 15] = [
    "case",
    "group",
    "view",
    "method",
    "promise",
    "kept",
    "measured",
    "side",
    "limit",
    "f",
    "frame_ms",
    "inked",
    "truth_px",
    "of",
    "exception",
];

/// Writes a line of names and a line for each promise. What a promise of no method has no value for is an empty cell.
///
/// # Errors
/// Those of the writer.
pub(crate) fn write_csv(outcome: &Outcome, out: impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(NAMES)?;
    outcome.checks.iter().try_for_each(|check| writer.write_record(row(check, outcome)))?;
    writer.flush()
}

fn row(check: &Check, outcome: &Outcome) -> [String; NAMES.len()] {
    let is_of = |case: &str, view: &str| case == check.case && view == check.view;
    let run = outcome.runs.iter().find(|run| is_of(run.case, run.view) && run.method == check.method);
    let group = outcome.cases.iter().find(|case| case.name == check.case).map_or("", |case| case.group);
    let cell = |figure: Option<f64>| figure.map_or_else(String::new, |figure| figure.to_string());
    [
        check.case.to_owned(),
        group.to_owned(),
        check.view.to_owned(),
        check.method.to_owned(),
        check.promise.name().to_owned(),
        check.kept.to_string(),
        check.measured.to_string(),
        if check.at_least { "at least" } else { "at most" }.to_owned(),
        check.limit.to_string(),
        cell(run.and_then(|run| run.f)),
        cell(run.map(|run| run.frame_ms)),
        run.map_or_else(String::new, |run| run.inked.to_string()),
        cell(run.map(|run| run.truth_px)),
        check.of.clone(),
        check.exception.to_owned(),
    ]
}
