//! `hachure styles`: the looks of a drawing.

use super::reference;
use super::talk::Talk;
use crate::error::{Error, Result};
use crate::ink::Style;
use crate::ink::styles::{self, BuiltIn};

/// The end of `hachure styles --help`.
const EXAMPLES: &str = "\
Examples:
  hachure styles
  hachure styles woodcut > my-style.toml
  hachure styles --schema > style.schema.json";

/// Flags of `hachure styles`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::STYLES, EXAMPLES]))]
pub(crate) struct StylesArguments {
    /// Print this style, whole: a name, or a file that ends in .toml
    #[arg(value_name = "NAME|FILE.toml", conflicts_with = "schema")]
    style: Option<String>,
    /// Print the JSON schema of style files, by which editors check and complete them
    #[arg(long)]
    schema: bool,
}

/// Lists the built-in styles, or prints one, or the schema.
///
/// # Errors
/// As [`styles::find`].
pub(crate) fn run(arguments: &StylesArguments, talk: &Talk) -> Result<()> {
    if arguments.schema {
        let schema = schemars::schema_for!(Style);
        return talk.answer(&serde_json::to_string_pretty(&schema).map_err(|e| Error::mistake(e.to_string()))?);
    }
    match &arguments.style {
        Some(name) => {
            let text = toml::to_string(&styles::find(name)?).map_err(|e| Error::mistake(e.to_string()))?;
            talk.answer(text.trim_end())
        }
        None => {
            let line = |style: BuiltIn| format!("{:<13} {}", style.to_string(), style.description());
            talk.answer(&BuiltIn::ALL.map(line).join("\n"))
        }
    }
}
