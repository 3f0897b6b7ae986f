//! A build without GDAL: the same names, each of which says that it can do nothing.

use std::io;
use std::iter::Empty;
use std::path::{Path, PathBuf};

use super::{MapFormat, MapLine, OwnLines, ReadOptions, ReadStage, Track};
use crate::dem::{Crs, Dem};
use crate::error::{Error, Result};

/// What is wrong.
const WITHOUT: &str = "this hachure was built without GDAL";
/// What to do about it.
const REMEDY: &str = "build it with its default features: `cargo build --release`";

/// Files opened and understood: there are none.
pub(crate) enum Reading {}

impl Reading {
    /// Opens nothing.
    ///
    /// # Errors
    /// [`Error::Input`], always.
    pub(crate) fn new(paths: &[PathBuf], _: &ReadOptions) -> Result<Self> {
        let path = paths.first().map_or(Path::new("DEM"), PathBuf::as_path);
        Err(Error::input(path, format!("cannot be read, {WITHOUT}"), REMEDY))
    }

    /// Every file on the disk that the DEM is made of.
    pub(crate) fn files(&self) -> Empty<&Path> {
        match *self {}
    }

    /// The format of the first file.
    pub(crate) fn format(&self) -> &str {
        match *self {}
    }

    /// The files' own grid in words, where the DEM is warped from it or its axes are turned.
    pub(crate) fn warped_from(&self) -> Option<String> {
        match *self {}
    }

    /// Reads the samples.
    ///
    /// # Errors
    /// None: nobody has one.
    pub(crate) fn finish(self, _: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
        match self {}
    }

    /// Reads the samples.
    ///
    /// # Errors
    /// None: nobody has one.
    pub(crate) fn finish_as_read(self, _: &dyn Fn(ReadStage, f64)) -> Result<Dem> {
        match self {}
    }

    /// Whether the samples are to be held in memory.
    ///
    /// # Errors
    /// None: nobody has one.
    pub(crate) fn check_held(&self) -> Result<()> {
        match *self {}
    }
}

impl Crs {
    /// Longitude and latitude in degrees, WGS 84.
    ///
    /// # Errors
    /// [`Error::Limit`], always: the register is PROJ's, which GDAL brings along.
    pub fn lonlat() -> Result<Self> {
        Self::from_epsg(4326)
    }

    /// The system that the register of EPSG gives this number.
    ///
    /// # Errors
    /// [`Error::Limit`], always: the register is PROJ's, which GDAL brings along.
    pub fn from_epsg(code: u32) -> Result<Self> {
        Err(without(&format!("EPSG:{code} cannot be looked up")))
    }
}

/// Whether this build has GDAL, which reads and writes rasters.
///
/// # Errors
/// [`Error::Limit`], always.
pub fn available() -> Result<()> {
    Err(without("rasters cannot be read or written"))
}

/// Reads nothing.
///
/// # Errors
/// [`Error::Input`], always.
pub(crate) fn track(path: &Path, _: bool) -> Result<Track> {
    Err(Error::input(path, format!("cannot be read, {WITHOUT}"), REMEDY))
}

/// Reads nothing.
///
/// # Errors
/// [`Error::Input`], always.
pub fn own_lines(path: &Path, _: bool) -> Result<OwnLines> {
    Err(Error::input(path, format!("cannot be read, {WITHOUT}"), REMEDY))
}

/// Writes nothing.
///
/// # Errors
/// The words of [`available`], always.
pub fn write(_: &Path, _: [usize; 2], _: f64, _: impl Fn(usize) -> Vec<f32> + Sync, _: &dyn Fn(f64)) -> io::Result<()> {
    available().map_err(io::Error::other)
}

fn without(what: &str) -> Error {
    Error::limit(format!("{what}, {WITHOUT}"), REMEDY)
}

/// Writes no lines.
///
/// # Errors
/// Always.
pub fn write_lines(_: MapFormat, _: &Crs, _: &[MapLine]) -> io::Result<Vec<u8>> {
    Err(io::Error::other(WITHOUT))
}
