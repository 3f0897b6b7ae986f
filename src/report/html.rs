//! The report as a page: one file that needs no network and no script to be read.
//!
//! `report.html` is the template, `report.css` and `report.js` go into it whole. Every text of the results is escaped
//! by the template engine; pictures become data URIs, each written once (the script takes them from where they stand).
//! A content security policy in the page forbids it to fetch anything.
//!
//! Does not handle: comparisons whose pictures do not fit in memory together.

use std::collections::BTreeMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, HtmlEscape, UndefinedBehavior, Value};
use serde::Serialize;

use super::pictures::Picture;
use super::words::{Words, milliseconds, words};
use super::{Results, merge};
use crate::error::{Error, Result};
use crate::measure::figures::{PassFigures, Run};

/// What the template sees.
#[derive(Serialize)]
struct ReportPage<'a> {
    results: &'a Results,
    words: Words,
    runs: Vec<Row<'a>>,
    /// Passes of all runs in the order of a frame.
    pass_names: Vec<&'static str>,
    /// Data URIs by file name.
    pictures: BTreeMap<&'a str, String>,
    /// The commands that draw scenes, by their names.
    commands: BTreeMap<&'a str, &'a str>,
    plot: &'a str,
    style: &'static str,
    script: &'static str,
}

/// A run with what the page says beside it.
#[derive(Serialize)]
struct Row<'a> {
    #[serde(flatten)]
    run: &'a Run,
    front: bool,
    /// The first run of its scene that has the best F.
    best: bool,
    /// Fragments of the scene's truth.
    truth_fragments: Option<f64>,
    /// Share of short chains of the scene's truth.
    truth_short_chains: Option<f64>,
    /// In the order of [`ReportPage::pass_names`].
    of_passes: Vec<Option<&'a PassFigures>>,
}

/// The page. `plot_svg` is the plot as [`error_time_svg`](super::error_time_svg) made it and goes in as it is.
///
/// # Errors
/// [`Error::Mistake`] where a picture is missing that the results name, or the template fails.
pub fn report_html(results: &Results, plot_svg: &str, pictures: &[Picture]) -> Result<String> {
    let pass_names = merge(results.runs.iter().map(|run| run.passes.iter().map(|pass| pass.name).collect()));
    let page = ReportPage {
        runs: results.runs.iter().map(|run| row(run, results, &pass_names)).collect(),
        words: words(results),
        pictures: data_uris(results, pictures)?,
        commands: results.scenes.iter().map(|scene| (scene.name.as_str(), scene.command.as_str())).collect(),
        plot: plot_svg,
        style: include_str!("report.css"),
        script: include_str!("report.js"),
        results,
        pass_names,
    };
    render("report.html", include_str!("report.html"), &page)
}

/// A page from a template, in which every text is escaped.
///
/// # Errors
/// [`Error::Mistake`] where the template fails.
pub(super) fn render(name: &str, template: &str, page: &impl Serialize) -> Result<String> {
    let page = try_render(name, template, page);
    page.map_err(|e| Error::no_report(format_args!("the page: {e:#}")))
}

fn try_render(name: &str, template: &str, page: &impl Serialize) -> std::result::Result<String, minijinja::Error> {
    let mut engine = Environment::new();
    engine.set_auto_escape_callback(|_| AutoEscape::Html);
    // A key that is not there is a mistake in the template, never an empty place on the page.
    engine.set_undefined_behavior(UndefinedBehavior::Strict);
    engine.set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build()?);
    engine.add_filter("fixed", fixed);
    engine.add_filter("figure", figure);
    engine.add_filter("plain", |value: f64| value.to_string());
    engine.add_filter("count", count);
    engine.add_filter("ms", |ms: f64| milliseconds(ms));
    engine.add_filter("cell", |v: Option<f64>, digits: usize| cell(v, |v| fixed(v, digits)));
    engine.add_filter("count_cell", |v: Option<f64>| cell(v, |v| count(v as u64)));
    engine.add_filter("level_cell", level_cell);
    engine.add_filter("ms_cell", |v: Option<f64>| cell(v, milliseconds));
    engine.render_named_str(name, template, Serde(page))
}

/// The pictures the results name, ready to stand in a `src`.
fn data_uris<'a>(results: &'a Results, pictures: &[Picture]) -> Result<BTreeMap<&'a str, String>> {
    let of_runs = results.runs.iter().flat_map(|run| [&run.mask, &run.difference]);
    let names = results.scenes.iter().map(|scene| &scene.picture).chain(of_runs);
    let data_uri = |name: &'a String| {
        let picture = pictures.iter().find(|picture| picture.name == *name);
        let picture = picture.ok_or_else(|| Error::no_report(format_args!("there is no picture {name}")))?;
        Ok((name.as_str(), self::data_uri(picture)))
    };
    names.map(data_uri).collect()
}

/// A picture, ready to stand in a `src`.
pub(super) fn data_uri(picture: &Picture) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(&picture.png))
}

fn row<'a>(run: &'a Run, results: &'a Results, pass_names: &[&str]) -> Row<'a> {
    let of_scene = || results.runs.iter().filter(|other| other.scene == run.scene);
    let best = of_scene().reduce(|a, b| if b.f > a.f { b } else { a });
    let scene = results.scenes.iter().find(|scene| scene.name == run.scene);
    let figures = |name: &&str| run.passes.iter().find(|pass| pass.name == *name);
    Row {
        run,
        front: run.pareto,
        best: best.is_some_and(|best| std::ptr::eq(best, run)),
        truth_fragments: scene.map(|scene| scene.truth.fragments),
        truth_short_chains: scene.map(|scene| scene.truth.short_chains),
        of_passes: pass_names.iter().map(figures).collect(),
    }
}

/// So many digits behind the point, and a minus as long as a plus.
fn fixed(value: f64, digits: usize) -> String {
    format!("{value:.digits$}").replace('-', "\u{2212}")
}

/// A figure with as many digits as tell something: whole, or four of those that count.
fn figure(value: f64) -> String {
    match value.abs() {
        _ if value.fract() == 0.0 => fixed(value, 0),
        small if small < 1e-4 => format!("{value:.2e}").replace('-', "\u{2212}"),
        small if small < 0.1 => fixed(value, 6),
        _ => fixed(value, 4),
    }
}

/// A whole number in groups of three digits.
fn count(value: u64) -> String {
    let digits = value.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    // Narrow spaces that do not break.
    groups.join("\u{202f}")
}

/// A cell of levels: in their order, `auto` last.
fn level_cell(level: Value) -> Value {
    let sorted = f64::try_from(level.clone()).unwrap_or(f64::MAX);
    cell(Some(sorted), |_| level.to_string())
}

/// A cell of a table: what is read, and the value by which it is sorted.
fn cell(value: Option<f64>, show: impl Fn(f64) -> String) -> Value {
    let (sorted, shown) = value.map_or_else(|| (String::new(), "–".into()), |v| (v.to_string(), show(v)));
    Value::from_safe_string(format!("<td data-v=\"{sorted}\">{}</td>", HtmlEscape(&shown)))
}
