//! Layers on one grid: each is warped straight to it and laid over what is there, blended where that shows beside it.
//!
//! A seam is where a layer is void and another beneath it is not. From there inward the weight of the upper layer grows from
//! 0 to 1 over four cells of the coarser of the two (the coarsest that it covers), by the smooth step of fifth degree
//! (Perlin 2002, Improving Noise), so that no slope and no curvature jumps; towards places where nothing is beneath it grows
//! likewise, and there the upper one is as it was. Small holes are no seams, see [`pinholes`]. Cost: a warp and up to four
//! distances a layer; at work about 20 bytes a sample of the DEM. Not handled: layers whose heights differ by a constant;
//! they meet in a ramp.

use rayon::prelude::*;

use super::distance::distances;
use super::grid::Grid;
use super::layer::reach;
use super::lie::Lie;
use super::part::Part;
use super::pinholes;
use super::raster::Raster;
use crate::dem::Window;
use crate::error::Result;
use crate::geo::Stage;

/// Cells of the coarser layer over which a seam is blended.
const SEAM_CELLS: f64 = 4.0;

/// What is laid so far.
struct Laid {
    raster: Raster,
    /// Metres of the cells of the layer that shows at each sample, 0 where none does.
    shown: Vec<f32>,
    /// Metres over which seams are blended: least and most.
    seams: Option<[f64; 2]>,
}

/// A layer on some samples of the grid, NaN at voids.
struct Upper {
    window: Window,
    metres: Vec<f32>,
    /// Metres of its own cells.
    cell: f64,
}

/// All samples of `parts`, from the bottom to the top, on `grid`, and the metres over which seams are blended, least
/// and most. `progress` hears the share of each part.
pub(super) fn lay(parts: &[Part], grid: &Grid, progress: &dyn Fn(Stage, f64)) -> Result<(Raster, Option<[f64; 2]>)> {
    let raster = Raster::void(grid.clone())?;
    let shown = vec![0.0; raster.metres.len()];
    let mut laid = Laid { raster, shown, seams: None };
    for (i, part) in parts.iter().enumerate() {
        let share = |stage, done: f64| progress(stage, (i as f64 + done) / parts.len() as f64);
        let own = part.raster(&|done| share(Stage::Read, done))?;
        let cell = part.layer().cell;
        if let Some((window, metres)) = on(grid, own, &|done| share(Stage::Warp, done))? {
            laid.cover(Upper { window, metres, cell });
        }
    }
    Ok((laid.raster, laid.seams))
}

/// Samples of a layer on those of `grid`: the window that they cover, with some voids around them.
fn on(grid: &Grid, own: Raster, progress: &dyn Fn(f64)) -> Result<Option<(Window, Vec<f32>)>> {
    if let Some(Lie::Aligned { first, flip: [false, false] }) = Lie::of(&own.grid, grid) {
        return Ok(copied(grid, &own, first));
    }
    let Some(window) = reach(&own.grid, grid) else { return Ok(None) };
    let mut onto = Raster::void(grid.part(window))?;
    onto.lay(&own, progress)?;
    Ok(Some((window, onto.metres)))
}

/// The same where samples fall on samples, from column and row `first` of the grid on.
fn copied(grid: &Grid, own: &Raster, first: [i64; 2]) -> Option<(Window, Vec<f32>)> {
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

impl Laid {
    /// Lays a layer over what is there.
    fn cover(&mut self, mut upper: Upper) {
        let weights = self.weights(&mut upper);
        let Window { first: [c0, r0], size: [width, height] } = upper.window;
        let columns = self.raster.grid.columns;
        let rows = self.raster.metres.par_chunks_mut(columns).zip(self.shown.par_chunks_mut(columns));
        rows.skip(r0).take(height).enumerate().for_each(|(r, (metres, shown))| {
            for (c, i) in (c0..c0 + width).zip(r * width..) {
                let own = upper.metres[i];
                if own.is_nan() {
                    continue;
                }
                shown[c] = upper.cell as f32;
                metres[c] = match &weights {
                    Some(weights) if !metres[c].is_nan() => metres[c] + (own - metres[c]) * weights[i],
                    _ => own,
                };
            }
        });
    }

    /// The weight of each sample of a layer over what is beneath, after its small holes are filled; `None` where it has all
    /// weight everywhere.
    fn weights(&mut self, upper: &mut Upper) -> Option<Vec<f32>> {
        let Window { first: [c0, r0], size } = upper.window;
        let Self { raster, shown, .. } = &*self;
        let place = |i: usize| (r0 + i / size[0]) * raster.grid.columns + c0 + i % size[0];
        let covered = upper.metres.par_iter().enumerate().filter(|(_, metres)| !metres.is_nan());
        let coarsest = f64::from(covered.map(|(i, _)| shown[place(i)]).reduce(|| 0.0, f32::max));
        if coarsest == 0.0 {
            return None;
        }
        let step = (raster.grid.cell() * raster.grid.crs.metres_per_unit().unwrap_or(1.0)).to_array();
        let coarser = coarsest.max(upper.cell);
        pinholes::fill(&mut upper.metres, size, step, coarser, &|i| raster.metres[place(i)]);
        let seam = SEAM_CELLS * coarser;
        let (covers, beneath) = (|i: usize| !upper.metres[i].is_nan(), |i: usize| shown[place(i)] > 0.0);
        let mut weights = distances(size, step, seam, |i| !covers(i) && beneath(i))?;
        let within = distances(size, step, seam, |i| covers(i) && !beneath(i));
        let smooth = |metres: f32| smooth_step(metres / seam as f32);
        weights.par_iter_mut().for_each(|weight| *weight = smooth(*weight));
        if let Some(within) = within {
            let both = |(weight, within): (&mut f32, f32)| *weight = 1.0 - (1.0 - *weight) * smooth(within);
            weights.par_iter_mut().zip(within).for_each(both);
        }
        let [least, most] = self.seams.unwrap_or([seam; 2]);
        self.seams = Some([least.min(seam), most.max(seam)]);
        Some(weights)
    }
}

/// From 0 at 0 to 1 at 1, level and without curvature at both.
fn smooth_step(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}
