//! What is said of a mistake in a text that somebody wrote: where it is, and what may have been meant.

use std::ops::Range;

/// How much of a name must agree for another to be meant (Jaro, Winkler 1990).
const ALIKE: f64 = 0.75;

/// Line and column of a mistake, from 1 on.
pub fn place(text: &str, span: Range<usize>) -> String {
    let before = text.get(..span.start).unwrap_or(text);
    let line = before.rsplit('\n').next().unwrap_or_default();
    format!("line {}, column {}", before.matches('\n').count() + 1, line.chars().count() + 1)
}

/// The known name that comes nearest, else all.
pub fn meant(name: &str, known: &[&str]) -> String {
    let likeness = |known: &&&str| strsim::jaro_winkler(&name.to_lowercase(), known);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match nearest.filter(|nearest| likeness(nearest) >= ALIKE) {
        Some(nearest) => format!("`{nearest}`"),
        None => format!("one of {}", known.iter().map(|known| format!("`{known}`")).collect::<Vec<_>>().join(", ")),
    }
}
