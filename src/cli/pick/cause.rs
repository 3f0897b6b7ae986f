//! Which rule drew a line or left it out, in words with its numbers, and the flags that change it.

use serde::Serialize;

use super::place::{HiddenBy, Located};
use crate::cli::words::short;
use crate::line::{Lack, Little};
use crate::relief::Crease;

/// What is finer shows as nothing, mm.
pub(super) const FINEST: f64 = 0.005;

/// A rule as it applied to a line.
pub(super) enum Rule {
    /// It is drawn.
    Drawn { layer: String, width_mm: f64, faded: Option<Box<Rule>>, weight: f64 },
    /// Too little farther lies what is behind.
    MinJump { jump: f64, min_jump: f64 },
    /// It is too short for the gap that lines keep.
    Length { length: f64, asked: [f64; 2], min_gap: f64 },
    /// A stronger line runs beside it.
    MinGap { to: String, apart: f64, min_gap: f64 },
    /// Nearer land stands before it; what, where that is known.
    Hidden(Option<HiddenBy>),
    /// The page does not show the relief that it tells of.
    Detail(Lack),
    /// It is a stream or a ridge under flat water.
    FlatWater,
    /// Nobody asked for its kind.
    Creases(Crease),
    /// The border is not drawn.
    Border,
    /// So much land gathers water there, square metres, and channels begin with so much.
    ChannelArea { here: f64, channels: f64 },
    /// So much land gathers water there, and that makes a channel, which was left out as too short or for lying in no valley.
    Pruned { here: f64, channels: f64 },
    /// The sea lies there, in which all water ends.
    Sea,
    /// It is finer than the pens draw, or a dot that the style leaves out.
    Pens { weight: f64 },
    /// A pen would leave the margins.
    Margin,
    /// There is none: the land turns towards the eye. Degrees between it and the line of sight, and pixels to the nearest line.
    Facing { degrees: Option<f64>, nearest: Option<(String, f64)> },
}

/// A line, or that there is none, as it is told.
#[derive(Serialize)]
pub(super) struct LineAnswer {
    pub kind: Option<String>,
    /// What the drawing calls its chain.
    pub id: Option<String>,
    pub drawn: bool,
    pub rule: &'static str,
    pub off_px: Option<f64>,
    pub distance_m: Option<f64>,
    #[serde(flatten)]
    pub located: Option<Located>,
    pub numbers: serde_json::Map<String, serde_json::Value>,
    /// Flags that would change it.
    pub flags: Option<String>,
    pub words: String,
}

