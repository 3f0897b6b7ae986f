//! Files as GDAL sees them: on the disk, in archives, on a network.
//!
//! Calls that the safe crate lacks, or makes with names that it turns into UTF-8 and so into those of other files.

use std::ffi::{CStr, CString, OsString, c_char};
use std::path::{Path, PathBuf};
use std::ptr;

use gdal::{Dataset, GdalOpenFlags};

use super::lossless;
use super::source::heard;

/// Bytes of a file's head that tell what it is: the mark of a tar archive ends at 262.
const HEAD: usize = 1024;

/// Opens `name` with the first of `drivers` that takes it, and says GDAL's complaint.
pub(super) fn open(name: &Path, flags: GdalOpenFlags, drivers: &[&str]) -> (Option<Dataset>, Option<String>) {
    let Some(name) = c_string(name) else { return (None, None) };
    let drivers: Vec<_> = drivers.iter().filter_map(|driver| CString::new(*driver).ok()).collect();
    let list: Vec<_> = drivers.iter().map(|driver| driver.as_ptr()).chain([ptr::null()]).collect();
    heard(|| {
        // SAFETY: the strings and the list, which ends in null, outlive the call; the handle is owned by one `Dataset`.
        unsafe {
            let (no_options, no_siblings) = (ptr::null(), ptr::null());
            let handle = gdal_sys::GDALOpenEx(name.as_ptr(), flags.bits(), list.as_ptr(), no_options, no_siblings);
            (!handle.is_null()).then(|| Dataset::from_c_dataset(handle))
        }
    })
}

/// The first bytes of a file; `None` where it cannot be opened and read, or is empty.
pub(super) fn head(name: &Path) -> Option<Vec<u8>> {
    let name = c_string(name)?;
    let mut bytes = vec![0; HEAD];
    let (read, _) = heard(|| {
        // SAFETY: the name ends in 0, `bytes` holds as many as are asked for, the file is closed once.
        unsafe {
            let file = gdal_sys::VSIFOpenL(name.as_ptr(), c"rb".as_ptr());
            if file.is_null() {
                return 0;
            }
            let read = gdal_sys::VSIFReadL(bytes.as_mut_ptr().cast(), 1, bytes.len(), file);
            gdal_sys::VSIFCloseL(file);
            read
        }
    });
    bytes.truncate(read);
    (read > 0).then_some(bytes)
}

/// The files below a folder of the disk or an archive, by their ways from there; `None` where it is no folder, or empty.
pub(super) fn files_below(folder: &Path) -> Option<Vec<OsString>> {
    let folder = c_string(folder)?;
    // SAFETY: the name ends in 0; the list is GDAL's, freed after it is copied.
    let (names, _) = heard(|| unsafe { list(gdal_sys::VSIReadDirRecursive(folder.as_ptr())) });
    let names: Vec<_> = names?.into_iter().filter(|name| !name.as_encoded_bytes().ends_with(b"/")).collect();
    Some(names)
}

/// The files that belong to a dataset.
pub(super) fn files_of(dataset: &Dataset) -> Vec<PathBuf> {
    // SAFETY: the handle is open; the list is the caller's, freed after it is copied.
    let (names, _) = heard(|| unsafe { list(gdal_sys::GDALGetFileList(dataset.c_dataset())) });
    names.unwrap_or_default().into_iter().map(PathBuf::from).collect()
}

/// What GDAL calls the grids of a container, as [`lossless`] text.
pub(super) fn grids_of(dataset: &Dataset) -> Vec<String> {
    // SAFETY: the handle is open; the list is the dataset's own, copied while that lives.
    let (lines, _) =
        heard(|| unsafe { copied(gdal_sys::GDALGetMetadata(dataset.c_dataset().cast(), c"SUBDATASETS".as_ptr())) });
    let lines = lines.unwrap_or_default();
    let lines = lines.iter().map(|line| lossless::text(line));
    lines.filter_map(|line| line.split_once("_NAME=").map(|(_, grid)| grid.to_owned())).collect()
}

/// A name as GDAL takes it; `None` with a 0 in it.
pub(super) fn c_string(name: &Path) -> Option<CString> {
    CString::new(name.as_os_str().as_encoded_bytes()).ok()
}

/// # Safety
/// `names` is null or a list of GDAL's that ends in null and that nobody uses afterwards.
unsafe fn list(names: *mut *mut c_char) -> Option<Vec<OsString>> {
    // SAFETY: as promised; the list is GDAL's to free.
    unsafe {
        let copied = copied(names);
        gdal_sys::CSLDestroy(names);
        copied
    }
}

/// # Safety
/// `names` is null or a list of strings that ends in null.
unsafe fn copied(names: *mut *mut c_char) -> Option<Vec<OsString>> {
    if names.is_null() {
        return None;
    }
    // SAFETY: as promised; each entry is a string that ends in 0.
    unsafe {
        let entries = (0..).map(|i| *names.add(i)).take_while(|entry| !entry.is_null());
        Some(entries.map(|entry| lossless::name(&lossless::text_of(CStr::from_ptr(entry).to_bytes()))).collect())
    }
}
