//! The whole way from files to metres.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; nothing yet where they
//! stay in their files. Memory of a held DEM at most 12 1/8 bytes a sample: the rasters under way are gone before normals
//! are computed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::crs::Proj;
use super::finest;
use super::grid::Grid;
use super::layer::Layer;
use super::layers::Layers;
use super::limits::are_held;
use super::part::Part;
use super::raster::{FILL_REACH, Raster};
use super::seams;
use super::target::{Target, rounded};
use crate::dem::filed::exaggerate;
use crate::dem::{Dem, Georeference, History};
use crate::error::{Error, Message, Result, Setting};
use crate::geo::info::name_of;
use crate::geo::{ReadOptions, Stage};
use crate::message;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
/// Layers that are named.
const NAMED: usize = 3;
/// Sound cell sizes, metres: from a millimetre to a thousand kilometres.
const CELLS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// Files opened and understood: what can be known without reading samples.
pub struct Reading {
    layers: Layers,
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
        let layers = Layers::open(paths, options, &mut history)?;
        let target = finest::target(&layers, options, &mut history)?;
        let held = are_held(&layers, &target, options)?;
        Ok(Self { layers, target, history, options: options.clone(), held })
    }

    /// Every file on the disk that the DEM is made of: those named, what they name in turn, archives and containers around
    /// them, and what stands beside each and may be read with it. No output may replace one of them.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.layers.all().iter().flat_map(Layer::files)
    }

    /// The format of the first file, in GDAL's words.
    pub fn format(&self) -> &str {
        &self.layers.first().format
    }

    /// The files' own grids in words, where the DEM is warped from them, one by one, or their axes are turned.
    pub fn warped_from(&self) -> Option<String> {
        match self.layers.all() {
            [layer] if self.target.warps || layer.grid.crs != layer.grid.crs.as_defined() => {
                Some(grid_words(&layer.grid))
            }
            [_] => None,
            layers => {
                let words = layers.iter().map(|layer| format!("{}: {}", layer.name(), grid_words(&layer.grid)));
                Some(words.collect::<Vec<_>>().join("; "))
            }
        }
    }

    /// Reads the samples, if they are to be held. `progress`: see [`read_all`](crate::geo::read_all()).
    ///
    /// # Errors
    /// Those of [`read_all`](crate::geo::read_all()).
    pub fn finish(self, progress: &dyn Fn(Stage, f64)) -> Result<Dem> {
        let Self { layers, target, mut history, options, held } = self;
        let label = layers.label();
        let (files, world) = (layers.first().grid.crs.as_defined(), target.grid.crs.clone());
        let georeference = Georeference::new(files, world, Arc::new(Proj));
        let alone = layers.all().len() == 1;
        let mut parts = layers.into_parts(&target);
        let Target { grid, warps, .. } = target;
        let raster = match parts.as_slice() {
            _ if !held => None,
            [part] if alone => Some(taken(part, warps.then_some(&grid), progress)?),
            parts => Some(laid(parts, &grid, &mut history, progress)?),
        };
        let heights = raster.map(|raster| hold(&parts, raster, &options, &mut history, progress)).transpose()?;
        let metres = grid.crs.metres_per_unit().unwrap_or(1.0);
        if metres != 1.0 {
            history.convert(format!("coordinates x {metres} to metres ({})", grid.crs.units()));
        }
        let (cell, origin) = (grid.cell() * metres, grid.sample(0.0, 0.0) * metres);
        let dem = match (heights, parts.pop()) {
            (None, Some(part)) => {
                let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
                Dem::from_tiles(Arc::new(part), cell, origin, options.exaggeration, budget)
            }
            (heights, _) => Dem::from_heights(grid.columns, cell, origin, heights.unwrap_or_default()),
        };
        Ok(dem.with_source(georeference, history).with_label(label))
    }
}

/// All samples of `part`, the only one. `warped` is the grid they are warped to.
fn taken(part: &Part, warped: Option<&Grid>, progress: &dyn Fn(Stage, f64)) -> Result<Raster> {
    let raster = part.raster(&|done| progress(Stage::Read, done))?;
    let Some(grid) = warped else { return Ok(raster) };
    let mut onto = Raster::void(grid.clone())?;
    onto.lay(&raster, &|done| progress(Stage::Warp, done))?;
    Ok(onto)
}

/// All samples of `parts` of several layers, from the bottom to the top, on `grid`.
fn laid(parts: &[Part], grid: &Grid, history: &mut History, progress: &dyn Fn(Stage, f64)) -> Result<Raster> {
    let [bottom, ..] = parts else { return Err(between(grid)) };
    let (raster, seams) = seams::lay(parts, grid, progress)?;
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
    history.convert(format!("{}{more}, cells of {cell} m{seam}", names.join(" on ")));
    Ok(raster)
}

/// Exaggerated metres of all samples that were read of `parts`, after what GDAL does to samples in memory.
fn hold(
    parts: &[Part],
    mut raster: Raster,
    options: &ReadOptions,
    history: &mut History,
    progress: &dyn Fn(Stage, f64),
) -> Result<Vec<f32>> {
    Part::assumed_of(parts).into_iter().for_each(|clause| history.assume(clause));
    let before = if options.fill_voids { raster.voids() } else { 0 };
    if before > 0 {
        raster.fill(&|done| progress(Stage::Fill, done))?;
        history.convert(filled(before, raster.voids()));
    }
    let mut metres = raster.metres;
    if let (true, Some(part)) = (metres.iter().all(|height| height.is_nan()), parts.first()) {
        return Err(part.void(metres.len() as u64));
    }
    exaggerate(&mut metres, options.exaggeration);
    Ok(metres)
}

/// A grid in words.
fn grid_words(grid: &Grid) -> String {
    let (cell, units) = (grid.cell(), grid.crs.units());
    let [west, south, east, north] = grid.extent_in_file();
    format!(
        "{} x {} samples, {}, cells of {:.6} x {:.6} {units}, W {west:.5} S {south:.5} E {east:.5} N {north:.5}",
        grid.columns,
        grid.rows,
        name_of(&grid.crs),
        cell.x,
        cell.y
    )
}

/// What filling did, in words.
fn filled(before: usize, after: usize) -> Message {
    let filled = format!("{} voids filled from up to {FILL_REACH} samples away (", before - after);
    let left = if after > 0 { format!(", {after} farther away stay holes") } else { String::new() };
    message![filled, Setting::FillVoids, ")", left]
}

/// The error for a crop that lies between all files.
fn between(grid: &Grid) -> Error {
    let [west, south, east, north] = grid.extent();
    let what = format!("no file has a sample in {west},{south},{east},{north} {}", grid.crs.units());
    Error::setting(Setting::Crop, what, "move it to where one has")
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
