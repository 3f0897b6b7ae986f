//! Files that are read while frames are drawn, and whether they are still those that were opened.
//!
//! Compared are device, inode, size and both times of each file: who writes into one and puts its time of writing back
//! still changes the time of the change. Cost: one `stat` a file. Not handled: what is not on the disk (archives are
//! looked at as a whole), and systems that tell size and time of writing alone.

use std::ffi::CStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use gdal::Dataset;

use super::source::heard;

/// Files as they were at one moment.
pub(super) struct Watch(Vec<(PathBuf, State)>);

/// What tells one state of a file from another.
#[derive(Debug, PartialEq)]
struct State {
    bytes: u64,
    written: Option<SystemTime>,
    /// Device, inode, seconds and nanoseconds of the last change of any kind.
    #[cfg(unix)]
    identity: [i128; 4],
}

impl Watch {
    /// Over all files that GDAL reads for a dataset, as far as they are on the disk.
    pub fn over(dataset: &Dataset) -> Self {
        let mut files: Vec<_> = listed(dataset).into_iter().filter_map(|name| on_disk(&name)).collect();
        files.sort();
        files.dedup();
        Self(files.into_iter().filter_map(|file| State::of(&file).map(|state| (file, state))).collect())
    }

    /// The first file that is gone or another one, or was written to.
    pub fn changed(&self) -> Option<&Path> {
        self.0.iter().find(|(file, state)| State::of(file).as_ref() != Some(state)).map(|(file, _)| file.as_path())
    }
}

impl State {
    fn of(file: &Path) -> Option<Self> {
        let found = fs::metadata(file).ok()?;
        #[cfg(unix)]
        let identity = {
            use std::os::unix::fs::MetadataExt;
            [found.dev().into(), found.ino().into(), found.ctime().into(), found.ctime_nsec().into()]
        };
        Some(Self {
            bytes: found.len(),
            written: found.modified().ok(),
            #[cfg(unix)]
            identity,
        })
    }
}

/// The names of the files of a dataset, in GDAL's words.
fn listed(dataset: &Dataset) -> Vec<String> {
    // SAFETY: the handle is open; the list is ended by null, its strings live until it is destroyed, and null is an
    // empty one.
    let (names, _) = heard(|| unsafe {
        let list = gdal_sys::GDALGetFileList(dataset.c_dataset());
        let count = usize::try_from(gdal_sys::CSLCount(list)).unwrap_or(0);
        let name = |i| CStr::from_ptr(*list.add(i)).to_string_lossy().into_owned();
        let names = (0..count).map(name).collect();
        gdal_sys::CSLDestroy(list);
        names
    });
    names
}

/// The file or archive on the disk behind a name of GDAL's.
fn on_disk(name: &str) -> Option<PathBuf> {
    let mut way = name;
    while let Some((_, inner)) = way.strip_prefix("/vsi").and_then(|rest| rest.split_once('/')) {
        way = inner;
    }
    Path::new(way).ancestors().find(|way| way.is_file()).map(Path::to_owned)
}
