//! One raster file, open as often as threads read it at once: GDAL lets one thread at a time use a handle.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::formats;
use super::source::Source;
use super::watch::Watch;
use crate::error::{Error, Result, shown};

/// The handles on a file that no thread uses at the moment.
pub(super) struct Handles {
    path: PathBuf,
    band: usize,
    allow_remote: bool,
    /// Size of the raster and stamp of its files as they were first opened.
    size: [usize; 2],
    stamp: Option<u64>,
    watch: Watch,
    spare: Mutex<Vec<Source>>,
}

impl Handles {
    /// Of a file opened with this `allow_remote`.
    pub fn new(first: Source, allow_remote: bool) -> Self {
        let (size, stamp, watch) = ([first.columns, first.rows], first.stamp, Watch::over(&first.dataset));
        let (path, band) = (first.path.clone(), first.band);
        Self { path, band, allow_remote, size, stamp, watch, spare: Mutex::new(vec![first]) }
    }

    /// The file as the user named it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What tells one state of the file and those it names from another, see [`Source::stamp`].
    pub fn stamp(&self) -> Option<u64> {
        self.stamp
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

    /// Fails where the file, or one that it names, is no longer what was opened.
    pub fn check_unchanged(&self) -> Result<()> {
        let Some(changed) = self.watch.changed() else { return Ok(()) };
        let which = match changed.file_name() == self.path.file_name() {
            true => String::new(),
            false => format!(" ({})", shown(changed)),
        };
        let what = format!("has changed since it was opened{which}");
        Err(Error::input(&self.path, what, "run again when nothing writes to it"))
    }

    fn open(&self) -> Result<Source> {
        let source = Source::open(&self.path, self.band, self.allow_remote)?;
        if source.stamp != self.stamp || [source.columns, source.rows] != self.size {
            return Err(source.error("has changed since it was opened", "run again when nothing writes to it"));
        }
        Ok(source)
    }

    fn spare(&self) -> std::sync::MutexGuard<'_, Vec<Source>> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
