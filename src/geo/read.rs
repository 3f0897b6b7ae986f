//! Reads rasters as one DEM: what to ask, and what is done.
//!
//! Cost: one pass over the samples that the drawn part needs, and the warp where there is one; where they stay in their files
//! nothing yet, but for a look at all of them where they may be multiples of a step, once a cache.

use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

use super::{ElevationUnit, Encoding, Nodata, Reading};
use crate::cache::Cache;
use crate::dem::Dem;
use crate::error::Result;

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
    /// How files on several grids lie on one another. Default: the finest on top.
    pub order: Order,
    /// The file whose grid is drawn. Default `None`: that of the finest file whose samples fit.
    pub cell_of: Option<PathBuf>,
    /// Warp to square cells of so many metres. Default `None`: warp only what is not north-up in a map that is true.
    pub resample: Option<f64>,
    /// Warp maps whose metres are off those on the ground by more than a percent (shear, unequal scale) to the UTM zone of
    /// their middle, where the outcome can be held. Default true.
    pub warp: bool,
    /// Fill voids up to 100 samples from data. Default false: voids stay holes.
    pub fill_voids: bool,
    /// The unit of elevations, whatever the files say. Default `None`: the files' own, else metres.
    pub elevation_unit: Option<ElevationUnit>,
    /// Numbers of the files that are voids, beside the one they declare. Default none.
    pub nodata: Nodata,
    /// How elevations are packed into the numbers of the files. Default `None`: they are the numbers.
    pub encoding: Option<Encoding>,
    /// Leave heights at the multiples of a step that the files hold, stairs and all. Default false: the smoothest surface
    /// within half a step of them is drawn.
    pub keep_steps: bool,
    /// Smooth at a scale of so many metres, from 2.5 cells to 256. Default `None`: not.
    pub generalise: Option<f64>,
    /// Where smoothed heights are kept of samples that stay in their files, and what was found of steps. Default none: they
    /// are smoothed as they are asked for.
    pub cache: Cache,
    /// Open files on a network, and VRTs that refer to files outside their folder. Default false.
    pub allow_remote: bool,
    /// Bytes of memory for samples and normals. A DEM that takes more stays in its files, and half of them keep what was
    /// read last. Default 1 GiB.
    pub memory: u64,
}

/// How files on several grids lie on one another. Of those whose samples fall on one grid the last is on top anyway.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// The finest on top, the last of those with like cells, blended along their seams.
    #[default]
    FinestOnTop,
    /// As they are given, the last on top as it is: nothing is blended.
    Given,
}

impl Order {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::FinestOnTop, Self::Given];
}

/// `finest` or `given`.
impl Display for Order {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FinestOnTop => "finest",
            Self::Given => "given",
        })
    }
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            crop: None,
            exaggeration: 1.0,
            band: None,
            cell: None,
            order: Order::default(),
            cell_of: None,
            resample: None,
            warp: true,
            fill_voids: false,
            elevation_unit: None,
            nodata: Nodata::default(),
            encoding: None,
            keep_steps: false,
            generalise: None,
            cache: Cache::none(),
            allow_remote: false,
            memory: 1 << 30,
        }
    }
}

/// What is being done, for a progress bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadStage {
    /// Samples come from the files.
    Read,
    /// They are warped to a north-up grid in metres.
    Warp,
    /// Voids are filled.
    Fill,
    /// All samples are looked at for steps, where they stay in their files.
    Look,
    /// They are smoothed, where they stay in their files.
    Smooth,
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
/// Up to [`MAX_SAMPLES`](crate::dem::MAX_SAMPLES) are held, if `options.memory` suffices. More stay in their files, up to
/// [`LARGEST_SIDE`](crate::dem::LARGEST_SIDE) along a side, where nothing is warped or filled.
///
/// Sample (c, r) lies in the middle of its pixel. Scale, offset and unit of the band are applied, then the exaggeration.
/// Voids are the declared nodata value and those of the options, masked and transparent samples, numbers that are not finite, and marks for no
/// data that the file forgot to declare: at or below -32767, above 100 000 m. Of files that overlap on one grid the last
/// wins. Files on several grids are warped, cubic, to that of the finest whose samples fit; the finest lies on top, and
/// seams are blended over four cells of the coarser, less where the finer is narrow. Degrees and turned grids are warped to square cells in metres.
/// Where all numbers of a file are multiples of a step (whole metres, feet, tenths), its heights become the smoothest surface
/// within half a step of them, before any warp; flat water stays flat.
/// What was converted and what had to be assumed stands in [`Dem::history`]. A path may name one grid of a container as
/// `NETCDF:file:grid`; `.gz`, `.zip` and `.tar` are read through. `progress` hears what is being done and the share done, 0 to 1.
///
/// The first call changes GDAL for the whole process: an error handler that prints nothing, no drivers of rasters off
/// the list of formats, no Python in VRTs, a small cache. No other thread should be inside GDAL at that moment.
///
/// # Errors
/// [`Error::Setting`](crate::error::Error::Setting) for options that make no sense,
/// [`Error::Limit`](crate::error::Error::Limit) for more samples than fit, [`Error::Input`](crate::error::Error::Input) for a
/// file that is missing, damaged, no raster, nowhere, without elevations, not to be trusted, or outside the crop.
pub fn read_all(paths: &[PathBuf], options: &ReadOptions, progress: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
    Reading::new(paths, options)?.finish(progress)
}
