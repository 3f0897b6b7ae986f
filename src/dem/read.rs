//! Reads band 1 of a raster as metres: the window asked for, in blocks of rows.
//!
//! Cost: one pass over the window; memory is 5 bytes a sample and one block. Not handled: resampling, warping, several
//! files.

use std::path::Path;

use gdal::raster::{GdalType, RasterBand};

use super::Dem;
use super::elevation::{Elevation, Reading};
use super::georeference::{Georeference, Window};
use super::source::{MIN_SIDE, Source, heard};
use crate::error::{Error, Result};

/// Most samples of a DEM: 2^25, 128 MiB of heights, the largest buffer that every GPU binds.
pub const MAX_SAMPLES: usize = 1 << 25;

/// Largest exaggeration: above it the highest mountain stands higher than the Earth is wide.
const MAX_EXAGGERATION: f64 = 1000.0;
/// Samples read at once: 8 MiB of f64.
const BLOCK_SAMPLES: usize = 1 << 20;

/// What to read of a file and how to change it on the way.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// West, south, east, north in the file's CRS; samples whose centres lie inside are read. `None`, the default,
    /// reads all.
    pub crop: Option<[f64; 4]>,
    /// Factor on every elevation, above 0 and at most 1000. Default 1.
    pub exaggeration: f64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { crop: None, exaggeration: 1.0 }
    }
}

/// Reads band 1 of `path` as a DEM of at least 2 x 2 and at most [`MAX_SAMPLES`] samples, metres, north-up.
///
/// Sample (c, r) lies in the middle of its pixel. Scale and offset of the band are applied, then the exaggeration.
/// Voids are the declared nodata value, masked and transparent samples, numbers that are not finite, and marks for no data that the file forgot to
/// declare: at or below -32767 m, above 100 000 m. A file without a coordinate reference system counts as metres.
/// `path` may name one grid of a container as `NETCDF:file:grid`; `.gz` and `.zip` are read through.
///
/// The first call installs a GDAL error handler that prints nothing, for the whole process.
///
/// # Errors
/// [`Error::Flag`] for options that make no sense, [`Error::Limit`] for more samples than fit, [`Error::Input`] for a
/// file that is missing, damaged, no raster, not in north-up metres, without elevations, or outside the crop.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Dem> {
    check_options(options)?;
    Grid::open(path)?.load(options).map(|loaded| loaded.dem)
}

/// An open raster whose place and elevations are understood.
pub(super) struct Grid {
    pub source: Source,
    pub georeference: Georeference,
    pub elevation: Elevation,
}

/// A DEM and how it came about.
pub(super) struct Loaded {
    pub dem: Dem,
    /// Samples that became void by their impossible value alone.
    pub sentinels: usize,
}

impl Grid {
    /// Opens `path` and checks all that can be checked without reading samples.
    pub fn open(path: &Path) -> Result<Self> {
        let source = Source::open(path)?;
        // First the elevations: a warp may lose their unit, and feet would pass for metres.
        let elevation = Elevation::of(&source)?;
        let georeference = Georeference::of(&source)?;
        Ok(Self { source, georeference, elevation })
    }

    /// Reads the samples.
    pub fn load(&self, options: &ReadOptions) -> Result<Loaded> {
        let window = self.window(options.crop)?;
        let mut heights = Vec::with_capacity(window.size[0] * window.size[1]);
        let mut sentinels = 0;
        self.each_block(window, |raw| {
            heights.extend(raw.iter().map(|raw| match self.elevation.reading(*raw) {
                Reading::Metres(metres) => (metres * options.exaggeration) as f32,
                Reading::Void => f32::NAN,
                Reading::Sentinel => {
                    sentinels += 1;
                    f32::NAN
                }
            }));
        })?;
        if heights.iter().all(|h| !h.is_finite()) {
            let inside = if options.crop.is_some() { " inside the crop" } else { "" };
            return Err(self.source.error(
                format!("holds no elevation{inside}, all {} samples are void", heights.len()),
                "check band 1 and its nodata value with `gdalinfo -stats`, or move --crop",
            ));
        }
        let origin = self.georeference.sample(window.first[0], window.first[1]);
        let dem = Dem::from_heights(window.size[0], self.georeference.cell, origin, heights);
        Ok(Loaded { dem: dem.with_crs(self.crs()), sentinels })
    }

