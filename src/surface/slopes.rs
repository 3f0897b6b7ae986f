//! Slopes in a byte each: enough to tell that all facets of a square face one way.

use bytemuck::{Pod, Zeroable};
use glam::DVec2;

/// Between which slopes the sides of facets along east and along north lie over a square, rounded outwards:
/// s = q / (127 - |q|) dz/d east and dz/d north. On steep and rough land control points lie aside, and a facet may lean a
/// little more.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct Slopes {
    low: [i8; 2],
    high: [i8; 2],
}

impl Slopes {
    /// None known.
    pub(super) const NONE: Self = Self { low: [i8::MAX; 2], high: [i8::MIN; 2] };

    /// Between these.
    pub(super) fn between(low: [f64; 2], high: [f64; 2]) -> Self {
        let coded = |slope: f64| 127.0 * slope / (1.0 + slope.abs());
        Self { low: low.map(|slope| coded(slope).floor() as i8), high: high.map(|slope| coded(slope).ceil() as i8) }
    }

    /// Of these and others.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1].map(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// Lowest and highest slopes: dz/d east, dz/d north.
    pub(super) fn range(self) -> [DVec2; 2] {
        let decoded = |q: i8| f64::from(q) / (127.0 - f64::from(q).abs()).max(1e-9);
        [self.low, self.high].map(|slopes| DVec2::from(slopes.map(decoded)))
    }
}
