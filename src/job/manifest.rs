//! What a process was to make in a folder, as a JSON file beside what it made: its shard, its jobs with the names of their
//! files, and how they went.
//!
//! Files tell by themselves what they are made of, so a manifest that was lost costs nothing but the knowledge of what is
//! missing. It is written when the work begins, every so often, and when it ends.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Content, Frames, Inks, Job, Shard, frames, name};
use crate::error::{Error, Result};
use crate::files::{Output, regular, relative};

/// Number of what a manifest holds: raised when that changes.
const FORMAT: u32 = 1;
/// Begins its name.
const PREFIX: &str = "hachure-";
/// Ends it.
const SUFFIX: &str = ".json";

/// What a process was to make.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    format: u32,
    /// The program.
    pub hachure: String,
    /// What it is of, in words.
    pub of: String,
    /// Of which sequence the jobs are, whatever its look: 32 digits.
    pub sequence: String,
    /// What all jobs have in common, look included: 32 digits.
    pub job: String,
    /// Jobs of the whole sequence.
    pub count: u32,
    /// Which shard of how many.
    pub shard: [u32; 2],
    /// Of which jobs it is a shard, where not of all.
    pub part: Option<String>,
    /// Frames a second, of a sequence that moves.
    pub fps: Option<f64>,
    /// What its pictures are drawn with.
    pub inks: Option<Inks>,
    /// The files of each DEM and what they hold.
    pub dems: Vec<Content>,
    /// Adapter and driver, once they are known.
    pub adapter: Option<String>,
    /// Its jobs.
    pub jobs: Vec<ManifestEntry>,
}

/// A job.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ManifestEntry {
    /// Its number.
    pub n: u32,
    /// Its files: paths from the manifest's folder, and the names of what they are made of.
    pub files: Vec<(PathBuf, String)>,
    /// Milliseconds that it took, where this process made it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub ms: Option<f64>,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub failed: Option<String>,
}

impl ManifestEntry {
    /// The first picture of its drawing. Masks come last, under a name of their own.
    pub(super) fn picture(&self) -> Option<PathBuf> {
        let (_, drawing) = self.files.first()?;
        let is_picture = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        self.files.iter().find(|(path, name)| name == drawing && is_picture(path)).map(|(path, _)| path.clone())
    }
}

/// What tells one sequence from others.
#[derive(Debug, Clone)]
pub struct SequenceKey {
    /// In words.
    pub of: String,
    /// Whatever its look.
    pub sequence: u128,
    /// Look included.
    pub job: u128,
    /// Jobs in all.
    pub count: u32,
    /// Frames a second, where it moves.
    pub fps: Option<f64>,
    /// What its pictures are drawn with, where it moves.
    pub inks: Option<Inks>,
}

impl Manifest {
    /// Of what is to be done in `folder`.
    pub fn new(sequence: &SequenceKey, shard: Shard, part: Option<&Frames>, jobs: &[Job], folder: &Path) -> Self {
        let entry = |job: &Job| ManifestEntry {
            n: job.number,
            files: job.files.iter().map(|made| (relative(folder, &made.path), name::text(made.name))).collect(),
            ms: None,
            failed: None,
        };
        Self {
            format: FORMAT,
            hachure: env!("CARGO_PKG_VERSION").to_owned(),
            of: sequence.of.clone(),
            sequence: name::text(sequence.sequence),
            job: name::text(sequence.job),
            count: sequence.count,
            shard: [shard.index, shard.count],
            part: part.map(Frames::to_string),
            fps: sequence.fps,
            inks: sequence.inks.clone(),
            dems: Vec::new(),
            adapter: None,
            jobs: jobs.iter().map(entry).collect(),
        }
    }

    /// What it is called: after its sequence where a folder may hold several, after its shard, and after the jobs of which
    /// it is one where those are not all.
    pub fn file_name(&self) -> String {
        let [index, count] = self.shard;
        let sequence = if self.fps.is_none() { format!("{:.8}-", self.sequence) } else { String::new() };
        let part = self.part.as_ref().map(|part| format!("-{:08x}", xxhash_rust::xxh3::xxh3_64(part.as_bytes()) >> 32));
        format!("{PREFIX}{sequence}{index}-of-{count}{}{SUFFIX}", part.unwrap_or_default())
    }

