//! What `draw --json` writes: what was done.

use std::path::PathBuf;

use serde::Serialize;

use super::flat_earth::FlatEarth;
use super::folds::FoldsReport;
use super::view_report::ViewReport;
use super::words::told;
use crate::dem::Dem;
use crate::ink::plot::Journey;
use crate::ink::style::Plot;
use crate::ink::unstroked::Unstroked;
use crate::ink::{Drawing, Layer, Sheet, StrokeForm};
use crate::line::{Chain, Strays};
use crate::measure::figures::DrawnLevel;
use crate::plan::left_out::LeftOut;
use crate::render::{Page, PassTime};

/// `--json`.
#[derive(Serialize)]
pub(super) struct Report {
    pub version: &'static str,
    pub dem: DemReport,
    pub method: &'static str,
    pub level: DrawnLevel,
    pub facets: u64,
    pub folds: FoldsReport,
    pub inked: usize,
    pub chains: Option<ChainsReport>,
    /// Parts of the mask that no stroke draws.
    pub without_stroke: Vec<Unstroked>,
    pub page: PageReport,
    pub layers: Vec<LayerReport>,
    pub covered: u64,
    pub longest_walk: u32,
    pub pieces: usize,
    pub warm_frames: usize,
    pub frame_ms: f64,
    pub timing: &'static str,
    pub passes: Vec<PassTime>,
    pub adapter: String,
    pub int64: bool,
    pub view: ViewReport,
    pub flat_earth: Option<FlatEarth>,
    pub left_out: Vec<LeftOutReport>,
}

/// The chains of contours that were found, and where they and the mask do not tell of the same lines.
#[derive(Serialize)]
pub(super) struct ChainsReport {
    pub count: usize,
    pub length_px: f64,
    pub without_ink_px: usize,
    pub ink_without_chain_px: usize,
}

/// What was drawn, and what became of the files on the way.
#[derive(Serialize)]
pub(super) struct DemReport {
    pub files: Vec<String>,
    pub columns: usize,
    pub rows: usize,
    pub cell_m: [f64; 2],
    pub extent_m: [f64; 4],
    pub voids: usize,
    pub steps_m: Vec<f64>,
    pub converted: Vec<String>,
    pub assumed: Vec<String>,
}

/// What the frame did without.
#[derive(Serialize)]
pub(super) struct LeftOutReport {
    pub what: &'static str,
    pub why: String,
    pub saved: Option<String>,
}

/// The sheet, and how the pixels of the frame lie on it.
#[derive(Serialize)]
pub(super) struct PageReport {
    size_mm: [f64; 2],
    margin_mm: f64,
    /// Where the frame lies: left, top, right, bottom.
    frame_mm: [f64; 4],
    frame_px_per_mm: f64,
}

/// What a pen draws.
#[derive(Serialize)]
pub(super) struct LayerReport {
    name: String,
    pen_mm: f64,
    strokes: usize,
    /// Of a plotter's pen, which follows the lines of layers of one width; else nothing.
    plot: Option<PlotReport>,
}

/// What a plotter's pen does for a layer.
#[derive(Serialize)]
struct PlotReport {
    drawn_mm: f64,
    travel_mm: f64,
    /// In the order in which lines were found.
    travel_found_mm: f64,
    seconds: f64,
}

impl PageReport {
    pub(super) fn of(sheet: &Sheet, frame: [u32; 2]) -> Self {
        let [low, high] = sheet.area();
        Self {
            size_mm: sheet.size.to_array(),
            margin_mm: sheet.margin,
            frame_mm: [low.x, low.y, high.x, high.y],
            frame_px_per_mm: sheet.placement(frame).px_per_mm,
        }
    }
}

impl LayerReport {
    /// Of each layer, drawn by such a plotter.
    pub(super) fn all(drawing: &Drawing, plotter: &Plot) -> Vec<Self> {
        let plot = |layer: &Layer| {
            let journey = Journey::through(&layer.strokes);
            PlotReport {
                drawn_mm: journey.drawn,
                travel_mm: journey.travel,
                travel_found_mm: layer.found.travel,
                seconds: journey.seconds(plotter),
            }
        };
        let of = |layer: &Layer| Self {
            name: layer.name.clone(),
            pen_mm: layer.pen.width,
            strokes: layer.strokes.len(),
            plot: (layer.form == StrokeForm::CentreLines).then(|| plot(layer)),
        };
        drawing.layers.iter().map(of).collect()
    }
}

impl LeftOutReport {
    pub(super) fn of(LeftOut { what, why, saved }: LeftOut) -> Self {
        Self { what, why: told(&why), saved }
    }
}

impl ChainsReport {
    pub(super) fn of(page: &Page) -> Self {
        let strays = Strays::of(&page.chains, &page.marks);
        Self {
            count: page.chains.len(),
            length_px: page.chains.iter().map(Chain::length).sum(),
            without_ink_px: strays.chains,
            ink_without_chain_px: strays.ink,
        }
    }
}

impl DemReport {
    pub(super) fn of(files: &[PathBuf], dem: &Dem) -> Self {
        // What cannot be read fails elsewhere, with its reason.
        let surveyed = dem.survey(&|_| ()).map(|survey| survey.assumed.clone()).unwrap_or_default();
        let assumed = [dem.history().assumed(), &surveyed, dem.history().usual()];
        Self {
            files: files.iter().map(|file| file.to_string_lossy().into_owned()).collect(),
            columns: dem.columns(),
            rows: dem.rows(),
            cell_m: dem.cell().to_array(),
            extent_m: dem.extent(),
            voids: dem.voids(),
            steps_m: dem.history().steps().to_vec(),
            converted: dem.history().converted().iter().map(told).collect(),
            assumed: assumed.into_iter().flatten().map(told).collect(),
        }
    }
}
