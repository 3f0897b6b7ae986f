//! Elevations under way: metres on a grid in memory, which GDAL can warp and fill.
//!
//! Memory: 4 bytes a sample; GDAL works on them where they lie. Unsafe calls stand here: GDAL's warper and filler have
//! no safe wrapper.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::null_mut;

use gdal::errors::GdalError;
use gdal::{Dataset, DriverManager};
use glam::DVec2;

use super::crs::Way;
use super::grid::Grid;
use super::source::heard;
use crate::error::{Error, Result, Setting, without_end};
use crate::message;

/// Farthest that GDAL fills from a sample with data, in samples: its own default.
pub const FILL_REACH: u32 = 100;
/// Farthest, in cells, that the warper's quick way of placing samples may miss the exact one.
const WARP_CELLS: &str = "0.01";
/// From this many samples a sample on, nothing is smoothed when warping.
const DENSE: f64 = 2.0 / 3.0;
/// Memory of the warper beside the rasters, MiB.
const WARP_MEMORY: &str = "32";

/// A grid of elevations in metres, NaN at voids.
pub(super) struct Raster {
    /// Where the samples lie.
    pub grid: Grid,
    /// Metres, row-major.
    pub metres: Vec<f32>,
}

impl Raster {
    /// All void.
    pub fn void(grid: Grid) -> Result<Self> {
        let samples = grid.columns * grid.rows;
        let mut metres = Vec::new();
        without_end(|| metres.try_reserve_exact(samples)).map_err(|e| out_of_memory(&grid, &e.to_string()))?;
        metres.resize(samples, f32::NAN);
        Ok(Self { grid, metres })
    }

    /// How many samples are void.
    pub fn voids(&self) -> usize {
        self.metres.iter().filter(|height| height.is_nan()).count()
    }

    /// Lays `from` over what is here, by cubic convolution in the systems and grids of both; voids of `from` cover
    /// nothing. `progress` hears the share done.
    pub fn lay(&mut self, from: &Self, progress: &dyn Fn(f64)) -> Result<()> {
        let threads = "NUM_THREADS=ALL_CPUS";
        // GDAL's own estimate takes turned grids for smaller ones and blurs them.
        let [x, y] = shrink(&from.grid, &self.grid);
        let (x, y) = (format!("XSCALE={x}"), format!("YSCALE={y}"));
        let quick = ["-et", WARP_CELLS, "-wm", WARP_MEMORY, "-wo", threads];
        let words = [&["-r", "cubic", "-novshift", "-wo", &x, "-wo", &y], &quick[..]].concat();
        let words: Vec<_> = words.into_iter().map(|word| CString::new(word).unwrap_or_default()).collect();
        let mut list = pointers(&words);
        let onto_metres = self.metres.as_mut_ptr();
        let (from, laid) = (from.dataset(from.metres.as_ptr().cast_mut())?, self.dataset(onto_metres)?);
        let mut sources = [from.c_dataset()];
        let onto = laid.c_dataset();
        let work = || {
            let mut misused: c_int = 0;
            // SAFETY: `list` ends with null and its strings outlive the call, as do both datasets with their samples (those
            // of `onto` borrowed for writing) and `progress`, which `share` alone reads, on this thread while GDALWarp
            // runs. The result is `onto` itself or null.
            unsafe {
                let options = gdal_sys::GDALWarpAppOptionsNew(list.as_mut_ptr(), null_mut());
                gdal_sys::GDALWarpAppOptionsSetProgress(options, Some(share), argument(&progress));
                let done = gdal_sys::GDALWarp(null_mut(), onto, 1, sources.as_mut_ptr(), options, &raw mut misused);
                gdal_sys::GDALWarpAppOptionsFree(options);
                !done.is_null() && misused == 0
            }
        };
        let (done, words) = heard(work);
        if done { Ok(()) } else { Err(self.failed(words, "the warper gave up")) }
    }

    /// Fills voids up to [`FILL_REACH`] samples from data, by inverse distance weighting. `progress` hears the share done.
    pub fn fill(&mut self, progress: &dyn Fn(f64)) -> Result<()> {
        // Its working rasters would otherwise be files in the folder where hachure is started.
        let words = [c"TEMP_FILE_DRIVER=MEM".to_owned()];
        let mut list = pointers(&words);
        let metres = self.metres.as_mut_ptr();
        let filled = self.dataset(metres)?;
        let dataset = filled.c_dataset();
        let work = || {
            // SAFETY: as in `lay`; band 1 is there, and without a mask GDAL takes the band's own, NaN.
            unsafe {
                let band = gdal_sys::GDALGetRasterBand(dataset, 1);
                let reach = f64::from(FILL_REACH);
                let argument = argument(&progress);
                gdal_sys::GDALFillNodata(band, null_mut(), reach, 0, 0, list.as_mut_ptr(), Some(share), argument)
            }
        };
        let (done, words) = heard(work);
        if done == gdal_sys::CPLErr::CE_None { Ok(()) } else { Err(self.failed(words, "the filler gave up")) }
    }

