//! What the plots of reports share: a white page of panels, logarithmic axes, curves, labels beside their points.
//!
//! Fonts are the reader's serif face, widths of texts are estimates. The same curves give the same bytes.

use std::io;

use minijinja::HtmlEscape;
use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::labels::{Obstacles, Placed, Rect};
use crate::error::{Error, Result};
use crate::plan::registry::{Marker, PlotLook};

/// Width of a plot, px.
const WIDTH: u32 = 960;
/// Height of a panel, px.
const PANEL: u32 = 520;
/// Height of the title, px.
const HEAD: u32 = 44;
/// Height of the note below, px.
const FOOT: u32 = 58;
/// Height of a line of the note, px.
const FOOT_LINE: f64 = 19.0;
/// Height of labels, px.
const TEXT_PX: f64 = 13.0;
/// Half the side of the square that a marker takes, px.
pub(super) const MARKER: f64 = 7.0;
/// Radius of the ring around a marker, px.
pub(super) const RING: f64 = 9.0;
/// Least 1 - F that is told from 0: truth is some thousand pixels long.
pub(super) const FLOOR: f64 = 1e-4;
/// Least time that is told from 0, ms.
const LEAST_MS: f64 = 1e-3;
/// Distance from a label to its point from which on a thin line joins them, px.
const FAR: f64 = 13.0;
/// Ends of an axis that are fewer times apart have all whole digits for marks.
const NARROW: f64 = 4.0;

pub(super) const INK: RGBColor = RGBColor(26, 26, 26);
const GREY: RGBColor = RGBColor(95, 95, 95);
const GRID: RGBColor = RGBColor(222, 222, 222);
const FAINT: RGBColor = RGBColor(241, 241, 241);

/// What draws in a [`DrawingArea`] can fail with.
pub(super) type Drawn = std::result::Result<(), DrawingAreaErrorKind<io::Error>>;
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// A logarithmic axis as the plotting library has it.
type Scale = WithKeyPoints<LogCoord<f64>>;
/// Axes on a panel.
pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Scale, Scale>>;

/// A logarithmic axis: its ends and its marks, with and without a number.
pub(super) struct Axis<'a> {
    /// What stands beside it.
    pub name: &'a str,
    /// How its numbers are written.
    pub number: fn(&f64) -> String,
    pub from: f64,
    pub to: f64,
    pub bold: Vec<f64>,
    pub light: Vec<f64>,
}

/// The axis of times of frames, as [`millis`] has them.
pub(super) fn time_axis(times: impl Iterator<Item = f64>) -> Axis<'static> {
    Axis::new("time of a frame, camera to mask, ms (median; left is faster)", f64::to_string, times, None)
}

/// The axis of errors, as [`error_of`] has them.
pub(super) fn error_axis(errors: impl Iterator<Item = f64>) -> Axis<'static> {
    let number = |error: &f64| if *error <= FLOOR { format!("≤ {FLOOR}") } else { error.to_string() };
    Axis::new("1 − F (lower is better)", number, errors, Some(FLOOR))
}

/// The time of a frame as far as it is told from 0.
pub(super) fn millis(frame_ms: f64) -> f64 {
    frame_ms.max(LEAST_MS)
}

/// 1 - F as far as it is told from 0.
pub(super) fn error_of(f: f64) -> f64 {
    (1.0 - f).max(FLOOR)
}

/// A plot as a file of its own, which may also stand inside a page: a panel for each of `panels` below the title, lines
/// of a note below them, and `told`, the same in words.
///
/// # Errors
/// [`Error::Mistake`] where the plotting library gives up.
pub(super) fn plot<T>(
    title: &str,
    told: &str,
    foot: &[&str],
    panels: &[T],
    draw: impl Fn(&Area, &Area, &T) -> Drawn,
) -> Result<String> {
    let mut svg = String::new();
    draw_page(&mut svg, title, foot, panels, draw).map_err(|e| Error::no_report(format_args!("the plot: {e}")))?;
    // The library knows neither of the two elements that tell what is drawn to those who do not see it.
    let [title, told] = [title, told].map(|text| HtmlEscape(text).to_string());
    let (tag, rest) = svg.split_once('\n').unwrap_or((&svg, ""));
    let tag = tag.replacen("<svg", "<svg role=\"img\" aria-labelledby=\"plot-title plot-desc\"", 1);
    Ok(format!("{tag}\n<title id=\"plot-title\">{title}</title>\n<desc id=\"plot-desc\">{told}</desc>\n{rest}"))
}

