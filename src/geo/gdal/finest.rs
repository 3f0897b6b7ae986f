//! Which grid is drawn of layers on several: that of the finest one that meets the crop and whose samples fit.
//!
//! The grid of that layer runs on over all others before it is cut or warped, so that what holds for one file holds for
//! all together. Where the finest does not fit, the next one is drawn, with a warning that says which part would be drawn
//! in the finest, and where none fits, the error says so: that part is tried before it is named.

use glam::DVec2;

use super::around::around;
use super::crop::{self, carried};
use super::layer::FileLayer;
use super::layers::{AS_FINE, Layers};
use super::limits::are_held;
use super::target::{CROP_DIGITS, Target, rounded};
use crate::dem::{History, MAX_SAMPLES, held_bytes, mebibytes};
use crate::error::{Error, Result, Setting};
use crate::geo::ReadOptions;
use crate::message;

/// Parts that are tried, each smaller than the one before.
const TRIALS: usize = 12;

/// What is drawn of `layers`. Fails when too little is left.
pub(super) fn target(layers: &Layers, options: &ReadOptions, history: &mut History) -> Result<Target> {
    if let [only] = layers.all() {
        let crop = layers.crop_on(&only.grid, options.crop)?;
        return Target::of(&only.grid, only.path(), crop, &only.grid.crs, options, history);
    }
    let candidates = candidates(layers, options)?;
    let Some((coarsest, finer)) = candidates.split_last() else {
        return on(layers, layers.first(), options, history);
    };
    for layer in finer {
        let mut own = History::default();
        // What is wrong with one map may be right with the next.
        if let Some(target) = on(layers, layer, options, &mut own).ok().filter(|target| fits(target, options)) {
            history.take(own, None);
            warn(layers, candidates[0], layer, options, history);
            return Ok(target);
        }
    }
    let target = on(layers, coarsest, options, history).and_then(|target| match fits(&target, options) {
        true => Ok(target),
        false => are_held(layers, &target, options).map(|_| target),
    });
    let target = target.map_err(|error| with_crop(error, layers, candidates[0], options))?;
    warn(layers, candidates[0], coarsest, options, history);
    Ok(target)
}

/// The error with a crop that can be drawn in the cells of `finest`, where there is one.
fn with_crop(error: Error, layers: &Layers, finest: &FileLayer, options: &ReadOptions) -> Error {
    let Some(crop) = crop_to_fit(layers, finest, options) else { return error };
    let part = |remedy| {
        let cells = format!(" for a part in the cells of {}, or ", finest.name());
        message!["use ", Setting::Crop.at(&crop), cells, remedy]
    };
    match error {
        Error::Input { path, what, remedy } => Error::Input { path, what, remedy: part(remedy).plain() },
        Error::Limit { what, remedy } => Error::limit(what, part(remedy)),
        other => other,
    }
}

/// The layers whose grids may be drawn, from the finest on; of like ones the first.
fn candidates<'a>(layers: &'a Layers, options: &ReadOptions) -> Result<Vec<&'a FileLayer>> {
    if let Some(chosen) = layers.chosen() {
        return Ok(vec![chosen]);
    }
    crop::on(&layers.first().grid, options.crop)?;
    let mut found: Vec<&FileLayer> = Vec::new();
    for layer in layers.all() {
        let crop = layers.crop_on(&layer.grid, options.crop);
        let met = crop.is_ok_and(|crop| crop.is_none_or(|crop| layer.grid.window(crop).is_some()));
        if met && found.iter().all(|other| (other.cell / layer.cell - 1.0).abs() > AS_FINE) {
            found.push(layer);
        }
    }
    found.sort_by(|a, b| a.cell.total_cmp(&b.cell));
    // Where the size of cells is given there is nothing to choose.
    if options.resample.is_some() {
        found.truncate(1);
    }
    Ok(found)
}

/// What is drawn in the grid of `base`.
fn on(layers: &Layers, base: &FileLayer, options: &ReadOptions, history: &mut History) -> Result<Target> {
    let around = around(layers, base, options.crop)?;
    let crop = layers.crop_on(&around, options.crop)?;
    Target::of(&around, base.path(), crop, &layers.first().grid.crs, options, history)
}

