//! TOML and JSON that people write: the text, and what is said of a mistake in it, with its place and what was meant.

use std::io::Read;
use std::ops::Range;
use std::path::Path;

use super::regular;
use crate::error::{Error, Result};

/// Largest file, bytes: nobody writes more.
const LARGEST: u64 = 1 << 20;

/// How much of a name must agree for another to be meant (Jaro, Winkler 1990).
const ALIKE: f64 = 0.75;

/// The text of a file of `language`.
///
/// # Errors
/// [`Error::Input`] where it cannot be read, is no regular file, or is larger than a mebibyte.
pub(crate) fn text(path: &Path, language: &str) -> Result<String> {
    let wrong = |what: String| Error::input(path, what, format!("name a file of {language} that can be read"));
    let mut text = String::new();
    let read = regular::open(path).and_then(|file| file.take(LARGEST + 1).read_to_string(&mut text));
    read.map_err(|e| wrong(e.to_string()))?;
    if text.len() as u64 > LARGEST {
        return Err(wrong(format!("over {LARGEST} bytes are more than anybody writes")));
    }
    Ok(text)
}

/// A mistake with its place and what was meant, `otherwise` a remedy for what is no wrong key or type.
pub(crate) fn mistake(text: &str, path: &Path, error: &toml::de::Error, otherwise: &str) -> Error {
    let place = error.span().map_or_else(String::new, |span| place(text, &span));
    let message = error.message().trim().replace('\n', " ");
    let (what, expected) = message.split_once(", expected ").unwrap_or((&message, ""));
    let expected = match expected {
        "f64" => "a number",
        "u32" => "a whole number, 0 to 4294967295",
        other => other,
    };
    let unknown = what.starts_with("unknown ").then(|| what.split('`').nth(1)).flatten();
    let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    let remedy = match (unknown, &known[..]) {
        (Some(unknown), [_, ..]) => format!("use {}", meant(unknown, &known)),
        _ if !expected.is_empty() => format!("want {expected}"),
        _ => otherwise.to_owned(),
    };
    Error::input(path, format!("{place}{}", what.replace("unknown field", "unknown key")), remedy)
}

/// Where a piece of a text begins, in words that end in a colon.
pub(crate) fn place(text: &str, span: &Range<usize>) -> String {
    text.get(..span.start).map_or_else(String::new, |before| {
        let line = before.rsplit('\n').next().unwrap_or_default();
        format!("line {}, column {}: ", before.matches('\n').count() + 1, line.chars().count() + 1)
    })
}

/// The known name that comes nearest, else all.
pub(crate) fn meant(name: &str, known: &[&str]) -> String {
    let likeness = |known: &&&str| strsim::jaro_winkler(&name.to_lowercase(), known);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match nearest.filter(|nearest| likeness(nearest) >= ALIKE) {
        Some(nearest) => format!("`{nearest}`"),
        None => format!("one of {}", known.iter().map(|known| format!("`{known}`")).collect::<Vec<_>>().join(", ")),
    }
}
