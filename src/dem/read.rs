//! Reads a raster through GDAL: the only place that knows GDAL.

use std::path::Path;

use super::Dem;
use crate::error::Result;

/// What to read of a file and how to change it on the way.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// West, south, east, north in the file's CRS; `None` reads all.
    pub crop: Option<[f64; 4]>,
    /// Factor on every elevation. Default 1.
    pub exaggeration: f64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { crop: None, exaggeration: 1.0 }
    }
}

/// Reads `path` as a DEM.
pub fn read(_path: &Path, _options: &ReadOptions) -> Result<Dem> {
    unimplemented!()
}

/// `hachure info`.
pub fn describe(_path: &Path) -> Result<String> {
    unimplemented!()
}
