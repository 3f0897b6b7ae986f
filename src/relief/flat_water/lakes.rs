//! Lakes among what is level on land: a bench of a lava field or the tread of a terrace is level, too, but narrow, and what
//! lies about it hardly rises.
//!
//! Method: water that hangs together is kept where it is wide for its shore, or most of its shore is steep. On seven DEMs of 10
//! to 100 m lakes are from 6.4 samples wide, and three benches out of fifty more than 6. Cost: one look at the water. Not handled: playas and levelled
//! fields, which are as wide as lakes.

use super::FlatWater;
use super::levelled::four;

/// Samples times four for each side of the shore, from which on water is a lake: a square of so many samples a side.
const WIDE: usize = 6;
/// Rise of a steep shore, and samples in which it is looked for.
const STEEP: f64 = 0.05;
const REACH: usize = 2;

impl FlatWater {
    /// Without what is no lake; water at 0 stays, it is the sea. `heights`: of all samples, water level; `across`: exaggerated
    /// metres between columns.
    pub(super) fn without_benches(mut self, heights: &[f32], across: f64) -> Self {
        let (columns, steep) = (self.columns, (STEEP * across * REACH as f64) as f32);
        let mut seen = vec![0_u64; self.words.len()];
        let (mut body, mut open) = (Vec::new(), Vec::new());
        for start in 0..heights.len() {
            if !bit(&self.words, start) || bit(&seen, start) || heights[start] == 0.0 {
                continue;
            }
            body.clear();
            set(&mut seen, start);
            open.push(start);
            let (mut sides, mut steep_sides) = (0, 0);
            while let Some(i) = open.pop() {
                body.push(i);
                for other in four(i, columns, heights.len()) {
                    if !bit(&self.words, other) {
                        sides += 1;
                        // Beyond the DEM, or around its edge, nothing is steep.
                        let beyond =
                            (other * REACH).checked_sub(i * (REACH - 1)).and_then(|beyond| heights.get(beyond));
                        steep_sides += usize::from(beyond.is_some_and(|height| height - heights[i] >= steep));
                    } else if !bit(&seen, other) {
                        set(&mut seen, other);
                        open.push(other);
                    }
                }
            }
            if 4 * body.len() < WIDE * sides && 2 * steep_sides < sides {
                body.iter().for_each(|i| self.words[i / 64] &= !(1 << (i % 64)));
            }
        }
        self
    }
}

fn bit(words: &[u64], i: usize) -> bool {
    words[i / 64] >> (i % 64) & 1 == 1
}

fn set(words: &mut [u64], i: usize) {
    words[i / 64] |= 1 << (i % 64);
}
