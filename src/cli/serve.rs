//! `--serve`: jobs as lines of JSON on standard input, an answer a line on standard output, what is open and warm kept between.
//!
//! A job is what a run with `--frames` does, manifest and bytes included. A job that fails, or is none, is answered and costs
//! itself alone; a lost device, SIGTERM and a reader of the answers that goes away end the process with 75 once the frame at
//! hand is written: jobs without an answer, or with 75 in it, are to be sent again, to another process. The end of standard
//! input ends it with 0 when the jobs that were sent are answered.

use std::io::{BufRead, ErrorKind, Write};
use std::path::Path;
use std::thread;
use std::time::Instant;

use serde::Serialize;
use serde_json::Value;

use super::progress::{JobCounts, Progress, ProgressForm, rounded};
use super::talk::Talk;
use super::words;
use super::work::JobWork;
use crate::error::{Error, Result};
use crate::files::{reader, signals};
use crate::job::serve::{self, Refusal, Request, WANTED};

/// An answer.
#[derive(Debug, Serialize)]
struct Answer {
    id: Value,
    ok: bool,
    #[serde(flatten)]
    counts: JobCounts,
    ms: f64,
    /// None where nothing was drawn.
    adapter: Option<String>,
    /// The code with which a run would have ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    exit: Option<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// From here on the process ends when nobody is left to read its answers, for nobody else would end it: at once where none is
/// due, as at the end of standard input, else as a signal ends it.
pub(crate) fn end_unread() {
    let watch = || {
        reader::wait_until_gone();
        // Who was asked already is about to end.
        if !signals::is_asked() {
            signals::ask(0);
        }
    };
    // Where the system has no thread left the next answer tells.
    drop(thread::Builder::new().spawn(watch));
}

/// Answers `requests` by `answers`: `make` does what is asked of `work`, which holds all that can be.
///
/// # Errors
/// What ends the process: [`Error::DeviceLost`], [`Error::Ended`]; [`Error::Input`] where requests cannot be read,
/// [`Error::Output`] where no job can write its files, or the answers cannot be written.
pub fn run(
    work: &JobWork,
    talk: &Talk,
    mut requests: impl BufRead,
    mut answers: impl Write,
    mut make: impl FnMut(&JobWork, &Progress, &Talk) -> Result<()>,
) -> Result<()> {
    work.prepare()?;
    talk.say(&format!("jobs are awaited on standard input, a line each: {WANTED}"))?;
    let talk = talk.hushed();
    while let Some(request) = serve::next(&mut requests).map_err(unreadable)? {
        let began = Instant::now();
        let (answer, done) = match request {
            Ok(Request { id, frames }) => {
                let progress = Progress::start(&talk, ProgressForm::None, frames.numbers().len());
                let done = work.part(&frames).and_then(|part| make(&part, &progress, &talk));
                (Answer::of(id, &progress, began, done.as_ref().err()), done)
            }
            Err(refusal) => (Answer::refusing(refusal), Ok(())),
        };
        answer.write(&mut answers)?;
        done.or_else(|error| if words::exit_code(&error) == words::TRY_AGAIN { Err(error) } else { Ok(()) })?;
        if signals::is_asked() {
            let what = "asked to end, all jobs that were begun are done";
            return Err(Error::Ended { what: what.into(), remedy: "send others to another process".into() });
        }
    }
    Ok(())
}

impl Answer {
    /// What became of a job that began then.
    fn of(id: Value, progress: &Progress, began: Instant, error: Option<&Error>) -> Self {
        Self {
            id,
            ok: error.is_none(),
            counts: progress.counts(),
            ms: rounded(began.elapsed().as_secs_f64() * 1e3),
            adapter: progress.adapter(),
            exit: error.map(words::exit_code),
            error: error.map(words::line),
        }
    }

    /// That a line is no job.
    fn refusing(Refusal { id, why }: Refusal) -> Self {
        let (counts, exit) = (JobCounts::default(), Some(words::USAGE));
        Self { id, ok: false, counts, ms: 0.0, adapter: None, exit, error: Some(why) }
    }

    /// Writes it as one line, at once.
    fn write(&self, out: &mut impl Write) -> Result<()> {
        let mut line = serde_json::to_string(self).map_err(|error| Error::mistake(error.to_string()))?;
        line.push('\n');
        out.write_all(line.as_bytes()).and_then(|()| out.flush()).map_err(|why| match why.kind() {
            ErrorKind::BrokenPipe => unread(),
            _ => Error::output(Path::new("standard output"), &why),
        })
    }
}

/// Nobody is left to read answers.
fn unread() -> Error {
    let remedy = "what was drawn is there: send the jobs that have no answer to another process".into();
    Error::Ended { what: "nobody reads the answers on standard output any more".into(), remedy }
}

fn unreadable(why: std::io::Error) -> Error {
    Error::input(
        Path::new("standard input"),
        format!("it cannot be read ({why})"),
        "send jobs through a pipe, or a file",
    )
}