    /// Name and EPSG code of the CRS, empty when the file has none.
    pub fn crs(&self) -> String {
        match self.georeference.epsg {
            Some(code) => format!("{} (EPSG:{code})", self.georeference.crs),
            None => self.georeference.crs.clone(),
        }
    }

    /// The samples to read: at least 2 x 2, at most [`MAX_SAMPLES`].
    fn window(&self, crop: Option<[f64; 4]>) -> Result<Window> {
        let Source { columns, rows, .. } = self.source;
        let window = match crop {
            None => Window { first: [0, 0], size: [columns, rows] },
            Some(crop) => self.georeference.window(&self.source, crop).ok_or_else(|| self.outside())?,
        };
        let [width, height] = window.size;
        if width < MIN_SIDE || height < MIN_SIDE {
            let cell = self.georeference.cell;
            return Err(self.source.error(
                format!("--crop leaves {width} x {height} samples; a surface needs at least 2 x 2"),
                format!("widen it: the samples are {} m east and {} m north apart", cell.x, cell.y),
            ));
        }
        let samples = width as u64 * height as u64;
        if samples > MAX_SAMPLES as u64 {
            return Err(Error::Limit {
                what: format!(
                    "{}: {width} x {height} = {samples} samples, at most {MAX_SAMPLES} fit",
                    self.source.path.display()
                ),
                remedy: "use --crop to take a part, or make it coarser with `gdalwarp -tr M M -r average`".into(),
            });
        }
        Ok(window)
    }

    fn outside(&self) -> Error {
        let Source { columns, rows, .. } = self.source;
        let [nw, se] = [self.georeference.sample(0, 0), self.georeference.sample(columns - 1, rows - 1)];
        self.source.error(
            "no sample lies inside --crop",
            format!("give E0,N0,E1,N1 within {},{},{},{} m", nw.x, se.y, se.x, nw.y),
        )
    }

    /// Hands the raw numbers of `window` to `take`, row-major, a few rows at a time; NaN where the file masks them.
    fn each_block(&self, window: Window, mut take: impl FnMut(&[f64])) -> Result<()> {
        let band = self.source.band()?;
        let masked = band.mask_flags().is_ok_and(|flags| flags.is_per_dataset());
        let mask = if masked { band.open_mask_band().ok() } else { None };
        let ([column, first_row], [width, height]) = (window.first, window.size);
        let step = (BLOCK_SAMPLES / width).max(1);
        for row in (0..height).step_by(step) {
            let place = (column as isize, (first_row + row) as isize);
            let size = (width, step.min(height - row));
            let mut raw = self.block::<f64>(&band, place, size)?;
            if let Some(mask) = &mask {
                let seen = self.block::<u8>(mask, place, size)?;
                raw.iter_mut().zip(seen).filter(|(_, seen)| *seen == 0).for_each(|(raw, _)| *raw = f64::NAN);
            }
            take(&raw);
        }
        Ok(())
    }

    /// One block of numbers, or the error for a damaged file.
    fn block<T: GdalType + Copy>(
        &self,
        band: &RasterBand,
        place: (isize, isize),
        size: (usize, usize),
    ) -> Result<Vec<T>> {
        let (block, complaint) = heard(|| band.read_as::<T>(place, size, size, None));
        match (block, complaint) {
            (Ok(block), None) => Ok(block.into_shape_and_vec().1),
            // A driver that complains and goes on has made the numbers up.
            (_, words) => Err(self.source.unreadable(words.as_deref())),
        }
    }
}

fn check_options(options: &ReadOptions) -> Result<()> {
    let factor = options.exaggeration;
    if !(factor > 0.0 && factor <= MAX_EXAGGERATION) {
        let what = format!("{factor} is no factor to draw with");
        return Err(Error::flag("--exaggeration", what, "give a number above 0 and at most 1000"));
    }
    let Some([west, south, east, north]) = options.crop else { return Ok(()) };
    let finite = [west, south, east, north].iter().all(|edge| edge.is_finite());
    if finite && west < east && south < north {
        return Ok(());
    }
    let what = format!("{west},{south},{east},{north} is no rectangle");
    Err(Error::flag("--crop", what, "give west,south,east,north with west < east and south < north"))
}
