//! Writes a DEM of any size, a band of rows at a time.

use std::io;
use std::path::Path;

use gdal::DriverManager;
use gdal::raster::{Buffer, RasterCreationOptions};
use gdal::spatial_ref::SpatialRef;
use rayon::prelude::*;

use super::formats;
use super::source::heard;
use crate::error::Result;

/// Samples along a side of the file's tiles, and rows written at once.
const TILE: usize = 512;
/// Where the samples lie: UTM zone 32, its middle meridian and 50 degrees north in the middle.
const EPSG: u32 = 32632;
const MIDDLE: [f64; 2] = [500_000.0, 5_540_000.0];

/// Whether this build has GDAL, which reads and writes rasters.
///
/// # Errors
/// None here; [`Error::Limit`](crate::error::Error::Limit) in a build without.
pub fn available() -> Result<()> {
    Ok(())
}

/// Writes `rows` of `columns` metres as a GeoTIFF, tiled and deflated, with square cells of `cell` metres. `row` gives one
/// row and is asked on several threads; `progress` hears the share done. Memory: 512 rows, twice.
///
/// # Errors
/// GDAL's words where it cannot write.
pub fn write(
    path: &Path,
    [columns, rows]: [usize; 2],
    cell: f64,
    row: impl Fn(usize) -> Vec<f32> + Sync,
    progress: &dyn Fn(f64),
) -> io::Result<()> {
    formats::restrict(false);
    let (width, height) = (format!("BLOCKXSIZE={TILE}"), format!("BLOCKYSIZE={TILE}"));
    let kind = ["COMPRESS=DEFLATE", "PREDICTOR=3", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"];
    let options = RasterCreationOptions::from_iter(["TILED=YES", &width, &height].into_iter().chain(kind));
    let make = || {
        let driver = DriverManager::get_driver_by_name("GTiff")?;
        let mut file = driver.create_with_band_type_with_options::<f32, _>(path, columns, rows, 1, &options)?;
        let [west, north] = [MIDDLE[0] - columns as f64 / 2.0 * cell, MIDDLE[1] + rows as f64 / 2.0 * cell];
        file.set_geo_transform(&[west, cell, 0.0, north, 0.0, -cell])?;
        file.set_spatial_ref(&SpatialRef::from_epsg(EPSG)?)?;
        let mut band = file.rasterband(1)?;
        for first in (0..rows).step_by(TILE) {
            let end = (first + TILE).min(rows);
            let samples = (first..end).into_par_iter().flat_map_iter(&row).collect();
            let size = (columns, end - first);
            band.write((0, first as isize), size, &mut Buffer::new(size, samples))?;
            progress(end as f64 / rows as f64);
        }
        file.close()
    };
    let (made, complaint) = heard(make);
    match complaint.or_else(|| made.err().map(|error| error.to_string())) {
        Some(words) => Err(io::Error::other(words.lines().next().unwrap_or_default().to_owned())),
        None => Ok(()),
    }
}
