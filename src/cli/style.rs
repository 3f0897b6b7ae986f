//! Flags of the look: a style, and what is changed of it.

use super::choices;
use super::values::{self, Gap};
use crate::error::{Error, Result, Setting};
use crate::ink::Style;
use crate::ink::styles::{self, BuiltIn};
use crate::line::Economy;
use crate::plan::Tone;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Style")]
pub(crate) struct StyleArguments {
    #[arg(
        long, value_name = "NAME|FILE.toml",
        help = format!("The look: {}, or a file; see `hachure styles --help` [default: {}]",
            BuiltIn::ALL.map(|style| style.to_string()).join(", "), BuiltIn::default())
    )]
    style: Option<String>,
    #[arg(
        long, value_name = "X", value_parser = values::min_jump, allow_hyphen_values = true,
        help = format!(
            "Leave lines out where what lies behind is less than this share farther than they are; from twice that on they are \
             whole. 0 draws all. Contours only [default: as the style has it, {}]",
            Style::default().min_jump
        )
    )]
    min_jump: Option<f64>,
    #[arg(
        long, value_name = ".4mm|3px", value_parser = values::min_gap, allow_hyphen_values = true,
        help = format!(
            "Of two lines nearer to each other than this the weaker fades, by kind, jump and length; the skyline never does. In \
             millimetres of the page or pixels of the mask, 0 leaves all lines. Contours only [default: as the style has it, {}mm]",
            Style::default().min_gap
        )
    )]
    min_gap: Option<Gap>,
    #[arg(
        long, value_parser = choices::tone(),
        help = format!("What the darkness of strokes down the slope says. Contours and plans only [default: as the style has it, {}]", Style::default().hachures.tone.name())
    )]
    hachures: Option<Tone>,
    /// Lines that nearer land hides. Contours only
    #[arg(long, value_parser = choices::hidden(), default_value = choices::default_hidden())]
    hidden: Hidden,
    /// Distances from the eye that part layers, the farthest first, as distance:5km,10km
    #[arg(long, value_name = "distance:D,…", value_parser = values::split)]
    split: Option<Split>,
}

/// What becomes of lines that nearer land hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Hidden {
    /// They are left out.
    #[default]
    Off,
    /// They are drawn in dashes, in a layer of their own.
    Dashed,
}

/// Distances that part layers, metres, rising.
#[derive(Debug, Clone, PartialEq)]
pub struct Split(pub Vec<f64>);

impl StyleArguments {
    /// The style.
    ///
    /// # Errors
    /// As [`styles::find`].
    pub(crate) fn style(&self) -> Result<Style> {
        let mut style = self.style.as_deref().map_or_else(|| Ok(Style::default()), styles::find)?;
        style.hachures.tone = self.hachures.unwrap_or(style.hachures.tone);
        Ok(style)
    }

    /// Whether hidden lines are drawn.
    pub(crate) fn draws_hidden(&self) -> bool {
        self.hidden == Hidden::Dashed
    }

    /// Distances that part layers, metres.
    pub(crate) fn split(&self) -> &[f64] {
        self.split.as_ref().map_or(&[], |split| &split.0)
    }

    /// Refuses what only contours can be asked for.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn refuse_for_traced(&self) -> Result<()> {
        let given = [
            (Setting::MinJump, self.min_jump.is_some()),
            (Setting::MinGap, self.min_gap.is_some()),
            (Setting::Hachures, self.hachures.is_some_and(|tone| tone != Tone::None)),
            (Setting::Hidden, self.draws_hidden()),
        ];
        let refuse = |setting| Error::setting(setting, "goes with contours only", "leave out --method");
        given.into_iter().find(|(_, given)| *given).map_or(Ok(()), |(setting, _)| Err(refuse(setting)))
    }

    /// How sparing contours are where a frame has so many pixels for each millimetre.
    pub(crate) fn economy(&self, style: &Style, px_per_mm: f64) -> Economy {
        let Economy { min_jump, min_gap } = style.economy(px_per_mm);
        let given = self.min_gap.map(|gap| match gap {
            Gap::Px(px) => px,
            Gap::Mm(mm) => mm * px_per_mm,
        });
        Economy { min_jump: self.min_jump.unwrap_or(min_jump), min_gap: given.unwrap_or(min_gap) }
    }
}
