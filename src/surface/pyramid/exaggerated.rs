//! The bounds of an exaggerated surface from those of the plain one, without a look at a sample.
//!
//! Method: a control point lies at its flat triangle less m = n (d . n) / 3 (see `bounds`). With e the height by which d leaves
//! the tangent plane and g the squared gradient there, |m| = |e| / 3 sqrt(1 + g). Times k, e becomes k e and g becomes k^2 g,
//! so |m| grows at most K = max(1, k) times. Let b be the bulge of the plain patch, 3/4 of its largest second difference. Each
//! m is a third of a sum of such differences, (2 (2 m - m') + (2 m' - m)) / 3, so |m| <= S = 4 b / 3. Hence, exaggerated:
//!
//! - control points lie within 3/2 K S = 2 K b of the flat triangle: heights between k low - 2 K b and k high + 2 K b;
//! - second differences are sums of at most three m: the bulge is at most 9/4 K S = 3 K b, the reach of boxes;
//! - facets of level 1 leave the patch by at most 2.4 K b, so that land and facets dip under a fence by less than 9 K b.
//!
//! Slopes: with s = k (1 + g) / (1 + k^2 g) the vertical part of m becomes s, its horizontal part s k times as much. g is
//! bounded by the slopes of the control points, hence both. Deviations are taken K times as large: what they become where
//! slopes are gentle, and about the most elsewhere; a measure of quality, not a bound. Samples are rounded to f32 after they
//! are multiplied: a slack of 2^-19 of the height. Cost: one look at each square. Not handled: land so steep that control points
//! may pass each other; its slopes are not known then, which costs facets.

use super::{Fences, Layer, Pyramid, Square};
use crate::surface::slopes::Slopes;

/// Bulges, K times as large as those of the plain surface, that patches may reach beyond their square.
pub(super) const BEYOND: f32 = 3.0;
/// The same for what lies under a fence: patches, and facets as far below them as they are let down anyway.
pub(super) const BELOW: f32 = 9.0;
/// The m's, each a S long at most, that a step between neighbouring control points is made of.
const STEP: f64 = 2.5;
/// Share of a third of a cell that control points may move for their slopes to be known.
const MOST_MOVED: f64 = 0.5;
/// Share of a height that rounding may change.
const ROUNDING: f64 = 1.0 / (1 << 19) as f64;

impl Pyramid {
    /// The bounds of the same surface with every height multiplied by `k`, looser than its own.
    pub fn exaggerated(&self, k: f64) -> Self {
        let cell = self.cell.min_element();
        let level_1 = self.level_1();
        let layer = |(number, layer): (usize, &Layer)| {
            let squares = layer.squares.iter().map(|square| square.exaggerated(k, cell, number > level_1)).collect();
            Layer { squares, ..*layer }
        };
        let layers = self.layers.iter().enumerate().map(layer).collect();
        Self { layers, samples: self.samples, cell: self.cell, beyond: BEYOND, below: BELOW }
    }
}

impl Square {
    /// Of the land times `k`; `measured`: its deviation is that of samples, above the bulge.
    fn exaggerated(self, k: f64, cell: f64, measured: bool) -> Self {
        let Self { low, high, bulge, deviation, fences, slopes } = self;
        if low > high {
            return self;
        }
        let most = k.max(1.0);
        let [low, high, bulge, deviation] = [low, high, bulge, deviation].map(f64::from);
        let slack = low.abs().max(high.abs()) * k * ROUNDING;
        let outwards = 2.0 * most * bulge + slack;
        let deviation = if measured { k * (deviation - bulge) + most * bulge } else { most * deviation };
        let times = |height: f32| (f64::from(height) * k) as f32;
        Self {
            low: ((k * low - outwards) as f32).next_down(),
            high: ((k * high + outwards) as f32).next_up(),
            bulge: ((most * bulge) as f32).next_up(),
            deviation: (deviation as f32).next_up(),
            fences: Fences { along_east: times(fences.along_east), along_north: times(fences.along_north) },
            slopes: exaggerated(slopes, k, 4.0 / 3.0 * bulge / (cell / 3.0), slack / (cell / 3.0)),
        }
    }
}

/// Slopes of control points of land times `k`, whose m's and rounding are at most such shares of a third of a cell.
fn exaggerated(slopes: Slopes, k: f64, m: f64, slack: f64) -> Slopes {
    let [low, high] = slopes.range();
    let steepest = low.abs().max(high.abs()).max_element();
    // Along a leg a slope is that of the tangent plane there, and this share of the one across.
    let across = 2.0 * m / (1.0 - 2.0 * m);
    let gradient = steepest / (1.0 - across);
    let g = 2.0 * gradient * gradient;
    let s = k * (1.0 + g) / (1.0 + k * k * g);
    let aside = (g / (1.0 + g)).sqrt();
    let (before, after) = (STEP * m * aside, STEP * m * aside * k * s.max(k));
    let known = 2.0 * m < MOST_MOVED / 2.0 && g.is_finite() && before < MOST_MOVED && after < MOST_MOVED;
    if !known {
        return Slopes::between([-f64::MAX; 2], [f64::MAX; 2]);
    }
    let ratios = [(1.0 - before) / (1.0 + after), (1.0 + before) / (1.0 - after)];
    let rise = (STEP * m * (k - s).abs() + slack) / (1.0 - after);
    let bounds = |slope: f64| ratios.map(|ratio| k * slope * ratio);
    let least = low.to_array().map(|slope| bounds(slope).into_iter().fold(f64::INFINITY, f64::min) - rise);
    let most = high.to_array().map(|slope| bounds(slope).into_iter().fold(f64::NEG_INFINITY, f64::max) + rise);
    Slopes::between(least, most)
}
