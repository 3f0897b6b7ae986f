//! Lines laid on the surface from above: the height of its patches over a place of the map, in closed form.
//!
//! Method: of the patches about a place the one over it is found by Newton's method on its barycentric weights, for patches bend
//! sideways a little; a place beside all of them, as at a rim that bends inwards, goes to their nearest side. Pieces of a line are cut
//! where they leave a cell or a triangle of one, then halved until the surface over their quarters lies within a tolerance of them.
//! Cost: some microseconds a place. Does not handle: folds, of which one sheet is taken.

use std::cell::RefCell;

use glam::{DMat2, DVec2, DVec3};

use super::lattice::patch_exists;
use super::patch::{Corner, Patch, Surface};
use crate::error::Result;

/// Steps of Newton's method, and how near it comes, in cells.
const STEPS: usize = 24;
const NEAR: f64 = 1e-9;
/// How far beside a patch a place still lies over it, as a weight.
const BESIDE: f64 = 1e-6;
/// Most times that a piece of a line is halved.
const HALVINGS: u32 = 10;
/// Samples along the part of a DEM in its file that is read at once, and those around a cell that places over it may need.
const PART: usize = 64;
const AROUND: usize = 2;
/// Places along the side of a patch at which its nearest is looked for first.
const ALONG: u32 = 16;

/// A surface on which lines are laid.
pub(crate) struct Drape<'a> {
    surface: &'a Surface,
    /// Of a DEM that stays in its file, the part read last, by its first sample.
    part: RefCell<Option<([usize; 2], Surface)>>,
    /// How far a line may leave the surface between its points, metres.
    tolerance: f64,
}

impl<'a> Drape<'a> {
    /// Of a surface, for lines that leave it by no more than so many metres.
    pub(crate) fn new(surface: &'a Surface, tolerance: f64) -> Self {
        Self { surface, part: RefCell::default(), tolerance }
    }

    /// A line over places of the map, metres, on the surface; of a closed one the last place is the first.
    ///
    /// # Errors
    /// As [`Surface::part`].
    pub(crate) fn line(&self, map: &[DVec2]) -> Result<Vec<DVec3>> {
        let mut line: Vec<DVec3> = Vec::new();
        for pair in map.windows(2) {
            let places = cuts(self.grid(pair[0]), self.grid(pair[1]));
            let places = places.into_iter().map(|share| pair[0].lerp(pair[1], share));
            for place in places {
                let next = self.place(place)?;
                match line.last().copied() {
                    None => line.push(next),
                    Some(last) => self.halve(last, next, HALVINGS, &mut line)?,
                }
            }
        }
        line.dedup();
        Ok(line)
    }

    /// The place of the surface over one of the map, or of its nearest side; at height 0 where there is no surface about it.
    ///
    /// # Errors
    /// As [`Surface::part`].
    pub(crate) fn place(&self, map: DVec2) -> Result<DVec3> {
        let patches = self.patches(map)?;
        let over = patches.iter().find_map(|patch| over(patch, map, self.surface.dem().cell()));
        let beside = || patches.iter().flat_map(|patch| sides(patch, map)).min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(over.or_else(|| beside().map(|(_, place)| place)).unwrap_or(map.extend(0.0)))
    }

    /// Adds the places between two of the surface that a line needs, and the second.
    fn halve(&self, a: DVec3, b: DVec3, halvings: u32, line: &mut Vec<DVec3>) -> Result<()> {
        let between = [0.25, 0.5, 0.75].map(|share| a.lerp(b, share));
        let [first, middle, last] = between.map(|place| self.place(place.truncate()));
        let off = [first?, middle.clone()?, last?].into_iter().zip(between).map(|(on, place)| on.distance(place));
        if halvings > 0 && off.fold(0.0, f64::max) > self.tolerance {
            let middle = middle?;
            self.halve(a, middle, halvings - 1, line)?;
            return self.halve(middle, b, halvings - 1, line);
        }
        line.push(b);
        Ok(())
    }

    /// Column and row of a place of the map.
    fn grid(&self, map: DVec2) -> DVec2 {
        self.surface.dem().grid_place(map)
    }