    /// With what an older one of the same jobs, if there is one, tells of how they went.
    #[must_use]
    pub fn after(mut self, folder: &Path) -> Self {
        let older = Self::read(&folder.join(self.file_name())).ok();
        if let Some(older) = older.filter(|older| older.job == self.job) {
            let at = |n: u32| older.jobs.binary_search_by_key(&n, |other| other.n).ok();
            let took =
                |entry: &ManifestEntry| older.jobs.get(at(entry.n)?).filter(|other| other.files == entry.files)?.ms;
            self.jobs.iter_mut().for_each(|entry| entry.ms = took(entry));
            self.adapter = older.adapter;
        }
        self
    }

    /// Notes how a job went.
    pub fn note(&mut self, number: u32, went: std::result::Result<f64, String>) {
        if let Ok(at) = self.jobs.binary_search_by_key(&number, |entry| entry.n) {
            let entry = &mut self.jobs[at];
            (entry.ms, entry.failed) = match went {
                Ok(ms) => (Some(ms), None),
                Err(why) => (None, Some(why)),
            };
        }
    }

    /// Writes it into its folder, in the place of an older one.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&self, folder: &Path) -> Result<()> {
        let mut file = Output::create(&folder.join(self.file_name()))?;
        file.write(|out| {
            serde_json::to_writer(&mut *out, self)?;
            writeln!(out)
        })?;
        file.publish()
    }

    /// All of a folder, in the order of their names; none where there is no folder.
    ///
    /// # Errors
    /// [`Error::Input`] for one that cannot be read, or is none.
    pub fn all(folder: &Path) -> Result<Vec<Self>> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let named = |path: &PathBuf| {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            name.starts_with(PREFIX) && name.ends_with(SUFFIX) && name.contains("-of-")
        };
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(named).collect();
        paths.sort();
        paths.iter().map(|path| Self::read(path)).collect()
    }

    fn read(path: &Path) -> Result<Self> {
        let failed = |why: String| Error::input(path, why, "remove it, or give another folder");
        let mut text = Vec::new();
        let read = regular::open(path).and_then(|mut file| file.read_to_end(&mut text));
        read.map_err(|error| failed(format!("it cannot be read ({error})")))?;
        let manifest: Self =
            serde_json::from_slice(&text).map_err(|error| failed(format!("it is no manifest ({error})")))?;
        if manifest.format != FORMAT {
            let format = manifest.format;
            return Err(failed(format!("it is a manifest of format {format}, this program knows {FORMAT}")));
        }
        manifest.check().map_err(|why| failed(format!("it is no manifest ({why})")))?;
        Ok(manifest)
    }

    /// Says what no process writes: there are no more jobs and shards than may be asked for.
    fn check(&self) -> std::result::Result<(), String> {
        let [index, count] = self.shard;
        Shard::new(index, count)?;
        self.part.as_deref().map_or(Ok(()), |part| part.parse::<Frames>().map(drop))?;
        let last = self.jobs.iter().map(|entry| entry.n).max();
        match self.count {
            count if count > frames::MOST => Err(format!("{count} jobs are more than {}", frames::MOST)),
            count if last.is_some_and(|last| last >= count) => Err(format!("a job of {count} has a higher number")),
            _ => Ok(()),
        }
    }

    /// Refuses a folder that holds another flight, whose frames would be mixed with ours.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn refuse_others(folder: &Path, sequence: &SequenceKey) -> Result<()> {
        let ours = name::text(sequence.sequence);
        let moves = |other: &Self| other.fps.is_some() && sequence.fps.is_some();
        match Self::all(folder)?.into_iter().find(|other| other.sequence != ours && moves(other)) {
            None => Ok(()),
            Some(other) => {
                let file = folder.join(other.file_name());
                let differs = if other.of == sequence.of { " that takes another way" } else { "" };
                let what = format!("it is the manifest of {}, this is {}{differs}", other.of, sequence.of);
                Err(Error::input(&file, what, "give another folder, or remove the manifest to draw over what is there"))
            }
        }
    }
}
