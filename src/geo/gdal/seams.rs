//! Layers on one grid: each is warped straight to it and laid over what is there, blended where that shows beside it.
//!
//! Where seams are and how wide they are blended: [`weights`](super::weights). Small holes are no seams, see [`pinholes`]. In
//! the order given nothing is blended and no hole is filled: what is on top shows as it is. Beyond the outermost samples of
//! a layer only what no other knows is laid, and [`gaps`] between two are bridged. Cost: a warp and up to eight
//! distances a layer; at work about 28 bytes a sample of the DEM. Not handled: layers whose heights differ by a constant;
//! they meet in a ramp.

use rayon::prelude::*;

use super::gaps;
use super::grid::GeoGrid;
use super::layer::reach;
use super::lie::Lie;
use super::part::Part;
use super::pinholes;
use super::raster::Raster;
use super::weights::Pair;
use crate::dem::Window;
use crate::error::Result;
use crate::geo::{Order, ReadStage};

/// What is laid so far.
struct LaidFiles {
    raster: Raster,
    /// Metres of the cells of the layer that shows at each sample, 0 where none does, negative beyond its outermost
    /// samples.
    shown: Vec<f32>,
    /// The largest of these cells.
    coarsest: f64,
    /// Metres over which seams are blended: least and most.
    seams: Option<[f64; 2]>,
}

/// A layer on some samples of the grid, NaN at voids.
struct Upper {
    window: Window,
    metres: Vec<f32>,
    /// Which of them lie beyond its outermost samples.
    rim: Vec<bool>,
    /// Metres of its own cells.
    cell: f64,
}

/// All samples of `parts`, from the bottom to the top, on `grid`, and the metres over which seams are blended, least
/// and most. `progress` hears the share of each part.
pub(super) fn lay(
    parts: &[Part],
    grid: &GeoGrid,
    order: Order,
    progress: &dyn Fn(ReadStage, f64),
) -> Result<(Raster, Option<[f64; 2]>)> {
    let raster = Raster::void(grid.clone())?;
    let shown = vec![0.0; raster.metres.len()];
    let mut laid = LaidFiles { raster, shown, coarsest: 0.0, seams: None };
    for (i, part) in parts.iter().enumerate() {
        let share = |stage, done: f64| progress(stage, (i as f64 + done) / parts.len() as f64);
        let own = part.raster(&|done| share(ReadStage::Read, done))?;
        let cell = part.layer().cell;
        if let Some(upper) = Upper::of(own, cell, grid, &|done| share(ReadStage::Warp, done))? {
            laid.cover(upper, order);
        }
    }
    Ok((laid.raster, laid.seams))
}

impl Upper {
    /// Of samples with cells of so many metres, on those of `grid`; `None` where they cover none.
    fn of(own: Raster, cell: f64, grid: &GeoGrid, progress: &dyn Fn(f64)) -> Result<Option<Self>> {
        if let Some(Lie::Aligned { first, flip: [false, false] }) = Lie::of(&own.grid, grid) {
            let all_known =
                |(window, metres): (_, Vec<_>)| Self { window, rim: vec![false; metres.len()], metres, cell };
            return Ok(copied(grid, &own, first).map(all_known));
        }
        let Some(window) = reach(&own.grid, grid) else { return Ok(None) };
        let mut onto = Raster::void(grid.part(window))?;
        onto.lay(&own, progress)?;
        let rim = gaps::rim(&own.grid, &onto.grid, &onto.metres, cell);
        Ok(Some(Self { window, metres: onto.metres, rim, cell }))
    }
}

/// Samples of a layer on those of `grid`, where they fall on them, with some voids around, from column and row `first` of the grid on.
fn copied(grid: &GeoGrid, own: &Raster, first: [i64; 2]) -> Option<(Window, Vec<f32>)> {
    let (size, there) = ([own.grid.columns, own.grid.rows], [grid.columns, grid.rows]);
    let low = [0, 1].map(|i| (first[i] - 1).clamp(0, there[i] as i64));
    let end = [0, 1].map(|i| (first[i] + size[i] as i64 + 1).clamp(0, there[i] as i64));
    let window = Window { first: low.map(|v| v as usize), size: [0, 1].map(|i| (end[i] - low[i]) as usize) };
    let sample = |i: usize| {
        let at = [low[0] + (i % window.size[0]) as i64 - first[0], low[1] + (i / window.size[0]) as i64 - first[1]];
        let inside = (0..2).all(|i| (0..size[i] as i64).contains(&at[i]));
        if inside { own.metres[at[1] as usize * size[0] + at[0] as usize] } else { f32::NAN }
    };
    let samples = window.size[0] * window.size[1];
    (samples > 0).then(|| (window, (0..samples).into_par_iter().map(sample).collect()))
}

