//! How time grows with the size of something, beside what is promised, as SVG: both axes logarithmic.
//!
//! The curve has the time beside each point; the promise is a dashed line from the first point's time on. The same figures
//! give the same bytes.

use plotters::prelude::*;

use super::chart::{
    Area, Axis, Drawn, INK, MARKER, axes, draw_curve, draw_label, draw_line, label_page, place, plot, segments,
};
use super::labels::{self, Choice, Rect};
use super::words::milliseconds;
use crate::error::Result;
use crate::measure::Growth;
use crate::plan::registry::{Marker, PlotLook};

const PROMISED: RGBColor = RGBColor(184, 58, 0);

/// The plot as a file of its own.
///
/// # Errors
/// [`Error::Mistake`](crate::error::Error::Mistake) where the plotting library gives up.
pub fn growth_svg(growth: &Growth) -> Result<String> {
    plot(&growth.title, &description(growth), &[&growth.note], &[()], |root, panel, ()| draw(growth, root, panel))
}

/// What the plot shows, in words.
fn description(growth: &Growth) -> String {
    let mut told = format!("The time of a frame against {}. Both axes are logarithmic.", growth.across);
    for ([size, ms], (times, broken)) in growth.points.iter().zip(growth.growth()) {
        let broken = if broken { ", more than promised" } else { "" };
        told += &format!(" {}: {} ms, {times:.2} times the first{broken}.", digits(size), milliseconds(*ms));
    }
    told
}

fn draw(growth: &Growth, root: &Area, panel: &Area) -> Drawn {
    let sizes = || growth.points.iter().map(|[size, _]| *size);
    let promise: Vec<[f64; 2]> = sizes().filter_map(|size| Some([size, growth.promised(size)?])).collect();
    let times = growth.points.iter().chain(&promise).map(|[_, ms]| *ms);
    let x = Axis { bold: sizes().collect(), ..Axis::new(&growth.across, digits, sizes(), None) };
    let y = Axis::new("time of a frame, camera to mask, ms (median)", f64::to_string, times, None);
    let chart = axes(panel, &growth.caption, &x, &y)?;
    let on_page = |points: &[[f64; 2]]| points.iter().map(|at| place(&chart, *at)).collect::<Vec<_>>();
    let (points, promise) = (on_page(&growth.points), on_page(&promise));
    let look = PlotLook { colour: [INK.0, INK.1, INK.2], dash: None, marker: Marker::Disc };
    draw_line(root, &promise, PROMISED, Some([6, 4]))?;
    draw_curve(root, &points, &look)?;
    let mut page = label_page(&chart, [segments(&points), segments(&promise)].concat());
    page.taken.extend(points.iter().map(|point| Rect::around(*point, MARKER)));
    let beside = |text: &str| promise.iter().map(|point| Choice { point: *point, text: text.into() }).collect();
    let promised = format!("promised: {}", growth.promise);
    if let Some(label) = labels::place(&[beside(&promised)], &mut page).iter().flatten().next() {
        draw_label(root, label, PROMISED)?;
    }
    let time = |(point, [_, ms]): (&[f64; 2], &[f64; 2])| {
        vec![Choice { point: *point, text: format!("{} ms", milliseconds(*ms)) }]
    };
    let times: Vec<_> = points.iter().zip(&growth.points).map(time).collect();
    labels::place(&times, &mut page).iter().flatten().try_for_each(|label| draw_label(root, label, INK))
}

/// A size to three digits, or whole.
fn digits(size: &f64) -> String {
    if size.fract() == 0.0 { size.to_string() } else { milliseconds(*size) }
}
