//! What a comparison found, as `results.json` holds it. Schema version 2: azimuths count from `north`.
//!
//! Truths and runs are told as they were measured: see [`figures`](crate::measure::figures), units too. What is measured anew in every run and so differs between two runs of the same
//! comparison has one of the last two endings or is called `passes` or `floor`; all else is the same to the last digit.

use serde::Serialize;

use crate::measure::figures::{Convergence, Run, SequenceRun, TruthReport};

/// Version of the schema: raised when a key changes its meaning or goes.
pub const SCHEMA: u32 = 2;

/// The whole comparison.
#[derive(Debug, Clone, Serialize)]
pub struct Results {
    /// [`SCHEMA`].
    pub version: u32,
    /// Version of hachure.
    pub hachure: &'static str,
    /// The command, with its flags as typed.
    pub command: String,
    /// Where it ran.
    pub machine: Machine,
    /// Of the scene whose truth is surest of itself the least: the limit of every figure here.
    pub truth: TruthSummary,
    /// What was drawn: views times sizes.
    pub scenes: Vec<ComparedScene>,
    /// Methods times levels, scene by scene.
    pub runs: Vec<Run>,
    /// Methods times levels over runs of frames; none unless they were asked for.
    pub sequences: Vec<SequenceRun>,
}

/// Processor, adapter and driver.
#[derive(Debug, Clone, Serialize)]
pub struct Machine {
    /// Operating system and processor architecture.
    pub system: String,
    /// Cores this process may use.
    pub cores: usize,
    /// Name of the adapter.
    pub adapter: String,
    /// `cpu` for a software driver, else the kind of GPU.
    pub adapter_kind: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Whether 64-bit atomics were in use.
    pub int64: bool,
    /// How times were taken, in words.
    pub timing: String,
}

/// How sure truth is of itself.
#[derive(Debug, Clone, Serialize)]
pub struct TruthSummary {
    /// Subdivisions of a cell's edge.
    pub level: u32,
    /// F of the truth of half the level, drawn one pixel wide, against it; 1 px.
    pub self_f: f64,
}

/// A view on a page, and its truth.
#[derive(Debug, Clone, Serialize)]
pub struct ComparedScene {
    /// Unique in the report; file names begin with it.
    pub name: String,
    /// Files of the DEM as named.
    pub dem: Vec<String>,
    /// Samples from west to east.
    pub columns: usize,
    /// Samples from north to south.
    pub rows: usize,
    /// Metres between columns and rows.
    pub cell_m: [f64; 2],
    /// PN triangles.
    pub patches: u64,
    /// Eye: easting, northing, exaggerated height.
    pub eye_m: [f64; 3],
    /// What `azimuth` is counted from: `true` or `grid`.
    pub north: String,
    /// Degrees clockwise from `north`.
    pub azimuth: f64,
    /// Degrees above the horizon.
    pub altitude: f64,
    /// Horizontal field of view, degrees.
    pub fov: f64,
    /// Flags that repeat the view.
    pub flags: String,
    /// The command that draws it, for the page alone.
    #[serde(skip)]
    pub command: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Whether border lines are drawn and judged.
    pub border: bool,
    /// What the runs are measured against.
    pub truth: TruthReport,
    /// How coarser levels close in on truth.
    pub convergence: Option<Convergence>,
    /// File name of truth drawn one pixel wide.
    pub picture: String,
}
