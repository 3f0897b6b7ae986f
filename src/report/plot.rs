//! Error against time as SVG: 1 - F upwards, the time of a frame to the right, both logarithmic; a panel a scene.
//!
//! Each method is a curve through its levels with a marker, a dash and a colour of its own, and its name beside it, so
//! that it reads without colour. Rings and the grey steps below them mark the Pareto front. The page is white whatever
//! lies behind it. The same results give the same bytes.
//!
//! Does not handle: fonts (texts are in the reader's serif face, their widths are estimates), and panels so crowded
//! that a label finds no place, which is left out then.

use std::io;

use minijinja::HtmlEscape;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Results;
use super::labels::{self, Choice, Page, Placed, Rect};
use super::results::{Run, Scene};
use crate::error::{Error, Result};

/// Least 1 - F that is told from 0: truth is some thousand pixels long.
const FLOOR: f64 = 1e-4;
/// Least time that is told from 0, ms.
const LEAST_MS: f64 = 1e-3;
/// Width of the plot, px.
const WIDTH: u32 = 960;
/// Height of a panel, px.
const PANEL: u32 = 520;
/// Height of the title, px.
const HEAD: u32 = 44;
/// Height of the note below, px.
const FOOT: u32 = 58;
/// Height of labels, px.
const TEXT_PX: f64 = 13.0;
/// Half the side of the square that a marker takes, px.
const MARKER: f64 = 7.0;
/// Radius of the ring around a marker of the front, px.
const RING: f64 = 9.0;

/// Distance from a label to its point from which on a thin line joins them, px.
const FAR: f64 = 13.0;

const TITLE: &str = "Error against time";
/// The lines below all panels.
const FOOTNOTE: [&str; 2] = [
    "Numbers beside points are levels, the subdivisions of a cell's edge. Ringed points lie on the Pareto front, which",
    "the grey steps join: no run of the scene is both faster and better. F and 1 − F are taken within 1 px of truth.",
];

const INK: RGBColor = RGBColor(26, 26, 26);
const GREY: RGBColor = RGBColor(95, 95, 95);
const FRONT: RGBColor = RGBColor(190, 190, 190);
const GRID: RGBColor = RGBColor(222, 222, 222);
const FAINT: RGBColor = RGBColor(241, 241, 241);

/// What draws in a [`DrawingArea`] can fail with.
type Drawn = std::result::Result<(), DrawingAreaErrorKind<io::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// How a method looks, told apart by each of the three alone.
struct Look {
    colour: RGBColor,
    /// Lengths of dash and gap, px; `None` for a full line.
    dash: Option<[i32; 2]>,
    marker: Marker,
}

enum Marker {
    Disc,
    Square,
    Triangle,
    Diamond,
    Cross,
}

