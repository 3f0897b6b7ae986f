//! The whole way from files to metres.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; where they stay in their
//! files nothing yet, but for a look at all of them where they may be multiples of a step. Memory of a held DEM at most 12 1/8
//! bytes a sample: the rasters under way are gone before normals are computed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::crs::Proj;
use super::finest;
use super::grid::GeoGrid;
use super::held::hold;
use super::layer::FileLayer;
use super::layers::Layers;
use super::limits::are_held;
use super::part::Part;
use super::smoothing::Smoothed;
use super::target::Target;
use crate::cache::Cache;
use crate::dem::focal::{Focal, Worked};
use crate::dem::scale::Scale;
use crate::dem::{Dem, Georeference, History, Tiles, not_held};
use crate::error::{Error, Result, Setting};
use crate::geo::info::name_of;
use crate::geo::{ReadOptions, ReadStage};
use crate::message;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
/// Least and largest scale of smoothing, in cells: below it changes nothing, beyond it looks too far around.
const SCALES: [f64; 2] = [2.5, 256.0];
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
        options.generalise.map_or(Ok(()), |metres| check_scale(metres, &target.grid))?;
        Ok(Self { layers, target, history, options: options.clone(), held })
    }

    /// Every file on the disk that the DEM is made of: those named, what they name in turn, archives and containers around
    /// them, and what stands beside each and may be read with it. No output may replace one of them.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.layers.all().iter().flat_map(FileLayer::files)
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
    pub fn finish(self, progress: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
        self.dem(true, progress)
    }

    /// The same for who asks for the range and the voids of files alone: heights that stay in their files are not smoothed,
    /// though the history says how they are drawn.
    ///
    /// # Errors
    /// As [`Self::finish`].
    pub fn finish_as_read(self, progress: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
        self.dem(false, progress)
    }

    /// Whether the samples are to be held in memory.
    ///
    /// # Errors
    /// [`Error::Limit`] where they stay in their files.
    pub fn check_held(&self) -> Result<()> {
        let GeoGrid { columns, rows, .. } = self.target.grid;
        if self.held { Ok(()) } else { Err(not_held([columns, rows])) }
    }

    fn dem(self, smooth: bool, progress: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
        let Self { layers, target, mut history, options, held } = self;
        let label = layers.label();
        let (files, world) = (layers.first().grid.crs.as_defined(), target.grid.crs.clone());
        let georeference = Georeference::new(files, world, Arc::new(Proj));
        let metres = target.grid.crs.metres_per_unit().unwrap_or(1.0);
        let (cell, origin) = (target.grid.cell() * metres, target.grid.sample(0.0, 0.0) * metres);
        let scale = options.generalise.map(|metres| Scale { metres, cell });
        let (columns, units) = (target.grid.columns, target.grid.crs.units().to_owned());
        let dem = if held {
            let heights = hold(layers, target, scale, &options, &mut history, progress)?;
            Dem::from_heights(columns, cell, origin, heights)
        } else {
            let part = looked(layers, &target, &options, &mut history, scale, progress)?;
            let tiles = match smooth {
                true => smoothed(Arc::new(part), scale, &options, label.clone(), &mut history, progress)?,
                false => Arc::new(part),
            };
            let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
            Dem::from_tiles(tiles, cell, origin, options.exaggeration, budget)
        };
        if metres != 1.0 {
            history.convert(format!("coordinates x {metres} to metres ({units})"));
        }
        Ok(dem.with_source(georeference, history).with_label(label))
    }
}

/// The samples of the only layer as they are read from its files, looked at for steps.
fn looked(
    layers: Layers,
    target: &Target,
    options: &ReadOptions,
    history: &mut History,
    scale: Option<Scale>,
    progress: &dyn Fn(ReadStage, f64),
) -> Result<Part> {
    let label = layers.label();
    let part = layers.into_parts(target, options.keep_steps).pop().ok_or_else(|| between(&target.grid))?;
    part.look(&options.cache, label, &|done| progress(ReadStage::Look, done))?;
    tell(std::slice::from_ref(&part), scale, history);
    Ok(part)
}

/// The samples of `part` with all work done on them; what comes of it is kept in the cache.
fn smoothed(
    part: Arc<Part>,
    scale: Option<Scale>,
    options: &ReadOptions,
    label: String,
    history: &mut History,
    progress: &dyn Fn(ReadStage, f64),
) -> Result<Arc<dyn Tiles>> {
    let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
    let smoothing = part.smoothing().cloned();
    let within =
        smoothing.map(|smoothing| Worked::new(part.clone(), Smoothed { part: part.clone(), smoothing }, budget));
    let keep = Keep { cache: &options.cache, label, history, progress: &|done| progress(ReadStage::Smooth, done) };
    match (within, scale) {
        (None, None) => Ok(part),
        (Some(within), None) => keep.keep(within),
        (None, Some(scale)) => keep.keep(Worked::new(part, scale, budget)),
        (Some(within), Some(scale)) => keep.keep(Worked::new(Arc::new(within), scale, budget)),
    }
}

/// How what comes of work is kept.
struct Keep<'a> {
    cache: &'a Cache,
    label: String,
    history: &'a mut History,
    progress: &'a dyn Fn(f64),
}

impl Keep<'_> {
    fn keep<F: Focal + 'static>(self, worked: Worked<F>) -> Result<Arc<dyn Tiles>> {
        worked.too_large_for(self.cache).into_iter().for_each(|why| self.history.convert(why));
        Ok(Arc::new(worked.kept_in(self.cache, self.label, self.progress)?))
    }
}

/// What is smoothed, in words.
pub(super) fn tell(parts: &[Part], scale: Option<Scale>, history: &mut History) {
    let found = || parts.iter().filter_map(|part| Some((part.layer(), &part.smoothing()?.steps)));
    let files = parts.iter().flat_map(|part| part.layer().numbers()).max().map_or(0, |last| last + 1);
    let mut metres = vec![0.0; files];
    for (layer, steps) in found() {
        let words = steps.words();
        history.convert(if parts.len() > 1 { message![format!("{}: ", layer.name()), words] } else { words });
        layer.numbers().iter().zip(steps.metres()).for_each(|(number, step)| metres[*number] = *step);
    }
    if found().next().is_some() {
        history.smooth(metres);
    }
    if let Some(Scale { metres, .. }) = scale {
        history.convert(message![format!("smoothed at a scale of {metres} m ("), Setting::Generalise, ")"]);
    }
}

/// A grid in words.
fn grid_words(grid: &GeoGrid) -> String {
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

/// The error for a crop that lies between all files.
pub(super) fn between(grid: &GeoGrid) -> Error {
    let [west, south, east, north] = grid.extent();
    let what = format!("no file has a sample in {west},{south},{east},{north} {}", grid.crs.units());
    Error::setting(Setting::Crop, what, "move it to where one has")
}

/// A scale at which something is smoothed, and not so many cells that the work grows without end.
fn check_scale(metres: f64, grid: &GeoGrid) -> Result<()> {
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