impl Rule {
    /// As scripts know it.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Drawn { .. } => "drawn",
            Self::MinJump { .. } => "min-jump",
            Self::Length { .. } | Self::MinGap { .. } => "min-gap",
            Self::Hidden(_) => "hidden",
            Self::Detail(_) => "crease-detail",
            Self::FlatWater | Self::Sea => "flat-water",
            Self::Creases(_) => "creases",
            Self::Border => "border",
            Self::ChannelArea { .. } => "channel-area",
            Self::Pruned { .. } => "pruned",
            Self::Pens { .. } => "pens",
            Self::Margin => "margin",
            Self::Facing { .. } => "facing",
        }
    }

    pub(super) fn is_drawn(&self) -> bool {
        matches!(self, Self::Drawn { .. })
    }

    /// Whether it is of a line, not of the land at the pixel.
    pub(super) fn has_line(&self) -> bool {
        !matches!(self, Self::ChannelArea { .. } | Self::Pruned { .. } | Self::Sea)
    }

    /// What it says, numbers and all.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Drawn { layer, width_mm, faded: None, .. } => {
                format!("drawn {} wide in layer {layer}", wide(*width_mm))
            }
            Self::Drawn { layer, width_mm, faded: Some(rule), weight } => format!(
                "drawn {} wide in layer {layer}, faded to {:.0} %{}",
                wide(*width_mm),
                weight * 100.0,
                rule.words().trim_start_matches("left out")
            ),
            Self::MinJump { jump, min_jump } => format!(
                "left out by --min-jump {}: what lies behind is but {} of its distance farther, and lines begin at the former and are \
                 whole from twice that on",
                short(*min_jump),
                short(*jump)
            ),
            Self::Length { length, asked: [least, whole], min_gap } => format!(
                "left out by --min-gap {}px: it is {} px long, and lines begin at {} px and are whole from {} px on",
                short(*min_gap),
                short(*length),
                short(*least),
                short(*whole)
            ),
            Self::MinGap { to, apart, min_gap } => format!(
                "left out by --min-gap {}px: {to}, which is stronger, runs {} px beside it",
                short(*min_gap),
                short(*apart)
            ),
            Self::Hidden(Some(by)) => format!("hidden by land {}", by.words()),
            Self::Hidden(None) => "hidden by nearer land".to_owned(),
            Self::Detail(lack) => format!("left out as too little for the page: {}", words_of(lack)),
            Self::FlatWater => "left out: it runs under flat water".to_owned(),
            Self::Creases(crease) => format!("left out: {} are not among --creases", crease.name()),
            Self::Border => "left out by --border off".to_owned(),
            Self::ChannelArea { here, channels } => format!(
                "no stream: water of {} gathers here, and by --channel-area channels begin with {}",
                area(*here),
                area(*channels)
            ),
            Self::Pruned { here, channels } => format!(
                "no stream: water of {} gathers here, and channels begin with {}, but this one is too short for a line, or lies in no valley",
                area(*here),
                area(*channels)
            ),
            Self::Sea => "no stream: the sea lies here, flat water at 0 m, in which all water ends".to_owned(),
            Self::Pens { weight } => {
                format!("left out: at {:.0} % of its width it is finer than the pens of the style draw", weight * 100.0)
            }
            Self::Margin => "left out: a pen would leave the margins of the page".to_owned(),
            Self::Facing { degrees, nearest } => {
                let seen = degrees.map_or(String::new(), |degrees| {
                    format!(" and here it faces the eye, {degrees:.1} degrees off the line of sight")
                });
                let nearest = nearest.as_ref().map_or("none is on the page".to_owned(), |(line, px)| {
                    format!("the nearest is {line}, {} px off", short(*px))
                });
                format!("none: silhouettes stand where land turns away from the eye{seen}; {nearest}")
            }
        }
    }

    /// Its numbers, for scripts.
    pub(super) fn numbers(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Drawn { width_mm, weight, .. } => vec![("width_mm", *width_mm), ("weight", *weight)],
            Self::MinJump { jump, min_jump } => vec![("jump", *jump), ("min_jump", *min_jump)],
            Self::Length { length, asked: [least, whole], min_gap } => {
                vec![("length_px", *length), ("least_px", *least), ("whole_px", *whole), ("min_gap_px", *min_gap)]
            }
            Self::MinGap { apart, min_gap, .. } => vec![("apart_px", *apart), ("min_gap_px", *min_gap)],
            Self::Hidden(Some(by)) => {
                let from = by.seen_from_m.map(|metres| ("seen_from_m", metres));
                [("hidden_by_distance_m", by.sighting.distance_m)].into_iter().chain(from).collect()
            }
            Self::Detail(Lack { is, asked: [least, whole], .. }) => {
                vec![("is", *is), ("least", *least), ("whole", *whole)]
            }
            Self::ChannelArea { here, channels } | Self::Pruned { here, channels } => {
                vec![("gathers_m2", *here), ("channel_area_m2", *channels)]
            }
            Self::Pens { weight } => vec![("weight", *weight)],
            Self::Facing { degrees, nearest } => {
                let off = nearest.as_ref().map(|(_, px)| ("nearest_px", *px));
                degrees.map(|degrees| ("off_sight_degrees", degrees)).into_iter().chain(off).collect()
            }
            Self::Hidden(None) | Self::FlatWater | Self::Sea | Self::Creases(_) | Self::Border | Self::Margin => {
                Vec::new()
            }
        }
    }

    /// Flags that would change it, where they do not depend on other lines.
    pub(super) fn flags(&self) -> Option<String> {
        match self {
            Self::Hidden(_) => Some("--hidden dashed".to_owned()),
            Self::Detail(Lack { what: Little::Length | Little::Drop | Little::ReliefOnPage, .. }) => {
                Some("a larger --size or a smaller --fov".to_owned())
            }
            Self::Border => Some("--border on".to_owned()),
            Self::Pens { .. } => Some("a --style with finer pens".to_owned()),
            Self::Margin => Some("a smaller --margin".to_owned()),
            _ => None,
        }
    }
}

fn words_of(Lack { what, is, asked: [least, whole] }: &Lack) -> String {
    let [is, least, whole] = [is, least, whole].map(|number| short(*number));
    let (begin, unit) = match what {
        Little::Length => ("the line is long", " px"),
        Little::Drop => ("it falls by", " px of the page"),
        Little::ReliefOnPage => ("the land beside it stands out by", " px of the page"),
        Little::Relief => ("the land beside it stands out by", " m"),
        Little::Slope => ("the slope beside it is", ""),
    };
    format!("{begin} {is}{unit}; lines begin at {least} and are whole from {whole} on")
}

/// A width in hundredths of a millimetre.
fn wide(mm: f64) -> String {
    if mm < FINEST { "under 0.01 mm".to_owned() } else { format!("{mm:.2} mm") }
}

fn area(square_metres: f64) -> String {
    match square_metres {
        m2 if m2 >= 1e6 => format!("{} km2", short(m2 / 1e6)),
        m2 if m2 >= 1e4 => format!("{} ha", short(m2 / 1e4)),
        m2 => format!("{} m2", short(m2)),
    }
}
