//! Error against time as SVG: 1 - F upwards, the time of a frame to the right, both logarithmic; a panel a scene.
//!
//! Each method is a curve through its levels with a marker, a dash and a colour of its own, and its name beside it, so
//! that it reads without colour. Rings and the grey steps below them mark the Pareto front. The page is white whatever
//! lies behind it. The same results give the same bytes.
//!
//! Does not handle: fonts (texts are in the reader's serif face, their widths are estimates), and panels so crowded
//! that a label finds no place, which is left out then.

use plotters::prelude::*;

use super::Results;
use super::chart::{
    Area, Drawn, INK, MARKER, RING, axes, draw_curve, draw_label, error_axis, error_of, label_page, millis, place,
    plot, rgb, segments, time_axis, whole,
};
use super::labels::{self, Choice, Obstacles, Rect};
use super::results::ComparedScene;
use crate::error::{Error, Result};
use crate::measure::figures::Run;
use crate::plan::Method;
use crate::plan::registry::PlotLook;

const TITLE: &str = "Error against time";
/// The lines below all panels.
const FOOTNOTE: [&str; 2] = [
    "Numbers beside points are levels, the subdivisions of a cell's edge. Ringed points lie on the Pareto front, which",
    "the grey steps join: no run of the scene is both faster and better. F and 1 − F are taken within 1 px of truth.",
];

const FRONT: RGBColor = RGBColor(190, 190, 190);

/// The plot of all scenes as a file of its own, which may also stand inside a page.
///
/// 1 - F of 0.0001 or less is drawn there, and the axis says so.
///
/// # Errors
/// [`Error::Mistake`] where a method is not in the registry, or the plotting library gives up.
pub fn error_time_svg(results: &Results) -> Result<String> {
    let panels = results.scenes.iter().map(|scene| Panel::of(scene, results)).collect::<Result<Vec<_>>>()?;
    plot(TITLE, &description(results), &FOOTNOTE, &panels, draw_panel)
}

/// What a panel shows.
struct Panel<'a> {
    scene: &'a ComparedScene,
    runs: Vec<&'a Run>,
    curves: Vec<Curve<'a>>,
}

/// The runs of a method, by level, and how they look.
struct Curve<'a> {
    runs: Vec<&'a Run>,
    look: PlotLook,
}

impl<'a> Panel<'a> {
    fn of(scene: &'a ComparedScene, results: &'a Results) -> Result<Self> {
        let runs: Vec<&Run> = results.runs.iter().filter(|run| run.scene == scene.name).collect();
        let curve = |runs: Vec<&'a Run>| Ok(Curve { look: look(runs[0].method)?, runs });
        Ok(Self { scene, curves: curves(&runs).into_iter().map(curve).collect::<Result<_>>()?, runs })
    }
}

/// What the plot shows, in words.
fn description(results: &Results) -> String {
    let mut told = "1 minus F, the harmonic mean of precision and recall within a pixel, against the time of a frame. \
                    Both axes are logarithmic; lower is better, left is faster."
        .to_owned();
    for run in &results.runs {
        let Run { scene, method, level, f, frame_ms, .. } = run;
        let front = if run.pareto { ", on the Pareto front" } else { "" };
        told += &format!(" {scene}, {method}, level {level}: F {f:.4} in {frame_ms:.1} ms{front}.");
    }
    told
}

/// The axes of a scene, its curves, and what stands beside them.
fn draw_panel(root: &Area, panel: &Area, shown: &Panel) -> Drawn {
    let Panel { scene, runs, curves } = shown;
    let x = time_axis(runs.iter().map(|run| millis(run.frame_ms)));
    let y = error_axis(runs.iter().map(|run| error_of(run.f)));
    let caption = format!("{}, {} × {} px", shorten(&scene.name, 60), scene.width, scene.height);
    let chart = axes(panel, &caption, &x, &y)?;
    let place = |run: &Run| place(&chart, [millis(run.frame_ms), error_of(run.f)]);
    let front = front(runs, &place);
    root.draw(&PathElement::new(front.iter().map(|at| whole(*at)).collect::<Vec<_>>(), FRONT.stroke_width(5)))?;
    let mut page = label_page(&chart, segments(&front));
    for Curve { runs, look } in curves {
        let points: Vec<[f64; 2]> = runs.iter().map(|run| place(run)).collect();
        draw_curve(root, &points, look)?;
        page.lines.extend(segments(&points));
        let reach = |run: &&Run| if run.pareto { RING + 1.0 } else { MARKER };
        page.taken.extend(runs.iter().zip(&points).map(|(run, point)| Rect::around(*point, reach(run))));
    }
    for run in runs.iter().filter(|run| run.pareto) {
        root.draw(&Circle::new(whole(place(run)), RING as i32, INK))?;
    }
    draw_labels(root, curves, page, &place)
}

/// The runs of each method, by level.
fn curves<'a>(runs: &[&'a Run]) -> Vec<Vec<&'a Run>> {
    let mut curves: Vec<Vec<&Run>> = Vec::new();
    for run in runs {
        match curves.iter_mut().find(|curve| curve[0].method == run.method) {
            Some(curve) => curve.push(run),
            None => curves.push(vec![run]),
        }
    }
    curves.iter_mut().for_each(|curve| curve.sort_by_key(|run| run.level));
    curves
}

/// Steps from each run of the front to the next slower one: what can be had in a time.
fn front(runs: &[&Run], place: &impl Fn(&Run) -> [f64; 2]) -> Vec<[f64; 2]> {
    let mut front: Vec<[f64; 2]> = runs.iter().filter(|run| run.pareto).map(|run| place(run)).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
    front.windows(2).flat_map(|two| [two[0], [two[1][0], two[0][1]], two[1]]).collect()
}

/// The method's name beside one point of its curve, levels beside the others.
fn draw_labels(root: &Area, curves: &[Curve], mut page: Obstacles, place: &impl Fn(&Run) -> [f64; 2]) -> Drawn {
    let choice = |run: &Run, text: String| Choice { point: place(run), text };
    let named = |run: &&Run| choice(run, format!("{}, level {}", run.method, run.level));
    // Names are wide: they choose first, and beside which point.
    let names: Vec<Vec<Choice>> = curves.iter().map(|curve| curve.runs.iter().map(named).collect()).collect();
    let names = labels::place(&names, &mut page);
    for (curve, name) in curves.iter().zip(names) {
        let told = name.as_ref().map(|name| name.choice.point);
        let others = curve.runs.iter().filter(|run| Some(place(run)) != told);
        let levels: Vec<_> = others.map(|run| vec![choice(run, run.level.to_string())]).collect();
        let levels = labels::place(&levels, &mut page);
        name.iter()
            .chain(levels.iter().flatten())
            .try_for_each(|label| draw_label(root, label, rgb(curve.look.colour)))?;
    }
    Ok(())
}

/// At most so many letters: a caption stays on its panel.
fn shorten(text: &str, letters: usize) -> String {
    match text.char_indices().nth(letters) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// How the curve of a method looks.
fn look(method: &str) -> Result<PlotLook> {
    let none = || Error::mistake(format!("no method is called {method}"));
    Ok(Method::named(method).ok_or_else(none)?.entry().look)
}
