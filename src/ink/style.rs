//! The look of a drawing as data: everything about it that is a matter of taste.
//!
//! Lengths are millimetres on the sheet. The look of [`Style::default`] is `field-sketch`; [`styles`](super::styles) has
//! the others, and reads those that users write.

use std::collections::BTreeMap;
use std::fmt::Display;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, de};

use super::hachures::{HachureStyle, LightStyle};
use super::styles::BuiltIn;
use super::{Colour, Pen};
use crate::line::Economy;
use crate::plan::{Hachures, Tone};
use crate::relief::Crease;

/// Least and greatest of numbers in styles.
pub(super) const LENGTH: [f64; 2] = [0.0, 100.0];
pub(super) const STEP: [f64; 2] = [0.05, 100.0];
pub(super) const WIDTH: [f64; 2] = [0.02, 10.0];
pub(super) const SHARE: [f64; 2] = [0.0, 1.0];
pub(super) const PART: [f64; 2] = [0.01, 1.0];
const JUMP: [f64; 2] = [0.0, 1e9];
const SPEED: [f64; 2] = [0.1, 10_000.0];
const SECONDS: [f64; 2] = [0.0, 60.0];

/// How lines become strokes. Lengths are millimetres on the sheet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Style {
    /// The style that has what this one does not say.
    pub base: BuiltIn,
    /// Colour of the sheet in pictures; vectors have none.
    pub paper: Colour,
    /// How far smoothing may move a line that is traced from a mask, and a hand may swerve.
    #[serde(deserialize_with = "length")]
    #[schemars(range(min = LENGTH[0], max = LENGTH[1]))]
    pub tolerance: f64,
    /// A line is left out where what lies behind is less than this share farther away, and whole from twice that on; 0 draws
    /// all. Contours only.
    #[serde(deserialize_with = "jump")]
    #[schemars(range(min = JUMP[0], max = JUMP[1]))]
    pub min_jump: f64,
    /// Of two lines nearer to each other than this the weaker fades; 0 leaves all. Contours only.
    #[serde(deserialize_with = "length")]
    #[schemars(range(min = LENGTH[0], max = LENGTH[1]))]
    pub min_gap: f64,
    /// Which lines of the land are drawn, whatever the eye: each in a layer of its own. Contours only.
    #[serde(deserialize_with = "creases")]
    pub creases: Vec<Crease>,
    /// Strokes down the slope that give tone. Contours only.
    pub hachures: HachureStyle,
    /// Where light comes from.
    pub light: LightStyle,
    /// Whether lone pixels of a mask are drawn, as dots; else they are left out as specks that say nothing.
    pub dots: bool,
    /// How wide lines are along their way.
    pub weight: Weight,
    /// A hand that is not quite steady.
    pub wobble: Wobble,
    /// What draws which lines.
    pub pens: Pens,
    /// How hidden lines are drawn.
    pub dashes: Dashes,
    /// What a plotter is given.
    pub plot: Plot,
}

/// How wide a line is, as a share of its pen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Weight {
    /// Width of the farthest lines as a share of the nearest.
    #[serde(deserialize_with = "part")]
    #[schemars(range(min = PART[0], max = PART[1]))]
    pub far: f64,
    /// Width of a line with nothing but the same slope behind it, as a share of one against the sky.
    #[serde(deserialize_with = "part")]
    #[schemars(range(min = PART[0], max = PART[1]))]
    pub flat: f64,
    /// Share of ink in the nine pixels around, each way, from which traced lines thin, so that they do not clot.
    #[serde(deserialize_with = "part")]
    #[schemars(range(min = PART[0], max = PART[1]))]
    pub crowd: f64,
    /// Length over which free ends run out; 0 leaves them blunt.
    #[serde(deserialize_with = "length")]
    #[schemars(range(min = LENGTH[0], max = LENGTH[1]))]
    pub taper: f64,
}

/// Swerves of a hand, the same for the same seed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Wobble {
    /// How far lines stray at most: less than the tolerance.
    #[serde(deserialize_with = "length")]
    #[schemars(range(min = LENGTH[0], max = LENGTH[1]))]
    pub reach: f64,
    /// About how far it is from one swerve to the next.
    #[serde(deserialize_with = "step")]
    #[schemars(range(min = STEP[0], max = STEP[1]))]
    pub length: f64,
    /// Another one is another hand.
    pub seed: u32,
}

