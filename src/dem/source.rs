//! Opens a raster file through GDAL and keeps GDAL silent.
//!
//! GDAL prints its complaints on stderr as they come, often several for one fault. The first use of this module
//! installs a process-wide GDAL error handler that prints nothing and keeps the first complaint of each thread as
//! context for our own one line. What a name means is settled in `name`, what a file would make GDAL open in `vrt`, and
//! which drivers may read it in `formats`, before GDAL opens anything. Not handled: directories that GDAL takes for one
//! raster, and HDF5, which prints diagnostics of its own when netCDF is read on another thread than the first.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};
use gdal::raster::{GdalDataType, RasterBand};
use gdal::{Dataset, DatasetOptions, GdalOpenFlags, Metadata, config};

use super::formats::{self, FORMATS, VECTORS};
use super::name::{Local, Name, Place};
use super::vrt;
use crate::error::{Error, Result};

thread_local! {
    /// The first complaint of GDAL on this thread since `heard` last began.
    static COMPLAINT: Cell<Option<String>> = const { Cell::new(None) };
}

/// Smallest side of a grid: one cell needs four samples.
pub(super) const MIN_SIDE: usize = 2;

/// A raster file, open for reading, with at least one band of real numbers and 2 x 2 samples.
pub(super) struct Source {
    /// The file as the user named it.
    pub path: PathBuf,
    /// GDAL's handle.
    pub dataset: Dataset,
    /// Samples from the first to the last column.
    pub columns: usize,
    /// Samples from the first to the last row.
    pub rows: usize,
    /// The band of elevations, from 1.
    pub band: usize,
    /// It and all rasters that VRTs name, as GDAL calls them.
    pub rasters: Vec<(PathBuf, Place)>,
}

impl Source {
    /// Opens `path` for the elevations in `band`, counted from 1. Fails when it is missing, no file, empty, no raster of
    /// a format on the list, or no grid of real numbers; and, without `allow_remote`, when it or anything it names lies
    /// on a network or, for a VRT, outside its folder.
    pub fn open(path: &Path, band: usize, allow_remote: bool) -> Result<Self> {
        formats::restrict(allow_remote);
        let (name, place) = connection(path, allow_remote)?;
        let vrt::Inspected { is_vrt, rasters } = vrt::inspect(path, &name, &place, allow_remote)?;
        // What was not inspected as a VRT is not opened as one.
        let drivers = if is_vrt { ["VRT"].as_slice() } else { &FORMATS };
        let flags =
            GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR;
        let (opened, complaint) = heard(|| open_as(&name, flags, drivers));
        let dataset = opened.map_err(|_| cannot_open(path, &name, complaint))?;
        let (columns, rows) = dataset.raster_size();
        let source = Self { path: path.to_owned(), dataset, columns, rows, band, rasters };
        source.check_band(&name)?;
        source.check_length()?;
        Ok(source)
    }

    /// The band of elevations.
    pub fn band(&self) -> Result<RasterBand<'_>> {
        self.dataset.rasterband(self.band).map_err(|_| {
            let count = self.dataset.raster_count();
            let bands = if count == 1 { "1 band".to_owned() } else { format!("{count} bands") };
            let remedy = format!("give `--band N` with N from 1 to {count}");
            self.error(format!("has {bands}, none of them is band {}", self.band), remedy)
        })
    }

    /// An error about this file.
    pub fn error(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::input(&self.path, what, remedy)
    }

    /// The error for samples that cannot be read, with GDAL's words where it has any: it says once, not twice, that a
    /// part of a mosaic is missing.
    pub fn unreadable(&self, words: Option<&str>) -> Error {
        let what = match words {
            Some(words) => format!("is damaged or cut short ({})", one_line(words, &self.path)),
            None => "is damaged or cut short, or lacks a file that it refers to".to_owned(),
        };
        self.error(what, "copy or download it again")
    }

    /// One band of real numbers, wide and high enough for a cell.
    fn check_band(&self, name: &Path) -> Result<()> {
        if self.dataset.raster_count() == 0 {
            return Err(self.no_band(name));
        }
        if self.band()?.band_type() == GdalDataType::Unknown {
            return Err(self.error(
                "holds complex numbers, not elevations",
                "give a file of real numbers, for instance made by `gdal_translate -ot Float32 IN OUT.tif`",
            ));
        }
        if self.columns < MIN_SIDE || self.rows < MIN_SIDE {
            let what = format!("is {} x {} samples; a surface needs at least 2 x 2", self.columns, self.rows);
            return Err(self.error(what, "give a larger grid"));
        }
        Ok(())
    }

    /// A container of several grids, or of none.
    fn no_band(&self, name: &Path) -> Error {
        let absolute = name.to_string_lossy();
        let listed = self.dataset.metadata_domain("SUBDATASETS").unwrap_or_default();
        let grids = listed.iter().filter_map(|line| line.split_once("_NAME=").map(|(_, grid)| grid));
        let shown = self.path.to_string_lossy();
        let grids: Vec<_> = grids.map(|g| g.replace(&*absolute, &shown).replace('"', "")).collect();
        match grids.first() {
            Some(first) => self.error(
                format!("holds {} grids, and which one is meant is not said", grids.len()),
                format!("name the one with the elevations, for instance `{first}`"),
            ),
            None => self.error("holds no grid", "give a file with a raster band of elevations"),
        }
    }

    /// GDAL fills the missing end of an ENVI file with zeros, and zeros would pass for sea.
    fn check_length(&self) -> Result<()> {
        if self.dataset.driver().short_name() != "ENVI" || starts_with_gzip(&self.path) {
            return Ok(());
        }
        let bytes = self.dataset.rasterbands().flatten().map(|b| u64::from(b.band_type().bytes())).sum::<u64>();
        let promised = self.columns as u64 * self.rows as u64 * bytes;
        match fs::metadata(&self.path) {
            Ok(file) if file.len() < promised => {
                Err(self.unreadable(Some(&format!("{} of {promised} bytes are there", file.len()))))
            }
            _ => Ok(()),
        }
    }
}

