//! Values of flags that are one of some words, each with a line of help.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::progress::ProgressForm;
use super::style::Hidden;
use crate::dem::North;
use crate::plan::registry::MethodEntry;
use crate::plan::{Border, Method, SharedVertices, Tone};

/// A word, its line of help, and what it stands for.
type Word<T> = (&'static str, &'static str, T);

const SHARES: [Word<SharedVertices>; 2] = [
    ("edge", "Two lattice vertices", SharedVertices::Edge),
    ("corner", "One lattice vertex: the vertex-storage variant", SharedVertices::Corner),
];
const NORTHS: [Word<North>; 2] = [
    ("grid", "Of the grid lines of the DEM's own CRS, before any warp", North::Grid),
    ("true", "Of the meridian", North::True),
];
const HIDDEN: [Word<Hidden>; 2] = [
    ("dashed", "Draw them in dashes, in a layer of their own", Hidden::Dashed),
    ("off", "Leave them out", Hidden::Off),
];
const PROGRESS: [Word<ProgressForm>; 4] = [
    ("bar", "As a bar on a terminal", ProgressForm::Bar),
    ("json", "As lines of JSON on standard output: start, frame, skip, fail, wait, done", ProgressForm::Json),
    (
        "openjd",
        "As a session of Open Job Description reads it on standard output: openjd_progress, openjd_status, openjd_fail",
        ProgressForm::OpenJd,
    ),
    ("none", "Not at all", ProgressForm::None),
];
const BORDERS: [Word<Border>; 2] = [("on", "Draw it", Border::On), ("off", "Leave it out", Border::Off)];

/// A method without its variants, which have flags of their own.
pub(crate) fn family() -> impl TypedValueParser<Value = Method> {
    let plain = Method::ALL.into_iter().filter(|method| method.entry().name == method.entry().family);
    one_of(plain.map(|method| (method.entry().family, method.entry().brief, method)))
}

/// What neighbouring facets share.
pub(crate) fn share() -> impl TypedValueParser<Value = SharedVertices> {
    one_of(SHARES)
}

/// The word for what they share if nothing is said.
pub fn default_share() -> &'static str {
    word_for(&SHARES, SharedVertices::default())
}

/// What azimuths are counted from.
pub(crate) fn north() -> impl TypedValueParser<Value = North> {
    one_of(NORTHS)
}

/// What the darkness of hachures says.
pub(crate) fn tone() -> impl TypedValueParser<Value = Tone> {
    one_of(Tone::ALL.map(|tone| {
        let help = match tone {
            Tone::None => "There are no strokes",
            Tone::Lehmann => "How steep the land is",
            Tone::Shadow => "How far it is turned from the light",
            Tone::Both => "The mean of the two",
        };
        (tone.name(), help, tone)
    }))
}

/// What becomes of lines that nearer land hides.
pub(crate) fn hidden() -> impl TypedValueParser<Value = Hidden> {
    one_of(HIDDEN)
}

/// The word for what becomes of them if nothing is said.
pub(crate) fn default_hidden() -> &'static str {
    word_for(&HIDDEN, Hidden::default())
}

/// How progress is shown.
pub(crate) fn progress() -> impl TypedValueParser<Value = ProgressForm> {
    one_of(PROGRESS)
}

/// The word for how it is shown if nothing is said.
pub(crate) fn default_progress() -> &'static str {
    word_for(&PROGRESS, ProgressForm::default())
}

/// Whether the border is drawn.
pub(crate) fn border() -> impl TypedValueParser<Value = Border> {
    one_of(BORDERS)
}

/// The word for whether it is if nothing is said.
pub(crate) fn default_border() -> &'static str {
    word_for(&BORDERS, Border::default())
}

/// The methods by the names that reports have for them, and what tells apart those of like names.
pub(crate) fn methods() -> String {
    let listed = |method: Method| match method.entry() {
        MethodEntry { name, aside: "", .. } => (*name).to_owned(),
        MethodEntry { name, aside, .. } => format!("{name} ({aside})"),
    };
    Method::ALL.map(listed).join(", ")
}

fn one_of<T: Clone + Send + Sync + 'static>(
    words: impl IntoIterator<Item = Word<T>>,
) -> impl TypedValueParser<Value = T> {
    let words: Vec<Word<T>> = words.into_iter().collect();
    let possible: Vec<_> = words.iter().map(|(word, help, _)| PossibleValue::new(*word).help(*help)).collect();
    PossibleValuesParser::new(possible).try_map(move |typed| {
        let known = words.iter().find(|(word, ..)| *word == typed);
        known.map(|(.., meant)| meant.clone()).ok_or("no such word")
    })
}

fn word_for<T: Copy + PartialEq>(words: &[Word<T>], meant: T) -> &'static str {
    words.iter().find(|(.., stands_for)| *stands_for == meant).map_or("", |(word, ..)| word)
}
