//! Many drawings as one piece of work that survives anything: each is skipped where it is done, and loses nothing but itself
//! where it fails.
//!
//! A [`Job`] is the files of one drawing and the [names](name) of all that they are made of. Files bear these names
//! ([`Seal`]), so that a run that is taken up again knows what is done by the files alone, without the DEM.
//! [`run`] draws on one thread and writes on another; [`Frames`] and [`Shard`] say which jobs are whose; a [`Manifest`] beside
//! the files says what was to be made by which process, and [`Merged`] whether all of it is there.

pub(crate) mod content;
pub(crate) mod engine;
pub(crate) mod film;
pub(crate) mod frames;
pub(crate) mod manifest;
pub(crate) mod merge;
pub(crate) mod name;
pub(crate) mod pattern;
pub(crate) mod serve;
pub(crate) mod shard;

use std::path::PathBuf;

use crate::ink::Seal;

pub(crate) use content::Content;
pub(crate) use engine::{Event, run};
pub use film::{Film, Inks};
pub use frames::Frames;
pub use manifest::Manifest;
pub use merge::Merged;
pub use pattern::Pattern;
pub use shard::Shard;

/// One drawing to make: a frame of a flight, a drawing of a batch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// Its place among all jobs, from 0 on.
    pub number: u32,
    /// In words.
    pub called: String,
    /// The files it makes.
    pub files: Vec<JobFile>,
}

/// A file that a job makes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobFile {
    /// Where it stands.
    pub path: PathBuf,
    /// The name of all that it is made of.
    pub name: u128,
}

impl Job {
    /// Whether all its files are there, whole, and made of the same.
    pub fn is_done(&self) -> bool {
        self.files.iter().all(JobFile::is_there)
    }
}

impl JobFile {
    /// Whether the file is there, whole, and made of the same.
    pub fn is_there(&self) -> bool {
        Seal::job_of(&self.path).is_ok_and(|name| name == Some(self.name))
    }
}