    /// The patches about a place of the map: those of its cell first, in metres of the world.
    fn patches(&self, map: DVec2) -> Result<Vec<Patch>> {
        let dem = self.surface.dem();
        let last = [dem.columns(), dem.rows()].map(|samples| samples - 2);
        let cell = self.grid(map).floor().max(DVec2::ZERO).to_array();
        let cell = [0, 1].map(|axis| (cell[axis] as usize).min(last[axis]));
        if !dem.is_filed() {
            return Ok(about(self.surface, cell, last));
        }
        let mut part = self.part.borrow_mut();
        let holds = |first: [usize; 2]| {
            let within = |axis: usize| {
                let (from, to) = (cell[axis].saturating_sub(1), (cell[axis] + AROUND).min(last[axis] + 1));
                first[axis] <= from && to < first[axis] + PART
            };
            within(0) && within(1)
        };
        if !part.as_ref().is_some_and(|(first, _)| holds(*first)) {
            let first = cell.map(|at| at.saturating_sub(PART / 2));
            *part = Some((first, self.surface.part(first, [PART; 2])?));
        }
        Ok(part.as_ref().map_or_else(Vec::new, |(_, surface)| about(surface, cell, last)))
    }
}

/// The patches of a cell and of those around it.
fn about(surface: &Surface, [c, r]: [usize; 2], last: [usize; 2]) -> Vec<Patch> {
    let dem = surface.dem();
    let corner =
        |c: usize, r: usize| -> Corner { (dem.position(c, r), (-surface.gradient(c, r)).extend(1.0).normalize()) };
    let near = |at: usize, last: usize| [Some(at), at.checked_sub(1), Some(at + 1).filter(|at| *at <= last)];
    let [columns, rows] = [near(c, last[0]), near(r, last[1])];
    let cells = rows.into_iter().flatten().flat_map(|r| columns.into_iter().flatten().map(move |c| (c, r)));
    let patches = cells.flat_map(|(c, r)| {
        let exists = [0, 1].map(|half| patch_exists(dem, c, r, half));
        let corners = [corner(c, r), corner(c, r + 1), corner(c + 1, r + 1), corner(c + 1, r)];
        (0..2).filter(move |half| exists[*half]).map(move |half| Patch::of_cell(corners, half))
    });
    patches.collect()
}

/// The place of a patch over one of the map.
fn over(patch: &Patch, map: DVec2, cell: DVec2) -> Option<DVec3> {
    let near = NEAR * cell.min_element();
    let mut weights = DVec3::splat(1.0 / 3.0);
    for _ in 0..STEPS {
        let place = patch.point(weights.to_array());
        let off = map - place.truncate();
        if off.length() <= near {
            return (weights.min_element() >= -BESIDE).then_some(map.extend(place.z));
        }
        let [a, b, c] = patch.derivatives(weights.to_array());
        let step = DMat2::from_cols((b - a).truncate(), (c - a).truncate()).inverse() * off;
        // Far beside a patch its cubics lead anywhere.
        if !step.is_finite() || weights.abs().max_element() > 8.0 {
            return None;
        }
        weights += DVec3::new(-step.x - step.y, step.x, step.y);
    }
    None
}

/// How far off on the map the nearest places of a patch's sides are, and where.
fn sides(patch: &Patch, map: DVec2) -> [(f64, DVec3); 3] {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
        let at = |share: f64| {
            let place = patch.point(corners[from].lerp(corners[to], share).to_array());
            (place.truncate().distance(map), place)
        };
        let first = (0..=ALONG).map(|i| f64::from(i) / f64::from(ALONG)).min_by(|a, b| at(*a).0.total_cmp(&at(*b).0));
        let (mut share, mut step) = (first.unwrap_or(0.0), 0.5 / f64::from(ALONG));
        for _ in 0..STEPS * 2 {
            let tries = [share - step, share, share + step].map(|share| share.clamp(0.0, 1.0));
            share = tries.into_iter().min_by(|a, b| at(*a).0.total_cmp(&at(*b).0)).unwrap_or(share);
            step /= 2.0;
        }
        at(share)
    })
}

/// The shares of a way between two places of the grid at which it crosses sides or diagonals of cells, both ends too.
fn cuts(a: DVec2, b: DVec2) -> Vec<f64> {
    let mut cuts = vec![0.0, 1.0];
    for [from, to] in [[a.x, b.x], [a.y, b.y], [a.x - a.y, b.x - b.y]] {
        let (low, high) = (from.min(to), from.max(to));
        let lines = std::iter::successors(Some(low.floor() + 1.0), |line| Some(line + 1.0));
        cuts.extend(lines.take_while(|line| *line < high).map(|line| (line - from) / (to - from)));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}
