//! Elevations under way: metres on a grid in memory, which GDAL can warp and fill.
//!
//! Memory: 4 bytes a sample; GDAL works on them where they lie.

use glam::DVec2;

use super::crs::CrsPath;
use super::grid::GeoGrid;
use super::lent::Lent;
use crate::error::{Error, Result, Setting, without_end};
use crate::message;

/// Farthest that GDAL fills from a sample with data, in samples: its own default.
pub(super) const FILL_REACH: u32 = 100;
/// Farthest, in cells of the finer of two grids, that the warper's quick way of placing samples may miss the exact one.
const WARP_CELLS: f64 = 0.01;
/// From this many samples a sample on, nothing is smoothed when warping; from its inverse on, samples are enlarged.
const DENSE: f64 = 2.0 / 3.0;
/// Memory of the warper beside the rasters, MiB.
const WARP_MEMORY: &str = "32";

/// A grid of elevations in metres, NaN at voids.
pub(super) struct Raster {
    /// Where the samples lie.
    pub grid: GeoGrid,
    /// Metres, row-major.
    pub metres: Vec<f32>,
}

impl Raster {
    /// All void.
    pub(super) fn void(grid: GeoGrid) -> Result<Self> {
        let samples = grid.columns * grid.rows;
        let mut metres = Vec::new();
        without_end(|| metres.try_reserve_exact(samples)).map_err(|e| out_of_memory(&grid, &e.to_string()))?;
        metres.resize(samples, f32::NAN);
        Ok(Self { grid, metres })
    }

    /// How many samples are void.
    pub(super) fn voids(&self) -> usize {
        self.metres.iter().filter(|height| height.is_nan()).count()
    }

    /// Lays `from` over what is here, by cubic convolution in the systems and grids of both; voids of `from` cover
    /// nothing. `progress` hears the share done.
    pub(super) fn lay(&mut self, from: &Self, progress: &dyn Fn(f64)) -> Result<()> {
        let threads = "NUM_THREADS=ALL_CPUS";
        // GDAL's own estimate takes turned grids for smaller ones and blurs them.
        let density = density(&from.grid, &self.grid);
        let [x, y] = density.map(|ratio| if ratio < DENSE { ratio } else { 1.0 });
        let (x, y) = (format!("XSCALE={x}"), format!("YSCALE={y}"));
        // It takes cells of `from`.
        let finer = density
            .into_iter()
            .fold(1.0, |finest: f64, ratio| if ratio > 1.0 / DENSE { finest.max(ratio) } else { finest });
        let cells = (WARP_CELLS / finer).to_string();
        let quick = ["-et", &cells, "-wm", WARP_MEMORY, "-wo", threads];
        let words = [&["-r", "cubic", "-novshift", "-wo", &x, "-wo", &y], &quick[..]].concat();
        let from_samples =
            Lent::reading(&from.metres, &from.grid).map_err(|words| out_of_memory(&from.grid, &words))?;
        let laid =
            Lent::writing(&mut self.metres, &self.grid).and_then(|mut onto| onto.warp(&from_samples, &words, progress));
        laid.map_err(|words| out_of_memory(&self.grid, &words))
    }

    /// Fills voids up to [`FILL_REACH`] samples from data, by inverse distance weighting. `progress` hears the share done.
    pub(super) fn fill(&mut self, progress: &dyn Fn(f64)) -> Result<()> {
        let filled = Lent::writing(&mut self.metres, &self.grid).and_then(|mut onto| onto.fill(FILL_REACH, progress));
        filled.map_err(|words| out_of_memory(&self.grid, &words))
    }
}

/// Samples of `onto` a sample of `from`, along its rows and down its columns, in the middle of `from`.
fn density(from: &GeoGrid, onto: &GeoGrid) -> [f64; 2] {
    let middle = DVec2::new(from.columns as f64, from.rows as f64) / 2.0;
    let mut places = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|step| from.to_crs.transform_point2(middle + step));
    if let Some(way) = CrsPath::between(&from.crs, &onto.crs) {
        way.carry(&mut places);
    }
    onto.pixels(&mut places);
    [places[1], places[2]].map(|place| (place - places[0]).length())
}

/// What else can fail in memory.
fn out_of_memory(grid: &GeoGrid, words: &str) -> Error {
    let words = words.lines().next().unwrap_or_default();
    Error::limit(
        format!("{} x {} samples cannot be held and warped in memory ({words})", grid.columns, grid.rows),
        message!["use ", Setting::Crop, " to take a part, or ", Setting::Resample.with_value(), " for larger cells"],
    )
}

#[cfg(test)]
mod tests {
    use glam::DAffine2;

    use super::*;
    use crate::dem::Crs;

    #[test]
    fn more_than_memory_is_an_error_in_words() {
        let grid = GeoGrid { crs: Crs::unknown(), to_crs: DAffine2::IDENTITY, columns: 1 << 30, rows: 1 << 30 };
        let said = Raster::void(grid).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.starts_with("1073741824 x 1073741824 samples cannot be held"), "{said}");
        assert!(said.ends_with("use crop to take a part, or resample for larger cells"), "{said}");
    }
}
