//! How the samples of one grid lie to those of another: on the same places, or between them.

use glam::DVec2;

use super::crs::CrsPath;
use super::grid::{GeoGrid, span};

/// How far, in cells, samples may lie from those of the first file and still count as the same places.
pub(super) const ALIGNED_CELLS: f64 = 0.01;

/// How the samples of a file lie to those of the layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lie {
    /// The same places, from this column and row on, read backwards where flipped.
    Aligned { first: [i64; 2], flip: [bool; 2] },
    /// Between them, in these columns and rows (first and beyond the last).
    Apart { first: [i64; 2], end: [i64; 2] },
}

impl Lie {
    /// Of `grid` to `base`; `None` where no way leads from one system to the other.
    pub(super) fn of(grid: &GeoGrid, base: &GeoGrid) -> Option<Self> {
        let own = grid.whole().outline();
        let mut places = grid.outline(grid.whole());
        CrsPath::between(&grid.crs, &base.crs)?.carry(&mut places);
        base.pixels(&mut places);
        if places.iter().any(|place| !place.is_finite()) {
            return None;
        }
        let [low, high] = span(&places);
        let size = DVec2::new(grid.columns as f64, grid.rows as f64);
        let first = (low - 0.5).round();
        let [flip_x, flip_y] = [places[3].x < places[0].x, places[1].y < places[0].y];
        let aligned = places.iter().zip(own).all(|(place, own)| {
            let x = if flip_x { size.x - own.x } else { own.x };
            let y = if flip_y { size.y - own.y } else { own.y };
            (*place - first - DVec2::new(x, y)).abs().max_element() <= ALIGNED_CELLS
        });
        if aligned {
            return Some(Self::Aligned { first: [first.x as i64, first.y as i64], flip: [flip_x, flip_y] });
        }
        // Places of the base between the outermost samples; where there are none the layer need not grow.
        let (low, high) = ((low - 0.5).ceil(), (high + 0.5).floor());
        let grows = low.cmplt(high).all();
        let (low, high) = if grows { (low, high) } else { (DVec2::ZERO, DVec2::ZERO) };
        Some(Self::Apart { first: [low.x as i64, low.y as i64], end: [high.x as i64, high.y as i64] })
    }

    /// First column and row, and those beyond the last, of `grid` that lies so.
    pub(super) fn bounds(self, grid: &GeoGrid) -> ([i64; 2], [i64; 2]) {
        match self {
            Self::Aligned { first, .. } => (first, [first[0] + grid.columns as i64, first[1] + grid.rows as i64]),
            Self::Apart { first, end } => (first, end),
        }
    }

    /// The same, counted from `low`.
    pub(super) fn moved(self, low: [i64; 2]) -> Self {
        let moved = |at: [i64; 2]| [at[0] - low[0], at[1] - low[1]];
        match self {
            Self::Aligned { first, flip } => Self::Aligned { first: moved(first), flip },
            Self::Apart { first, end } => Self::Apart { first: moved(first), end: moved(end) },
        }
    }
}
