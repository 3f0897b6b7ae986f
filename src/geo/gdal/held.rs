//! The samples of a DEM that is held: read, smoothed within their steps, laid on the grid that is drawn, voids filled.

use super::grid::GeoGrid;
use super::layers::Layers;
use super::part::Part;
use super::raster::{FILL_REACH, Raster};
use super::reading::{between, tell};
use super::seams;
use super::target::{Target, rounded};
use crate::dem::History;
use crate::dem::filed::exaggerate;
use crate::dem::scale::Scale;
use crate::error::{Message, Result, Setting};
use crate::geo::{Order, ReadOptions, ReadStage};
use crate::message;

/// Layers that are named.
const NAMED: usize = 3;

/// Exaggerated metres of all samples of `target`, smoothed at `scale`.
pub(super) fn hold(
    layers: Layers,
    target: Target,
    scale: Option<Scale>,
    options: &ReadOptions,
    history: &mut History,
    progress: &dyn Fn(ReadStage, f64),
) -> Result<Vec<f32>> {
    let alone = layers.all().len() == 1;
    let parts = layers.into_parts(&target, options.keep_steps);
    let Target { grid, warps, cut, .. } = target;
    let (mut raster, lie) = match parts.as_slice() {
        [part] if alone => (taken(part, warps.then_some(&grid), progress)?, None),
        parts => laid(parts, &grid, options.order, progress).map(|(raster, lie)| (raster, Some(lie)))?,
    };
    Part::assumed_of(&parts).into_iter().for_each(|clause| history.assume(clause));
    tell(&parts, scale, history);
    lie.into_iter().for_each(|lie| history.convert(lie));
    let before = if options.fill_voids { raster.voids() } else { 0 };
    if before > 0 {
        raster.fill(&|done| progress(ReadStage::Fill, done))?;
        history.convert(filled(before, raster.voids()));
    }
    cut.iter().for_each(|cut| cut.cut(&mut raster));
    let (size, mut metres) = ([raster.grid.columns, raster.grid.rows], raster.metres);
    if let (true, Some(part)) = (metres.iter().all(|height| height.is_nan()), parts.first()) {
        return Err(part.void(metres.len() as u64));
    }
    scale.map_or(Ok(()), |scale| scale.smooth(&mut metres, size))?;
    exaggerate(&mut metres, options.exaggeration);
    Ok(metres)
}

/// All samples of `part`, the only one. `warped` is the grid they are warped to.
fn taken(part: &Part, warped: Option<&GeoGrid>, progress: &dyn Fn(ReadStage, f64)) -> Result<Raster> {
    let raster = part.raster(&|done| progress(ReadStage::Read, done))?;
    let Some(grid) = warped else { return Ok(raster) };
    let mut onto = Raster::void(grid.clone())?;
    onto.lay(&raster, &|done| progress(ReadStage::Warp, done))?;
    Ok(onto)
}

/// All samples of `parts` of several layers, from the bottom to the top, on `grid`, and how
/// they lie, in words.
fn laid(parts: &[Part], grid: &GeoGrid, order: Order, progress: &dyn Fn(ReadStage, f64)) -> Result<(Raster, String)> {
    let [bottom, ..] = parts else { return Err(between(grid)) };
    let (raster, seams) = seams::lay(parts, grid, order, progress)?;
    let names: Vec<_> = parts.iter().rev().take(NAMED).map(|part| part.layer().name()).collect();
    let more = match parts.len() - names.len() {
        0 => String::new(),
        more => format!(" and {more} more grids, the lowest of {}", bottom.layer().name()),
    };
    let cell = rounded(grid.cell().x * grid.crs.metres_per_unit().unwrap_or(1.0), 6);
    let seam = match seams.map(|metres| metres.map(|metres| rounded(metres, 3))) {
        None => String::new(),
        Some([least, most]) if least == most => format!(", seams blended over {most} m"),
        Some([least, most]) => format!(", seams blended over {least} to {most} m"),
    };
    Ok((raster, format!("{}{more}, cells of {cell} m{seam}", names.join(" on "))))
}

/// What filling did, in words.
fn filled(before: usize, after: usize) -> Message {
    let filled = format!("{} voids filled from up to {FILL_REACH} samples away (", before - after);
    let left = if after > 0 { format!(", {after} farther away stay holes") } else { String::new() };
    message![filled, Setting::FillVoids, ")", left]
}
