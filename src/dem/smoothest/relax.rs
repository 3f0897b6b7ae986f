//! Sweeps that bend a surface less and less within its band.

use std::ops::Range;

use rayon::prelude::*;

use super::levels::{Level, clamped};

/// Share of the energy's gradient that a sweep goes: one over its largest eigenvalue.
const STEP: f32 = 1.0 / 64.0;
/// Rows that one task sweeps.
const ROWS: usize = 32;
/// Columns that are swept or left out together.
const COLUMNS: usize = 64;

/// `surface` after so many sweeps on a level.
pub(super) fn relaxed(level: &Level, mut surface: Vec<f32>, sweeps: usize, parallel: bool) -> Vec<f32> {
    let width = level.window.size[0];
    let bands = level.middle.chunks(ROWS * width).zip(level.half.chunks(ROWS * width));
    let runs: Vec<_> = bands.map(|(middle, half)| loose(middle, half, width)).collect();
    let (mut ahead, mut next) = (surface.clone(), surface.clone());
    for sweep in 0..sweeps {
        let momentum = sweep as f32 / (sweep + 3) as f32;
        let task = |(at, (surface, next)): (usize, (&mut [f32], &mut [f32]))| {
            Rows { level, ahead: &ahead, first: at * ROWS, runs: &runs[at] }.sweep(surface, next, momentum);
        };
        let length = ROWS * width;
        match parallel {
            true => surface.par_chunks_mut(length).zip(next.par_chunks_mut(length)).enumerate().for_each(task),
            false => surface.chunks_mut(length).zip(next.chunks_mut(length)).enumerate().for_each(task),
        }
        std::mem::swap(&mut ahead, &mut next);
    }
    surface
}

/// Runs of columns in which something can move.
fn loose(middle: &[f32], half: &[f32], width: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for first in (0..width).step_by(COLUMNS) {
        let columns = first..(first + COLUMNS).min(width);
        let mut rows = middle.chunks_exact(width).zip(half.chunks_exact(width));
        if rows.all(|(middle, half)| columns.clone().all(|c| is_fixed(middle[c], half[c]))) {
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.end == first => run.end = columns.end,
            _ => runs.push(columns),
        }
    }
    runs
}

/// Whether a sample stays as it is: one without a band, or a void, which would cost what a rim costs in every sweep.
fn is_fixed(middle: f32, half: f32) -> bool {
    half == 0.0 || middle.is_nan()
}

/// Rows of a level, from `first` on, and the surface ahead of which they are swept.
struct Rows<'a> {
    level: &'a Level<'a>,
    ahead: &'a [f32],
    first: usize,
    runs: &'a [Range<usize>],
}

