//! Reads rasters as one DEM: the whole way from files to metres.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; nothing yet where they
//! stay in their files. Memory of a held DEM at most 12 1/8 bytes a sample: the rasters under way are gone before normals
//! are computed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::elevation::ElevationUnit;
use super::encoding::Encoding;
use super::filed::{Filed, exaggerate};
use super::grid::Grid;
use super::limits::are_held;
use super::mosaic::Mosaic;
use super::nodata::Nodata;
use super::raster::{FILL_REACH, Raster};
use super::target::Target;
use super::{Dem, Georeference, History, Samples, Store};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
/// Sound cell sizes, metres: from a millimetre to a thousand kilometres.
const CELLS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// What to read of files and how to change it on the way.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// West, south, east, north in units of the first file's CRS; samples inside are read. Degrees whose west is beyond
    /// their east cross the meridian of 180 (or 0). `None`, the default, reads all.
    pub crop: Option<[f64; 4]>,
    /// Factor on every elevation, above 0 and at most 1000. Default 1.
    pub exaggeration: f64,
    /// The band with the elevations, from 1. `None`, the default, takes the one called elevation, dem, height, idw or mean,
    /// else the first, and refuses pictures.
    pub band: Option<usize>,
    /// Metres between samples of files that do not say where they lie. Default `None`: such files are refused.
    pub cell: Option<f64>,
    /// Warp to square cells of so many metres. Default `None`: warp only what is not north-up in a map projection.
    pub resample: Option<f64>,
    /// Fill voids up to 100 samples from data. Default false: voids stay holes.
    pub fill_voids: bool,
    /// The unit of elevations, whatever the files say. Default `None`: the files' own, else metres.
    pub elevation_unit: Option<ElevationUnit>,
    /// Numbers of the files that are voids, beside the one they declare. Default none.
    pub nodata: Nodata,
    /// How elevations are packed into the numbers of the files. Default `None`: they are the numbers.
    pub encoding: Option<Encoding>,
    /// Open files on a network, and VRTs that refer to files outside their folder. Default false.
    pub allow_remote: bool,
    /// Bytes of memory for samples and normals. A DEM that takes more stays in its files, and half of them keep what was
    /// read last. Default 1 GiB.
    pub memory: u64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            crop: None,
            exaggeration: 1.0,
            band: None,
            cell: None,
            resample: None,
            fill_voids: false,
            elevation_unit: None,
            nodata: Nodata::default(),
            encoding: None,
            allow_remote: false,
            memory: 1 << 30,
        }
    }
}

/// What is being done, for a progress bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Samples come from the files.
    Read,
    /// They are warped to a north-up grid in metres.
    Warp,
    /// Voids are filled.
    Fill,
}

/// Reads `path` as a DEM of at least 2 x 2 samples, metres, north-up. See [`read_all`].
///
/// # Errors
/// As [`read_all`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Dem> {
    read_all(&[path.as_ref().to_owned()], options, &|_, _| ())
}

/// Reads `paths` as one DEM of at least 2 x 2 samples, metres, north-up.
///
/// Up to [`MAX_SAMPLES`](super::MAX_SAMPLES) are held, if `options.memory` suffices. More stay in their files, up to
/// [`LARGEST_SIDE`](super::LARGEST_SIDE) along a side, where nothing is warped or filled.
///
/// Sample (c, r) lies in the middle of its pixel. Scale, offset and unit of the band are applied, then the exaggeration.
/// Voids are the declared nodata value and those of the options, masked and transparent samples, numbers that are not finite, and marks for no
/// data that the file forgot to declare: at or below -32767, above 100 000 m. Of files that overlap the last wins; those
/// on another grid than the first are warped to it. Degrees and turned grids are warped to square cells in metres.
/// What was converted and what had to be assumed stands in [`Dem::history`]. A path may name one grid of a container as
/// `NETCDF:file:grid`; `.gz`, `.zip` and `.tar` are read through. `progress` hears what is being done and the share done, 0 to 1.
///
/// The first call changes GDAL for the whole process: an error handler that prints nothing, no drivers of rasters off
/// the list of formats, no Python in VRTs, a small cache. No other thread should be inside GDAL at that moment.
///
/// # Errors
/// [`Error::Setting`] for options that make no sense, [`Error::Limit`] for more samples than fit, [`Error::Input`] for a
/// file that is missing, damaged, no raster, nowhere, without elevations, not to be trusted, or outside the crop.
pub fn read_all(paths: &[PathBuf], options: &ReadOptions, progress: &dyn Fn(Stage, f64)) -> Result<Dem> {
    Reading::new(paths, options)?.finish(progress)
}

/// Files opened and understood: what can be known without reading samples.
pub struct Reading {
    pub(super) mosaic: Mosaic,
    pub(super) target: Target,
    history: History,
    options: ReadOptions,
    held: bool,
}

impl Reading {
    /// Opens the files.
    ///
    /// # Errors
    /// Those of [`read_all`] that need no sample.
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

    /// Reads the samples, if they are to be held. `progress`: see [`read_all`].
    ///
    /// # Errors
    /// Those of [`read_all`].
    pub fn finish(self, progress: &dyn Fn(Stage, f64)) -> Result<Dem> {
        let Self { mosaic, target: Target { grid, window, warps }, mut history, options, held } = self;
        let label = mosaic.label();
        let georeference = Georeference::new(mosaic.grid.crs.clone(), grid.crs.clone());
        let store = if held {
            let warped = warps.then_some(&grid);
            Store::Held(hold(Filed::new(mosaic, window, 1.0, 0), warped, &options, &mut history, progress)?)
        } else {
            let budget = usize::try_from(options.memory).unwrap_or(usize::MAX);
            Store::Filed(Arc::new(Filed::new(mosaic, window, options.exaggeration, budget)))
        };
        let metres = grid.crs.metres_per_unit().unwrap_or(1.0);
        if metres != 1.0 {
            history.convert(format!("coordinates x {metres} to metres ({})", grid.crs.units()));
        }
        let (cell, origin) = (grid.cell() * metres, grid.sample(0.0, 0.0) * metres);
        Ok(Dem::new([grid.columns, grid.rows], cell, origin, store)
            .with_source(georeference, history)
            .with_label(label))
    }
}

/// Reads all samples of `files`, which are neither exaggerated nor kept there, and does with them what GDAL does to
/// samples in memory. `warped` is the grid they are warped to.
fn hold(
    files: Filed,
    warped: Option<&Grid>,
    options: &ReadOptions,
    history: &mut History,
    progress: &dyn Fn(Stage, f64),
) -> Result<Samples> {
    let (mut raster, tallies) = files.raster(&|done| progress(Stage::Read, done))?;
    files.assumed(&tallies).into_iter().for_each(|clause| history.assume(clause));
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
    let Raster { grid, mut metres } = raster;
    if metres.iter().all(|height| height.is_nan()) {
        return Err(files.all_void(metres.len(), &tallies));
    }
    exaggerate(&mut metres, options.exaggeration);
    Ok(Samples::new(grid.whole(), metres))
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
