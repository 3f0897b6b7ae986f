//! The whole way from files to metres.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; where they stay in their files
//! nothing yet, or a look for steps. Memory of a held DEM at most 12 1/8 bytes a sample: the rasters under way are gone before normals
//! are computed; some 24 while heights become the smoothest within their steps.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::crs::Proj;
use super::grid::Grid;
use super::limits::are_held;
use super::mosaic::Mosaic;
use super::part::Part;
use super::raster::{FILL_REACH, Raster};
use super::smoothing::{Smoothed, Smoothing};
use super::target::Target;
use crate::dem::filed::exaggerate;
use crate::dem::focal::Worked;
use crate::dem::scale::Scale;
use crate::dem::{Dem, Georeference, History, Tiles};
use crate::error::{Error, Message, Result, Setting};
use crate::geo::info::name_of;
use crate::geo::{ReadOptions, Stage};
use crate::message;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
/// Least and largest scale of smoothing, in cells: below it changes nothing, beyond it looks too far around.
const SCALES: [f64; 2] = [2.5, 256.0];
/// Sound cell sizes, metres: from a millimetre to a thousand kilometres.
const CELLS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// Files opened and understood: what can be known without reading samples.
pub struct Reading {
    mosaic: Mosaic,
    target: Target,
    history: History,
    options: ReadOptions,
    held: bool,
}

impl Reading {
    /// Opens the files.
    ///
    /// # Errors
    /// Those of [`read_all`](crate::geo::read_all()) that need no sample.
    pub fn new(paths: &[PathBuf], options: &ReadOptions) -> Result<Self> {
        check_options(options)?;
        let mut history = History::default();
        let mosaic = Mosaic::open(paths, options, &mut history)?;
        let target = Target::of(&mosaic.grid, mosaic.path(), options, &mut history)?;
        let held = are_held(&mosaic, &target, options)?;
        options.generalise.map_or(Ok(()), |metres| check_scale(metres, &target.grid))?;
        Ok(Self { mosaic, target, history, options: options.clone(), held })
    }

    /// Every file on the disk that the DEM is made of: those named, what they name in turn, archives and containers around
    /// them, and what stands beside each and may be read with it. No output may replace one of them.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.mosaic.files()
    }

    /// The format of the first file, in GDAL's words.
    pub fn format(&self) -> &str {
        &self.mosaic.format
    }

    /// The files' own grid in words, where the DEM is warped from it.
    pub fn warped_from(&self) -> Option<String> {
        if !self.target.warps {
            return None;
        }
        let files = &self.mosaic.grid;
        let (cell, units) = (files.cell(), files.crs.units());
        let [west, south, east, north] = files.extent();
        Some(format!(
            "{} x {} samples, {}, cells of {:.6} x {:.6} {units}, W {west:.5} S {south:.5} E {east:.5} N {north:.5}",
            files.columns,
            files.rows,
            name_of(&files.crs),
            cell.x,
            cell.y
        ))
    }

    /// Reads the samples, if they are to be held. `progress`: see [`read_all`](crate::geo::read_all()).
    ///
    /// # Errors
    /// Those of [`read_all`](crate::geo::read_all()).
    pub fn finish(self, progress: &dyn Fn(Stage, f64)) -> Result<Dem> {
        let Self { mosaic, target: Target { grid, window, warps }, mut history, options, held } = self;
        let label = mosaic.label();
        let georeference = Georeference::new(mosaic.grid.crs.clone(), grid.crs.clone(), Arc::new(Proj));
        let part = Arc::new(Part::new(mosaic, window, options.keep_steps));
        let metres = grid.crs.metres_per_unit().unwrap_or(1.0);
        let (cell, origin) = (grid.cell() * metres, grid.sample(0.0, 0.0) * metres);
        let scale = options.generalise.map(|metres| Scale { metres, cell });
        let dem = match held {
            true => {
                let heights = hold(&part, warps.then_some(&grid), scale, &options, &mut history, progress)?;
                Dem::from_heights(grid.columns, cell, origin, heights)
            }
            false => {
                part.look(&options.cache, &|done| progress(Stage::Look, done))?;
                tell(&part, scale, &mut history);
                let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
                let tiles = filed(&part, scale, &options, &|done| progress(Stage::Smooth, done))?;
                Dem::from_tiles(tiles, cell, origin, options.exaggeration, budget)
            }
        };
        if metres != 1.0 {
            history.convert(format!("coordinates x {metres} to metres ({})", grid.crs.units()));
        }
        Ok(dem.with_source(georeference, history).with_label(label))
    }
}

