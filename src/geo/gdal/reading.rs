//! The whole way from files to metres.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; nothing yet where they
//! stay in their files. Memory of a held DEM at most 12 1/8 bytes a sample: the rasters under way are gone before normals
//! are computed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::crs::Proj;
use super::grid::Grid;
use super::limits::are_held;
use super::mosaic::Mosaic;
use super::part::Part;
use super::raster::{FILL_REACH, Raster};
use super::target::Target;
use crate::dem::filed::exaggerate;
use crate::dem::{Dem, Georeference, History, Tiles};
use crate::error::{Error, Message, Result, Setting};
use crate::geo::info::name_of;
use crate::geo::{ReadOptions, Stage};
use crate::message;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
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

    /// The files' own grid in words, where the DEM is warped from it or its axes are turned.
    pub fn warped_from(&self) -> Option<String> {
        let files = &self.mosaic.grid;
        if !self.target.warps && files.crs == files.crs.as_defined() {
            return None;
        }
        let (cell, units) = (files.cell(), files.crs.units());
        let [west, south, east, north] = files.extent_in_file();
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
        let georeference = Georeference::new(mosaic.grid.crs.as_defined(), grid.crs.clone(), Arc::new(Proj));
        let part = Part::new(mosaic, window);
        let heights = match held {
            true => Some(hold(&part, warps.then_some(&grid), &options, &mut history, progress)?),
            false => None,
        };
        let metres = grid.crs.metres_per_unit().unwrap_or(1.0);
        if metres != 1.0 {
            history.convert(format!("coordinates x {metres} to metres ({})", grid.crs.units()));
        }
        let (cell, origin) = (grid.cell() * metres, grid.sample(0.0, 0.0) * metres);
        let dem = match heights {
            Some(heights) => Dem::from_heights(grid.columns, cell, origin, heights),
            None => {
                let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
                Dem::from_tiles(Arc::new(part), cell, origin, options.exaggeration, budget)
            }
        };
        Ok(dem.with_source(georeference, history).with_label(label))
    }
}

/// Exaggerated metres of all samples of `part`, after what GDAL does to samples in memory. `warped` is the grid they are
/// warped to.
fn hold(
    part: &Part,
    warped: Option<&Grid>,
    options: &ReadOptions,
    history: &mut History,
    progress: &dyn Fn(Stage, f64),
) -> Result<Vec<f32>> {
    let mut raster = part.raster(&|done| progress(Stage::Read, done))?;
    part.assumed().into_iter().for_each(|clause| history.assume(clause));
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
    let mut metres = raster.metres;
    if metres.iter().all(|height| height.is_nan()) {
        return Err(part.void(metres.len() as u64));
    }
    exaggerate(&mut metres, options.exaggeration);
    Ok(metres)
}

/// What filling did, in words.
fn filled(before: usize, after: usize) -> Message {
    let filled = format!("{} voids filled from up to {FILL_REACH} samples away (", before - after);
    let left = if after > 0 { format!(", {after} farther away stay holes") } else { String::new() };
    message![filled, Setting::FillVoids, ")", left]
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
