//! The built-in styles, and reading styles that users write.
//!
//! A style file is TOML. What it does not say is as in the style that it names as its `base`, `field-sketch` where it names
//! none. Mistakes are told with line and column, unknown keys and names with the known ones they come nearest to.

use std::fmt::{self, Display, Formatter};
use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::Style;
use crate::error::text::{meant, place};
use crate::error::{Error, Result, Setting, shown};

/// Largest style file, bytes: what is larger is no style.
const LARGEST: u64 = 1 << 20;

/// A style that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BuiltIn {
    /// Warm ink that tapers.
    #[default]
    FieldSketch,
    /// Fine, even lines.
    Atlas,
    /// One width a pen.
    Plotter,
    /// Bold lines.
    Woodcut,
}

impl Display for BuiltIn {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(match self {
            Self::FieldSketch => "field-sketch",
            Self::Atlas => "atlas",
            Self::Plotter => "plotter",
            Self::Woodcut => "woodcut",
        })
    }
}

impl BuiltIn {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::FieldSketch, Self::Atlas, Self::Plotter, Self::Woodcut];

    /// What it changes of `field-sketch`.
    fn text(self) -> &'static str {
        match self {
            Self::FieldSketch => include_str!("styles/field-sketch.toml"),
            Self::Atlas => include_str!("styles/atlas.toml"),
            Self::Plotter => include_str!("styles/plotter.toml"),
            Self::Woodcut => include_str!("styles/woodcut.toml"),
        }
    }

    /// How it looks, in a sentence.
    pub fn description(self) -> &'static str {
        self.text().lines().next().unwrap_or_default().trim_start_matches("# ")
    }

    /// The style, whole.
    ///
    /// # Errors
    /// [`Error::Mistake`] where it does not read: a test reads them all.
    pub fn style(self) -> Result<Style> {
        parse(self.text(), Path::new("a built-in style")).map_err(|e| Error::mistake(e.to_string()))
    }
}

/// The style of this name, or of a file, which ends in `.toml`.
///
/// # Errors
/// [`Error::Setting`] for a name that no style has, [`Error::Input`] for a file that is missing or no style.
pub fn find(name: &str) -> Result<Style> {
    if let Some(known) = BuiltIn::ALL.into_iter().find(|known| known.to_string() == name) {
        return known.style();
    }
    let path = Path::new(name);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
        return read(path);
    }
    let names = BuiltIn::ALL.map(|known| known.to_string());
    let what = format!("there is no style `{}`", shown(path));
    let known = names.iter().map(String::as_str).collect::<Vec<_>>();
    let remedy = format!("use {}, or a file that ends in .toml", meant(name, &known));
    Err(Error::setting(Setting::Style, what, remedy))
}

/// The style of a file.
///
/// # Errors
/// [`Error::Input`] where it cannot be read or is no style: where in it, what, and what was meant.
fn read(path: &Path) -> Result<Style> {
    let unreadable = |e: io::Error| Error::input(path, e.to_string(), "name a file of TOML that can be read");
    let wrong = |what: String| Error::input(path, what, "name a file of TOML");
    // A pipe would be waited for.
    if !fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(wrong("it is no regular file".to_owned()));
    }
    let mut text = String::new();
    File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_string(&mut text)).map_err(unreadable)?;
    if text.len() as u64 > LARGEST {
        return Err(wrong(format!("over {LARGEST} bytes are no style")));
    }
    parse(&text, path)
}

/// The style of a text; `path` is what errors call it.
///
/// # Errors
/// [`Error::Input`].
pub fn parse(text: &str, path: &Path) -> Result<Style> {
    let mistake = |e: &toml::de::Error| mistake(text, path, e.message(), e.span());
    // By itself first: what was laid over a base has no places.
    let own: Style = toml::from_str(text).map_err(|e| mistake(&e))?;
    let mut whole: Table = toml::from_str(own.base.text()).map_err(|e| Error::mistake(e.to_string()))?;
    overlay(&mut whole, toml::from_str(text).map_err(|e| mistake(&e))?);
    let style: Style = Value::Table(whole).try_into().map_err(|e: toml::de::Error| mistake(&e))?;
    style.check().map_err(|(what, remedy)| Error::input(path, what, remedy))?;
    Ok(style)
}

/// Puts the values of `over` in the place of those of `under`, key by key.
fn overlay(under: &mut Table, over: Table) {
    for (key, value) in over {
        match (under.get_mut(&key), value) {
            (Some(Value::Table(under)), Value::Table(over)) => overlay(under, over),
            (_, value) => drop(under.insert(key, value)),
        }
    }
}

/// A mistake in a style, with its place and what was meant.
fn mistake(text: &str, path: &Path, message: &str, span: Option<Range<usize>>) -> Error {
    let place = span.map_or_else(String::new, |span| format!("{}: ", place(text, span)));
    let message = message.trim().replace('\n', " ");
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
        _ => "mend it as the schema of styles says".to_owned(),
    };
    Error::input(path, format!("{place}{}", what.replace("unknown field", "unknown key")), remedy)
}
