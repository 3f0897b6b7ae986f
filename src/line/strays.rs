//! Where the chains of a page and its mask do not tell of the same lines.
//!
//! Cost: nine look-ups for each pixel of either.

use rustc_hash::FxHashSet;

use super::{Chain, Marks, one_pixel_wide};

/// Pixels of the smallest set of ink that counts as a line.
pub(crate) const LEAST: usize = 6;

/// Pixels of lines that one of the two has alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Strays {
    /// Of chains, one pixel wide, without ink in them or beside them.
    pub chains: usize,
    /// Of 8-connected sets of at least 6 inked pixels, in which and beside which no chain runs.
    pub ink: usize,
}

impl Strays {
    /// Compares the visible chains of a page with its mask.
    pub fn of(chains: &[Chain], mask: &Marks) -> Self {
        let drawn = one_pixel_wide(chains, [mask.width, mask.height]);
        let alone = places(&drawn).into_iter().filter(|at| !is_beside(mask, *at)).count();
        Self { chains: alone, ink: without_chain(&drawn, mask).map(|set| set.len()).sum() }
    }
}

/// The ink of a mask that is a line, and in which and beside which none of the chains runs.
pub(crate) fn unchained(chains: &[Chain], mask: &Marks) -> Marks {
    let size = [mask.width, mask.height];
    let drawn = one_pixel_wide(chains, size);
    let sets = without_chain(&drawn, mask);
    Marks::new(size, sets.flatten().filter_map(|[x, y]| mask.at(x, y).copied()).collect())
}

/// The 8-connected sets of ink that count as lines without one that is drawn.
fn without_chain(drawn: &Marks, mask: &Marks) -> impl Iterator<Item = Vec<[i64; 2]>> {
    let sets = connected(&places(mask)).into_iter().filter(|set| set.len() >= LEAST);
    sets.filter(|set| !set.iter().any(|at| is_beside(drawn, *at)))
}

fn places(marks: &Marks) -> Vec<[i64; 2]> {
    marks.places().map(|at| at.map(i64::from)).collect()
}

/// Whether a pixel is inked, or one beside it.
fn is_beside(marks: &Marks, at: [i64; 2]) -> bool {
    around(at).any(|[x, y]| is_ink(marks, x, y))
}

fn is_ink(marks: &Marks, column: i64, row: i64) -> bool {
    marks.at(column, row).is_some_and(|mark| mark.pixel.is_ink())
}

/// A pixel and its 8 neighbours.
pub(crate) fn around([x, y]: [i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    (y - 1..=y + 1).flat_map(move |row| (x - 1..=x + 1).map(move |column| [column, row]))
}

/// 8-connected sets of pixels.
pub(crate) fn connected(pixels: &[[i64; 2]]) -> Vec<Vec<[i64; 2]>> {
    let mut left: FxHashSet<[i64; 2]> = pixels.iter().copied().collect();
    let mut sets = Vec::new();
    for first in pixels {
        if !left.remove(first) {
            continue;
        }
        let mut set = vec![*first];
        let mut next = 0;
        while let Some(at) = set.get(next).copied() {
            set.extend(around(at).filter(|beside| left.remove(beside)));
            next += 1;
        }
        sets.push(set);
    }
    sets
}
