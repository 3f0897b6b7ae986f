//! Error against time of all cases: a panel for the walk and one for the contour, a point a view, ordinary land ringed beside the
//! others. What stiffness costs is how far a point lies from those.
//!
//! Views of which no F is promised have no point, for want of 200 px of true line or of a truth that can be trusted; the note below
//! says how many there are.

use plotters::prelude::*;

use crate::error::Result;
use crate::plan::registry::{Marker, PlotLook};
use crate::report::chart::{
    Area, Drawn, FLOOR, INK, MARKER, RING, axes, draw_label, draw_marker, error_axis, error_of, label_page, millis,
    place, plot, rgb, time_axis, whole, write,
};
use crate::report::labels::{self, Choice, Rect};
use crate::stress::figures::RunFigures;
use crate::stress::limits::{F, LEAST_TRUTH_PX};
use crate::stress::{Check, Group, Outcome, Promise};

const TITLE: &str = "Error against time, ordinary land and hard cases";
/// How many of the worst points have their names beside them.
const NAMED: usize = 8;
/// Methods with a panel.
const METHODS: [&str; 2] = ["walk", "contour"];

/// How points of a group look.
fn look(group: &str) -> PlotLook {
    let (colour, marker) = match group {
        "stiff" => ([184, 58, 0], Marker::Diamond),
        "views" => ([0, 90, 200], Marker::Square),
        "scales" => ([0, 110, 95], Marker::Triangle),
        "sizes" => ([130, 40, 130], Marker::Plus),
        "data" => ([110, 90, 20], Marker::Cross),
        _ => ([26, 26, 26], Marker::Disc),
    };
    PlotLook { colour, dash: None, marker }
}

/// The points of a method.
struct Panel<'a> {
    method: &'static str,
    runs: Vec<&'a RunFigures>,
}

/// The plot as a file of its own, which may also stand inside a page.
///
/// # Errors
/// [`Error::Mistake`](crate::error::Error::Mistake) where the plotting library gives up.
pub(crate) fn error_time_svg(outcome: &Outcome) -> Result<String> {
    // Where nothing is promised of F, truth is no measure.
    let promised = |run: &RunFigures, check: &Check| {
        let of_run = (check.case, check.view, check.method) == (run.case, run.view, run.method);
        of_run && check.promise == Promise::Accurate
    };
    let has_point = |run: &&RunFigures| outcome.checks.iter().any(|check| promised(run, check));
    let panels = METHODS.map(|method| {
        let of_method = outcome.runs.iter().filter(|run| run.method == method);
        Panel { method, runs: of_method.filter(has_point).collect() }
    });
    let views = outcome.runs.iter().filter(|run| run.method == METHODS[0]).count();
    let without = views - panels[0].runs.len();
    let foot = [
        format!(
            "A point is a view. Ringed: ordinary land. {without} of {views} views promise no F or have less than {LEAST_TRUTH_PX} px of true line."
        ),
        format!(
            "F and 1 − F are taken within 1 px of truth; {F} is promised. Times are those of warm frames, medians of three."
        ),
    ];
    plot(TITLE, &description(&panels), &foot.each_ref().map(String::as_str), &panels, draw_panel)
}

/// What the plot shows, in words.
fn description(panels: &[Panel]) -> String {
    let mut told =
        "1 minus F against the time of a frame, both axes logarithmic; lower is better, left is faster.".to_owned();
    for run in panels.iter().flat_map(|panel| &panel.runs) {
        let f = run.f.unwrap_or_default();
        told += &format!(" {}, {}, {}: F {f:.4} in {:.1} ms.", run.case, run.view, run.method, run.frame_ms);
    }
    told
}

fn draw_panel(root: &Area, panel: &Area, shown: &Panel) -> Drawn {
    let Panel { method, runs } = shown;
    let x = time_axis(runs.iter().map(|run| millis(run.frame_ms)));
    let errors = runs.iter().map(|run| error(run)).chain([1.0 - F]);
    let y = error_axis(errors);
    let chart = axes(panel, method, &x, &y)?;
    let promised = [x.from, x.to].map(|at| whole(place(&chart, [at, 1.0 - F])));
    root.draw(&PathElement::new(promised.to_vec(), RGBColor(190, 190, 190).stroke_width(2)))?;
    let at = |run: &RunFigures| place(&chart, [millis(run.frame_ms), error(run)]);
    let mut page = label_page(&chart, Vec::new());
    for run in runs {
        draw_marker(root, whole(at(run)), &look(run.group))?;
        if run.group == Group::Ordinary.name() {
            root.draw(&Circle::new(whole(at(run)), RING as i32, INK))?;
        }
        page.taken.push(Rect::around(at(run), MARKER));
    }
    let mut named: Vec<&&RunFigures> = runs.iter().collect();
    named.sort_by(|a, b| error(b).total_cmp(&error(a)));
    let worst = named.iter().take(NAMED).filter(|run| error(run) > FLOOR);
    let slowest = runs.iter().max_by(|a, b| a.frame_ms.total_cmp(&b.frame_ms));
    let mut labelled: Vec<&RunFigures> = worst.map(|run| **run).collect();
    labelled.extend(slowest.copied().filter(|run| !labelled.iter().any(|other| std::ptr::eq(*other, *run))));
    let choice = |run: &&RunFigures| vec![Choice { point: at(run), text: format!("{}, {}", run.case, run.view) }];
    let choices: Vec<_> = labelled.iter().map(choice).collect();
    let placed = labels::place(&choices, &mut page);
    for (run, label) in labelled.iter().zip(placed) {
        label.iter().try_for_each(|label| draw_label(root, label, rgb(look(run.group).colour)))?;
    }
    legend(root, panel)
}

/// What markers stand for, in a row above the axes.
fn legend(root: &Area, panel: &Area) -> Drawn {
    let (across, down) = panel.get_pixel_range();
    let mut x = f64::from(across.end) - 450.0;
    let y = f64::from(down.start) + 18.0;
    for group in Group::ALL.map(Group::name) {
        let look = look(group);
        draw_marker(root, whole([x, y]), &look)?;
        write(root, group, [x + 10.0, y - 8.0], 13.0, rgb(look.colour))?;
        x += 74.0;
    }
    Ok(())
}

fn error(run: &RunFigures) -> f64 {
    error_of(run.f.unwrap_or_default())
}
