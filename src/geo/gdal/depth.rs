//! Depths below zero, told from heights by what the file says of its band, in the words of the CF conventions.
//!
//! An encoding that is asked for is surer than any file, `positive` is sure, and so is the standard name. The long name is
//! for people: where it, or the name of the band or variable, has a word for heights, too, depth is only spoken of; and
//! where it alone speaks of depth the numbers have a say: those that are below zero already are heights. Not handled:
//! other words and languages.

use super::choice::has_word;
use super::elevation::{Elevation, Reading};
use super::glance::windows;
use super::layer::block;
use super::said::Said;
use super::source::Source;
use crate::dem::{History, Window};
use crate::error::{Message, MessagePart, Result, Setting};
use crate::geo::Encoding;
use crate::message;

/// Words of a name that is one of heights, whatever else says depth.
const UPWARD: [&str; 17] = [
    "height",
    "heights",
    "altitude",
    "altitudes",
    "elevation",
    "elevations",
    "elev",
    "topography",
    "topographic",
    "topo",
    "relief",
    "orography",
    "dem",
    "dtm",
    "dsm",
    "upward",
    "upwards",
];
/// The same in two words.
const POSITIVE_UP: &str = "positive up";
/// Whether the band of `source` holds depths, as `encoding` says or else the file; what was found goes to `history`.
/// `elevation` are its rules so far.
pub(super) fn is_depth(
    source: &Source,
    elevation: &Elevation,
    encoding: Option<Encoding>,
    history: &mut History,
) -> Result<bool> {
    match encoding {
        Some(Encoding::Elevations) => return Ok(false),
        Some(Encoding::Depths) => {
            history.convert(message!["depths x -1 to heights (", asked(Encoding::Depths), ")"]);
            return Ok(true);
        }
        _ => {}
    }
    let said = Said::of(source);
    let says_depth = |name: &str| has_word(name, "depth");
    let positive = said.attribute("positive").to_lowercase();
    let (standard, long) = (said.attribute("standard_name"), said.attribute("long_name"));
    let negate = |history: &mut History, why: &str| {
        history.convert(message![format!("depths x -1 to heights ({why}; "), unless(), ")"]);
        Ok(true)
    };
    match positive.trim() {
        "up" => return Ok(false),
        "down" => return negate(history, "its band says positive: down"),
        _ => {}
    }
    if says_depth(&standard) {
        return negate(history, &format!("its standard name is \"{standard}\""));
    }
    if !says_depth(&long) || is_upward(&standard) {
        return Ok(false);
    }
    if is_upward(&long) || said.names().iter().any(|name| is_upward(name)) {
        let though = format!("numbers are heights, though the long name \"{long}\" speaks of depth");
        history.assume_as_usual(message![though, " (if they are depths, say ", asked(Encoding::Depths), ")"]);
        return Ok(false);
    }
    if is_mostly_negative(source, elevation)? {
        let though = format!("they are heights already, though the long name is \"{long}\"");
        history.assume(message![
            format!("most numbers are below zero because {though} (if they are depths, add "),
            asked(Encoding::Depths),
            "; ",
            unless(),
            ")"
        ]);
        return Ok(false);
    }
    negate(history, &format!("its long name is \"{long}\""))
}

fn asked(encoding: Encoding) -> MessagePart {
    Setting::Encoding.at(encoding.name())
}

/// What to ask for where depths are none.
fn unless() -> Message {
    message!["if they are heights, say ", asked(Encoding::Elevations)]
}

/// Whether a name is one of heights.
fn is_upward(name: &str) -> bool {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let words = words.collect::<Vec<_>>().join(" ").to_lowercase();
    words.contains(POSITIVE_UP) || UPWARD.iter().any(|word| has_word(&words, word))
}

/// Whether most numbers of a few windows are below zero.
fn is_mostly_negative(source: &Source, elevation: &Elevation) -> Result<bool> {
    let (mut negative, mut positive) = (0, 0);
    for Window { first, size } in windows([source.columns, source.rows]) {
        for raw in block::<f64>(source, &source.band()?, first, size)? {
            match elevation.reading(raw) {
                Reading::Metres(metres) if metres < 0.0 => negative += 1,
                Reading::Metres(metres) if metres > 0.0 => positive += 1,
                _ => {}
            }
        }
    }
    Ok(negative > positive)
}
