//! What stands around a picture on its sheet: a neatline, a title, a line on the view, credits.
//!
//! The margins stay blank: furniture takes its room from the picture, or makes the sheet larger where nobody gave one. The neatline
//! is a thin rule, whose inner edge is that of the picture, and a thick one around it. Below stand, in the middle, the title, the
//! view line, and credits:
//!
//! ```text
//!      +================================+
//!      | +----------------------------+ |
//!      | |          picture           | |
//!      | +----------------------------+ |
//!      +================================+
//!                  T I T L E
//!           from where, to where
//!                   credits
//! ```
//!
//! Sizes are those of a sheet of A4, times a scale that grows more slowly than sheets do. A text that is too long is set smaller,
//! view line and credits in two lines, down to what can be read.

mod fitted;
mod layers;
mod sizes;

use glam::DVec2;

pub(crate) use layers::Set;

use super::letters::Face;
use super::{Sheet, Style, Surround};
use crate::error::{Error, Result, Setting};
use crate::message;
use fitted::Fitted;
use sizes::Sizes;

/// Lines that a view line or credits may take.
const LINES: usize = 2;
/// A view line as long as most are, by which room is made for it before there is one.
const LONG: &str = "From 00.0000° N, 000.0000° W at 0000 m, looking 000.0° from true north, 00.0° down · field of view 00.0° · heights × 00";

/// What is wanted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Furniture {
    /// What the picture is called.
    pub title: Option<String>,
    /// Whether two rules frame it.
    pub neatline: bool,
    /// Whether it is said from where the land is seen, or at which scale.
    pub view_line: bool,
    /// Who made the DEM.
    pub credits: Option<Credits>,
}

/// Where credits come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Credits {
    /// From what the files of the DEM say.
    OfFiles,
    /// From the user.
    Own(String),
}

/// Texts that are known when there is a DEM and a view; those that are not wanted are not looked at.
#[derive(Debug, Clone, Default)]
pub struct Texts {
    /// From where, to where.
    pub view_line: String,
    /// Of the files of the DEM.
    pub credits: String,
}

impl Furniture {
    /// Whether nothing is wanted.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The room that it takes of a sheet which has this size, mm, within its margins.
    ///
    /// # Errors
    /// [`Error::Setting`] for a text that does not fit, or holds letters that the face lacks.
    pub fn within(&self, size: DVec2, style: &Style) -> Result<Surround> {
        self.surround(Sizes::of(size, style), size.x, style)
    }

    /// The room that it takes around a picture of this size, mm.
    ///
    /// # Errors
    /// As [`Self::within`].
    pub fn around(&self, size: DVec2, style: &Style) -> Result<Surround> {
        let sizes = Sizes::of(size, style);
        let sides = if self.neatline { sizes.neatline() } else { 0.0 };
        self.surround(sizes, size.x + 2.0 * sides, style)
    }

    /// The room that it takes where texts may be so wide, mm.
    fn surround(&self, sizes: Sizes, width: f64, style: &Style) -> Result<Surround> {
        if self.is_none() {
            return Ok(Surround::NONE);
        }
        let face = face(style);
        let title = self.fitted_title(&sizes, width, face)?;
        // Of a text that is not known yet two lines are kept where one may not do.
        let is_long = face.set(LONG, sizes.view_line, 0.0)?.width() > width;
        let view_line = self.view_line.then_some((sizes.view_line, if is_long { LINES } else { 1 }));
        let credits = match &self.credits {
            Some(Credits::Own(text)) => {
                let own = fitted_credits(text, &sizes, width, face)?;
                Some((own.em, own.lines.len()))
            }
            Some(Credits::OfFiles) => Some((sizes.credits, LINES)),
            None => None,
        };
        let (_, foot) = stack([title.map(|title| (title.em, 1)), view_line, credits], face);
        let sides = if self.neatline { sizes.neatline() } else { 0.0 };
        Ok(Surround { sides, head: sides, foot: sides + foot, scale: sizes.scale })
    }

