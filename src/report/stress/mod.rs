//! Reports of stiff and extreme cases: JSON, CSV, a plot, and a page to read with a picture of each view in it.
//!
//! [`Report`] is what `results.json` holds: where and how cases ran, and what was found, under the names of
//! [`stress::figures`](crate::stress::figures). Figures that end in `_ms`, and `seconds`, are measured anew in every run; all else is
//! the same to the last digit on one device and driver.

mod csv;
mod page;
mod picture;
mod plot;

use serde::Serialize;

use super::folder::Contents;
use super::pictures::Picture;
use super::results::Machine;
use crate::error::{Error, Result};
use crate::stress::Outcome;

pub(crate) use csv::write_csv;
pub(crate) use page::page_html;
pub(crate) use picture::picture;
pub(crate) use plot::error_time_svg;

/// Version of the schema: raised when a key changes its meaning or goes.
pub(crate) const SCHEMA: u32 = 1;

/// A run of cases.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Report {
    /// [`SCHEMA`].
    pub version: u32,
    /// Version of hachure.
    pub hachure: &'static str,
    /// The command, with its flags as typed.
    pub command: String,
    /// Where it ran.
    pub machine: Machine,
    /// What the whole run took.
    pub seconds: f64,
    /// Promises that were kept.
    pub kept: usize,
    /// Promises that were broken.
    pub broken: usize,
    /// What was found.
    #[serde(flatten)]
    pub outcome: Outcome,
}

impl Report {
    /// All files but the pictures.
    ///
    /// # Errors
    /// [`Error::Mistake`] where one cannot be made.
    pub(crate) fn contents(&self, pictures: &[Picture]) -> Result<Contents> {
        let plot = error_time_svg(&self.outcome)?;
        let failed = |e: std::io::Error| Error::no_report(e);
        let mut csv = Vec::new();
        write_csv(&self.outcome, &mut csv).map_err(failed)?;
        let mut json = serde_json::to_vec_pretty(self).map_err(|e| failed(e.into()))?;
        json.push(b'\n');
        Ok(Contents { page: page_html(self, &plot, pictures)?, json, csv, plot })
    }
}
