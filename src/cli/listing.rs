//! Jobs as lines of JSON, with what they may take: for farms that book memory and time.

use serde::Serialize;

use super::talk::Talk;
use super::words;
use crate::error::{Error, Result};
use crate::job::{Job, name};
use crate::plan::frame::KeptLattice;
use crate::plan::{Frame, Plan};
use crate::render::Estimate;
use crate::surface::Surface;
use crate::view::Camera;

/// A job.
#[derive(Serialize)]
struct JobLine {
    n: u32,
    files: Vec<String>,
    job: String,
    done: bool,
    samples: u64,
    facets: u64,
    start_seconds: f64,
    seconds: f64,
    memory_bytes: u64,
    device_bytes: u64,
    /// Why it cannot be made.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// What a view may take.
///
/// # Errors
/// As [`Frame::new`] and [`Estimate::of`].
pub(crate) fn estimate(plan: &Plan, surface: &Surface, camera: &Camera, kept: &mut KeptLattice) -> Result<Estimate> {
    Estimate::of(&Frame::new(plan, surface, camera, true, kept)?, surface)
}

/// Prints a job and what it may take, which is nothing where it is done, or why it cannot be made.
///
/// # Errors
/// As [`Talk::answer`].
pub(crate) fn tell(job: &Job, estimate: Result<Estimate>, talk: &Talk) -> Result<()> {
    let error = estimate.as_ref().err().map(words::line);
    let Estimate { samples, facets, start, seconds, memory, device } = estimate.unwrap_or(Estimate::NOTHING);
    let line = JobLine {
        n: job.number,
        files: job.files.iter().map(|made| made.path.to_string_lossy().into_owned()).collect(),
        job: job.files.first().map(|made| name::text(made.name)).unwrap_or_default(),
        done: job.is_done(),
        samples,
        facets,
        start_seconds: milliseconds(start),
        seconds: milliseconds(seconds),
        memory_bytes: memory,
        device_bytes: device,
        error,
    };
    talk.answer(&serde_json::to_string(&line).map_err(|error| Error::mistake(error.to_string()))?)
}

/// Seconds to the millisecond.
fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e3).round() / 1e3
}
