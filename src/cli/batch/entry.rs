//! A file of drawings: TOML, whose keys are the flags of `hachure draw`.

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::cache::Cache;
use crate::cli::draw::DrawArguments;
use crate::cli::plan;
use crate::cli::talk::Talk;
use crate::cli::words;
use crate::error::{Error, Result, Setting, shown};
use crate::files::typed::{self, meant, place};
use crate::files::{Taken, straight};
use crate::job::name::Naming;
use crate::job::{Content, Job, JobFile};

/// Keys of a drawing that are no flags of it.
const OWN: [&str; 2] = ["name", "dem"];
/// Flags that no drawing has: what they ask for is asked of the whole batch, or told there.
const NONE: [&str; 9] =
    ["json", "georeferenced", "explain", "adapter", "no-int64", "cache", "cache-size", "quiet", "verbose"];

/// Where it stands what a drawing may be asked for.
const AS_DRAWN: &str = "see `hachure draw --help`";

/// A drawing of the file.
pub(crate) struct BatchEntry {
    /// In words, for lines about it.
    pub called: String,
    /// As if typed.
    pub draw: DrawArguments,
}

/// What the files of DEMs hold, as far as it is known.
pub(super) struct Contents<'a> {
    /// So far.
    pub known: Vec<Content>,
    /// Where it is kept.
    pub cache: &'a Cache,
    /// Hears of what is wrong with that.
    pub talk: &'a Talk,
}

impl Contents<'_> {
    /// Of a drawing's DEM.
    fn of(&mut self, draw: &DrawArguments) -> Result<Content> {
        let asked = draw.terrain.asked();
        if let Some(known) = self.known.iter().find(|content| content.holds(asked)) {
            return Ok(known.clone());
        }
        let found = draw.terrain.content(draw.drawing.exaggeration, self.cache, self.talk)?;
        self.known.retain(|content| !content.is_of(asked));
        self.known.push(found.clone());
        Ok(found)
    }
}

/// Reads flags as `hachure draw` does.
#[derive(Debug, Parser)]
#[command(name = "drawing", no_binary_name = true)]
struct Typed {
    #[command(flatten)]
    draw: DrawArguments,
}

/// Keys and values with their places.
type Keys<'a> = Vec<(String, Range<usize>, &'a DeValue<'a>)>;

/// The file as it is read.
struct Source<'a> {
    path: &'a Path,
    text: &'a str,
    known: Vec<String>,
}

/// The drawings of a file.
///
/// # Errors
/// [`Error::Input`] where it cannot be read, or what stands in it is no drawing: where, what, and what was meant.
pub(crate) fn read(path: &Path) -> Result<Vec<BatchEntry>> {
    let text = typed::text(path, "TOML")?;
    let source = Source { path, text: &text, known: known() };
    let table = DeTable::parse(&text)
        .map_err(|e| typed::mistake(&text, path, &e, "write it as `hachure batch --help` shows"))?;
    let (mut defaults, mut drawings): (Keys, Vec<(Range<usize>, Keys)>) = Default::default();
    for (key, value) in table.get_ref() {
        match (&**key.get_ref(), value.get_ref()) {
            ("defaults", DeValue::Table(table)) => defaults = source.keys(table)?,
            ("drawing", DeValue::Array(list)) => {
                for item in list.iter() {
                    let DeValue::Table(table) = item.get_ref() else {
                        return Err(source.wrong(
                            item.span(),
                            "it is no table",
                            "write [[drawing]] before each drawing",
                        ));
                    };
                    drawings.push((item.span(), source.keys(table)?));
                }
            }
            ("drawing", DeValue::Table(_)) => {
                return Err(source.wrong(
                    key.span(),
                    "[drawing] is one table, drawings are a list",
                    "write [[drawing]]",
                ));
            }
            (other, _) => {
                let what = format!("`{other}` is neither [defaults] nor [[drawing]]");
                let remedy = format!("use {}", meant(other, &["defaults", "drawing"]));
                return Err(source.wrong(key.span(), what, remedy));
            }
        }
    }
    if drawings.is_empty() {
        return Err(Error::input(path, "no drawing is in it", "write [[drawing]] before the keys of each"));
    }
    let entries = (0..).zip(&drawings).map(|(n, (span, keys))| source.entry(n, span, &defaults, keys));
    entries.collect()
}

