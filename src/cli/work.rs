//! What every subcommand that makes many drawings does about them: manifest, progress, what is said at the end.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::jobs::Share;
use super::progress::{Counts, Form, Progress, duration};
use super::talk::Talk;
use super::words;
use crate::error::{Error, Result, shown};
use crate::files::signals;
use crate::job::manifest::Sequence;
use crate::job::{self, Content, Event, Job, Manifest};

/// How often the manifest is written while the work goes on.
const OFTEN: Duration = Duration::from_secs(10);

/// Jobs to do.
pub struct Work<'a> {
    /// Of which they are.
    pub sequence: Sequence,
    /// Which of them.
    pub share: Share,
    /// One of them, and several, in words.
    pub called: [&'a str; 2],
    /// They.
    pub jobs: Vec<Job>,
    /// Where the manifest stands.
    pub folder: PathBuf,
    /// What the files of the one DEM hold.
    pub dem: Option<Content>,
}

/// A manifest that is written from time to time.
struct Noted<'a> {
    manifest: Mutex<(Manifest, Instant)>,
    folder: &'a Path,
}

impl Work<'_> {
    /// Does the jobs: `draw` makes of each what `finish` writes to its files; both may tell `progress` of the adapter.
    ///
    /// # Errors
    /// As [`job::run`]; [`Error::Incomplete`] where some failed; [`Error::Input`] where the folder holds another sequence;
    /// [`Error::Output`] where it takes no files.
    pub fn run<'j, P: Send>(
        &'j self,
        talk: &Talk,
        form: Form,
        draw: impl FnMut(&'j Job, &Progress) -> Result<P>,
        finish: impl Fn(&'j Job, P) -> Result<()> + Sync,
    ) -> Result<()> {
        let began = Instant::now();
        Manifest::refuse_others(&self.folder, &self.sequence)?;
        fs::create_dir_all(&self.folder).map_err(|error| Error::output(&self.folder, &error))?;
        let noted = self.noted()?;
        signals::finish_first();
        let progress = Progress::start(talk, form, self.jobs.len());
        let first = Mutex::new(None);
        let hear = |event: Event<'_>| {
            progress.hear(&event);
            if let Event::Failed(job, error) = event {
                let line = words::line(error);
                talk.warn(&format!("{} {} failed: {line}", self.called[0], job.number));
                first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(line);
            }
            noted.note(&event, &progress);
        };
        let mut draw = draw;
        let done = job::run(&self.jobs, |job| draw(job, &progress), finish, &hear);
        let written = noted.write(&progress);
        let counts = progress.done();
        done.and(written)?;
        self.tell(counts, began, talk)?;
        let first = first.into_inner().unwrap_or_else(PoisonError::into_inner);
        match first {
            None => Ok(()),
            Some(first) => {
                let of = format!(
                    "{} of {} {} failed, the first with: {first}",
                    counts.failed,
                    self.jobs.len(),
                    self.called[1]
                );
                Err(Error::incomplete(of, "mend that; the same command makes what is missing"))
            }
        }
    }

    fn noted(&self) -> Result<Noted<'_>> {
        let Share { part, shard, .. } = &self.share;
        let mut manifest = Manifest::new(&self.sequence, *shard, part.as_ref(), &self.jobs, &self.folder);
        manifest = manifest.after(&self.folder);
        manifest.dem = self.dem.clone();
        manifest.write(&self.folder)?;
        Ok(Noted { manifest: Mutex::new((manifest, Instant::now())), folder: &self.folder })
    }

    fn tell(&self, Counts { made, skipped, failed }: Counts, began: Instant, talk: &Talk) -> Result<()> {
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        talk.say(&format!(
            "{}: {made} {} drawn, {skipped} were there{failed}, {}",
            shown(&self.folder),
            self.called[1],
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
