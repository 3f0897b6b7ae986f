//! The drawing as data: a sheet with layers, a layer with a pen and strokes, all in millimetres.

use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::plot::Journey;
use super::style::{SHARE, WIDTH, share, width};
use super::{Colour, Seal, Sheet};
use crate::line::Id;

/// A sheet of line work.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What it stands on.
    pub sheet: Sheet,
    /// Colour of the sheet, for pictures; vectors leave the paper as it is.
    pub paper: Colour,
    /// From bottom to top, in the order of plotting.
    pub layers: Vec<Layer>,
    /// What it is called, for files that are to tell.
    pub title: Option<String>,
    /// What made it, for files that are to tell.
    pub seal: Option<Seal>,
}

/// A pen: one width, one colour.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Pen {
    /// Width of the widest lines, mm.
    #[serde(deserialize_with = "width")]
    #[schemars(range(min = WIDTH[0], max = WIDTH[1]))]
    pub width: f64,
    /// Colour of the ink.
    pub colour: Colour,
    /// Of the whole layer, 0 to 1: where its strokes cross, nothing is darker.
    #[serde(deserialize_with = "share")]
    #[schemars(range(min = SHARE[0], max = SHARE[1]))]
    pub opacity: f64,
}

/// What one pen draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What editors and plotters call it: its place in the order of plotting, from 1 on, then what it is.
    pub name: String,
    /// The pen.
    pub pen: Pen,
    /// How strokes are written.
    pub form: StrokeForm,
    /// What a pen would have done with its lines in the order in which they were found.
    pub found: Journey,
    /// In the order of plotting, the same in every run.
    pub strokes: Vec<Stroke>,
    /// Filled as they are, in layers of outlines: letters and rules.
    pub areas: Vec<Area>,
}

/// An area by its borders: rings in millimetres on the sheet, filled together by the non-zero rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Area(pub Vec<Vec<DVec2>>);

/// How the strokes of a layer are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrokeForm {
    /// Each as the area that it covers: widths vary along it.
    Outlines,
    /// Each as the line that a pen follows: all are as wide as the pen, with round ends.
    CentreLines,
}

/// One line without lifting the pen; one point is a dot.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// The chain it draws, of several the lowest; `None` where that has no name.
    pub chain: Option<Id>,
    /// Which of the strokes of that chain it is, from 0 on: along the chain, layer by layer.
    pub piece: u32,
    /// At least one.
    pub points: Vec<StrokePoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

/// A point of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokePoint {
    /// Millimetres from the sheet's top left corner, x right, y down.
    pub place: DVec2,
    /// Width here as a share of the pen's, 0 to 1; 0 at an end that runs out.
    pub width: f64,
}