/// Whether the samples can be held.
fn fits(target: &Target, options: &ReadOptions) -> bool {
    let samples = target.grid.whole().samples();
    samples <= MAX_SAMPLES as u64 && held_bytes(samples) <= options.memory
}

/// Warns where `drawn` is coarser than the `finest`, and says how the finest would be drawn.
fn warn(layers: &Layers, finest: &FileLayer, drawn: &FileLayer, options: &ReadOptions, history: &mut History) {
    if finest.cell >= drawn.cell {
        return;
    }
    let [fine, coarse] = [finest, drawn].map(|layer| rounded(layer.cell, 3));
    let mut ways = Vec::new();
    if let Some(crop) = crop_to_fit(layers, finest, options) {
        ways.push(message!["use ", Setting::Crop.at(crop), " for a part in these"]);
    }
    let all = on(layers, finest, options, &mut History::default()).ok();
    let samples = all.map(|target| target.grid.whole().samples()).filter(|samples| *samples <= MAX_SAMPLES as u64);
    if let Some(samples) = samples {
        ways.push(message!["give ", mebibytes(held_bytes(samples).div_ceil(1 << 20)), " for all in these"]);
    }
    let what = format!("cells of {coarse} m are fine enough (all in the {fine} m of {} do not fit", finest.name());
    let mut clause = message![what];
    for (i, way) in ways.into_iter().enumerate() {
        clause.push(if i == 0 { ": " } else { ", or " });
        clause.push(way);
    }
    history.assume(message![clause, ")"]);
}

/// A crop around the finest layer, with as much land around it as fits or as much of it, in units of the first file; one
/// that was tried.
fn crop_to_fit(layers: &Layers, finest: &FileLayer, options: &ReadOptions) -> Option<String> {
    let asked = layers.crop_on(&finest.grid, options.crop).ok()?;
    // Where its map cannot show all, nothing bounds it but what fits.
    let all = asked.or_else(|| Some(around(layers, finest, None).ok()?.extent()));
    let [low, high] = all.map_or([-DVec2::INFINITY, DVec2::INFINITY], corners);
    let [own_low, own_high] = corners(finest.grid.extent());
    let (own_low, own_high) = (own_low.max(low), own_high.min(high));
    let (mut middle, half) = ((own_low + own_high) / 2.0, (own_high - own_low) / 2.0);
    if half.min_element() <= 0.0 {
        return None;
    }
    let mut share = (most(options.memory) / finest.grid.whole().samples() as f64).sqrt();
    if share < 1.0 {
        // The middle of several files may be between them.
        let (file, within) = (finest.first_grid(), half * (1.0 - share));
        middle = file.centre(file.whole()).clamp(middle - within, middle + within);
    }
    for _ in 0..TRIALS {
        let [low, high] = [(middle - half * share).max(low), (middle + half * share).min(high)];
        let part = [low.x, low.y, high.x, high.y];
        let crop = carried(part, &finest.grid.crs, &layers.first().grid.crs.as_defined())?
            .map(|edge| rounded(edge, CROP_DIGITS));
        let trial = ReadOptions { crop: Some(crop), ..options.clone() };
        share *= match on(layers, finest, &trial, &mut History::default()) {
            Ok(target) if fits(&target, options) => return Some(crop.map(|edge| edge.to_string()).join(",")),
            // A little less, for a rectangle of another map is larger.
            Ok(target) => (0.98 * (most(options.memory) / target.grid.whole().samples() as f64).sqrt()).min(0.98),
            Err(_) => 0.5,
        };
    }
    None
}

/// Samples that fit into so many bytes, and may be held.
fn most(memory: u64) -> f64 {
    let bytes = held_bytes(1 << 10) as f64 / 1024.0;
    (memory as f64 / bytes).min(MAX_SAMPLES as f64)
}

/// South-west and north-east.
fn corners([west, south, east, north]: [f64; 4]) -> [DVec2; 2] {
    [DVec2::new(west, south), DVec2::new(east, north)]
}