impl LaidFiles {
    /// Lays a layer over what is there.
    fn cover(&mut self, mut upper: Upper, order: Order) {
        self.leave_rims(&mut upper);
        let weights = if order == Order::Given { None } else { self.weights(&mut upper) };
        let Window { first: [c0, r0], size: [width, height] } = upper.window;
        let columns = self.raster.grid.columns;
        let rows = self.raster.metres.par_chunks_mut(columns).zip(self.shown.par_chunks_mut(columns));
        rows.skip(r0).take(height).enumerate().for_each(|(r, (metres, shown))| {
            for (c, i) in (c0..c0 + width).zip(r * width..) {
                let own = upper.metres[i];
                if own.is_nan() {
                    continue;
                }
                shown[c] = if upper.rim[i] { -upper.cell } else { upper.cell } as f32;
                metres[c] = match &weights {
                    Some(weights) if !metres[c].is_nan() => metres[c] + (own - metres[c]) * weights[i],
                    _ => own,
                };
            }
        });
        drop(weights);
        self.bridge(&upper);
        self.coarsest = self.coarsest.max(upper.cell);
    }

    /// Takes away of either what lies beyond its outermost samples and within those of the other.
    fn leave_rims(&mut self, upper: &mut Upper) {
        let columns = self.raster.grid.columns;
        for i in 0..upper.metres.len() {
            let place = place(columns, upper.window, i);
            if upper.metres[i].is_nan() || self.shown[place] == 0.0 {
                continue;
            }
            match (upper.rim[i], self.shown[place] < 0.0) {
                (true, false) => upper.metres[i] = f32::NAN,
                (false, true) => (self.raster.metres[place], self.shown[place]) = (f32::NAN, 0.0),
                _ => (),
            }
        }
    }

    /// Fills the gaps between a layer that was laid last and those around it.
    fn bridge(&mut self, upper: &Upper) {
        let (columns, step) = (self.raster.grid.columns, self.raster.grid.step());
        let reach = self.coarsest.max(upper.cell) + step[0].max(step[1]);
        let around = grown(upper.window, step.map(|step| (reach / step).ceil() as usize + 1), &self.raster.grid);
        let (raster, shown) = (&self.raster, &self.shown);
        let is_rim = |i: usize| shown[place(columns, around, i)] < 0.0;
        if !(0..around.samples() as usize).into_par_iter().any(is_rim) {
            return;
        }
        let metres = (0..around.samples() as usize).into_par_iter().map(|i| raster.metres[place(columns, around, i)]);
        let mut metres: Vec<_> = metres.collect();
        let within = |i: usize| {
            let at = [around.first[0] + i % around.size[0], around.first[1] + i / around.size[0]];
            let at = [0, 1].map(|i| at[i].wrapping_sub(upper.window.first[i]));
            (0..2).all(|i| at[i] < upper.window.size[i]).then(|| at[1] * upper.window.size[0] + at[0])
        };
        let is_upper = |i: usize| within(i).is_some_and(|i| !upper.metres[i].is_nan());
        let known = |i: usize| shown[place(columns, around, i)] > 0.0;
        let sides: [&(dyn Fn(usize) -> bool + Sync); 2] = [&|i| known(i) && !is_upper(i), &|i| known(i) && is_upper(i)];
        for i in gaps::fill(&mut metres, around.size, step, reach, is_rim, sides) {
            let place = place(columns, around, i);
            if !metres[i].is_nan() {
                (self.raster.metres[place], self.shown[place]) = (metres[i], self.shown[place].abs());
            }
        }
    }

    /// The weight of each sample of a layer over what is beneath, after its small holes are filled; `None` where it has all
    /// weight everywhere.
    fn weights(&mut self, upper: &mut Upper) -> Option<Vec<f32>> {
        let (window, size) = (upper.window, upper.window.size);
        let Self { raster, shown, .. } = &*self;
        let place = |i: usize| place(raster.grid.columns, window, i);
        let (metres, beneath) = (|i: usize| raster.metres[place(i)], |i: usize| shown[place(i)].abs());
        let holes = upper.metres.par_iter().enumerate().filter(|(_, metres)| metres.is_nan());
        let coarsest = f64::from(holes.map(|(i, _)| beneath(i)).reduce(|| 0.0, f32::max));
        if coarsest == 0.0 {
            return None;
        }
        let step = raster.grid.step();
        pinholes::fill(&mut upper.metres, size, step, coarsest.max(upper.cell), &metres);
        let pair = Pair { size, step, upper: &upper.metres, cell: upper.cell, beneath: &beneath };
        let (weights, [narrowest, widest]) = pair.weights()?;
        let [least, most] = self.seams.unwrap_or([narrowest, widest]);
        self.seams = Some([least.min(narrowest), most.max(widest)]);
        Some(weights)
    }
}

/// Where sample `i` of a window lies among those of rows of so many columns.
fn place(columns: usize, window: Window, i: usize) -> usize {
    (window.first[1] + i / window.size[0]) * columns + window.first[0] + i % window.size[0]
}

/// A window with so many columns and rows more on each side, as far as `grid` has them.
fn grown(window: Window, margin: [usize; 2], grid: &GeoGrid) -> Window {
    let there = [grid.columns, grid.rows];
    let first = [0, 1].map(|i| window.first[i].saturating_sub(margin[i]));
    let end = [0, 1].map(|i| (window.first[i] + window.size[i] + margin[i]).min(there[i]));
    Window { first, size: [0, 1].map(|i| end[i] - first[i]) }
}