/// Flags that a drawing may have.
fn known() -> Vec<String> {
    let command = Typed::command();
    let flags = command.get_arguments().filter_map(|flag| flag.get_long().map(str::to_owned));
    let flags = flags.filter(|flag| !NONE.contains(&flag.as_str()) && !["help", "version"].contains(&flag.as_str()));
    flags.chain(OWN.map(str::to_owned)).collect()
}

impl Source<'_> {
    fn wrong(&self, span: Range<usize>, what: impl std::fmt::Display, remedy: impl Into<String>) -> Error {
        Error::input(self.path, format!("{}{what}", place(self.text, &span)), remedy.into())
    }

    /// The keys of a table, each of which is known.
    fn keys<'t>(&self, table: &'t DeTable<'t>) -> Result<Keys<'t>> {
        let key = |(key, value): (&Spanned<_>, &'t Spanned<DeValue<'t>>)| {
            let text: &std::borrow::Cow<str> = key.get_ref();
            let flag = text.replace('_', "-");
            if self.known.contains(&flag) {
                return Ok((flag, value.span(), value.get_ref()));
            }
            if NONE.contains(&flag.as_str()) {
                let what = format!("`{text}` is no key of a drawing");
                return Err(self.wrong(key.span(), what, "leave it out, or ask it of the whole batch"));
            }
            let known: Vec<&str> = self.known.iter().map(String::as_str).collect();
            Err(self.wrong(key.span(), format!("unknown key `{text}`"), format!("use {}", meant(&flag, &known))))
        };
        table.iter().map(key).collect()
    }

    /// A drawing with its own keys, and the defaults for others.
    fn entry(&self, n: u32, span: &Range<usize>, defaults: &Keys, own: &Keys) -> Result<BatchEntry> {
        let is_own = |flag: &String| own.iter().any(|(other, ..)| other == flag);
        let keys = own.iter().chain(defaults.iter().filter(|(flag, ..)| !is_own(flag)));
        let (mut called, mut words, mut dems) = (format!("drawing {n}"), Vec::new(), Vec::new());
        for (flag, span, value) in keys {
            let texts = self.texts(span, value)?;
            match (flag.as_str(), *value) {
                ("name", _) => called = texts.join(" "),
                ("dem", _) => dems = texts,
                (_, DeValue::Boolean(true)) => words.push(format!("--{flag}")),
                (_, DeValue::Boolean(false)) => {}
                ("output" | "lines", _) => words.extend(texts.into_iter().map(|text| format!("--{flag}={text}"))),
                ("creases", _) => words.push(format!("--{flag}={}", texts.join(","))),
                (_, DeValue::Array(_))
                    if texts.iter().any(|text| text.parse::<f64>().is_err() && !text.starts_with('+')) =>
                {
                    return Err(self.wrong(span.clone(), format!("`{flag}` takes no list"), "give one value"));
                }
                _ => words.push(format!("--{flag}={}", texts.join(","))),
            }
        }
        // Whatever they are called, they are no flags.
        words.push("--".to_owned());
        words.append(&mut dems);
        // The key that is spoken of, where it can be told; it may be one of the defaults.
        let spoken = |text: &str| {
            let keys = own.iter().chain(defaults);
            let said = |flag: &String| text.contains(&format!("--{flag} ")) || text.contains(&format!("--{flag}:"));
            keys.into_iter().find(|(flag, ..)| said(flag)).map_or(span.clone(), |(_, span, _)| span.clone())
        };
        let typed = Typed::try_parse_from(&words).map_err(|e| {
            let what = in_words(&called, &e);
            self.wrong(spoken(&what), &what, AS_DRAWN)
        })?;
        let entry = BatchEntry { called, draw: typed.draw };
        let checked = match entry.draw.scale() {
            Some(_) => plan::check(&entry.draw).map(drop),
            None => entry.draw.check().map(drop),
        };
        // What cannot be read fails as the drawing is made.
        if let Err(e @ Error::Setting { .. }) = checked {
            let what = format!("{}: {}", entry.called, words::line(&e));
            return Err(self.wrong(spoken(&what), what, AS_DRAWN));
        }
        if entry.draw.fill_stdout() {
            return Err(self.wrong(
                span.clone(),
                format!("{}: standard output takes no drawing", entry.called),
                "name a file",
            ));
        }
        Ok(entry)
    }

    /// A value as it would be typed, one text for each of a list.
    fn texts(&self, span: &Range<usize>, value: &DeValue) -> Result<Vec<String>> {
        Ok(vec![match value {
            DeValue::String(text) => text.to_string(),
            DeValue::Integer(number) => i64::from_str_radix(&number.as_str().replace('_', ""), number.radix())
                .map_err(|_| self.wrong(span.clone(), "it is out of range", "want a smaller number"))?
                .to_string(),
            DeValue::Float(number) => number.as_str().replace('_', ""),
            DeValue::Boolean(flag) => flag.to_string(),
            DeValue::Array(list) => {
                let texts = list.iter().map(|item| self.texts(&item.span(), item.get_ref()));
                return Ok(texts.collect::<Result<Vec<_>>>()?.concat());
            }
            DeValue::Datetime(_) | DeValue::Table(_) => {
                return Err(self.wrong(
                    span.clone(),
                    "it is no value of a flag",
                    "want text, a number, true, false or a list",
                ));
            }
        }])
    }
}