impl Rows<'_> {
    /// One sweep: `surface` is moved, and `next` is what lies ahead of it.
    fn sweep(&self, surface: &mut [f32], next: &mut [f32], momentum: f32) {
        let width = self.level.window.size[0];
        let mut bends = [(); 3].map(|()| vec![f32::NAN; width]);
        let mut pull = vec![0.0; width];
        for run in self.runs {
            self.bend(self.first.checked_sub(1), run, &mut bends[1]);
            self.bend(Some(self.first), run, &mut bends[2]);
            let rows = surface.chunks_exact_mut(width).zip(next.chunks_exact_mut(width));
            for (r, (surface, next)) in (self.first..).zip(rows) {
                bends.rotate_left(1);
                self.bend(Some(r + 1), run, &mut bends[2]);
                let [above, here, below] = [0, 1, 2].map(|i| &bends[i][..]);
                let pull = &mut pull[run.clone()];
                self.pull([above, here, below], r, run, pull);
                let at = r * width + run.start..r * width + run.end;
                let (middle, half) = (&self.level.middle[at.clone()], &self.level.half[at.clone()]);
                let ahead = &self.ahead[at];
                advance(&mut surface[run.clone()], &mut next[run.clone()], ahead, pull, middle, half, momentum);
            }
        }
    }

    /// The Laplacian of a row about a run; NaN where a neighbour is missing.
    fn bend(&self, row: Option<usize>, run: &Range<usize>, bend: &mut [f32]) {
        let width = self.level.window.size[0];
        let rows = row.map(|row| [row.checked_sub(1), Some(row), Some(row + 1)].map(|row| self.row(row)));
        let around = run.start.saturating_sub(1)..(run.end + 1).min(width);
        let Some([Some(above), Some(here), Some(below)]) = rows else {
            return bend[around].fill(f32::NAN);
        };
        let inner = around.start.max(1)..around.end.min(width - 1);
        if inner.is_empty() {
            return;
        }
        let (west, east) = (&here[inner.start - 1..inner.end - 1], &here[inner.start + 1..inner.end + 1]);
        let (above, here, below) = (&above[inner.clone()], &here[inner.clone()], &below[inner.clone()]);
        let bend = &mut bend[inner];
        for i in 0..bend.len() {
            let at = here[i];
            bend[i] = ((above[i] - at) + (below[i] - at)) + ((west[i] - at) + (east[i] - at));
        }
    }

    /// The gradient of the energy along a run of row `r`; near edges 0 where nothing moves.
    fn pull(&self, [above, here, below]: [&[f32]; 3], r: usize, run: &Range<usize>, pull: &mut [f32]) {
        let width = here.len();
        pull.fill(f32::NAN);
        let inner = run.start.max(1)..run.end.min(width - 1);
        if !inner.is_empty() {
            let (west, east) = (&here[inner.start - 1..inner.end - 1], &here[inner.start + 1..inner.end + 1]);
            let (above, here, below) = (&above[inner.clone()], &here[inner.clone()], &below[inner.clone()]);
            let pull = &mut pull[inner.start - run.start..inner.end - run.start];
            for i in 0..pull.len() {
                pull[i] = ((above[i] + below[i]) + (west[i] + east[i])) - 4.0 * here[i];
            }
        }
        if pull.iter().any(|pull| pull.is_nan()) {
            let (middle, half) = (&self.level.middle[r * width..][..width], &self.level.half[r * width..][..width]);
            for (pull, c) in pull.iter_mut().zip(run.clone()).filter(|(pull, _)| pull.is_nan()) {
                *pull = if is_fixed(middle[c], half[c]) { 0.0 } else { self.pull_at_edge(c, r) };
            }
        }
    }

    /// The gradient at a sample where some of its second differences have no samples.
    fn pull_at_edge(&self, c: usize, r: usize) -> f32 {
        let at = |dc: isize, dr: isize| {
            let c = c.checked_add_signed(dc)?;
            let height = *self.row(r.checked_add_signed(dr))?.get(c)?;
            Some(height).filter(|height| !height.is_nan())
        };
        // Twice the sample in the middle of a second difference, or once at either end.
        let bend = |step: isize, [dc, dr]: [isize; 2]| {
            let along = |k: isize| at((step + k) * dc, (step + k) * dr);
            Some((along(-1)? - along(0)?) + (along(1)? - along(0)?))
        };
        let twist = |dc: isize, dr: isize| Some((at(0, 0)? - at(dc, 0)?) - (at(0, dr)? - at(dc, dr)?));
        let mut pull = 0.0;
        for way in [[1, 0], [0, 1]] {
            let [before, here, after] = [-1, 0, 1].map(|step| bend(step, way).unwrap_or_default());
            pull += (before + after) - 2.0 * here;
        }
        for (dc, dr) in [(-1, -1), (1, -1), (-1, 1), (1, 1)] {
            pull += 2.0 * twist(dc, dr).unwrap_or_default();
        }
        pull
    }

    fn row(&self, row: Option<usize>) -> Option<&[f32]> {
        self.ahead.chunks_exact(self.level.window.size[0]).nth(row?)
    }
}

/// Moves a row of the surface against `pull` from what lay ahead of it, within the band.
fn advance(
    surface: &mut [f32],
    next: &mut [f32],
    ahead: &[f32],
    pull: &[f32],
    middle: &[f32],
    half: &[f32],
    momentum: f32,
) {
    let length = surface.len();
    let (next, ahead, pull) = (&mut next[..length], &ahead[..length], &pull[..length]);
    let (middle, half) = (&middle[..length], &half[..length]);
    for i in 0..length {
        let moved = clamped(ahead[i] - STEP * pull[i], middle[i], half[i]);
        next[i] = moved + momentum * (moved - surface[i]);
        surface[i] = moved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::window::Window;

    #[test]
    fn voids_cost_no_look_at_their_neighbours() {
        let size = [2 * COLUMNS + 3, ROWS];
        // Nothing but voids and exact heights in the middle block of columns.
        let middle: Vec<_> = (0..size[0] * size[1])
            .map(|i| match (i % size[0], i / size[0]) {
                (c, r) if (COLUMNS..2 * COLUMNS).contains(&c) && r != 3 => f32::NAN,
                (c, r) => (c * c % 7 + r * r % 5) as f32,
            })
            .collect();
        let in_block = |i: usize| (COLUMNS..2 * COLUMNS).contains(&(i % size[0]));
        let half: Vec<_> = (0..middle.len()).map(|i| if in_block(i) && i / size[0] == 3 { 0.0 } else { 0.5 }).collect();
        assert_eq!(loose(&middle, &half, size[0]), [0..COLUMNS, 2 * COLUMNS..size[0]]);

        let level = Level::finest(&middle, &half, Window { first: [0, 0], size });
        let rows = Rows { level: &level, ahead: &middle, first: 0, runs: &[] };
        let (missing, mut pull) = (vec![f32::NAN; size[0]], vec![0.0; size[0]]);
        rows.pull([&missing; 3], 2, &(0..size[0]), &mut pull);
        assert!((0..size[0]).all(|c| (pull[c] == 0.0) == in_block(c)), "{pull:?}");
    }
}
