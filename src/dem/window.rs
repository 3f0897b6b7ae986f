//! A rectangle of samples.

/// A rectangle of samples inside a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column and row.
    pub first: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Window {
    /// How many samples.
    pub fn samples(self) -> u64 {
        self.size[0] as u64 * self.size[1] as u64
    }
}
