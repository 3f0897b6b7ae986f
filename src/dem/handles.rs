//! One raster file, open as often as threads read it at once: GDAL lets one thread at a time use a handle.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::formats;
use super::listed::Listed;
use super::source::Source;
use crate::error::{Error, Result};

/// The handles on a file that no thread uses at the moment.
pub(super) struct Handles {
    path: PathBuf,
    band: usize,
    allow_remote: bool,
    /// Size of the raster and its files as they were first opened.
    size: [usize; 2],
    listed: Listed,
    spare: Mutex<Vec<Source>>,
}

impl Handles {
    /// Of a file opened with this `allow_remote`.
    pub fn new(first: Source, allow_remote: bool) -> Self {
        let (size, listed) = ([first.columns, first.rows], Listed::new(&first.dataset, &first.rasters));
        Self { path: first.path.clone(), band: first.band, allow_remote, size, listed, spare: Mutex::new(vec![first]) }
    }

    /// The file as the user named it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The band that is read, from 1.
    pub fn band(&self) -> usize {
        self.band
    }

    /// Every file on the disk that it is made of.
    pub fn listed(&self) -> &Listed {
        &self.listed
    }

    /// The error where one of its files is another than when it was opened, or gone: a look at each, none inside.
    pub fn check(&self) -> Result<()> {
        if self.listed.have_changed() { Err(has_changed(&self.path)) } else { Ok(()) }
    }

    /// Lets `work` read from a handle that is its own meanwhile. One that failed is not used again: GDAL says once, not
    /// twice, what is wrong. Fails as `work`, or where the file cannot be opened once more as it was.
    pub fn read<T>(&self, work: impl FnOnce(&Source) -> Result<T>) -> Result<T> {
        // What a file names may be opened by its first reading: on this thread, whichever opened the file.
        formats::restrict(self.allow_remote);
        let spare = self.spare().pop();
        let source = spare.map_or_else(|| self.open(), Ok)?;
        let done = work(&source)?;
        self.spare().push(source);
        Ok(done)
    }

    fn open(&self) -> Result<Source> {
        let source = Source::open(&self.path, self.band, self.allow_remote)?;
        self.check()?;
        if [source.columns, source.rows] == self.size { Ok(source) } else { Err(has_changed(&self.path)) }
    }

    fn spare(&self) -> std::sync::MutexGuard<'_, Vec<Source>> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn has_changed(path: &Path) -> Error {
    Error::input(path, "has changed since it was opened", "run again when nothing writes to it")
}