    /// GDAL's dataset over `metres`, a pointer to the samples: it must not outlive them, nor write to those that are
    /// borrowed for reading.
    fn dataset(&self, metres: *mut f32) -> Result<Dataset> {
        let grid = &self.grid;
        let words = [CString::new(format!("DATAPOINTER=0x{:x}", metres as usize)).unwrap_or_default()];
        let make = || {
            let memory = DriverManager::get_driver_by_name("MEM")?;
            let mut dataset = memory.create_with_band_type::<f32, _>("", grid.columns, grid.rows, 0)?;
            let mut list = pointers(&words);
            // SAFETY: `list` ends with null and its string outlives the call; the pointer leads to as many samples.
            let class = unsafe {
                gdal_sys::GDALAddBand(dataset.c_dataset(), gdal_sys::GDALDataType::GDT_Float32, list.as_mut_ptr())
            };
            if class != gdal_sys::CPLErr::CE_None {
                return Err(GdalError::CplError { class, number: 0, msg: "no band can be added".into() });
            }
            let ([x, y], m) = (grid.to_crs.translation.to_array(), grid.to_crs.matrix2);
            dataset.set_geo_transform(&[x, m.x_axis.x, m.y_axis.x, y, m.x_axis.y, m.y_axis.y])?;
            if let Some(reference) = grid.crs.reference() {
                dataset.set_spatial_ref(&reference)?;
            }
            dataset.rasterband(1)?.set_no_data_value(Some(f64::NAN))?;
            Ok::<_, GdalError>(dataset)
        };
        let (made, words) = heard(make);
        made.map_err(|e| self.failed(words, &e.to_string()))
    }

    fn failed(&self, words: Option<String>, otherwise: &str) -> Error {
        out_of_memory(&self.grid, words.as_deref().unwrap_or(otherwise))
    }
}

/// Samples of `onto` a sample of `from`, along its rows and down its columns, in the middle of `from`; 1 where they are
/// about as dense or denser, for there is nothing to smooth away.
fn shrink(from: &Grid, onto: &Grid) -> [f64; 2] {
    let middle = DVec2::new(from.columns as f64, from.rows as f64) / 2.0;
    let mut places = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|step| from.to_crs.transform_point2(middle + step));
    if let Some(way) = Way::between(&from.crs, &onto.crs) {
        way.carry(&mut places);
    }
    onto.pixels(&mut places);
    [places[1], places[2]]
        .map(|place| (place - places[0]).length())
        .map(|ratio| if ratio < DENSE { ratio } else { 1.0 })
}

/// What else can fail in memory.
fn out_of_memory(grid: &Grid, words: &str) -> Error {
    let words = words.lines().next().unwrap_or_default();
    Error::limit(
        format!("{} x {} samples cannot be held and warped in memory ({words})", grid.columns, grid.rows),
        message!["use ", Setting::Crop, " to take a part, or ", Setting::Resample.at("M"), " for larger cells"],
    )
}

/// A list of strings as GDAL takes it, ended by null.
fn pointers(words: &[CString]) -> Vec<*mut c_char> {
    words.iter().map(|word| word.as_ptr().cast_mut()).chain([null_mut()]).collect()
}

/// A pointer to `progress`, for [`share`].
fn argument(progress: &&dyn Fn(f64)) -> *mut c_void {
    std::ptr::from_ref(progress).cast_mut().cast()
}

/// Called back by GDAL with the share done; 1 means go on.
extern "C" fn share(complete: f64, _: *const c_char, argument: *mut c_void) -> c_int {
    // SAFETY: `argument` is the pointer made above, to a borrow that lives while GDAL runs.
    let progress = unsafe { &*argument.cast::<&dyn Fn(f64)>() };
    // The warper ends at a little more than all.
    progress(complete.min(1.0));
    1
}

#[cfg(test)]
mod tests {
    use glam::DAffine2;

    use super::super::Crs;
    use super::*;

    #[test]
    fn more_than_memory_is_an_error_in_words() {
        let grid = Grid { crs: Crs::unknown(), to_crs: DAffine2::IDENTITY, columns: 1 << 30, rows: 1 << 30 };
        let said = Raster::void(grid).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.starts_with("1073741824 x 1073741824 samples cannot be held"), "{said}");
        assert!(said.ends_with("use crop to take a part, or resample M for larger cells"), "{said}");
    }
}
