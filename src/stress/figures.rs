//! What a run of cases found; `results.json` holds it under the same names. Lengths on the page are pixels (`_px`), times
//! milliseconds (`_ms`), shares run from 0 to 1.

use glam::DVec2;
use serde::Serialize;

use super::promise::{Check, Promise};
use crate::measure::figures::DrawnLevel;
use crate::truth::Mask;

/// A case, its land and its views.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct CaseFigures {
    /// Unique.
    pub name: &'static str,
    /// What makes it hard.
    pub group: &'static str,
    /// The same in a line.
    pub about: &'static str,
    /// Samples from west to east.
    pub columns: usize,
    /// Samples from north to south.
    pub rows: usize,
    /// Metres between columns and rows.
    pub cell_m: [f64; 2],
    /// What it promises.
    pub promises: Vec<Promise>,
    /// At least one.
    pub views: Vec<ViewFigures>,
    /// What all of it took.
    pub seconds: f64,
}

/// A view of a case, and its truth.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ViewFigures {
    /// Unique in its case.
    pub name: &'static str,
    /// Easting, northing, exaggerated height.
    pub eye_m: [f64; 3],
    /// Degrees clockwise from the y axis of the world.
    pub azimuth: f64,
    /// Degrees above the horizon.
    pub altitude: f64,
    /// Horizontal field of view, degrees.
    pub fov: f64,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Subdivisions of a cell's edge of truth.
    pub truth_level: u32,
    /// Visible line on the page.
    pub truth_px: f64,
    /// Time it took.
    pub truth_ms: f64,
    /// File name of the picture.
    pub picture: String,
    /// Where it is worst.
    pub worst: Vec<Worst>,
    /// What the picture shows.
    #[serde(skip)]
    pub seen: Seen,
}

/// A place that a promise is measured worst at.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Worst {
    /// Name of the method.
    pub method: &'static str,
    /// Of which promise.
    pub promise: Promise,
    /// Middle of the place on the page, px from the top left.
    pub at_px: [f64; 2],
    /// How many pixels about it.
    pub pixels: usize,
}

impl Worst {
    /// A place.
    pub(crate) fn new(method: &'static str, promise: Promise, (at, pixels): (DVec2, usize)) -> Self {
        let tenths = |v: f64| (v * 10.0).round() / 10.0;
        Self { method, promise, at_px: [tenths(at.x), tenths(at.y)], pixels }
    }
}

/// What a picture of a view shows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Seen {
    /// Which pixels show land, row by row.
    pub land: Vec<bool>,
    /// The ink of the walk.
    pub ink: Option<Mask>,
    /// Which of it lies astray: column and row.
    pub astray: Vec<[u32; 2]>,
    /// Where it lacks some.
    pub missed: Vec<[u32; 2]>,
}

/// A method in a view.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RunFigures {
    /// Name of the case.
    pub case: &'static str,
    /// Of which group it is.
    pub group: &'static str,
    /// Name of the view.
    pub view: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// Subdivisions of a cell's edge, or `auto`.
    pub level: DrawnLevel,
    /// Pixels of true line on the page.
    pub truth_px: f64,
    /// Share of ink within 1 px of truth; `None` without truth.
    pub precision: Option<f64>,
    /// Share of truth within 1 px of ink.
    pub recall: Option<f64>,
    /// Harmonic mean of the two.
    pub f: Option<f64>,
    /// Missed stretches of truth of at least 3 px.
    pub gaps: Option<usize>,
    /// 8-connected sets of ink wholly farther than 2.5 px from truth.
    pub spurious: Option<usize>,
    /// Inked pixels.
    pub inked: usize,
    /// Facets of the whole land.
    pub facets: u64,
    /// Median of three warm frames, camera to mask.
    pub frame_ms: f64,
    /// Share of ink that pops when the eye moves by a millionth of its distance.
    pub popped: f64,
    /// The same of truth.
    pub truth_popped: f64,
    /// Change of lines over change of eye, both in px.
    pub amplification: f64,
    /// Pixels that differ on land that is turned or mirrored, as a share of the ink; `None` where the case does not promise it.
    pub turned: Option<f64>,
}

/// All that was found.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Outcome {
    /// In the order of the registry.
    pub cases: Vec<CaseFigures>,
    /// Methods times views.
    pub runs: Vec<RunFigures>,
    /// Every promise, kept or not.
    pub checks: Vec<Check>,
}

impl Outcome {
    /// With those of more cases.
    pub(crate) fn extend(&mut self, more: Self) {
        self.cases.extend(more.cases);
        self.runs.extend(more.runs);
        self.checks.extend(more.checks);
    }

    /// Those that were broken.
    pub(crate) fn broken(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|check| !check.kept)
    }
}
