//! The command line, one file a subcommand: flags as typed become options checked.

pub(crate) mod bare;
pub(crate) mod batch;
pub(crate) mod blank;
pub(crate) mod cache;
pub(crate) mod cells;
mod channels;
pub(crate) mod choices;
pub(crate) mod compare;
pub(crate) mod device;
pub(crate) mod draw;
mod draw_report;
pub(crate) mod drawing;
pub(crate) mod film;
pub(crate) mod flat_earth;
pub(crate) mod flight;
pub(crate) mod flight_keys;
mod flight_plan;
pub(crate) mod fly;
pub(crate) mod folds;
pub(crate) mod frames;
pub(crate) mod furniture;
pub(crate) mod generate;
mod georeferenced;
pub(crate) mod info;
pub(crate) mod jobs;
pub(crate) mod journey;
pub(crate) mod land;
pub(crate) mod lines;
pub(crate) mod listing;
pub(crate) mod machine;
pub(crate) mod memory;
pub(crate) mod merge;
pub(crate) mod norths;
pub(crate) mod outputs;
pub(crate) mod page;
mod peaks;
pub(crate) mod pick;
pub(crate) mod plan;
pub(crate) mod progress;
pub(crate) mod reference;
pub(crate) mod scene;
pub(crate) mod serve;
pub(crate) mod stress;
pub(crate) mod style;
pub(crate) mod styles;
pub(crate) mod talk;
pub(crate) mod terrain;
pub(crate) mod threads;
pub(crate) mod values;
pub(crate) mod view_report;
pub(crate) mod viewpoint;
pub(crate) mod views;
pub(crate) mod words;
pub(crate) mod work;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::error::{Error, Result};
use crate::files::signals;
use talk::{LinesTo, Talk, TalkArguments};

/// The end of `hachure --help`.
const EXAMPLES: &str = "\
Examples:
  hachure info dem/golden-gate.tif
  hachure draw dem/golden-gate.tif -o golden-gate.png
  hachure compare dem/golden-gate.tif -o report

`hachure draw --help` has more.";

/// Pen-and-ink landscapes from digital elevation models.
#[derive(Debug, Parser)]
#[command(name = "hachure", version, about, max_term_width = 100, after_help = EXAMPLES, after_long_help = reference::of(&[reference::ALL, EXAMPLES]))]
pub struct Arguments {
    #[command(flatten)]
    talk: TalkArguments,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw a DEM as seen from an eye
    Draw(Box<draw::DrawArguments>),
    /// Draw the frames of a flight along a path
    Fly(Box<fly::FlyArguments>),
    /// Make many drawings, as a file lists them
    Batch(Box<batch::BatchArguments>),
    /// Say whether all frames or drawings of a folder are there
    Merge(merge::MergeArguments),
    /// Compare silhouette methods: their errors and their times, as a report
    Compare(Box<compare::CompareArguments>),
    /// Run stiff and extreme cases and say which of their promises hold, as a report
    Stress(Box<stress::StressArguments>),
    /// Say what a pixel shows and which rule drew or left out a line there, or where a place stands on the page
    Pick(Box<pick::PickArguments>),
    /// List, clear or make what is kept for later runs
    Cache(Box<cache::CacheCommand>),
    /// List the looks of a drawing, print one, or the schema of their files
    Styles(styles::StylesArguments),
    /// Say what a DEM holds
    Info(info::InfoArguments),
    /// Make completions, man pages, and terrain to test with
    #[command(hide = true)]
    Generate(generate::GenerateArguments),
}

impl Arguments {
    /// How the program talks to its user, as asked.
    pub fn talk(&self) -> Talk {
        let lines = match &self.command {
            Command::Draw(arguments) if arguments.fill_stdout() => LinesTo::Stderr,
            Command::Batch(arguments) if arguments.jobs().fills_stdout() => LinesTo::Stderr,
            Command::Fly(arguments) if arguments.jobs().fills_stdout() => LinesTo::Stderr,
            // Standard output holds the answer alone.
            Command::Pick(_) => LinesTo::Stderr,
            _ => LinesTo::Stdout,
        };
        Talk::new(&self.talk, lines)
    }

    /// Does what was asked, and says why not where it cannot be done.
    pub fn run_to_end(&self, talk: &Talk) -> ExitCode {
        let Err(error) = self.run(talk) else { return ExitCode::SUCCESS };
        talk.error(&error);
        let code = words::exit_code(&error);
        if let Error::DeviceLost { .. } = error {
            // The driver may be at work for ever, and would be waited for.
            signals::end_now(code.into());
        }
        ExitCode::from(code)
    }

    /// Does what was asked.
    ///
    /// # Errors
    /// Whatever went wrong; [`words::exit_code`] says with which code the program ends then.
    pub fn run(&self, talk: &Talk) -> Result<()> {
        match &self.command {
            Command::Draw(arguments) => draw::run(arguments, talk),
            Command::Batch(arguments) => arguments.jobs().progress.told(batch::run(arguments, talk)),
            Command::Merge(arguments) => merge::run(arguments, talk),
            Command::Compare(arguments) => compare::run(arguments, talk),
            Command::Stress(arguments) => stress::run(arguments, talk),
            Command::Pick(arguments) => pick::run(arguments, talk),
            Command::Cache(arguments) => cache::run(arguments, talk),
            Command::Styles(arguments) => styles::run(arguments, talk),
            Command::Info(arguments) => info::run(arguments, talk),
            Command::Fly(arguments) => arguments.jobs().progress.told(fly::run(arguments, talk)),
            Command::Generate(arguments) => generate::run(arguments, talk),
        }
    }
}
