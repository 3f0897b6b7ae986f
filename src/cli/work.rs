//! What every subcommand that makes many drawings does about them: manifest, progress, what is said at the end.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::jobs::{self, JobShare};
use super::progress::{JobCounts, Progress, duration};
use super::talk::Talk;
use super::words;
use crate::error::{Error, Result, shown};
use crate::files::{Output, output, signals};
use crate::job::manifest::SequenceKey;
use crate::job::{self, Content, Event, Frames, Job, JobFile, Manifest, Shard};

/// How often the manifest is written while the work goes on.
const OFTEN: Duration = Duration::from_secs(10);

/// Jobs to do.
pub struct JobWork<'a> {
    /// Of which they are.
    pub sequence: SequenceKey,
    /// Which of them.
    pub share: JobShare,
    /// They, in words.
    pub called: &'a str,
    /// They.
    pub jobs: Vec<Job>,
    /// Where the manifest stands.
    pub folder: PathBuf,
    /// What the files of DEMs hold.
    pub dems: Vec<Content>,
}

/// Temporary files that nobody has written to for so long are of a process that was killed.
const LEFT: Duration = Duration::from_secs(600);

/// Opens an output, whose folder is made where it is not there.
///
/// # Errors
/// [`Error::Output`].
pub(crate) fn create(path: &Path) -> Result<Output> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), |folder| fs::create_dir_all(folder).map_err(|error| Error::output(folder, &error)))?;
    Output::create(path)
}

/// A manifest that is written from time to time.
struct Noted<'a> {
    manifest: Mutex<(Manifest, Instant)>,
    folder: &'a Path,
}

impl JobWork<'_> {
    /// Some of it as work of its own: it holds all jobs there are.
    ///
    /// # Errors
    /// As [`jobs::check`].
    pub fn part(&self, frames: &Frames) -> Result<JobWork<'_>> {
        jobs::check(frames, self.jobs.len() as u32, self.called)?;
        let jobs = frames.numbers().iter().filter_map(|n| self.jobs.get(*n as usize).cloned()).collect();
        let share = JobShare { part: Some(frames.clone()), shard: Shard::WHOLE, frames: frames.clone() };
        let (sequence, folder, dems) = (self.sequence.clone(), self.folder.clone(), self.dems.clone());
        Ok(JobWork { sequence, share, called: self.called, jobs, folder, dems })
    }

    /// Does the jobs in folders that are [prepared](Self::prepare): `draw` makes of each what `finish` writes to its files; both
    /// may tell `progress` of the adapter.
    ///
    /// # Errors
    /// As [`job::run`]; [`Error::Incomplete`] where some failed; [`Error::Output`] where the folder takes no files.
    pub fn run<'j, P: Send>(
        &'j self,
        talk: &Talk,
        progress: &Progress,
        draw: impl FnMut(&'j Job) -> Result<P>,
        finish: impl Fn(&'j Job, P) -> Result<()> + Sync,
    ) -> Result<()> {
        let began = Instant::now();
        let noted = self.noted()?;
        let finishing = signals::finish_first();
        let first = Mutex::new(None);
        let hear = |event: Event<'_>| {
            progress.hear(&event);
            if let Event::Failed(job, error) = event {
                let line = words::line(error);
                talk.warn(&format!("{} failed: {line}", job.called));
                first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(line);
            }
            noted.note(&event, progress);
        };
        let done = job::run(&self.jobs, draw, finish, &hear);
        drop(finishing);
        let written = noted.write(progress);
        let counts = progress.counts();
        done.and(written)?;
        self.tell(counts, began, talk)?;
        let first = first.into_inner().unwrap_or_else(PoisonError::into_inner);
        match first {
            None => Ok(()),
            Some(first) => {
                let of =
                    format!("{} of {} {} failed, the first with: {first}", counts.failed, self.jobs.len(), self.called);
                Err(Error::incomplete(of, "mend that; the same command makes what is missing"))
            }
        }
    }

    /// Makes the folders, and removes what a process that was killed has left there.
    ///
    /// # Errors
    /// [`Error::Output`] where no job can write all its files: else those fail that cannot.
    pub fn prepare(&self) -> Result<()> {
        fn folder_of(made: &JobFile) -> &Path {
            made.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
        }
        let ready = |folder: &Path| {
            fs::create_dir_all(folder)
                .and_then(|()| tempfile::tempfile_in(folder))
                .map_err(|error| Error::output(folder, &error))?;
            output::remove_left(folder, LEFT);
            Ok(())
        };
        ready(&self.folder)?;
        let folders: BTreeSet<&Path> = self.jobs.iter().flat_map(|job| &job.files).map(folder_of).collect();
        let failed: BTreeMap<&Path, Error> =
            folders.into_iter().filter_map(|folder| Some((folder, ready(folder).err()?))).collect();
        let fails = |job: &Job| job.files.iter().any(|made| failed.contains_key(folder_of(made)));
        let all_fail = self.jobs.iter().all(fails);
        failed.into_values().next().filter(|_| all_fail).map_or(Ok(()), Err)
    }

    fn noted(&self) -> Result<Noted<'_>> {
        let JobShare { part, shard, .. } = &self.share;
        let mut manifest = Manifest::new(&self.sequence, *shard, part.as_ref(), &self.jobs, &self.folder);
        manifest = manifest.after(&self.folder);
        manifest.dems = self.dems.clone();
        manifest.write(&self.folder)?;
        Ok(Noted { manifest: Mutex::new((manifest, Instant::now())), folder: &self.folder })
    }

    fn tell(&self, JobCounts { made, skipped, failed }: JobCounts, began: Instant, talk: &Talk) -> Result<()> {
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        talk.say(&format!(
            "{}: {made} {} drawn, {skipped} were there{failed}, {}",
            shown(&self.folder),
            self.called,
            duration(began.elapsed().as_secs_f64())
        ))
    }
}

impl Noted<'_> {
    /// Notes what became of a job; writes it down where that was long ago.
    fn note(&self, event: &Event, progress: &Progress) {
        let mut noted = self.manifest.lock().unwrap_or_else(PoisonError::into_inner);
        let (manifest, written) = &mut *noted;
        match event {
            Event::Made(job, ms) => manifest.note(job.number, Ok(*ms)),
            Event::Failed(job, error) => manifest.note(job.number, Err(words::line(error))),
            Event::Skipped(_) => return,
        }
        if written.elapsed() >= OFTEN {
            *written = Instant::now();
            manifest.adapter = progress.adapter().or(manifest.adapter.take());
            // What cannot be written now is tried again, at the end at the latest.
            let _ = manifest.write(self.folder);
        }
    }

    fn write(&self, progress: &Progress) -> Result<()> {
        let mut noted = self.manifest.lock().unwrap_or_else(PoisonError::into_inner);
        let adapter = progress.adapter().or(noted.0.adapter.take());
        noted.0.adapter = adapter;
        // A folder that was removed meanwhile is there again with the first file.
        fs::create_dir_all(self.folder).map_err(|error| Error::output(self.folder, &error))?;
        noted.0.write(self.folder)
    }
}
