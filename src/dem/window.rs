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

    /// With so many more samples on every side as a grid of `whole` columns and rows has.
    pub(crate) fn with_halo(self, halo: usize, whole: [usize; 2]) -> Self {
        let first = self.first.map(|first| first.saturating_sub(halo));
        let end = [0, 1].map(|i| (self.first[i] + self.size[i] + halo).min(whole[i]));
        Self { first, size: [0, 1].map(|i| end[i] - first[i]) }
    }
}