/// A pen for each kind of line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Pens {
    /// Land before farther land, and before the sky.
    pub silhouette: Pen,
    /// The border of the DEM and of its voids.
    pub border: Pen,
    /// Where land and flat water meet.
    pub shore: Pen,
    /// Streams.
    pub drainage: Pen,
    /// Where water parts.
    pub ridge: Pen,
    /// Lines that the user gives.
    pub own: Pen,
    /// Hachures: as broad as they get.
    pub hachure: Pen,
    /// Lines that land hides.
    pub hidden: Pen,
    /// Lines that the user gives, by the names of their layers; of all others `own`, which also has what one of these does not
    /// say. Names that no layer has are no mistake.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub lines: BTreeMap<String, Pen>,
}

/// Dashes of hidden lines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Dashes {
    /// Length of a dash.
    #[serde(deserialize_with = "step")]
    #[schemars(range(min = STEP[0], max = STEP[1]))]
    pub dash: f64,
    /// Length of a gap.
    #[serde(deserialize_with = "step")]
    #[schemars(range(min = STEP[0], max = STEP[1]))]
    pub gap: f64,
}

/// What a plotter is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Plot {
    /// Whether lines of varying width are drawn by pens of one width each, along their middles.
    pub centre_lines: bool,
    /// Widths of the pens at hand for that, a layer each; none: the pen of each kind of line.
    #[serde(deserialize_with = "widths")]
    #[schemars(length(max = MOST_WIDTHS), inner(range(min = WIDTH[0], max = WIDTH[1])))]
    pub widths: Vec<f64>,
    /// Whether every layer has marks in the corners, to lay the next one over it; not with a neatline, nor on plans.
    pub registration: bool,
    /// Speed of the pen on paper, mm/s.
    #[serde(deserialize_with = "speed")]
    #[schemars(range(min = SPEED[0], max = SPEED[1]))]
    pub speed: f64,
    /// Speed of the pen in the air, mm/s.
    #[serde(deserialize_with = "speed")]
    #[schemars(range(min = SPEED[0], max = SPEED[1]))]
    pub travel_speed: f64,
    /// Time to lift the pen and to lower it, s.
    #[serde(deserialize_with = "seconds")]
    #[schemars(range(min = SECONDS[0], max = SECONDS[1]))]
    pub lift: f64,
}

/// `field-sketch`: warm ink that tapers.
impl Default for Style {
    fn default() -> Self {
        Self {
            base: BuiltIn::FieldSketch,
            paper: Colour([251, 248, 240]),
            tolerance: 0.075,
            min_jump: 0.01,
            min_gap: 0.45,
            creases: Vec::new(),
            hachures: HachureStyle::default(),
            light: LightStyle::default(),
            dots: false,
            weight: Weight::default(),
            wobble: Wobble::default(),
            pens: Pens::default(),
            dashes: Dashes::default(),
            plot: Plot::default(),
        }
    }
}

impl Default for Weight {
    fn default() -> Self {
        Self { far: 0.18, flat: 0.6, crowd: 0.22, taper: 2.5 }
    }
}

impl Default for Wobble {
    fn default() -> Self {
        Self { reach: 0.0, length: 4.0, seed: 1 }
    }
}

impl Default for Pens {
    fn default() -> Self {
        let pen = |width| Pen { width, ..Pen::default() };
        Self {
            // Lines lead, hachures follow.
            silhouette: pen(0.45),
            border: pen(0.4),
            shore: pen(0.25),
            drainage: pen(0.25),
            ridge: pen(0.2),
            own: pen(0.24),
            hachure: pen(0.38),
            hidden: pen(0.15),
            lines: BTreeMap::new(),
        }
    }
}

impl Pens {
    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = Pen> {
        let Self { silhouette, border, shore, drainage, ridge, own, hachure, hidden, lines } = self;
        [silhouette, border, shore, drainage, ridge, own, hachure, hidden].into_iter().chain(lines.values()).copied()
    }