fn draw_page<T>(
    svg: &mut String,
    title: &str,
    foot: &[&str],
    panels: &[T],
    draw: impl Fn(&Area, &Area, &T) -> Drawn,
) -> Drawn {
    let below = HEAD + PANEL * panels.len() as u32;
    let root = SVGBackend::with_string(svg, (WIDTH, below + FOOT)).into_drawing_area();
    root.fill(&WHITE)?;
    write(&root, title, [30.0, 10.0], 22.0, INK)?;
    let mut rest = root.split_vertically(HEAD).1;
    for what in panels {
        let (panel, below) = rest.split_vertically(PANEL);
        draw(&root, &panel, what)?;
        rest = below;
    }
    for (line, text) in foot.iter().enumerate() {
        write(&root, text, [30.0, f64::from(below) + 6.0 + FOOT_LINE * line as f64], TEXT_PX, GREY)?;
    }
    root.present()
}

/// Draws the axes of a panel with their grid.
pub(super) fn axes<'a>(
    panel: &Area<'a>,
    caption: &str,
    x: &Axis,
    y: &Axis,
) -> std::result::Result<Chart<'a>, DrawingAreaErrorKind<io::Error>> {
    let scale = |axis: &Axis| {
        let scale = (axis.from..axis.to).log_scale();
        scale.with_key_points(axis.bold.clone()).with_light_points(axis.light.clone())
    };
    let mut chart = ChartBuilder::on(panel)
        .margin(8)
        .margin_right(30)
        .caption(caption, font(17.0, INK))
        .x_label_area_size(52)
        .y_label_area_size(88)
        .build_cartesian_2d(scale(x), scale(y))?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(FAINT)
        .axis_style(GREY)
        .label_style(font(TEXT_PX, INK))
        .axis_desc_style(font(14.0, INK))
        .x_desc(x.name)
        .y_desc(y.name)
        .x_label_formatter(&x.number)
        .y_label_formatter(&y.number)
        .draw()?;
    Ok(chart)
}

/// Where a place on the axes lies on the page, px: markers and labels have sizes there.
pub(super) fn place(chart: &Chart, at: [f64; 2]) -> [f64; 2] {
    let (x, y) = chart.backend_coord(&at.into());
    [f64::from(x), f64::from(y)]
}

/// A page for labels between the axes, clear of these lines.
pub(super) fn label_page(chart: &Chart, lines: Vec<[[f64; 2]; 2]>) -> Obstacles {
    let (across, down) = chart.plotting_area().get_pixel_range();
    let inside = Rect([across.start + 2, down.start + 2, across.end - 2, down.end - 2].map(f64::from));
    Obstacles { inside, taken: Vec::new(), lines, text_px: TEXT_PX }
}

/// The straight lines between points that follow one another.
pub(super) fn segments(points: &[[f64; 2]]) -> Vec<[[f64; 2]; 2]> {
    points.windows(2).map(|ends| [ends[0], ends[1]]).collect()
}

/// Draws a line with a marker at each point.
pub(super) fn draw_curve(root: &Area, points: &[[f64; 2]], look: &PlotLook) -> Drawn {
    draw_line(root, points, rgb(look.colour), look.dash)?;
    points.iter().try_for_each(|point| draw_marker(root, whole(*point), look))
}