/// Exaggerated metres of all samples of `part`, after what GDAL does to samples in memory. `warped` is the grid they are
/// warped to.
fn hold(
    part: &Part,
    warped: Option<&Grid>,
    scale: Option<Scale>,
    options: &ReadOptions,
    history: &mut History,
    progress: &dyn Fn(Stage, f64),
) -> Result<Vec<f32>> {
    let mut raster = part.raster(&|done| progress(Stage::Read, done))?;
    part.assumed().into_iter().for_each(|clause| history.assume(clause));
    tell(part, scale, history);
    if let Some(grid) = warped {
        let mut onto = Raster::void(grid.clone())?;
        onto.lay(&raster, &|done| progress(Stage::Warp, done))?;
        raster = onto;
    }
    let before = if options.fill_voids { raster.voids() } else { 0 };
    if before > 0 {
        raster.fill(&|done| progress(Stage::Fill, done))?;
        history.convert(filled(before, raster.voids()));
    }
    let (whole, mut metres) = (raster.grid.whole(), raster.metres);
    if metres.iter().all(|height| height.is_nan()) {
        return Err(part.void(metres.len() as u64));
    }
    scale.iter().for_each(|scale| scale.smooth(&mut metres, whole, true));
    exaggerate(&mut metres, options.exaggeration);
    Ok(metres)
}

/// The samples of `part` as they are read from its files and worked on; what comes of all work is kept in the cache.
fn filed(
    part: &Arc<Part>,
    scale: Option<Scale>,
    options: &ReadOptions,
    progress: &dyn Fn(f64),
) -> Result<Arc<dyn Tiles>> {
    let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
    let smoothed = part.smoothing().cloned().map(|smoothing| {
        let part = part.clone();
        Worked::new(part.clone(), Smoothed { part, smoothing }, budget)
    });
    let (cache, label) = (&options.cache, part.label());
    Ok(match (smoothed, scale) {
        (None, None) => part.clone(),
        (Some(smoothed), None) => Arc::new(smoothed.kept_in(cache, label, progress)?),
        (None, Some(scale)) => Arc::new(Worked::new(part.clone(), scale, budget).kept_in(cache, label, progress)?),
        (Some(smoothed), Some(scale)) => {
            Arc::new(Worked::new(Arc::new(smoothed), scale, budget).kept_in(cache, label, progress)?)
        }
    })
}

/// What is smoothed, in words.
fn tell(part: &Part, scale: Option<Scale>, history: &mut History) {
    if let Some(Smoothing { steps, .. }) = part.smoothing() {
        history.convert(steps.words());
        history.smooth(steps.metres().to_vec());
    }
    if let Some(Scale { metres, .. }) = scale {
        history.convert(message![format!("smoothed at a scale of {metres} m ("), Setting::Generalise, ")"]);
    }
}

/// What filling did, in words.
fn filled(before: usize, after: usize) -> Message {
    let filled = format!("{} voids filled from up to {FILL_REACH} samples away (", before - after);
    let left = if after > 0 { format!(", {after} farther away stay holes") } else { String::new() };
    message![filled, Setting::FillVoids, ")", left]
}

/// A scale at which something is smoothed, and not so many cells that the work grows without end.
fn check_scale(metres: f64, grid: &Grid) -> Result<()> {
    let cell = grid.cell() * grid.crs.metres_per_unit().unwrap_or(1.0);
    let [least, most] = SCALES.map(|cells| cell.min_element() * cells);
    if (least..=most).contains(&metres) {
        return Ok(());
    }
    let (least, most) = ((least * 1e3).ceil() / 1e3, (most * 1e3).floor() / 1e3);
    let what = format!("{metres} m is no scale to smooth cells of {} x {} m at", cell.x, cell.y);
    let remedy = match metres < least {
        true => message![format!("give {least} to {most} metres, or leave it out: so little changes nothing")],
        false => {
            message![format!("give {least} to {most} metres, or larger cells with "), Setting::Resample.with_value()]
        }
    };
    Err(Error::setting(Setting::Generalise, what, remedy))
}

fn check_options(options: &ReadOptions) -> Result<()> {
    let factor = options.exaggeration;
    if !(factor > 0.0 && factor <= MAX_EXAGGERATION) {
        let what = format!("{factor} is no factor to draw with");
        return Err(Error::setting(Setting::Exaggeration, what, "give a number above 0 and at most 1000"));
    }
    for (setting, metres) in [(Setting::Cell, options.cell), (Setting::Resample, options.resample)] {
        if let Some(metres) = metres.filter(|metres| !CELLS.contains(metres)) {
            let what = format!("{metres} is no size of a cell");
            return Err(Error::setting(setting, what, "give metres, from 0.001 to 1000000"));
        }
    }
    if let (Some(encoding), Some(_)) = (options.encoding.filter(|encoding| encoding.is_picture()), options.band) {
        let what = format!("{} takes the three bands of a picture, not one", encoding.name());
        let remedy = message!["leave out ", Setting::Band, " or ", Setting::Encoding];
        return Err(Error::setting(Setting::Encoding, what, remedy));
    }
    let Some([west, south, east, north]) = options.crop else { return Ok(()) };
    let finite = [west, south, east, north].iter().all(|edge| edge.is_finite());
    // Degrees may have their west beyond their east, see `crop`.
    if finite && west != east && south < north {
        return Ok(());
    }
    let what = format!("{west},{south},{east},{north} is no rectangle");
    Err(Error::setting(Setting::Crop, what, "give west,south,east,north with west < east and south < north"))
}