    /// Sets it on a sheet that has room for it.
    ///
    /// # Errors
    /// As [`Self::within`].
    pub fn set(&self, sheet: &Sheet, style: &Style, texts: &Texts) -> Result<Set> {
        let (sizes, face) = (Sizes::scaled(sheet.surround.scale, style), face(style));
        let width = sheet.size.x - 2.0 * sheet.margin;
        let title = self.fitted_title(&sizes, width, face)?;
        let view_line = self.view_line.then(|| {
            let em = [sizes.view_line, face.least()];
            Fitted::of(Setting::ViewLine, &texts.view_line, em, 0.0, width, LINES, face)
        });
        let credits = self.credits.as_ref().map(|credits| match credits {
            Credits::Own(text) => fitted_credits(text, &sizes, width, face),
            Credits::OfFiles => fitted_credits(&texts.credits, &sizes, width, face),
        });
        let fitted = [title, view_line.transpose()?, credits.transpose()?];
        let sized = fitted.each_ref().map(|text| text.as_ref().map(|text| (text.em, text.lines.len())));
        let (baselines, foot) = stack(sized, face);
        let [low, high] = sheet.area();
        let outer = if self.neatline { sizes.neatline() } else { 0.0 };
        if sheet.surround.foot + 1e-9 < outer + foot {
            let remedy = message![
                "leave out ",
                Setting::ViewLine,
                " or ",
                Setting::Credits,
                ", or use a larger ",
                Setting::Page
            ];
            return Err(Error::setting(Setting::ViewLine, "there is no room for all lines below the picture", remedy));
        }
        let mut set = Set::new(self.title.clone(), face);
        if self.neatline {
            sizes.rules([low, high]).into_iter().for_each(|rule| set.rule(rule));
        }
        let top = high.y + outer;
        for ((text, baseline), is_title) in fitted.into_iter().zip(baselines).zip([true, false, false]) {
            let Some(text) = text else { continue };
            for (i, line) in text.lines.into_iter().enumerate() {
                let [left, right] = line.bounds().map(|corner| corner.x);
                let at = DVec2::new((sheet.size.x - left - right) / 2.0, top + baseline + i as f64 * LEADING * text.em);
                set.line(line.moved(at), if is_title { sizes.title_pen(text.em) } else { sizes.pen() });
            }
        }
        Ok(set)
    }

    fn fitted_title(&self, sizes: &Sizes, width: f64, face: Face) -> Result<Option<Fitted>> {
        let fitted = self.title.as_ref().map(|title| {
            let em = [sizes.title, sizes.view_line.max(face.least())];
            Fitted::of(Setting::Title, title, em, spacing(title), width, 1, face)
        });
        fitted.transpose()
    }
}

fn fitted_credits(text: &str, sizes: &Sizes, width: f64, face: Face) -> Result<Fitted> {
    Fitted::of(Setting::Credits, text, [sizes.credits, face.least()], 0.0, width, LINES, face)
}

/// The face of a style: a pen follows lines.
pub(crate) fn face(style: &Style) -> Face {
    if style.plot.centre_lines { Face::SingleStroke } else { Face::Outlines }
}

/// How much farther apart letters of a title are, em: capitals are spaced out.
fn spacing(title: &str) -> f64 {
    if title.chars().any(char::is_lowercase) { 0.01 } else { 0.16 }
}

/// From one baseline to the next, em.
const LEADING: f64 = 1.32;

/// The first baselines of title, view line and credits below what they stand under, and where the last letters end, mm; each with
/// its em and how many lines it has.
fn stack(texts: [Option<(f64, usize)>; 3], face: Face) -> ([f64; 3], f64) {
    let (mut baselines, mut last, mut end) = ([0.0; 3], None::<(usize, f64)>, 0.0);
    for (i, text) in texts.into_iter().enumerate() {
        let Some((em, lines)) = text else { continue };
        let air = match last {
            // Below the picture.
            None if i == 0 => 0.68 * em,
            None => 0.95 * em,
            Some((0, title)) => 0.58 * title,
            Some(_) => 0.92 * em,
        };
        let baseline = last.map_or(0.0, |_| end) + air + face.cap_height() * em;
        baselines[i] = baseline;
        end = baseline + (lines - 1) as f64 * LEADING * em;
        last = Some((i, em));
    }
    (baselines, last.map_or(0.0, |(_, em)| end + face.descent() * em))
}
