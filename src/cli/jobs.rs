//! Flags of every subcommand that makes many drawings: which of them, and how their progress is shown.

use std::env;

use super::choices;
use super::progress::ProgressForm;
use crate::error::{Error, Result, Setting};
use crate::job::{Frames, Shard};
use crate::message;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Jobs")]
pub(crate) struct JobArguments {
    /// Make these alone, counted from 0: numbers and ranges, every fifth with :5
    #[arg(long, value_name = "3,5-10,0-99:5", value_parser = |text: &str| text.parse::<Frames>())]
    frames: Option<Frames>,
    /// Make one of n shares alone, i from 0 on; a share is a run of frames
    #[arg(long, value_name = "i/n", value_parser = |text: &str| text.parse::<Shard>(), conflicts_with = "shard_from_env")]
    shard: Option<Shard>,
    /// Make the share that the environment names: of a job array of Slurm or AWS Batch, of an indexed job of Kubernetes
    /// (which does not say how many there are: set HACHURE_SHARDS)
    #[arg(long)]
    shard_from_env: bool,
    /// List the jobs as lines of JSON, with the samples that they read at most, and the seconds, memory and device memory they
    /// may take; make nothing
    #[arg(long)]
    pub list: bool,
    /// Stay, take jobs from standard input, a line of JSON each: {"id": 7, "frames": "3,5-10"}, and answer each with a line on
    /// standard output, which repeats the id; the end of standard input ends it
    #[arg(long, conflicts_with_all = ["frames", "shard", "shard_from_env", "list", "progress"])]
    pub serve: bool,
    /// How progress is shown: a bar on a terminal, lines for programs on standard output, or none
    #[arg(long, value_parser = choices::progress(), default_value = choices::default_progress())]
    pub progress: ProgressForm,
}

/// Which jobs a process has to do.
#[derive(Debug, Clone)]
pub struct JobShare {
    /// The jobs of which it has a share, where those are not all.
    pub part: Option<Frames>,
    /// Which share.
    pub shard: Shard,
    /// Its own.
    pub frames: Frames,
}

impl JobArguments {
    /// Whether standard output holds something else than lines on the work.
    pub(crate) fn fills_stdout(&self) -> bool {
        self.list || self.serve || matches!(self.progress, ProgressForm::Json | ProgressForm::OpenJd)
    }

    /// Which of `count` jobs are to be done; they are called `frames` or `drawings`.
    ///
    /// # Errors
    /// [`Error::Setting`] for jobs beyond the last, and where the environment names no shard.
    pub(crate) fn share(&self, count: u32, called: &str) -> Result<JobShare> {
        let all = self.frames.clone().unwrap_or_else(|| Frames::first(count));
        check(&all, count, called)?;
        let from_env = || {
            Shard::from_env(|name| env::var(name).ok()).map_err(|what| {
                Error::setting(Setting::ShardFromEnv, what, message!["give ", Setting::Shard.with_value()])
            })
        };
        let shard = match self.shard {
            Some(shard) => shard,
            None if self.shard_from_env => from_env()?,
            None => Shard::WHOLE,
        };
        Ok(JobShare { part: self.frames.clone(), shard, frames: shard.of(&all) })
    }
}

/// Whether all these are among the `count` frames or drawings that there are.
///
/// # Errors
/// [`Error::Setting`].
pub(crate) fn check(frames: &Frames, count: u32, called: &str) -> Result<()> {
    frames.last().filter(|last| *last >= count).map_or(Ok(()), |last| {
        let what = format!("there is no {last}; the {count} {called} count from 0 to {}", count.saturating_sub(1));
        Err(Error::setting(Setting::Frames, what, "name those that there are"))
    })
}
