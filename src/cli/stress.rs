//! `hachure stress`: stiff and extreme cases, what they promise, and whether it is kept, as a report.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::device::DeviceArguments;
use super::machine::{command, machine};
use super::reference;
use super::talk::Talk;
use crate::error::{Error, Result, shown};
use crate::files::Taken;
use crate::report::folder::Folder;
use crate::report::stress::{Report, SCHEMA, picture as stress_picture};
use crate::stress::sight::picture_name;
use crate::stress::{self, Case, Outcome};

/// The end of `hachure stress --help`.
const EXAMPLES: &str = "\
Examples:
  hachure stress --list
  hachure stress -o stress
  hachure stress -o stress --only needle";

/// Flags of `hachure stress`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[&reference::stressed(), EXAMPLES]))]
pub(crate) struct StressArguments {
    /// The folder for the report: report.html, results.json, results.csv, error-time.svg, and a picture a view
    #[arg(short, long, value_name = "DIR", required_unless_present = "list")]
    output: Option<PathBuf>,
    /// Run this case alone
    #[arg(long, value_name = "NAME", conflicts_with = "short")]
    only: Option<String>,
    /// Run the short list, in at most 90 s on two cores
    #[arg(long)]
    short: bool,
    /// List cases with what they promise, and run none
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    device: DeviceArguments,
}

impl StressArguments {
    fn cases(&self) -> Result<Vec<Case>> {
        match (&self.only, self.short) {
            (Some(name), _) => Ok(vec![stress::named(name)?]),
            (None, true) => Ok(stress::short()),
            (None, false) => Ok(stress::all()),
        }
    }
}

/// Runs cases, or lists them.
///
/// # Errors
/// [`Error::Incomplete`] where a promise is broken, the report whole; whatever else went wrong, no page stands in the folder
/// then.
pub(crate) fn run(arguments: &StressArguments, talk: &Talk) -> Result<()> {
    let cases = arguments.cases()?;
    let Some(output) = arguments.output.as_ref().filter(|_| !arguments.list) else {
        return talk.answer(&cases.iter().map(Case::line).collect::<Vec<_>>().join("\n"));
    };
    let pictures = cases.iter().flat_map(|case| case.views.iter().map(|view| picture_name(case.name, view.name)));
    let folder = Folder::open(output, pictures, Taken::inputs([]))?;
    let gpu = Arc::new(arguments.device.open_with(wgpu::Features::empty(), talk)?);
    let (start, mut outcome, mut pictures) = (Instant::now(), Outcome::default(), Vec::new());
    for (done, case) in cases.iter().enumerate() {
        let share = done as f64 / cases.len() as f64;
        let found = stress::run(&gpu, case, &|stage| talk.progress(stage, share))?;
        said(&found, talk)?;
        let views = found.cases.iter().flat_map(|case| &case.views);
        pictures.extend(views.map(stress_picture).collect::<Result<Vec<_>>>()?);
        outcome.extend(found);
    }
    talk.progress("writing", 1.0);
    let (page, broken) = (folder.page(), outcome.broken().count());
    let report = Report {
        version: SCHEMA,
        hachure: env!("CARGO_PKG_VERSION"),
        command: command(),
        machine: machine(&gpu),
        seconds: start.elapsed().as_secs_f64(),
        kept: outcome.checks.len() - broken,
        broken,
        outcome,
    };
    folder.publish(&report.contents(&pictures)?, &pictures)?;
    let (promises, seconds) = (report.outcome.checks.len(), report.seconds);
    talk.say(&format!("{} of {promises} promises kept by {} cases in {seconds:.0} s", report.kept, cases.len()))?;
    talk.say(&format!("report: {}", shown(&page)))?;
    verdict(&report.outcome, &page)
}

/// A line a case, and one for each promise it broke.
fn said(found: &Outcome, talk: &Talk) -> Result<()> {
    for case in &found.cases {
        let (kept, all) = (found.checks.iter().filter(|check| check.kept).count(), found.checks.len());
        talk.say(&format!("{}: {kept} of {all} promises kept, {:.1} s", case.name, case.seconds))?;
    }
    found.broken().try_for_each(|check| talk.say(&format!("broken: {}", check.line())))?;
    found.checks.iter().try_for_each(|check| talk.detail(&check.line()))
}

/// An error that names the first promise that was broken.
fn verdict(outcome: &Outcome, page: &Path) -> Result<()> {
    let broken = outcome.broken().count();
    let Some(first) = outcome.broken().next() else { return Ok(()) };
    let more = if broken > 1 { format!(", and {} more", broken - 1) } else { String::new() };
    let what = format!("a promise is broken: {}{more}", first.line());
    Err(Error::incomplete(what, format!("see {}", shown(page))))
}
