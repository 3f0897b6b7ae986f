//! A first guess: heights between the places where they change.
//!
//! Along each of the four lines through a sample (west-east, north-south, both diagonals) the nearest changes of height are
//! looked for to either side. Where heights change the surface crosses the edge of the band, so that on a line that rises on
//! one side and falls on the other the height follows linearly. Steep lines count more, by the square of their steepness,
//! as one reads a contour map. On a line that rises or falls to both sides the height goes back to the middle of the
//! band by a parabola; where there is a change on one side only, by a line of length [`REACH`].
//!
//! Cost: eight scans over tiles with the reach around them. Not handled: a bend of the contours between two lines.

use std::ops::Range;

use rayon::prelude::*;

/// Samples along a line in which changes are looked for.
pub(super) const REACH: usize = 28;
/// Weight of a line that rises, or falls, to both sides.
const SAME: f32 = 0.1;
/// Columns and rows of a tile.
const TILE: usize = 192;

/// A surface within `half` of `heights`, guessed.
pub(super) fn between(heights: &[f32], half: &[f32], width: usize, parallel: bool) -> Vec<f32> {
    let mut guess = vec![f32::NAN; heights.len()];
    let task = |(at, rows): (usize, &mut [f32])| {
        for first in (0..width).step_by(TILE) {
            ContourTile::new(heights, half, width, [first, at * TILE]).fill(rows);
        }
    };
    match parallel {
        true => guess.par_chunks_mut(TILE * width).enumerate().for_each(task),
        false => guess.chunks_mut(TILE * width).enumerate().for_each(task),
    }
    guess
}

/// Some samples with those around them that they depend on.
struct ContourTile<'a> {
    heights: &'a [f32],
    half: &'a [f32],
    width: usize,
    /// Rows and columns that are guessed.
    rows: Range<usize>,
    columns: Range<usize>,
    /// The same with those around them.
    around: [Range<usize>; 2],
}

/// Signed samples to the nearest change along a row's lines, 0 where there is none: positive where heights rise.
type Changes = [Vec<f32>; 3];

impl<'a> ContourTile<'a> {
    fn new(heights: &'a [f32], half: &'a [f32], width: usize, [c, r]: [usize; 2]) -> Self {
        let height = heights.len() / width;
        let (columns, rows) = (c..(c + TILE).min(width), r..(r + TILE).min(height));
        let around = |range: &Range<usize>, end: usize| range.start.saturating_sub(REACH)..(range.end + REACH).min(end);
        let around = [around(&columns, width), around(&rows, height)];
        Self { heights, half, width, rows, columns, around }
    }

    /// Guesses the tile's samples; `rows` are whole rows of the guess, from the tile's first one on.
    fn fill(&self, rows: &mut [f32]) {
        let [columns, around] = &self.around;
        let none = || [(); 3].map(|()| vec![0.0; columns.len()]);
        let mut above: Vec<Changes> = Vec::with_capacity(self.rows.end - around.start);
        for r in around.start..self.rows.end {
            let beyond = r.checked_sub(1).filter(|r| around.contains(r));
            let mut changes = none();
            self.look(r, beyond.map(|r| (r, above.last())), &mut changes);
            above.push(changes);
        }
        let (mut below, mut next) = (none(), none());
        let [mut west, mut east] = [(); 2].map(|()| vec![0.0; columns.len()]);
        for r in around.clone().rev().take_while(|r| *r >= self.rows.start) {
            let beyond = Some(r + 1).filter(|r| around.contains(r));
            self.look(r, beyond.map(|r| (r, Some(&below))), &mut next);
            std::mem::swap(&mut below, &mut next);
            if self.rows.contains(&r) {
                self.look_along(r, &mut west, &mut east);
                let [north, north_west, north_east] = &above[r - around.start];
                let [south, south_west, south_east] = &below;
                let diagonal = std::f32::consts::SQRT_2;
                let lines = [
                    (&west, &east, 1.0),
                    (north, south, 1.0),
                    (north_west, south_east, diagonal),
                    (north_east, south_west, diagonal),
                ];
                let first = (r - self.rows.start) * self.width;
                self.guess(r, lines, &mut rows[first + self.columns.start..first + self.columns.end]);
            }
        }
    }

