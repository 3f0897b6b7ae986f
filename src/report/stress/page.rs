//! The report of cases as a page: one file that needs no network and no script to be read, as that of comparisons.

use serde::Serialize;

use super::Report;
use crate::error::{Error, Result};
use crate::report::html::{data_uri, render};
use crate::report::pictures::Picture;
use crate::stress::figures::{CaseFigures, RunFigures, ViewFigures};
use crate::stress::{Check, Group, Promise};

/// What the template sees.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    headline: String,
    broken: Vec<&'a Check>,
    exceptions: Vec<&'a Check>,
    promises: Vec<Kept<'a>>,
    groups: Vec<GroupOf<'a>>,
    plot: &'a str,
    style: &'static str,
    script: &'static str,
}

/// How well a promise was kept.
#[derive(Serialize)]
struct Kept<'a> {
    promise: Promise,
    says: &'static str,
    checked: usize,
    kept: usize,
    /// The check that came nearest to breaking it, or broke it most.
    nearest: Option<&'a Check>,
}

/// The cases of a group.
#[derive(Serialize)]
struct GroupOf<'a> {
    name: &'static str,
    cases: Vec<CaseOf<'a>>,
}

#[derive(Serialize)]
struct CaseOf<'a> {
    case: &'a CaseFigures,
    views: Vec<ViewOf<'a>>,
}

#[derive(Serialize)]
struct ViewOf<'a> {
    view: &'a ViewFigures,
    picture: String,
    runs: Vec<&'a RunFigures>,
    checks: Vec<&'a Check>,
    kept: usize,
}

/// The page. `plot_svg` is the plot as [`error_time_svg`](super::error_time_svg) made it and goes in as it is.
///
/// # Errors
/// [`Error::Mistake`] where a picture is missing that the figures name, or the template fails.
pub(crate) fn page_html(report: &Report, plot_svg: &str, pictures: &[Picture]) -> Result<String> {
    let outcome = &report.outcome;
    let groups = Group::ALL.map(|group| {
        let of_group = outcome.cases.iter().filter(|case| case.group == group.name());
        let cases = of_group.map(|case| case_of(case, report, pictures)).collect::<Result<Vec<_>>>()?;
        Ok(GroupOf { name: group.name(), cases })
    });
    let groups: Vec<GroupOf> = groups.into_iter().collect::<Result<_>>()?;
    let page = Page {
        headline: headline(report),
        broken: outcome.broken().collect(),
        exceptions: outcome.checks.iter().filter(|check| !check.exception.is_empty()).collect(),
        promises: Promise::ALL.map(|promise| kept(promise, &outcome.checks)).into(),
        groups: groups.into_iter().filter(|group| !group.cases.is_empty()).collect(),
        plot: plot_svg,
        style: include_str!("../report.css"),
        script: include_str!("../report.js"),
        report,
    };
    render("stress.html", include_str!("page.html"), &page)
}

/// The whole run in a sentence.
fn headline(report: &Report) -> String {
    let Report { kept, broken, outcome, .. } = report;
    let cases = outcome.cases.len();
    let cases = format!("{cases} {}", if cases == 1 { "case" } else { "cases" });
    match broken {
        0 => format!("All {kept} promises of {cases} are kept."),
        _ => format!("{broken} of {} promises of {cases} are broken.", kept + broken),
    }
}

fn kept(promise: Promise, checks: &[Check]) -> Kept<'_> {
    let of_it: Vec<&Check> = checks.iter().filter(|check| check.promise == promise).collect();
    let (_, at_least) = promise.limit();
    // Those with an exception stand by themselves.
    let plain = of_it.iter().copied().filter(|check| check.exception.is_empty());
    let nearest =
        plain.reduce(|a, b| if (b.measured > a.measured) != at_least && b.measured != a.measured { b } else { a });
    Kept {
        promise,
        says: promise.says(),
        checked: of_it.len(),
        kept: of_it.iter().filter(|check| check.kept).count(),
        nearest,
    }
}

fn case_of<'a>(case: &'a CaseFigures, report: &'a Report, pictures: &[Picture]) -> Result<CaseOf<'a>> {
    let outcome = &report.outcome;
    let view_of = |view: &'a ViewFigures| {
        let picture = pictures.iter().find(|picture| picture.name == view.picture);
        let picture = picture.ok_or_else(|| Error::no_report(format_args!("there is no picture {}", view.picture)))?;
        let is_of = |c: &str, v: &str| c == case.name && v == view.name;
        let checks: Vec<&Check> = outcome.checks.iter().filter(|check| is_of(check.case, check.view)).collect();
        Ok(ViewOf {
            view,
            picture: data_uri(picture),
            runs: outcome.runs.iter().filter(|run| is_of(run.case, run.view)).collect(),
            kept: checks.iter().filter(|check| check.kept).count(),
            checks,
        })
    };
    Ok(CaseOf { case, views: case.views.iter().map(view_of).collect::<Result<_>>()? })
}