/// The plot of all scenes as a file of its own, which may also stand inside a page.
///
/// 1 - F of 0.0001 or less is drawn there, and the axis says so.
///
/// # Errors
/// [`Error::Report`] where the plotting library gives up.
pub fn error_time_svg(results: &Results) -> Result<String> {
    let mut svg = String::new();
    draw(&mut svg, results).map_err(|e| Error::Report { what: format!("the plot: {e}") })?;
    // The library knows neither of the two elements that tell what is drawn to those who do not see it.
    let (title, told) = (TITLE, HtmlEscape(&description(results)).to_string());
    let (tag, rest) = svg.split_once('\n').unwrap_or((&svg, ""));
    let tag = tag.replacen("<svg", "<svg role=\"img\" aria-labelledby=\"plot-title plot-desc\"", 1);
    Ok(format!("{tag}\n<title id=\"plot-title\">{title}</title>\n<desc id=\"plot-desc\">{told}</desc>\n{rest}"))
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

fn draw(svg: &mut String, results: &Results) -> Drawn {
    let panels = results.scenes.len() as u32;
    let root = SVGBackend::with_string(svg, (WIDTH, HEAD + PANEL * panels + FOOT)).into_drawing_area();
    root.fill(&WHITE)?;
    write(&root, TITLE, [30.0, 10.0], 22.0, INK)?;
    let mut rest = root.split_vertically(HEAD).1;
    for scene in &results.scenes {
        let (panel, below) = rest.split_vertically(PANEL);
        draw_panel(&root, &panel, scene, results)?;
        rest = below;
    }
    let foot = f64::from(HEAD + PANEL * panels);
    for (line, text) in FOOTNOTE.iter().enumerate() {
        write(&root, text, [30.0, foot + 6.0 + 19.0 * line as f64], TEXT_PX, GREY)?;
    }
    root.present()
}

/// The axes of a scene, its curves, and what stands beside them.
fn draw_panel(root: &Area, panel: &Area, scene: &Scene, results: &Results) -> Drawn {
    let runs: Vec<&Run> = results.runs.iter().filter(|run| run.scene == scene.name).collect();
    let x = axis(runs.iter().map(|run| millis(run)), None);
    let y = axis(runs.iter().map(|run| error(run)), Some(FLOOR));
    let caption = format!("{}, {} × {} px", shorten(&scene.name, 60), scene.width, scene.height);
    let mut chart = ChartBuilder::on(panel)
        .margin(8)
        .margin_right(30)
        .caption(caption, font(17.0, INK))
        .x_label_area_size(52)
        .y_label_area_size(88)
        .build_cartesian_2d(
            (x.from..x.to).log_scale().with_key_points(x.bold).with_light_points(x.light),
            (y.from..y.to).log_scale().with_key_points(y.bold).with_light_points(y.light),
        )?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(FAINT)
        .axis_style(GREY)
        .label_style(font(TEXT_PX, INK))
        .axis_desc_style(font(14.0, INK))
        .x_desc("time of a frame, camera to mask, ms (median; left is faster)")
        .y_desc("1 − F (lower is better)")
        .x_label_formatter(&|ms| ms.to_string())
        .y_label_formatter(&|error| if *error <= FLOOR { format!("≤ {FLOOR}") } else { error.to_string() })
        .draw()?;

    // From here on in pixels of the page: markers and labels have sizes there.
    let place = |run: &Run| {
        let (x, y) = chart.backend_coord(&(millis(run), error(run)));
        [f64::from(x), f64::from(y)]
    };
    let curves = curves(&runs);
    let (across, down) = chart.plotting_area().get_pixel_range();
    let inside = Rect([across.start + 2, down.start + 2, across.end - 2, down.end - 2].map(f64::from));
    let front = front(&runs, &place);
    root.draw(&PathElement::new(front.iter().map(|at| whole(*at)).collect::<Vec<_>>(), FRONT.stroke_width(5)))?;
    let mut page = Page { inside, taken: Vec::new(), lines: segments(&front), text_px: TEXT_PX };
    for curve in &curves {
        let points: Vec<[f64; 2]> = curve.iter().map(|run| place(run)).collect();
        draw_curve(root, &points, &look(curve[0].method))?;
        page.lines.extend(segments(&points));
        let reach = |run: &&Run| if run.pareto { RING + 1.0 } else { MARKER };
        page.taken.extend(curve.iter().zip(&points).map(|(run, point)| Rect::around(*point, reach(run))));
    }
    for run in runs.iter().filter(|run| run.pareto) {
        root.draw(&Circle::new(whole(place(run)), RING as i32, INK))?;
    }
    draw_labels(root, &curves, page, &place)
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

/// The straight lines between points that follow one another.
fn segments(points: &[[f64; 2]]) -> Vec<[[f64; 2]; 2]> {
    points.windows(2).map(|ends| [ends[0], ends[1]]).collect()
}

fn draw_curve(root: &Area, points: &[[f64; 2]], look: &Look) -> Drawn {
    let line = points.iter().map(|point| whole(*point)).collect::<Vec<_>>();
    let style = look.colour.stroke_width(2);
    match look.dash {
        None => root.draw(&PathElement::new(line, style))?,
        Some([dash, gap]) => root.draw(&plotters::element::DashedPathElement::new(line, dash, gap, style))?,
    }
    points.iter().try_for_each(|point| draw_marker(root, whole(*point), look))
}

fn draw_marker(root: &Area, (x, y): (i32, i32), look: &Look) -> Drawn {
    let filled = look.colour.filled();
    let polygon = |corners: &[(i32, i32)]| {
        root.draw(&Polygon::new(corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect::<Vec<_>>(), filled))
    };
    match look.marker {
        Marker::Disc => root.draw(&Circle::new((x, y), 5, filled)),
        Marker::Square => polygon(&[(-5, -5), (5, -5), (5, 5), (-5, 5)]),
        Marker::Triangle => polygon(&[(-6, 5), (6, 5), (0, -6)]),
        Marker::Diamond => polygon(&[(-6, 0), (0, -6), (6, 0), (0, 6)]),
        Marker::Cross => root.draw(&Cross::new((x, y), 5, look.colour.stroke_width(3))),
    }
}

/// The method's name beside one point of its curve, levels beside the others.
fn draw_labels(root: &Area, curves: &[Vec<&Run>], mut page: Page, place: &impl Fn(&Run) -> [f64; 2]) -> Drawn {
    let choice = |run: &Run, text: String| Choice { point: place(run), text };
    let named = |run: &&Run| choice(run, format!("{}, level {}", run.method, run.level));
    // Names are wide: they choose first, and beside which point.
    let names: Vec<Vec<Choice>> = curves.iter().map(|curve| curve.iter().map(named).collect()).collect();
    let names = labels::place(&names, &mut page);
    for (curve, name) in curves.iter().zip(names) {
        let told = name.as_ref().map(|name| name.choice.point);
        let others = curve.iter().filter(|run| Some(place(run)) != told);
        let levels: Vec<_> = others.map(|run| vec![choice(run, run.level.to_string())]).collect();
        let levels = labels::place(&levels, &mut page);
        name.iter().chain(levels.iter().flatten()).try_for_each(|label| draw_label(root, label, curve[0].method))?;
    }
    Ok(())
}

/// A label in the colour of its curve; a thin line leads to a point farther away.
fn draw_label(root: &Area, label: &Placed, method: &str) -> Drawn {
    let (point, colour, [left, top, right, bottom]) = (label.choice.point, look(method).colour, label.rect.0);
    // Estimated widths are on the safe side: the text begins at the side of its point.
    let (across, anchor) = match label.side {
        side if side > 0.0 => (left, HPos::Left),
        side if side < 0.0 => (right, HPos::Right),
        _ => ((left + right) / 2.0, HPos::Center),
    };
    let nearest = label.rect.nearest(point);
    if f64::hypot(nearest[0] - point[0], nearest[1] - point[1]) > FAR {
        root.draw(&PathElement::new(vec![whole(point), whole(nearest)], GREY))?;
    }
    let style = font(TEXT_PX, colour).pos(Pos::new(anchor, VPos::Center));
    root.draw(&Text::new(label.choice.text.as_str(), whole([across, (top + bottom) / 2.0]), style))
}

/// Writes a line of text below and to the right of a place.
fn write(root: &Area, text: &str, at: [f64; 2], size: f64, colour: RGBColor) -> Drawn {
    root.draw(&Text::new(text, whole(at), font(size, colour)))
}

/// The serif face in this size; the library's SVG writer divides sizes by 1.24.
fn font<'a>(px: f64, colour: RGBColor) -> TextStyle<'a> {
    ("serif", px * 1.24).into_font().color(&colour)
}

fn whole([x, y]: [f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

/// At most so many letters: a caption stays on its panel.
fn shorten(text: &str, letters: usize) -> String {
    match text.char_indices().nth(letters) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

fn millis(run: &Run) -> f64 {
    run.frame_ms.max(LEAST_MS)
}

fn error(run: &Run) -> f64 {
    (1.0 - run.f).max(FLOOR)
}

fn look(method: &str) -> Look {
    let (colour, dash, marker) = match method {
        "walk" => (INK, None, Marker::Disc),
        "toward-away" => (RGBColor(0, 90, 200), Some([12, 4]), Marker::Square),
        "toward-away-wide" => (RGBColor(0, 110, 95), Some([6, 4]), Marker::Triangle),
        "adjacency" => (RGBColor(184, 58, 0), Some([3, 4]), Marker::Diamond),
        _ => (RGBColor(130, 40, 130), Some([18, 6]), Marker::Cross),
    };
    Look { colour, dash, marker }
}

/// The ends of a logarithmic axis and its marks, with and without a number.
struct Axis {
    from: f64,
    to: f64,
    bold: Vec<f64>,
    light: Vec<f64>,
}

/// An axis that holds all values with room to spare; where it reaches down to a floor, it ends there.
fn axis(values: impl Iterator<Item = f64>, floor: Option<f64>) -> Axis {
    let (least, most) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let (least, most) = if least <= most { (least, most) } else { (1.0, 1.0) };
    let fine = marks(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    let below = fine.iter().rev().copied().find(|mark| *mark <= least / 1.15).unwrap_or(least);
    let above = fine.iter().copied().find(|mark| *mark >= most * 1.15).unwrap_or(most * 1.15);
    // A value on the floor lies on the lowest mark, a little above the end of the axis. No error is above 1.
    let (from, to) = floor.map_or((below, above), |floor| (below.max(floor / 1.5), above.min(1.3)));
    let within = |marks: Vec<f64>| marks.into_iter().filter(|mark| (from..=to).contains(mark)).collect::<Vec<_>>();
    // Over three powers of ten and more, numbers between them would crowd.
    let bold = within(if to / from > 2000.0 { marks(&[1]) } else { marks(&[1, 2, 5]) });
    Axis { from, to, bold, light: within(fine) }
}

/// These digits times every power of ten that may occur.
fn marks(digits: &[u32]) -> Vec<f64> {
    // Quotients of whole numbers are the f64 that print shortest.
    let power = |digit: u32, power: i32| match 10.0_f64.powi(power.abs()) {
        ten if power < 0 => f64::from(digit) / ten,
        ten => f64::from(digit) * ten,
    };
    (-5..9).flat_map(|e| digits.iter().map(move |digit| power(*digit, e))).collect()
}
