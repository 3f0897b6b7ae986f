//! What the program says to its user: lines, warnings, errors, progress.
//!
//! | | goes to | `-q` | a pipe |
//! |---|---|---|---|
//! | answer (what was asked for) | standard output | said | said |
//! | line, detail (`-v` only) | standard output; standard error where standard output holds a file | silent | said |
//! | warning | standard error | silent | said, without colour |
//! | progress | standard error, after a second | silent | silent |
//! | error | standard error | said | said, without colour |
//!
//! Colours are those clap gives its own errors, shown by its own rule: on a terminal, unless `NO_COLOR` is set.
//! Does not handle: a standard error that cannot be written, since there is nowhere left to say so.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use clap::builder::Styles;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::words;
use crate::error::{Error, Result, plain};
use crate::files::Output;

/// Work that lasts no longer shows no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often the clock beside a bar is drawn anew.
const TICK: Duration = Duration::from_millis(200);
/// Steps of a bar.
const STEPS: f64 = 1000.0;
/// What a bar looks like.
const BAR: &str = "{msg:24} [{bar:30}] {elapsed}";
/// Colours of clap's errors.
const STYLES: Styles = Styles::styled();

/// Flags of every subcommand.
#[derive(Debug, clap::Args)]
pub struct TalkArguments {
    /// Say nothing but errors and what was asked for
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say more: driver, what was left out, times that were taken
    #[arg(short, long, global = true)]
    verbose: bool,
}

/// How much is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Loudness {
    Quiet,
    /// Warnings alone.
    Hushed,
    Normal,
    Verbose,
}

/// Where lines go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinesTo {
    /// To standard output.
    Stdout,
    /// To standard error: standard output holds a file.
    Stderr,
}

/// What is said, how loud and where; one for the whole run of the program.
#[derive(Debug)]
pub struct Talk {
    loudness: Loudness,
    lines: LinesTo,
    began: Instant,
    bar: Mutex<Option<ProgressBar>>,
}

impl Talk {
    /// As loud as the flags ask.
    pub fn new(arguments: &TalkArguments, lines: LinesTo) -> Self {
        // clap sees a conflict of the two only where they stand together: in `-q draw -v` the quiet one wins.
        let loudness = match arguments {
            TalkArguments { quiet: true, .. } => Loudness::Quiet,
            TalkArguments { verbose: true, .. } => Loudness::Verbose,
            _ => Loudness::Normal,
        };
        Self { loudness, lines, began: Instant::now(), bar: Mutex::new(None) }
    }

    /// The same for one of many pieces of work, of which warnings alone are said unless more is wanted.
    pub fn hushed(&self) -> Self {
        let loudness = if self.loudness == Loudness::Normal { Loudness::Hushed } else { self.loudness };
        Self { loudness, lines: self.lines, began: self.began, bar: Mutex::default() }
    }

    /// Whether details are said: they need not be gathered otherwise.
    pub fn is_verbose(&self) -> bool {
        self.loudness == Loudness::Verbose
    }

    /// Prints what was asked for.
    ///
    /// # Errors
    /// [`Error::Output`] when standard output takes no more; a reader that has gone away is no error.
    pub fn answer(&self, text: &str) -> Result<()> {
        self.without_bar(|| {
            let mut out = Output::stdout();
            out.write(|bytes| writeln!(bytes, "{text}"))?;
            out.publish()
        })
    }

    /// A line on the work.
    ///
    /// # Errors
    /// As [`Self::answer`].
    pub fn say(&self, line: &str) -> Result<()> {
        match self.lines {
            _ if self.loudness <= Loudness::Hushed => Ok(()),
            LinesTo::Stdout => self.answer(&plain(line.to_owned())),
            LinesTo::Stderr => {
                self.aside(&plain(line.to_owned()));
                Ok(())
            }
        }
    }

    /// A line for those who want to know more.
    ///
    /// # Errors
    /// As [`Self::answer`].
    pub fn detail(&self, line: &str) -> Result<()> {
        if self.is_verbose() { self.say(line) } else { Ok(()) }
    }

    /// Something the user should know; the work goes on.
    pub fn warn(&self, line: &str) {
        if self.loudness > Loudness::Quiet {
            let yellow = STYLES.get_invalid().bold();
            self.aside(&format!("{yellow}warning:{yellow:#} {}", plain(line.to_owned())));
        }
    }

    /// Why the work ended; with `-q` too.
    pub fn error(&self, error: &Error) {
        self.finish_bar();
        let red = STYLES.get_error();
        self.aside(&format!("{red}error:{red:#} {}", plain(words::line(error))));
    }

    /// How far a stage of the work has come, from 0 to 1, which ends it. A bar appears on a terminal once the work has
    /// lasted over a second.
    pub fn progress(&self, stage: &str, share: f64) {
        if self.loudness <= Loudness::Hushed || !stderr().is_terminal() {
            return;
        }
        if share >= 1.0 {
            return self.finish_bar();
        }
        let mut bar = self.bar.lock().unwrap_or_else(PoisonError::into_inner);
        let bar = bar.get_or_insert_with(|| bar_after(PATIENCE.saturating_sub(self.began.elapsed())));
        if bar.is_hidden() && self.began.elapsed() >= PATIENCE {
            show(bar);
        }
        bar.set_message(stage.to_owned());
        bar.set_position((share * STEPS) as u64);
    }

    fn finish_bar(&self) {
        if let Some(bar) = self.bar.lock().unwrap_or_else(PoisonError::into_inner).take() {
            bar.finish_and_clear();
        }
    }

    /// Does it with the bar off the terminal.
    fn without_bar<T>(&self, say: impl FnOnce() -> T) -> T {
        match &*self.bar.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(bar) => bar.suspend(say),
            None => say(),
        }
    }

    /// A line to standard error, with its colours where they can be shown.
    fn aside(&self, line: &str) {
        self.without_bar(|| drop(writeln!(anstream::stderr(), "{line}")));
    }
}

/// A bar that shows itself after a while, also when the work is too busy to report meanwhile.
fn bar_after(wait: Duration) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(STEPS as u64), ProgressDrawTarget::hidden());
    if let Ok(style) = ProgressStyle::with_template(BAR) {
        bar.set_style(style.progress_chars("=> "));
    }
    let waiting = bar.clone();
    // Where the system has no thread left there is no bar.
    let _ = thread::Builder::new().spawn(move || {
        thread::sleep(wait);
        show(&waiting);
    });
    bar
}

/// Draws a bar from now on, unless it is finished.
fn show(bar: &ProgressBar) {
    if !bar.is_finished() {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        bar.enable_steady_tick(TICK);
    }
}