    /// That of a layer of the user's own lines.
    pub fn of_own(&self, layer: &str) -> Pen {
        self.lines.get(layer).copied().unwrap_or(self.own)
    }
}

/// Warm black.
impl Default for Pen {
    fn default() -> Self {
        Self { width: 0.3, colour: Colour([38, 30, 24]), opacity: 1.0 }
    }
}

impl Default for Dashes {
    fn default() -> Self {
        Self { dash: 1.2, gap: 0.9 }
    }
}

impl Default for Plot {
    fn default() -> Self {
        Self {
            centre_lines: false,
            widths: Vec::new(),
            registration: false,
            speed: 60.0,
            travel_speed: 150.0,
            lift: 0.15,
        }
    }
}

impl Style {
    /// How sparing contours are where a frame has so many pixels for each millimetre of its sheet.
    pub fn economy(&self, px_per_mm: f64) -> Economy {
        Economy { min_jump: self.min_jump, min_gap: self.min_gap * px_per_mm }
    }

    /// How hachures look in a frame that has so many pixels for each millimetre of its sheet; none where there are none.
    pub fn hachures(&self, px_per_mm: f64) -> Option<Hachures> {
        let HachureStyle { tone, spacing, length, black_at, most_black, .. } = self.hachures;
        (tone != Tone::None).then(|| Hachures {
            tone,
            black_at,
            most_black,
            spacing: spacing * px_per_mm,
            broadest: self.pens.hachure.width * px_per_mm,
            length: length * px_per_mm,
            shortest: Hachures::SHORTEST,
            light: self.light.light(),
        })
    }

    /// Width of the broadest pen.
    pub fn broadest(&self) -> f64 {
        let own = self.pens.all().map(|pen| pen.width).fold(0.0, f64::max);
        self.plot.widths.last().copied().filter(|_| self.plot.centre_lines).unwrap_or(own)
    }

    /// What two settings say together that each may say alone.
    ///
    /// Else what is wrong, and what to do.
    pub(super) fn check(&self) -> Result<(), (String, String)> {
        let (reach, tolerance) = (self.wobble.reach, self.tolerance);
        if reach > 0.0 && reach >= tolerance {
            let what = format!("`wobble.reach` of {reach} mm is not below the `tolerance` of {tolerance} mm");
            return Err((what, format!("lower `reach` in [wobble] below {tolerance}, or raise `tolerance`")));
        }
        Ok(())
    }
}

/// A number of a style, if it is within bounds.
pub(super) fn within<'de, D: Deserializer<'de>>(
    from: D,
    bounds: [f64; 2],
    what: impl Display,
) -> Result<f64, D::Error> {
    let number = f64::deserialize(from)?;
    let [least, most] = bounds;
    if (least..=most).contains(&number) {
        return Ok(number);
    }
    Err(de::Error::custom(format!("{number} is out of range, expected {what}, {least} to {most}")))
}

fn length<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, LENGTH, "millimetres")
}

pub(super) fn step<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, STEP, "millimetres")
}

pub(super) fn width<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, WIDTH, "millimetres of a pen")
}

pub(super) fn share<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, SHARE, "a share")
}

pub(super) fn part<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, PART, "a share")
}

fn jump<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, JUMP, "a share of the distance")
}

fn speed<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, SPEED, "millimetres a second")
}

fn seconds<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, SECONDS, "seconds")
}

/// Each once, in one order.
fn creases<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Crease>, D::Error> {
    let mut creases = Vec::<Crease>::deserialize(from)?;
    creases.sort_unstable();
    creases.dedup();
    Ok(creases)
}

/// Pens at hand, from fine to broad.
fn widths<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
    #[derive(Deserialize)]
    struct Width(#[serde(deserialize_with = "width")] f64);
    let widths: Vec<f64> = Vec::<Width>::deserialize(from)?.into_iter().map(|width| width.0).collect();
    if widths.len() > MOST_WIDTHS || !widths.is_sorted_by(|a, b| a < b) {
        return Err(de::Error::custom(format!(
            "widths are not in order, expected at most {MOST_WIDTHS}, each broader than the last"
        )));
    }
    Ok(widths)
}

/// Most pens at hand: a layer each.
const MOST_WIDTHS: usize = 16;
