//! How far a sequence has come: a bar on a terminal, or lines for programs, in JSON or as Open Job Description has them.
//!
//! Lines of JSON go to standard output, one object each: `start`, `frame`, `skip` and `fail` for each job, `done` at the end, with what
//! is left and the error that ended it; `wait` where nothing else was to be said for a while. Sessions of Open Job Description
//! (2023-09, How Jobs Are Run: messages on standard output) read `openjd_progress: 12.5`, percent; `openjd_status:`, a line in
//! words; `openjd_fail:`, why the work ended, which is said once.

use std::fmt::Display;
use std::io::{Write, stdout};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde_json::{Value, json};

use super::talk::Talk;
use super::words;
use crate::error::{Error, Result, plain};
use crate::job::Event;

/// Longest silence.
const SILENCE: Duration = Duration::from_secs(25);

/// How it is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ProgressForm {
    /// As a bar on a terminal.
    #[default]
    Bar,
    /// As lines of JSON.
    Json,
    /// As lines for a session of Open Job Description.
    OpenJd,
    /// Not at all.
    None,
}

impl ProgressForm {
    /// Tells a farm why the work ended, were it before it began; what else reads lines hears of that on standard error.
    pub fn told(self, done: Result<()>) -> Result<()> {
        if let (Self::OpenJd, Err(error)) = (self, &done) {
            say(&format!("openjd_fail: {}", plain(words::line(error))));
        }
        done
    }
}

/// How far the jobs have come.
pub struct Progress<'a> {
    talk: &'a Talk,
    form: ProgressForm,
    jobs: usize,
    began: Instant,
    counts: Mutex<JobCounts>,
    adapter: Mutex<Option<String>>,
    spoken: Arc<Mutex<Instant>>,
    /// Dropped with this, it ends who breaks silences.
    _silence: Option<Sender<()>>,
}

/// What became of jobs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct JobCounts {
    /// Made.
    pub made: usize,
    /// There already.
    pub skipped: usize,
    /// Failed.
    pub failed: usize,
}

impl JobCounts {
    fn all(self) -> usize {
        self.made + self.skipped + self.failed
    }
}

impl<'a> Progress<'a> {
    /// Begins so many jobs.
    pub fn start(talk: &'a Talk, form: ProgressForm, jobs: usize) -> Self {
        let spoken = Arc::new(Mutex::new(Instant::now()));
        let silence = (form == ProgressForm::Json).then(|| break_silences(&spoken));
        let progress = Self {
            talk,
            form,
            jobs,
            began: Instant::now(),
            counts: Mutex::default(),
            adapter: Mutex::default(),
            spoken,
            _silence: silence.flatten(),
        };
        progress.line(|| json!({"event": "start", "jobs": jobs}));
        progress.openjd("progress", 0.0);
        progress
    }

    /// The end: all was done, or an error ended it.
    pub fn end(&self, error: Option<&Error>) {
        let counts = self.counts();
        let JobCounts { made, skipped, failed } = counts;
        let (left, s) = (self.jobs.saturating_sub(counts.all()), rounded(self.began.elapsed().as_secs_f64()));
        let error = error.map(words::line);
        self.line(|| {
            json!({"event": "done", "made": made, "skipped": skipped, "failed": failed, "left": left, "s": s, "error": error})
        });
        if error.is_none() {
            self.openjd("progress", 100.0);
            self.openjd("status", format_args!("{made} drawn, {skipped} were there"));
        }
        self.talk.progress("", 1.0);
    }

    /// From here on jobs are made on this adapter.
    pub fn on(&self, adapter: &str) {
        *lock(&self.adapter) = Some(adapter.to_owned());
    }

    /// The adapter on which jobs are made, once it is known.
    pub fn adapter(&self) -> Option<String> {
        lock(&self.adapter).clone()
    }

    /// Something became of a job.
    pub fn hear(&self, event: &Event) {
        let counts = {
            let mut counts = lock(&self.counts);
            match event {
                Event::Made(..) => counts.made += 1,
                Event::Skipped(_) => counts.skipped += 1,
                Event::Failed(..) => counts.failed += 1,
            }
            *counts
        };
        let elapsed = self.began.elapsed().as_secs_f64();
        // What was skipped took no time.
        let left = self.jobs.saturating_sub(counts.all()) as f64;
        let eta = elapsed / (counts.made + counts.failed).max(1) as f64 * left;
        self.line(|| match event {
            Event::Made(job, ms) => {
                let adapter = self.adapter();
                json!({"event": "frame", "n": job.number, "ms": rounded(*ms), "eta_s": rounded(eta), "adapter": adapter})
            }
            Event::Skipped(job) => json!({"event": "skip", "n": job.number}),
            Event::Failed(job, error) => json!({"event": "fail", "n": job.number, "name": job.called, "error": words::line(error)}),
        });
        let stage = || format!("{} of {}, {} left", counts.all(), self.jobs, duration(eta));
        let share = counts.all() as f64 / self.jobs.max(1) as f64;
        match (self.form, event) {
            // The end is told with the last line.
            (ProgressForm::Bar, _) => self.talk.progress(&stage(), share.min(0.999)),
            // Thousands may be skipped in a second, each a message to a farm.
            (ProgressForm::OpenJd, Event::Made(..) | Event::Failed(..)) => {
                self.openjd("progress", rounded(share * 100.0));
                self.openjd("status", stage());
            }
            _ => {}
        }
    }

    /// What became of the jobs so far.
    pub fn counts(&self) -> JobCounts {
        *lock(&self.counts)
    }

    /// A motion picture is made of the frames, of which a share is done.
    pub fn film(&self, share: f64) {
        if self.form == ProgressForm::Bar {
            self.talk.progress("making the motion picture", share.min(0.999));
        }
    }

    /// A message of one line.
    fn openjd(&self, key: &str, value: impl Display) {
        if self.form == ProgressForm::OpenJd {
            say(&format!("openjd_{key}: {value}"));
        }
    }

    fn line(&self, line: impl FnOnce() -> Value) {
        if self.form == ProgressForm::Json {
            *lock(&self.spoken) = Instant::now();
            say(&line());
        }
    }
}

/// Says from time to time that the work goes on, where nothing else was said, until what it gives is dropped; `None` where the
/// system has no thread left.
fn break_silences(spoken: &Arc<Mutex<Instant>>) -> Option<Sender<()>> {
    let (sender, receiver) = channel::<()>();
    let spoken = spoken.clone();
    let work = move || {
        while receiver.recv_timeout(Duration::from_secs(1)) == Err(RecvTimeoutError::Timeout) {
            let mut spoken = lock(&spoken);
            if spoken.elapsed() >= SILENCE {
                *spoken = Instant::now();
                say(&json!({"event": "wait"}));
            }
        }
    };
    thread::Builder::new().spawn(work).ok().map(|_| sender)
}

/// A reader that has gone away has had what it wanted.
fn say(line: &dyn Display) {
    let mut out = stdout().lock();
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// With three decimals.
pub(crate) fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3
}

/// Seconds in words.
pub(crate) fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds} s"),
        (hours, minutes, _) => format!("{hours} h {minutes} min"),
    }
}
