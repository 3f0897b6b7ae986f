//! Samples in memory as datasets of GDAL, which warps and fills them where they lie.
//!
//! A dataset borrows its samples as long as it lives, for reading or for writing, and shows its handle to nobody: no safe
//! code can keep it longer, change what is borrowed for reading, or look at what is being written. Its calls are
//! unsafe: GDAL's driver for memory takes a bare pointer, and its warper and filler have no safe wrapper.

use std::ffi::{CString, c_char, c_int, c_void};
use std::marker::PhantomData;
use std::ptr::null_mut;

use gdal::errors::GdalError;
use gdal::{Dataset, DriverManager};
use glam::DAffine2;

use super::grid::GeoGrid;
use super::source::heard;

/// A dataset over borrowed samples: `S` is `&[f32]` where GDAL reads them, `&mut [f32]` where it writes them, too.
pub(super) struct Lent<S> {
    dataset: Dataset,
    samples: PhantomData<S>,
}

impl<'a> Lent<&'a [f32]> {
    /// Of all samples of `grid`, NaN at voids. Fails with GDAL's words.
    pub(super) fn reading(samples: &'a [f32], grid: &GeoGrid) -> Result<Self, String> {
        // SAFETY: they stay borrowed as long as the guard lives, and no method of this type lets GDAL write.
        let dataset = unsafe { dataset(samples.as_ptr().cast_mut(), samples.len(), grid) }?;
        Ok(Self { dataset, samples: PhantomData })
    }
}

impl<'a> Lent<&'a mut [f32]> {
    /// Of all samples of `grid`, NaN at voids. Fails with GDAL's words.
    pub(super) fn writing(samples: &'a mut [f32], grid: &GeoGrid) -> Result<Self, String> {
        // SAFETY: they stay borrowed, by nobody else, as long as the guard lives.
        let dataset = unsafe { dataset(samples.as_mut_ptr(), samples.len(), grid) }?;
        Ok(Self { dataset, samples: PhantomData })
    }

    /// Lays `from` over it, with these words of `gdalwarp`. `progress` hears the share done. Fails with GDAL's words.
    pub(super) fn warp(&mut self, from: &Lent<&[f32]>, words: &[&str], progress: &dyn Fn(f64)) -> Result<(), String> {
        let words: Vec<_> = words.iter().map(|word| CString::new(*word).unwrap_or_default()).collect();
        let mut list = pointers(&words);
        let mut sources = [from.dataset.c_dataset()];
        let onto = self.dataset.c_dataset();
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
        if done { Ok(()) } else { Err(words.unwrap_or_else(|| "the warper gave up".into())) }
    }

    /// Fills voids up to `reach` samples from data. `progress` hears the share done. Fails with GDAL's words.
    pub(super) fn fill(&mut self, reach: u32, progress: &dyn Fn(f64)) -> Result<(), String> {
        // Its working rasters would otherwise be files in the folder where hachure is started.
        let words = [c"TEMP_FILE_DRIVER=MEM".to_owned()];
        let mut list = pointers(&words);
        let dataset = self.dataset.c_dataset();
        let work = || {
            // SAFETY: as in `warp`; band 1 is there, and without a mask GDAL takes the band's own, NaN.
            unsafe {
                let band = gdal_sys::GDALGetRasterBand(dataset, 1);
                let argument = argument(&progress);
                gdal_sys::GDALFillNodata(
                    band,
                    null_mut(),
                    f64::from(reach),
                    0,
                    0,
                    list.as_mut_ptr(),
                    Some(share),
                    argument,
                )
            }
        };
        let (done, words) = heard(work);
        let filled = done == gdal_sys::CPLErr::CE_None;
        if filled { Ok(()) } else { Err(words.unwrap_or_else(|| "the filler gave up".into())) }
    }
}

/// GDAL's dataset over `count` samples of `grid`, which begin at `samples`.
///
/// # Panics
/// Where the grid has more samples, or fewer.
///
/// # Safety
/// The samples must outlive the dataset, and be left alone while it is used; it must not be written to where they are
/// borrowed for reading.
unsafe fn dataset(samples: *mut f32, count: usize, grid: &GeoGrid) -> Result<Dataset, String> {
    assert_eq!(count, grid.columns * grid.rows);
    let words = [CString::new(format!("DATAPOINTER=0x{:x}", samples as usize)).unwrap_or_default()];
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
        let defined = DAffine2::from_mat2(grid.crs.axes().transpose()) * grid.to_crs;
        let ([x, y], m) = (defined.translation.to_array(), defined.matrix2);
        dataset.set_geo_transform(&[x, m.x_axis.x, m.y_axis.x, y, m.x_axis.y, m.y_axis.y])?;
        if let Some(reference) = grid.crs.reference() {
            dataset.set_spatial_ref(&reference)?;
        }
        dataset.rasterband(1)?.set_no_data_value(Some(f64::NAN))?;
        Ok::<_, GdalError>(dataset)
    };
    let (made, words) = heard(make);
    made.map_err(|e| words.unwrap_or_else(|| e.to_string()))
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
