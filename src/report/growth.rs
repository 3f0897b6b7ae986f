//! How time grows with the size of something, beside what is promised, as SVG: both axes logarithmic.
//!
//! The curve has the time beside each point; the promise is a dashed line from the first point's time on. The same figures
//! give the same bytes.

use std::fmt;

use plotters::prelude::*;

use super::chart::{
    Area, Axis, Drawn, INK, MARKER, axes, draw_curve, draw_label, draw_line, label_page, place, plot, segments,
};
use super::labels::{self, Choice, Rect};
use super::words::milliseconds;
use crate::error::Result;
use crate::plan::registry::{Look, Marker};

const PROMISED: RGBColor = RGBColor(184, 58, 0);

/// Times of the same work at growing sizes.
#[derive(Debug, Clone)]
pub struct Growth {
    /// What the plot is about.
    pub title: String,
    /// What was drawn.
    pub caption: String,
    /// By what, and how times were taken.
    pub note: String,
    /// What grows, and its unit.
    pub across: String,
    /// Sizes, growing, and the time of a frame at each, ms; above 0.
    pub points: Vec<[f64; 2]>,
    /// What is promised of these times.
    pub promise: Promise,
}

/// How much time may grow from the first size on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Promise {
    /// To less than so many times the first time, whatever the size.
    Below(f64),
    /// As many times as the size at most.
    Linear,
}

impl fmt::Display for Promise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Below(times) => write!(f, "less than {times} times the first"),
            Self::Linear => write!(f, "at most linear"),
        }
    }
}

impl Growth {
    /// At a size the time promised, ms; `None` where nothing was measured.
    fn promised(&self, size: f64) -> Option<f64> {
        let [first, ms] = *self.points.first()?;
        Some(match self.promise {
            Promise::Below(times) => ms * times,
            Promise::Linear => ms * size / first,
        })
    }

    /// Of each point how many times the first time it takes, and whether that is more than promised.
    pub fn growth(&self) -> Vec<(f64, bool)> {
        let of = |&[size, ms]: &[f64; 2]| {
            let promised = self.promised(size)?;
            let broken = match self.promise {
                Promise::Below(_) => ms >= promised,
                Promise::Linear => ms > promised,
            };
            Some((ms / self.points[0][1], broken))
        };
        self.points.iter().filter_map(of).collect()
    }

    /// Whether no point breaks the promise.
    pub fn is_kept(&self) -> bool {
        self.growth().iter().all(|(_, broken)| !broken)
    }

    /// The plot as a file of its own.
    ///
    /// # Errors
    /// [`Error::Report`](crate::error::Error::Report) where the plotting library gives up.
    pub fn svg(&self) -> Result<String> {
        plot(&self.title, &self.description(), &[&self.note], &[()], |root, panel, ()| self.draw(root, panel))
    }

    /// What the plot shows, in words.
    fn description(&self) -> String {
        let mut told = format!("The time of a frame against {}. Both axes are logarithmic.", self.across);
        for ([size, ms], (times, broken)) in self.points.iter().zip(self.growth()) {
            let broken = if broken { ", more than promised" } else { "" };
            told += &format!(" {}: {} ms, {times:.2} times the first{broken}.", digits(size), milliseconds(*ms));
        }
        told
    }

    fn draw(&self, root: &Area, panel: &Area) -> Drawn {
        let sizes = || self.points.iter().map(|[size, _]| *size);
        let promise: Vec<[f64; 2]> = sizes().filter_map(|size| Some([size, self.promised(size)?])).collect();
        let times = self.points.iter().chain(&promise).map(|[_, ms]| *ms);
        let x = Axis { bold: sizes().collect(), ..Axis::new(&self.across, digits, sizes(), None) };
        let y = Axis::new("time of a frame, camera to mask, ms (median)", f64::to_string, times, None);
        let chart = axes(panel, &self.caption, &x, &y)?;
        let on_page = |points: &[[f64; 2]]| points.iter().map(|at| place(&chart, *at)).collect::<Vec<_>>();
        let (points, promise) = (on_page(&self.points), on_page(&promise));
        let look = Look { colour: [INK.0, INK.1, INK.2], dash: None, marker: Marker::Disc };
        draw_line(root, &promise, PROMISED, Some([6, 4]))?;
        draw_curve(root, &points, &look)?;
        let mut page = label_page(&chart, [segments(&points), segments(&promise)].concat());
        page.taken.extend(points.iter().map(|point| Rect::around(*point, MARKER)));
        let beside = |text: &str| promise.iter().map(|point| Choice { point: *point, text: text.into() }).collect();
        let promised = format!("promised: {}", self.promise);
        if let Some(label) = labels::place(&[beside(&promised)], &mut page).iter().flatten().next() {
            draw_label(root, label, PROMISED)?;
        }
        let time = |(point, [_, ms]): (&[f64; 2], &[f64; 2])| {
            vec![Choice { point: *point, text: format!("{} ms", milliseconds(*ms)) }]
        };
        let times: Vec<_> = points.iter().zip(&self.points).map(time).collect();
        labels::place(&times, &mut page).iter().flatten().try_for_each(|label| draw_label(root, label, INK))
    }
}

/// A size to three digits, or whole.
fn digits(size: &f64) -> String {
    if size.fract() == 0.0 { size.to_string() } else { milliseconds(*size) }
}