/// Draws straight lines from point to point, dashed by the lengths of dash and gap.
pub(super) fn draw_line(root: &Area, points: &[[f64; 2]], colour: RGBColor, dash: Option<[i32; 2]>) -> Drawn {
    let line = points.iter().map(|point| whole(*point)).collect::<Vec<_>>();
    let style = colour.stroke_width(2);
    match dash {
        None => root.draw(&PathElement::new(line, style)),
        Some([dash, gap]) => root.draw(&plotters::element::DashedPathElement::new(line, dash, gap, style)),
    }
}

/// Draws a marker at a place.
pub(super) fn draw_marker(root: &Area, (x, y): (i32, i32), look: &PlotLook) -> Drawn {
    let colour = rgb(look.colour);
    let filled = colour.filled();
    let polygon = |corners: &[(i32, i32)]| {
        root.draw(&Polygon::new(corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect::<Vec<_>>(), filled))
    };
    match look.marker {
        Marker::Disc => root.draw(&Circle::new((x, y), 5, filled)),
        Marker::Square => polygon(&[(-5, -5), (5, -5), (5, 5), (-5, 5)]),
        Marker::Triangle => polygon(&[(-6, 5), (6, 5), (0, -6)]),
        Marker::Diamond => polygon(&[(-6, 0), (0, -6), (6, 0), (0, 6)]),
        Marker::Plus => polygon(&[
            (-2, -6),
            (2, -6),
            (2, -2),
            (6, -2),
            (6, 2),
            (2, 2),
            (2, 6),
            (-2, 6),
            (-2, 2),
            (-6, 2),
            (-6, -2),
            (-2, -2),
        ]),
        Marker::Cross => root.draw(&Cross::new((x, y), 5, colour.stroke_width(3))),
    }
}

/// A colour as the plotting library has it.
pub(super) fn rgb([red, green, blue]: [u8; 3]) -> RGBColor {
    RGBColor(red, green, blue)
}

/// A label in the colour of its curve; a thin line leads to a point farther away.
pub(super) fn draw_label(root: &Area, label: &Placed, colour: RGBColor) -> Drawn {
    let (point, [left, top, right, bottom]) = (label.choice.point, label.rect.0);
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
pub(super) fn write(root: &Area, text: &str, at: [f64; 2], size: f64, colour: RGBColor) -> Drawn {
    root.draw(&Text::new(text, whole(at), font(size, colour)))
}

/// The serif face in this size; the library's SVG writer divides sizes by 1.24.
fn font<'a>(px: f64, colour: RGBColor) -> TextStyle<'a> {
    ("serif", px * 1.24).into_font().color(&colour)
}

pub(super) fn whole([x, y]: [f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

impl<'a> Axis<'a> {
    /// An axis that holds all values with room to spare; where it reaches down to a floor, it ends there.
    pub(super) fn new(
        name: &'a str,
        number: fn(&f64) -> String,
        values: impl Iterator<Item = f64>,
        floor: Option<f64>,
    ) -> Self {
        let (least, most) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        let (least, most) = if least <= most { (least, most) } else { (1.0, 1.0) };
        let fine = marks(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        let below = fine.iter().rev().copied().find(|mark| *mark <= least / 1.15).unwrap_or(least);
        let above = fine.iter().copied().find(|mark| *mark >= most * 1.15).unwrap_or(most * 1.15);
        // A value on the floor lies on the lowest mark, a little above the end of the axis. No error is above 1.
        let (from, to) = floor.map_or((below, above), |floor| (below.max(floor / 1.5), above.min(1.3)));
        let within = |marks: Vec<f64>| marks.into_iter().filter(|mark| (from..=to).contains(mark)).collect::<Vec<_>>();
        // Over three powers of ten and more, numbers between them would crowd; over a short way few would have one.
        let bold = match to / from {
            wide if wide > 2000.0 => within(marks(&[1])),
            narrow if narrow < NARROW => within(fine.clone()),
            _ => within(marks(&[1, 2, 5])),
        };
        Self { name, number, from, to, bold, light: within(fine) }
    }
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
