//! Does jobs one after the other: the caller's thread draws, a second one writes, so that the device works while files are
//! made.
//!
//! A job that is done is skipped; its files are looked at right before, so that two processes at the same jobs do no harm.
//! One that fails costs itself alone, but for what would fail all others too: a lost device, a disk that is full. Asked to
//! end, the jobs under way are finished. At most three drawings are in memory at a time.

use std::io::ErrorKind;
use std::sync::Mutex;
use std::sync::mpsc::sync_channel;
use std::thread;
use std::time::Instant;

use super::Job;
use crate::error::{Error, Result};
use crate::files::signals;

/// What became of a job.
#[derive(Debug)]
pub enum Event<'a> {
    /// Its files were there.
    Skipped(&'a Job),
    /// It was made, in so many milliseconds since it or, while others were under way, the last one was.
    Made(&'a Job, f64),
    /// It failed.
    Failed(&'a Job, &'a Error),
}

/// Does jobs in their order: `draw` makes of each what `finish` writes to its files. `hear` is told of each, from either
/// thread.
///
/// # Errors
/// What would fail all other jobs too: [`Error::DeviceLost`], [`Error::NoAdapter`], [`Error::Output`] for a disk without room;
/// [`Error::Ended`] where the process was asked to end.
pub(crate) fn run<'a, P: Send>(
    jobs: &'a [Job],
    mut draw: impl FnMut(&'a Job) -> Result<P>,
    finish: impl Fn(&'a Job, P) -> Result<()> + Sync,
    hear: &(dyn Fn(Event<'_>) + Sync),
) -> Result<()> {
    let fatal: Mutex<Option<Error>> = Mutex::new(None);
    let failed = |job: &'a Job, error: Error| {
        hear(Event::Failed(job, &error));
        if is_fatal(&error)
            && let Ok(mut fatal) = fatal.lock()
        {
            fatal.get_or_insert(error);
        }
    };
    let ends = || signals::is_asked() || fatal.lock().is_ok_and(|fatal| fatal.is_some());
    let (sender, receiver) = sync_channel::<(&'a Job, Instant, P)>(1);
    let left = thread::scope(|scope| {
        let write = || {
            let mut last: Option<Instant> = None;
            for (job, began, drawn) in receiver {
                match finish(job, drawn) {
                    Ok(()) => {
                        let began = last.map_or(began, |last| last.max(began));
                        hear(Event::Made(job, began.elapsed().as_secs_f64() * 1e3));
                    }
                    Err(error) => failed(job, error),
                }
                last = Some(Instant::now());
            }
        };
        scope.spawn(write);
        // Dropped at the end of the work, it ends the writer.
        let sender = sender;
        let mut left = jobs.iter();
        for job in left.by_ref() {
            if job.is_done() {
                hear(Event::Skipped(job));
                continue;
            }
            if ends() {
                return left.len() + 1;
            }
            let began = Instant::now();
            match draw(job) {
                // The writer goes on as long as there is a sender.
                Ok(drawn) => drop(sender.send((job, began, drawn))),
                Err(error) => failed(job, error),
            }
        }
        left.len()
    });
    if let Some(error) = fatal.into_inner().ok().flatten() {
        return Err(error);
    }
    match signals::is_asked() && left > 0 {
        true => Err(Error::Ended {
            what: format!("asked to end with {left} of {} left", jobs.len()).into(),
            remedy: "the same command goes on from there".into(),
        }),
        false => Ok(()),
    }
}

/// Whether all other jobs would fail for the same reason.
fn is_fatal(error: &Error) -> bool {
    match error {
        Error::DeviceLost { .. } | Error::NoAdapter { .. } => true,
        Error::Output { why, .. } => {
            matches!(why, ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::ReadOnlyFilesystem)
        }
        _ => false,
    }
}
