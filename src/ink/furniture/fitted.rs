//! A text set so that it fits a width.

use crate::error::{Error, Message, Result, Setting, is_unprintable};
use crate::ink::letters::{Face, Lettering};
use crate::message;

/// Between one size that is tried and the next.
const STEP: f64 = 0.97;
/// Down to which share of its size a text stays on one line before it takes two.
const ONE_LINE: f64 = 0.86;

/// Lines of a text, each from the left end of its baseline on.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    /// mm.
    pub em: f64,
    pub lines: Vec<Lettering>,
}

impl Fitted {
    /// As large as `most` mm an em, or smaller down to `least`, on up to so many lines of `width` mm. Lines break at plain spaces.
    ///
    /// # Errors
    /// [`Error::Setting`] where it does not fit, or the face lacks a letter.
    pub(super) fn of(
        setting: Setting,
        text: &str,
        [most, least]: [f64; 2],
        spacing: f64,
        width: f64,
        lines: usize,
        face: Face,
    ) -> Result<Self> {
        if let Some(letter) = face.lacking(text)? {
            return Err(lacks(setting, letter, face));
        }
        let least = least.min(most);
        // All sizes are alike but for roundings: one is measured.
        let measure = |text: &str| Ok::<_, Error>(face.set(text, 1.0, spacing)?.width());
        let whole = measure(text)?;
        let halves = if lines > 1 { halves(text, &measure)? } else { None };
        let largest = |wide: f64, least: f64| {
            let sizes = std::iter::successors(Some(most), |em| Some(em * STEP)).take_while(|em| *em > least);
            sizes.chain([least]).find(|em| wide * em <= width)
        };
        let set = |em: f64, texts: &[&str]| {
            let lines = texts.iter().map(|text| face.set(text, em, spacing)).collect::<Result<_>>()?;
            Ok(Self { em, lines })
        };
        let bound = if halves.is_some() { least.max(most * ONE_LINE) } else { least };
        if let Some(em) = largest(whole, bound) {
            return set(em, &[text]);
        }
        match halves.and_then(|(first, second, wide)| Some((largest(wide, least)?, first, second))) {
            Some((em, first, second)) => set(em, &[first, second]),
            None => Err(too_long(setting, text, whole * least, least, width, lines)),
        }
    }
}

/// A text in two lines of which the longer is as short as can be, and how long that is; `None` where it has no space. A dot that
/// parts what stands before it from what follows goes where the line breaks.
fn halves<'a>(text: &'a str, measure: &impl Fn(&str) -> Result<f64>) -> Result<Option<(&'a str, &'a str, f64)>> {
    let mut best: Option<(&str, &str, f64)> = None;
    for (at, _) in text.match_indices(' ') {
        let (first, second) = (text[..at].trim_end_matches([' ', '·']), text[at..].trim_start_matches([' ', '·']));
        let wide = measure(first)?.max(measure(second)?);
        if !first.is_empty() && !second.is_empty() && best.is_none_or(|(.., least)| wide < least) {
            best = Some((first, second, wide));
        }
    }
    Ok(best)
}

fn too_long(setting: Setting, text: &str, long: f64, least: f64, width: f64, lines: usize) -> Error {
    let lines = if lines > 1 { " in two lines" } else { "" };
    let what = format!(
        "\"{text}\" is {long:.0} mm long in letters of {least:.1} mm, the least that can be read, and has {width:.0} mm{lines}"
    );
    let remedy: Message = match setting {
        Setting::Credits => message!["give shorter ones in your own words, ", Setting::Credits.with_value()],
        Setting::ViewLine => message!["use a larger ", Setting::Page, ", or leave it out"],
        _ => message!["shorten it, or use a larger ", Setting::Page],
    };
    Error::setting(setting, what, remedy)
}

/// The error for a letter that is not in the face, named so that it is known even where a terminal does not show it.
fn lacks(setting: Setting, letter: char, face: Face) -> Error {
    let code = format!("U+{:04X}", u32::from(letter));
    let named = if is_unprintable(letter) || letter.is_whitespace() { code } else { format!("`{letter}` ({code})") };
    let which = match face {
        Face::Outlines => "the font of furniture has no",
        Face::SingleStroke => "the single strokes that pens write with have no",
    };
    let remedy: Message = match setting {
        Setting::Credits => message!["give them in your own words, ", Setting::Credits.with_value()],
        _ => "write it otherwise".into(),
    };
    Error::setting(setting, format!("{which} {named}"), remedy)
}
