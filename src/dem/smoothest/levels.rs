//! Middles and halves of a band, sample by sample and block by block.

use std::borrow::Cow;

use crate::dem::window::Window;

/// The band on one level.
#[derive(Debug)]
pub(super) struct Level<'a> {
    /// Which of the level's blocks.
    pub window: Window,
    /// Metres in the middle of the band, NaN where there is no sample.
    pub middle: Cow<'a, [f32]>,
    /// Metres from there to its edges.
    pub half: Cow<'a, [f32]>,
}

impl<'a> Level<'a> {
    /// The samples themselves.
    pub(super) fn finest(heights: &'a [f32], half: &'a [f32], window: Window) -> Self {
        Self { window, middle: Cow::Borrowed(heights), half: Cow::Borrowed(half) }
    }

    /// The level of blocks of 2 x 2 of this one.
    pub(super) fn coarser(&self) -> Level<'static> {
        let (middle, half) = (self.halved(&self.middle), self.halved(&self.half));
        Level { window: halved(self.window), middle: Cow::Owned(middle), half: Cow::Owned(half) }
    }

    /// Means of `values` over what is there of blocks of 2 x 2.
    pub(super) fn halved(&self, values: &[f32]) -> Vec<f32> {
        let (fine, coarse) = (self.window, halved(self.window));
        let mut means = Vec::with_capacity(coarse.size[0] * coarse.size[1]);
        for r in 0..coarse.size[1] {
            let rows = inside(2 * (coarse.first[1] + r), fine.first[1], fine.size[1]);
            for c in 0..coarse.size[0] {
                let columns = inside(2 * (coarse.first[0] + c), fine.first[0], fine.size[0]);
                let places = rows.clone().flat_map(|r| columns.clone().map(move |c| r * fine.size[0] + c));
                let there = places.filter(|at| !self.middle[*at].is_nan());
                let (sum, count) = there.fold((0.0, 0.0), |(sum, count), at| (sum + values[at], count + 1.0));
                means.push(sum / count);
            }
        }
        means
    }

    /// A surface on this level's blocks at the places of a finer `window`: parabolas through three neighbours, along rows,
    /// then along columns.
    pub(super) fn refined(&self, surface: &[f32], window: Window) -> Vec<f32> {
        let coarse = self.window;
        let mut rows = Vec::with_capacity(window.size[0] * coarse.size[1]);
        for row in surface.chunks_exact(coarse.size[0]) {
            rows.extend((0..window.size[0]).map(|c| {
                let (at, side) = place(c + window.first[0], coarse.first[0]);
                let near = |at: usize| row.get(at).copied().unwrap_or(f32::NAN);
                between(near(at.wrapping_sub(1)), near(at), near(at + 1), side)
            }));
        }
        let mut fine = Vec::with_capacity(window.size[0] * window.size[1]);
        let nothing = vec![f32::NAN; window.size[0]];
        for r in 0..window.size[1] {
            let (at, side) = place(r + window.first[1], coarse.first[1]);
            let row = |at: usize| rows.chunks_exact(window.size[0]).nth(at).unwrap_or(&nothing);
            let (above, row, below) = (row(at.wrapping_sub(1)), row(at), row(at + 1));
            fine.extend(above.iter().zip(row).zip(below).map(|((a, m), b)| between(*a, *m, *b, side)));
        }
        fine
    }

    /// A surface moved into the band; no surface where there is no band.
    pub(super) fn within(&self, mut surface: Vec<f32>) -> Vec<f32> {
        for ((height, middle), half) in surface.iter_mut().zip(&*self.middle).zip(&*self.half) {
            *height = if middle.is_nan() { f32::NAN } else { clamped(*height, *middle, *half) };
        }
        surface
    }
}

/// A height moved into a band; NaN stays.
pub(super) fn clamped(height: f32, middle: f32, half: f32) -> f32 {
    let (low, high) = (middle - half, middle + half);
    let height = if height < low { low } else { height };
    if height > high { high } else { height }
}

/// The blocks of 2 x 2 that a window meets.
fn halved(window: Window) -> Window {
    let first = window.first.map(|first| first / 2);
    Window { first, size: [0, 1].map(|i| (window.first[i] + window.size[i]).div_ceil(2) - first[i]) }
}

/// Which of the two places from `at` on a window has, counted in it.
fn inside(at: usize, first: usize, size: usize) -> std::ops::Range<usize> {
    at.saturating_sub(first)..(at + 2 - first).min(size)
}

/// The block of a place, counted from the first one, and on which side of its middle the place lies.
fn place(at: usize, first: usize) -> (usize, bool) {
    (at / 2 - first, at % 2 == 1)
}

/// A quarter of the way from `middle` to one of its neighbours, `after` or else `before`, along the parabola through all
/// three; a straight line where one is missing.
fn between(before: f32, middle: f32, after: f32, to_after: bool) -> f32 {
    let (near, far) = if to_after { (after, before) } else { (before, after) };
    let (near, far) = (near - middle, far - middle);
    match (near.is_nan(), far.is_nan()) {
        (false, false) => middle + 0.15625 * near - 0.09375 * far,
        (false, true) => middle + 0.25 * near,
        (true, false) => middle - 0.25 * far,
        (true, true) => middle,
    }
}