    /// Changes of row `r` towards the row `beyond`: straight, to the west and to the east of it.
    fn look(&self, r: usize, beyond: Option<(usize, Option<&Changes>)>, changes: &mut Changes) {
        let Some((beyond, Some(far))) = beyond else {
            return changes.iter_mut().for_each(|changes| changes.fill(0.0));
        };
        let ([here, half], [there, there_half]) = (self.row(r), self.row(beyond));
        let last = here.len() - 1;
        let [straight, west, east] = changes;
        follow(straight, [here, half], [there, there_half, &far[0]]);
        west[0] = 0.0;
        follow(&mut west[1..], [&here[1..], &half[1..]], [&there[..last], &there_half[..last], &far[1][..last]]);
        east[last] = 0.0;
        follow(&mut east[..last], [&here[..last], &half[..last]], [&there[1..], &there_half[1..], &far[2][1..]]);
    }

    /// Changes of row `r` along itself.
    fn look_along(&self, r: usize, west: &mut [f32], east: &mut [f32]) {
        let [here, half] = self.row(r);
        let last = here.len() - 1;
        (west[0], east[last]) = (0.0, 0.0);
        for i in 1..=last {
            west[i] = change([here[i], half[i]], [here[i - 1], half[i - 1]], west[i - 1]);
        }
        for i in (0..last).rev() {
            east[i] = change([here[i], half[i]], [here[i + 1], half[i + 1]], east[i + 1]);
        }
    }

    /// Heights of row `r` from the changes along its lines, to either side, with the length of a line's step.
    fn guess(&self, r: usize, lines: [(&Vec<f32>, &Vec<f32>, f32); 4], guess: &mut [f32]) {
        let (mut sums, mut weights) = (vec![0.0; guess.len()], vec![0.0; guess.len()]);
        let skipped = self.columns.start - self.around[0].start;
        let part = skipped..skipped + guess.len();
        for (one, other, step) in lines {
            let changes = one[part.clone()].iter().zip(&other[part.clone()]);
            for ((sum, weight), (one, other)) in sums.iter_mut().zip(&mut weights).zip(changes) {
                let (share, counts) = along(one * step, other * step);
                *sum += counts * share;
                *weight += counts;
            }
        }
        let [here, half] = self.row(r).map(|row| &row[part.clone()]);
        for (i, guess) in guess.iter_mut().enumerate() {
            let share = if weights[i] > 0.0 { sums[i] / weights[i] } else { 0.0 };
            *guess = here[i] + half[i] * share;
        }
    }

    /// Heights and halves of a row of the tile with what lies around it.
    fn row(&self, r: usize) -> [&'a [f32]; 2] {
        let part = r * self.width + self.around[0].start..r * self.width + self.around[0].end;
        [&self.heights[part.clone()], &self.half[part]]
    }
}

/// [`change`] for a row.
fn follow(changes: &mut [f32], [here, half]: [&[f32]; 2], [there, there_half, far]: [&[f32]; 3]) {
    let length = changes.len();
    let (here, half) = (&here[..length], &half[..length]);
    let (there, there_half, far) = (&there[..length], &there_half[..length], &far[..length]);
    for i in 0..length {
        changes[i] = change([here[i], half[i]], [there[i], there_half[i]], far[i]);
    }
}

/// Signed samples from one sample to the nearest change of height beyond its neighbour, for which they are `far`.
fn change([here, half]: [f32; 2], [there, there_half]: [f32; 2], far: f32) -> f32 {
    let rise = there - here;
    let further = far + 1f32.copysign(far);
    let further = if far != 0.0 && further.abs() <= REACH as f32 { further } else { 0.0 };
    let share = half / rise.abs();
    let share = if share < 1.0 { share } else { 1.0 };
    let crossed = if rise.abs() > 0.0 { share.copysign(rise) } else { 0.0 };
    if rise == 0.0 && half == there_half { further } else { crossed }
}

/// The height on a line as a share of the band's half, and its weight, from the signed distances of the changes to either
/// side.
fn along(one: f32, other: f32) -> (f32, f32) {
    let (reach, kind) = (REACH as f32, one * other);
    let length = one.abs() + other.abs();
    let off = (other.abs() - one.abs()) / length;
    let alone = if length < reach { 1.0 - length / reach } else { 0.0 };
    let share = if kind < 0.0 {
        off
    } else if kind > 0.0 {
        off * off
    } else {
        alone
    };
    let sign = if kind == 0.0 { one + other } else { one };
    let share = if length > 0.0 { share.copysign(share * sign) } else { 0.0 };
    let base = if kind == 0.0 { length + reach } else { length };
    let counts = if kind > 0.0 { SAME } else { 1.0 };
    let counts = if length > 0.0 { counts } else { 0.0 };
    (share, counts / (base * base))
}
