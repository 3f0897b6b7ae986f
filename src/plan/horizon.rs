//! What nearer land hides, column by column of the map before the eye.
//!
//! Method: land is looked at from the eye outwards. Rows and columns of samples stand like fences across the way of rays;
//! the steepest line of sight over them is the horizon so far of each column (Floriani, Magillo 1994, front-to-back
//! horizons). What lies below it in all its columns is hidden. A ray that has passed a void may go under the land:
//! from there on nothing rises. Cost: a few columns a square. Only for eyes over the land that do not look up or down too
//! steeply; else nothing is hidden.

use std::ops::Range;

use glam::{DVec2, DVec3};

use crate::surface::Surface;
use crate::surface::pyramid::Fences;
use crate::view::Camera;

/// Columns across the page.
const COLUMNS: usize = 1024;
/// Squares are looked at one by one until they are so many columns wide.
const FINE_COLUMNS: usize = 16;

/// The horizon so far.
pub(super) struct Horizon {
    /// Metres east and north of sample (0, 0), height.
    eye: DVec3,
    /// Unit vectors of the map: to the right of the page, and ahead.
    right: DVec2,
    ahead: DVec2,
    /// Tangents of the leftmost and rightmost column.
    edge: [f64; 2],
    /// Slope of a line of sight a pixel above another, at most.
    pixel: f64,
    /// Of each column, rise over distance ahead of the steepest hidden line of sight.
    slopes: Vec<f64>,
    /// Of each column, whether a ray may have come under the land.
    open: Vec<bool>,
}

/// What of the columns and the way ahead a rectangle of the map takes.
struct Reach {
    /// First and last tangent of any of it.
    any: [f64; 2],
    /// Distance ahead, metres.
    ahead: [f64; 2],
}

impl Horizon {
    /// Nothing hidden yet. `None` where nothing can be told.
    pub(super) fn new(surface: &Surface, camera: &Camera) -> Option<Self> {
        let sides = camera.frustum()?;
        let dem = surface.dem();
        let eye = camera.eye - dem.position(0, 0).with_z(0.0);
        let at = dem.grid_place(camera.eye.truncate());
        let last = DVec2::new((dem.columns() - 1) as f64, (dem.rows() - 1) as f64);
        let over = at.cmpge(DVec2::ZERO).all() && at.cmplt(last).all();
        let ground = surface.height_below(camera.eye.truncate(), crate::surface::Level::EIGHT)?;
        if !over || ground >= camera.eye.z {
            return None;
        }
        let azimuth = camera.azimuth.to_radians();
        let (ahead, right) = (DVec2::new(azimuth.sin(), azimuth.cos()), DVec2::new(azimuth.cos(), -azimuth.sin()));
        // The sides of the page lead along (normal.y, -normal.x) or against it.
        let edge = sides.map(|normal| {
            let along = DVec2::new(normal.y, -normal.x);
            along.dot(right) / along.dot(ahead)
        });
        let usable = edge[0] < edge[1] && edge.iter().all(|tangent| tangent.is_finite());
        usable.then(|| Self {
            eye,
            right,
            ahead,
            edge,
            pixel: 2.0 / camera.focal(),
            slopes: vec![f64::NEG_INFINITY; COLUMNS],
            open: vec![false; COLUMNS],
        })
    }

    /// Whether all of a box lies below the horizon.
    pub(super) fn hides(&self, [low, high]: [DVec3; 2]) -> bool {
        let Some(reach) = self.reach(low.truncate(), high.truncate()) else { return false };
        let rise = high.z - self.eye.z;
        let slope = rise / if rise > 0.0 { reach.ahead[0] } else { reach.ahead[1] } + self.pixel;
        let columns = self.touched(reach.any);
        !columns.is_empty() && self.slopes[columns].iter().all(|horizon| slope < *horizon)
    }

    /// Whether a rectangle of the map takes so much of the page that its parts are better looked at one by one.
    pub(super) fn is_wide(&self, low: DVec2, high: DVec2) -> bool {
        match self.reach(low, high) {
            Some(reach) => self.touched(reach.any).len() > FINE_COLUMNS,
            // Wholly behind the eye, or around it.
            None => [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)]
                .into_iter()
                .any(|corner| (corner - self.eye.truncate()).dot(self.ahead) > 0.0),
        }
    }

    /// Raises the horizon by the fences of a square of the map, lowered by `deviation` metres; `None` where it has voids.
    pub(super) fn raise(&mut self, low: DVec2, high: DVec2, fences: Option<Fences>, deviation: f64) {
        let Some(reach) = self.reach(low, high) else { return };
        let Some(fences) = fences else {
            let columns = self.touched(reach.any);
            self.open[columns].fill(true);
            return;
        };
        let corner = |x: f64, y: f64| self.tangent(DVec2::new(x, y));
        let [sw, se, nw, ne] =
            [corner(low.x, low.y), corner(high.x, low.y), corner(low.x, high.y), corner(high.x, high.y)];
        // Wherever in the square a fence stands, it spans what both of its parallel sides span.
        let both = |a: [f64; 2], b: [f64; 2]| {
            let sorted = |[p, q]: [f64; 2]| [p.min(q), p.max(q)];
            let (a, b) = (sorted(a), sorted(b));
            [a[0].max(b[0]), a[1].min(b[1])]
        };
        for (height, span) in
            [(fences.along_east, both([sw, se], [nw, ne])), (fences.along_north, both([sw, nw], [se, ne]))]
        {
            let rise = f64::from(height) - deviation - self.eye.z;
            let slope = rise / if rise > 0.0 { reach.ahead[1] } else { reach.ahead[0] };
            for column in self.covered(span) {
                if !self.open[column] {
                    self.slopes[column] = self.slopes[column].max(slope);
                }
            }
        }
    }

    /// `None` where some of the rectangle does not lie ahead.
    fn reach(&self, low: DVec2, high: DVec2) -> Option<Reach> {
        let mut reach = Reach { any: [f64::INFINITY, f64::NEG_INFINITY], ahead: [f64::INFINITY, f64::NEG_INFINITY] };
        for corner in [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)] {
            let ahead = (corner - self.eye.truncate()).dot(self.ahead);
            if ahead <= 0.0 {
                return None;
            }
            let tangent = self.tangent(corner);
            reach.any = [reach.any[0].min(tangent), reach.any[1].max(tangent)];
            reach.ahead = [reach.ahead[0].min(ahead), reach.ahead[1].max(ahead)];
        }
        Some(reach)
    }

    fn tangent(&self, place: DVec2) -> f64 {
        let from_eye = place - self.eye.truncate();
        from_eye.dot(self.right) / from_eye.dot(self.ahead)
    }

    /// Column, fractional, of a tangent.
    fn column(&self, tangent: f64) -> f64 {
        (tangent - self.edge[0]) / (self.edge[1] - self.edge[0]) * COLUMNS as f64
    }

    /// Columns of the page that a span touches.
    fn touched(&self, [from, to]: [f64; 2]) -> Range<usize> {
        columns(self.column(from).floor(), self.column(to).ceil())
    }

    /// Columns of the page that lie wholly in a span.
    fn covered(&self, [from, to]: [f64; 2]) -> Range<usize> {
        columns(self.column(from).ceil(), self.column(to).floor())
    }
}

fn columns(from: f64, to: f64) -> Range<usize> {
    let on_page = |column: f64| column.clamp(0.0, COLUMNS as f64) as usize;
    on_page(from)..on_page(to).max(on_page(from))
}
