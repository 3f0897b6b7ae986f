//! The built-in styles, and reading styles that users write.
//!
//! A style file is TOML. What it does not say is as in the style that it names as its `base`, `field-sketch` where it names
//! none. Mistakes are told with line and column, unknown keys and names with the known ones they come nearest to.

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::Style;
use crate::error::{Error, Result, Setting, shown};
use crate::files::typed;

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
        return parse(&typed::text(path, "TOML")?, path);
    }
    let names = BuiltIn::ALL.map(|known| known.to_string());
    let what = format!("there is no style `{}`", shown(path));
    let known = names.iter().map(String::as_str).collect::<Vec<_>>();
    let remedy = format!("use {}, or a file that ends in .toml", typed::meant(name, &known));
    Err(Error::setting(Setting::Style, what, remedy))
}

/// The style of a text; `path` is what errors call it.
///
/// # Errors
/// [`Error::Input`].
pub fn parse(text: &str, path: &Path) -> Result<Style> {
    let mistake = |e: &toml::de::Error| typed::mistake(text, path, e, "mend it as the schema of styles says");
    // By itself first: what was laid over a base has no places.
    let own: Style = toml::from_str(text).map_err(|e| mistake(&e))?;
    let mut whole = Table::try_from(Style::default()).map_err(|e| Error::mistake(e.to_string()))?;
    overlay(&mut whole, toml::from_str(own.base.text()).map_err(|e| Error::mistake(e.to_string()))?);
    overlay(&mut whole, toml::from_str(text).map_err(|e| mistake(&e))?);
    complete(&mut whole);
    let style: Style = Value::Table(whole).try_into().map_err(|e: toml::de::Error| mistake(&e))?;
    style.check().map_err(|(what, remedy)| Error::input(path, what, remedy))?;
    Ok(style)
}

/// Gives the pens of layers of the user's own lines what they do not say, from `own`.
fn complete(style: &mut Table) {
    let Some(Value::Table(pens)) = style.get_mut("pens") else { return };
    let Some(Value::Table(own)) = pens.get("own").cloned() else { return };
    let Some(Value::Table(lines)) = pens.get_mut("lines") else { return };
    for pen in lines.iter_mut().filter_map(|(_, pen)| pen.as_table_mut()) {
        let said = std::mem::replace(pen, own.clone());
        overlay(pen, said);
    }
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