/// Runs `work` and returns what it returns and the first complaint GDAL made meanwhile.
pub(super) fn heard<T>(work: impl FnOnce() -> T) -> (T, Option<String>) {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        config::set_error_handler(|class, _, words| {
            if matches!(class, CplErrType::Failure | CplErrType::Fatal) {
                let words = words.to_owned();
                COMPLAINT.with(|complaint| complaint.set(complaint.take().or(Some(words))));
            }
        });
    });
    COMPLAINT.take();
    let result = work();
    (result, COMPLAINT.take())
}

fn open_as(name: &Path, open_flags: GdalOpenFlags, drivers: &[&str]) -> std::result::Result<Dataset, GdalError> {
    Dataset::open_ex(name, DatasetOptions { open_flags, allowed_drivers: Some(drivers), ..Default::default() })
}

/// What GDAL is asked to open and where that lies: absolute, so that no file name is taken for something else.
fn connection(path: &Path, allow_remote: bool) -> Result<(PathBuf, Place)> {
    let name = match path.to_str() {
        Some(text) if !path.exists() => Name::of(text),
        _ => Name::Local(Local::by_ending(path)),
    };
    match name {
        Name::Local(mut local) => {
            check_file(path, &local.file)?;
            local.file = std::path::absolute(&local.file).map_err(|e| unreadable_file(path, &e))?;
            Ok((local.connection(), local.place()))
        }
        Name::Remote(name) if allow_remote => Ok((name, Place::Remote)),
        Name::Remote(_) => Err(Error::input(
            path,
            "lies on a network",
            "download it first, or add `--allow-remote` if you trust where it comes from",
        )),
        Name::Other => Err(Error::input(
            path,
            "is no file, but a connection to something else",
            "save the raster to a file and name that",
        )),
    }
}

/// A regular file that is there, readable and not empty.
fn check_file(path: &Path, file: &Path) -> Result<()> {
    let found = fs::metadata(file).map_err(|e| unreadable_file(path, &e))?;
    if found.is_dir() {
        return Err(Error::input(path, "is a directory", "name the raster file in it"));
    }
    if !found.is_file() {
        return Err(Error::input(path, "is not a regular file", "save the raster to a file and name that"));
    }
    if found.len() == 0 {
        return Err(Error::input(path, "is empty (0 bytes)", "copy or download it again"));
    }
    File::open(file).map(drop).map_err(|e| unreadable_file(path, &e))
}

fn unreadable_file(path: &Path, error: &std::io::Error) -> Error {
    match error.kind() {
        std::io::ErrorKind::NotFound => {
            Error::input(path, "there is no such file", "check the spelling and the folder")
        }
        std::io::ErrorKind::PermissionDenied => {
            Error::input(path, "may not be read", "ask its owner for permission to read it")
        }
        _ => Error::input(path, format!("cannot be read ({error})"), "check the file and the disk"),
    }
}

/// Why GDAL did not open `name`: vector data, a fault that GDAL names, or no raster at all.
fn cannot_open(path: &Path, name: &Path, complaint: Option<String>) -> Error {
    let (vector, _) = heard(|| open_as(name, GdalOpenFlags::GDAL_OF_VECTOR, &VECTORS));
    if vector.is_ok_and(|v| v.layer_count() > 0) {
        return Error::input(
            path,
            "holds points, lines or areas, not a raster of elevations",
            "give a DEM raster; contours and points become one with `gdal_grid`",
        );
    }
    match complaint.filter(|words| !words.contains("not recognized as a supported file format")) {
        Some(words) => Error::input(
            path,
            format!("cannot be opened as a raster ({})", one_line(&words, path)),
            "check the file with `gdalinfo`",
        ),
        None => Error::input(
            path,
            "is in no raster format that hachure reads",
            "give a DEM such as GeoTIFF, .asc, .flt, .bil or .dem, perhaps made by `gdal_translate IN OUT.tif`",
        ),
    }
}

/// The first sentence of GDAL's words, with the file as the user named it, and no full stop.
fn one_line(words: &str, path: &Path) -> String {
    let sentence = words.lines().next().unwrap_or_default().split(". ").next().unwrap_or_default();
    let line = sentence.trim().trim_end_matches('.');
    let absolute = std::path::absolute(path).unwrap_or_default();
    match absolute.to_str() {
        Some(absolute) if !absolute.is_empty() => line.replace(absolute, &path.to_string_lossy()),
        _ => line.to_owned(),
    }
}

fn starts_with_gzip(path: &Path) -> bool {
    let mut start = [0; 2];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok_and(|()| start == [0x1f, 0x8b])
}
