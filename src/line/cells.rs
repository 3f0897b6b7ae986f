//! Places of the page by cells, to look up what lies near.
//!
//! Cost: two passes over the places. Memory: 8 bytes a place, at most twice as many cells as places.

use std::ops::Range;

use glam::Vec2;

/// Least side of a cell, px.
const LEAST_CELL: f32 = 2.0;

/// Places by cells of the page.
pub(super) struct Cells {
    low: Vec2,
    side: f32,
    columns: usize,
    rows: usize,
    /// Where each cell's places begin in `list`, and where the last ends.
    starts: Vec<u32>,
    /// Numbers of places, cell by cell in reading order.
    pub list: Vec<u32>,
}

impl Cells {
    /// Sorts places in; those up to `reach` px from another are in the cells about it.
    pub(super) fn new(places: &[Vec2], reach: f32) -> Self {
        let low = places.iter().copied().reduce(Vec2::min).unwrap_or_default();
        let size = places.iter().copied().reduce(Vec2::max).unwrap_or_default() - low;
        // No more cells than twice the places, however large the page.
        let fewest = (size.x * size.y / (2.0 * places.len() as f32 + 1.0)).sqrt().max(size.max_element() / 10_000.0);
        let side = reach.max(fewest).max(LEAST_CELL);
        let [columns, rows] = [size.x, size.y].map(|size| (size / side) as usize + 1);
        let mut cells =
            Self { low, side, columns, rows, starts: vec![0; columns * rows + 1], list: vec![0; places.len()] };
        let of: Vec<usize> =
            places.iter().map(|place| cells.at(*place)).map(|[column, row]| row * columns + column).collect();
        of.iter().for_each(|cell| cells.starts[cell + 1] += 1);
        (0..columns * rows).for_each(|cell| cells.starts[cell + 1] += cells.starts[cell]);
        let mut ends = cells.starts.clone();
        for (i, cell) in (0..).zip(of) {
            cells.list[ends[cell] as usize] = i;
            ends[cell] += 1;
        }
        cells
    }

    /// Column and row of a place.
    fn at(&self, place: Vec2) -> [usize; 2] {
        let at = ((place - self.low) / self.side).to_array();
        [(at[0] as usize).min(self.columns - 1), (at[1] as usize).min(self.rows - 1)]
    }

    /// Where in the list are the places in the cell of a place and in the 8 about it, row by row.
    pub(super) fn about(&self, place: Vec2) -> impl Iterator<Item = Range<usize>> {
        let [column, row] = self.at(place);
        let columns = [column.saturating_sub(1), (column + 2).min(self.columns)];
        let start = move |row: usize, column: usize| self.starts[row * self.columns + column] as usize;
        let rows = row.saturating_sub(1)..(row + 2).min(self.rows);
        rows.map(move |row| start(row, columns[0])..start(row, columns[1]))
    }
}