/// Refuses a file that two drawings would make, and one that is read.
///
/// # Errors
/// [`Error::Input`].
pub(crate) fn each_output_once(file: &Path, entries: &[BatchEntry]) -> Result<()> {
    let read = entries.iter().flat_map(|entry| &entry.draw.terrain.dems).map(PathBuf::as_path);
    let mut taken = Taken::inputs(read.chain([file]));
    // Of folders that are not there yet nothing is known but their names.
    let mut seen = HashSet::new();
    let mut take = |path: &Path| {
        taken.take(Setting::Output, path)?;
        if std::path::absolute(path).is_ok_and(|path| seen.insert(straight(&path))) {
            return Ok(());
        }
        let what = format!("{} is another drawing's output already", shown(path));
        Err(Error::setting(Setting::Output, what, "give each file a name of its own"))
    };
    for entry in entries {
        let (drawings, mask) = entry.draw.outputs.files();
        let taken = drawings.iter().map(PathBuf::as_path).chain(mask).try_for_each(&mut take);
        taken.map_err(|e| Error::input(file, format!("{}: {}", entry.called, words::line(&e)), "mend it"))?;
    }
    Ok(())
}

/// The first line of what the reader of flags says.
fn in_words(called: &str, error: &clap::Error) -> String {
    let text = error.to_string();
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let rest = text.lines().skip(1).map(str::trim).filter(|line| line.starts_with(['-', '[', '<']));
    let all: Vec<&str> = std::iter::once(first.trim_start_matches("error: ")).chain(rest).collect();
    format!("{called}: {}", all.join(" "))
}

impl BatchEntry {
    /// The names of all that its drawing and its mask are made of; of what cannot be made, why.
    pub(super) fn names(&self, contents: &mut Contents) -> [u128; 2] {
        let names = contents.of(&self.draw).and_then(|dem| self.draw.names(&dem));
        names.unwrap_or_else(|error| [Naming::new().with("failed", words::line(&error)).name(); 2])
    }

    /// The job that makes it.
    pub(super) fn job(&self, number: u32, [drawing, of_mask]: [u128; 2]) -> Job {
        let (drawings, mask) = self.draw.outputs.files();
        let drawings = drawings.iter().map(|path| JobFile { path: path.clone(), name: drawing });
        let mask = mask.map(|path| JobFile { path: path.to_owned(), name: of_mask });
        Job { number, called: self.called.clone(), files: drawings.chain(mask).collect() }
    }
}
