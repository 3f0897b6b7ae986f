//! Where samples lie in arrays that have a frame of voids about them, so that no neighbour is ever outside.

use glam::DVec2;

/// Columns and rows of the eight neighbours, from the east clockwise; that across from `k` is `(k + 4) % 8`.
pub(crate) const AROUND: [[isize; 2]; 8] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];

/// Size and cells of a grid whose arrays have one sample more on every side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramedGrid {
    /// Columns and rows without the frame.
    pub size: [usize; 2],
    /// Metres between columns and between rows.
    pub cell: DVec2,
}

impl FramedGrid {
    /// Samples between one and that south of it.
    pub fn stride(self) -> usize {
        self.size[0] + 2
    }

    /// Samples of an array, its frame included.
    pub fn samples(self) -> usize {
        self.stride() * (self.size[1] + 2)
    }

    /// Where the sample at a column and row lies in an array.
    pub fn index(self, [c, r]: [usize; 2]) -> usize {
        (r + 1) * self.stride() + c + 1
    }

    /// Column and row of a sample that is not of the frame.
    pub fn place(self, i: usize) -> [usize; 2] {
        [i % self.stride() - 1, i / self.stride() - 1]
    }

    /// The same as a place on the map of the DEM.
    pub fn at(self, i: usize) -> DVec2 {
        let [c, r] = self.place(i);
        DVec2::new(c as f64, r as f64)
    }

    /// Where the samples of a row lie.
    pub fn row(self, r: usize) -> std::ops::Range<usize> {
        let first = self.index([0, r]);
        first..first + self.size[0]
    }

    /// All samples that are not of the frame, by rows.
    pub fn indices(self) -> impl Iterator<Item = usize> {
        (0..self.size[1]).flat_map(move |r| self.row(r))
    }

    /// From a sample to each of its neighbours, as a number to add and wrap.
    pub fn steps(self) -> [usize; 8] {
        AROUND.map(|[c, r]| (r * self.stride() as isize + c) as usize)
    }

    /// Metres to each neighbour.
    pub fn distances(self) -> [f64; 8] {
        AROUND.map(|[c, r]| (DVec2::new(c as f64, r as f64) * self.cell).length())
    }

    /// Square metres of a cell.
    pub fn area(self) -> f64 {
        self.cell.x * self.cell.y
    }

    /// Side of a square of that area, metres.
    pub fn side(self) -> f64 {
        self.area().sqrt()
    }

    /// The nearest place on the map of the DEM that is not outside.
    pub fn within(self, at: DVec2) -> DVec2 {
        at.clamp(DVec2::ZERO, DVec2::new(self.size[0] as f64, self.size[1] as f64) - 1.0)
    }
}
