//! Elevations of a rectangle of samples, in memory.

use rayon::prelude::*;

use super::window::Window;

/// Words of validity that one core makes at a time: 65 536 samples.
const WORDS: usize = 2048;

/// Heights and validity of a rectangle of a DEM's samples. Columns and rows count from the DEM's north-west corner, not
/// from the rectangle's. Memory: 4 1/8 bytes a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    window: Window,
    heights: Vec<f32>,
    valid: Vec<u32>,
}

impl Samples {
    /// `heights` of all samples of `window`, row-major; those that are not finite are voids.
    pub(super) fn new(window: Window, mut heights: Vec<f32>) -> Self {
        let word = |heights: &mut [f32]| {
            heights.iter_mut().enumerate().fold(0, |word, (bit, height)| {
                let valid = height.is_finite();
                *height = if valid { *height } else { 0.0 };
                word | u32::from(valid) << bit
            })
        };
        let valid = heights.par_chunks_mut(32).with_min_len(WORDS).map(word).collect();
        Self { window, heights, valid }
    }

    /// Column and row of its north-west sample.
    pub fn first(&self) -> [usize; 2] {
        self.window.first
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.window.size
    }

    /// Exaggerated metres, row-major from the north-west; 0 at voids.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Whether each sample holds an elevation: bit `i % 32` of word `i / 32`, `i` counting as in `heights`.
    pub fn valid(&self) -> &[u32] {
        &self.valid
    }

    /// Exaggerated metres of sample (c, r), `None` at a void and outside.
    pub fn height(&self, c: usize, r: usize) -> Option<f32> {
        let i = self.index(c, r)?;
        self.is_valid(i).then(|| self.heights[i])
    }

    /// Exaggerated metres of the rectangle's samples of row `r`, 0 at voids; nothing outside.
    pub fn row(&self, r: usize) -> &[f32] {
        let first = self.index(self.window.first[0], r);
        first.map_or(&[], |first| &self.heights[first..first + self.window.size[0]])
    }

    /// Exaggerated metres of the samples of row `r` from column `c` on, `None` at voids; nothing outside.
    pub fn row_from(&self, c: usize, r: usize) -> impl Iterator<Item = Option<f32>> {
        let (first, end) = match self.index(c, r) {
            Some(first) => (first, first + self.window.size[0] - (c - self.window.first[0])),
            None => (0, 0),
        };
        (first..end).map(|i| self.is_valid(i).then(|| self.heights[i]))
    }

    /// How many samples are void.
    pub fn voids(&self) -> usize {
        let valid: usize = self.valid.par_iter().with_min_len(WORDS).map(|word| word.count_ones() as usize).sum();
        self.heights.len() - valid
    }

    /// Which of its two patches (NW, SW, SE) and (NW, SE, NE) each cell between rows `r` and `r + 1` has, from the west:
    /// those whose corners all hold an elevation. One less than the columns; nothing where one of the rows is outside.
    pub fn patches(&self, r: usize) -> impl Iterator<Item = [bool; 2]> {
        let row = |r: usize| self.index(self.window.first[0], r);
        let (north, south, cells) = match (row(r), row(r.wrapping_add(1))) {
            (Some(north), Some(south)) => (north, south, self.window.size[0] - 1),
            _ => (0, 0, 0),
        };
        (0..cells).map(move |c| {
            let diagonal = self.is_valid(north + c) && self.is_valid(south + c + 1);
            [diagonal && self.is_valid(south + c), diagonal && self.is_valid(north + c + 1)]
        })
    }

    /// Of the 64 samples of row `r` from column `c` on those that hold an elevation, the first in the lowest bit; none
    /// outside.
    pub(super) fn valid_from(&self, c: usize, r: usize) -> u64 {
        let Some(first) = self.index(c, r) else { return 0 };
        let word = |k: usize| u64::from(self.valid.get(first / 32 + k).copied().unwrap_or(0));
        let (here, shift) = (word(0) | word(1) << 32, first % 32);
        let bits = if shift == 0 { here } else { here >> shift | word(2) << (64 - shift) };
        let left = self.window.size[0] - (c - self.window.first[0]);
        if left < 64 { bits & ((1 << left) - 1) } else { bits }
    }

    /// The heights of a window, NaN at voids and outside.
    pub(super) fn part(&self, window: Window) -> Vec<f32> {
        let mut heights = vec![f32::NAN; window.samples() as usize];
        let west = window.first[0].max(self.window.first[0]);
        for (row, heights) in heights.chunks_exact_mut(window.size[0].max(1)).enumerate() {
            let from = self.row_from(west, window.first[1] + row);
            let onto = heights.iter_mut().skip(west - window.first[0]);
            onto.zip(from).for_each(|(onto, height)| *onto = height.unwrap_or(f32::NAN));
        }
        heights
    }

    /// Place of a sample in `heights`.
    fn index(&self, c: usize, r: usize) -> Option<usize> {
        let Window { first, size } = self.window;
        let [c, r] = [c.wrapping_sub(first[0]), r.wrapping_sub(first[1])];
        (c < size[0] && r < size[1]).then(|| r * size[0] + c)
    }

    fn is_valid(&self, i: usize) -> bool {
        self.valid[i / 32] >> (i % 32) & 1 == 1
    }
}
