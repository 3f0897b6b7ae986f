//! The command line, one file a subcommand: flags as typed become options checked.

pub mod bare;
pub mod batch;
pub mod blank;
pub mod cache;
pub mod cells;
mod channels;
pub mod choices;
pub mod compare;
pub mod device;
pub mod draw;
mod draw_report;
pub mod drawing;
pub mod film;
pub mod flat_earth;
pub mod flight;
mod flight_keys;
mod flight_plan;
pub mod fly;
pub mod frames;
pub mod generate;
mod georeferenced;
pub mod info;
pub mod jobs;
pub mod journey;
pub mod land;
pub mod lines;
pub mod listing;
pub mod memory;
pub mod merge;
pub mod norths;
pub mod outputs;
pub mod page;
mod peaks;
pub mod pick;
pub mod plan;
pub mod progress;
pub mod reference;
pub mod scene;
pub mod serve;
pub mod style;
pub mod styles;
pub mod talk;
pub mod terrain;
pub mod threads;
pub mod values;
pub mod view_report;
pub mod viewpoint;
pub mod views;
pub mod words;
pub mod work;

use clap::{Parser, Subcommand};

use crate::error::Result;
use talk::{Lines, Talk, TalkArguments};

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
            Command::Draw(arguments) if arguments.fill_stdout() => Lines::Stderr,
            Command::Batch(arguments) if arguments.jobs().fills_stdout() => Lines::Stderr,
            Command::Fly(arguments) if arguments.jobs().fills_stdout() => Lines::Stderr,
            // Standard output holds the answer alone.
            Command::Pick(_) => Lines::Stderr,
            _ => Lines::Stdout,
        };
        Talk::new(&self.talk, lines)
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
            Command::Pick(arguments) => pick::run(arguments, talk),
            Command::Cache(arguments) => cache::run(arguments, talk),
            Command::Styles(arguments) => styles::run(arguments, talk),
            Command::Info(arguments) => info::run(arguments, talk),
            Command::Fly(arguments) => arguments.jobs().progress.told(fly::run(arguments, talk)),
            Command::Generate(arguments) => generate::run(arguments, talk),
        }
    }
}
