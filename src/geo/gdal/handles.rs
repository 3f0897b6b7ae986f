//! Raster files, open as often as threads read them at once: GDAL lets one thread at a time use a handle.
//!
//! A system lets a process hold some hundreds of files open, and a DEM may have thousands. Handles that no thread uses
//! wait in a pool of a few; the one that was used longest ago is closed for another, and opened again when it is asked
//! for. Beside the pool each thread holds at most one. Not handled: other parts of the process that hold many files.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use xxhash_rust::xxh3::Xxh3;

use super::formats;
use super::listed::{Folders, Listed};
use super::lossless;
use super::name::RasterPlace;
use super::source::Source;
use crate::error::{Error, Result, shown};

/// Most handles that wait.
const MOST: usize = 64;
/// Files that a process holds open beside them: libraries, the GPU's driver, outputs, a handle a thread.
const OTHERS: usize = 48;
/// Files that a handle takes: the raster, its mask, its overviews.
const FILES: usize = 4;

/// Handles of all files of a DEM that no thread uses at the moment, each with the number of its file; the one used last
/// is the last.
#[derive(Default)]
struct HandleCache(Mutex<Spare>);

#[derive(Default)]
struct Spare {
    files: usize,
    sources: VecDeque<(usize, Source)>,
}

/// What the files of one DEM share as they are opened.
#[derive(Default)]
pub(super) struct Opening {
    pool: Arc<HandleCache>,
    folders: Folders,
}

/// A file and where its handles wait.
pub(super) struct Handles {
    path: PathBuf,
    exact: PathBuf,
    band: usize,
    allow_remote: bool,
    /// Size of the raster and its files as they were first opened.
    size: [usize; 2],
    transposed: bool,
    listed: Listed,
    /// What of its name is no file on the disk: the grid of a container, the member of an archive.
    inner: String,
    file: usize,
    pool: Arc<HandleCache>,
}

impl HandleCache {
    /// A number for one more file.
    fn add(&self) -> usize {
        let mut spare = self.spare();
        spare.files += 1;
        spare.files
    }

    fn take(&self, file: usize) -> Option<Source> {
        let mut spare = self.spare();
        let place = spare.sources.iter().rposition(|(of, _)| *of == file)?;
        spare.sources.remove(place).map(|(_, source)| source)
    }

    fn put(&self, file: usize, source: Source) {
        let mut spare = self.spare();
        spare.sources.push_back((file, source));
        let oldest = if spare.sources.len() > most() { spare.sources.pop_front() } else { None };
        // Closing takes a while, and others wait for the lock.
        drop(spare);
        drop(oldest);
    }

    fn spare(&self) -> MutexGuard<'_, Spare> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Handles {
    /// Of a file opened with this `allow_remote`.
    pub(super) fn new(first: Source, allow_remote: bool, opening: &mut Opening) -> Self {
        let (size, pool) = ([first.columns, first.rows], opening.pool.clone());
        let (file, listed) = (pool.add(), Listed::new(&first.dataset, &first.rasters, &mut opening.folders));
        let (path, exact, band, transposed) = (first.path.clone(), first.exact.clone(), first.band, first.transposed);
        let inner = first.rasters.first().map(inner).unwrap_or_default();
        pool.put(file, first);
        Self { path, exact, band, allow_remote, size, transposed, listed, inner, file, pool }
    }

    /// The file as the user named it.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Takes what tells this raster in its present state from any other into a hash: the band, what of its name is no file
    /// on the disk, the files. `None` where a part is not on the disk.
    pub(super) fn hash(&self, hash: &mut Xxh3) -> Option<()> {
        hash.update(format!("band {} {:?}\n", self.band, self.inner).as_bytes());
        self.listed.hash(hash)
    }

    /// Every file on the disk that it is made of.
    pub(super) fn listed(&self) -> &Listed {
        &self.listed
    }

    /// The error where one of its files is another than when it was opened, or gone: a look at each, none inside.
    pub(super) fn check(&self) -> Result<()> {
        let Some(changed) = self.listed.changed() else { return Ok(()) };
        let which = match changed.file_name() == self.path.file_name() {
            true => String::new(),
            false => format!(" ({})", shown(changed)),
        };
        let what = format!("has changed since it was opened{which}");
        Err(Error::input(&self.path, what, "run again when nothing writes to it"))
    }

    /// Lets `work` read from a handle that is its own meanwhile. One that failed is not used again: GDAL says once, not
    /// twice, what is wrong. Fails as `work`, or where the file cannot be opened once more as it was.
    pub(super) fn read<T>(&self, work: impl FnOnce(&Source) -> Result<T>) -> Result<T> {
        // What a file names may be opened by its first reading: on this thread, whichever opened the file.
        formats::restrict(self.allow_remote);
        let source = self.pool.take(self.file).map_or_else(|| self.open(), Ok)?;
        let done = work(&source)?;
        self.pool.put(self.file, source);
        Ok(done)
    }

    fn open(&self) -> Result<Source> {
        let source = Source::open(&self.exact, self.band, self.allow_remote)?;
        self.check()?;
        if [source.columns, source.rows] != self.size {
            return Err(source.error("has changed since it was opened", "run again when nothing writes to it"));
        }
        Ok(Source { path: self.path.clone(), transposed: self.transposed, ..source })
    }
}

/// What of a raster's name is no file on the disk, so that all ways to the file are one.
fn inner((name, place): &(PathBuf, RasterPlace)) -> String {
    let name = lossless::text(name.as_os_str());
    match place {
        RasterPlace::File(file) | RasterPlace::Archive(file) => name.replacen(&lossless::text(file.as_os_str()), "", 1),
        RasterPlace::Remote => name,
    }
}

/// How many files may be held open that no thread reads at the moment, by what the system allows the process.
pub(super) fn most() -> usize {
    (allowed().saturating_sub(OTHERS) / FILES).clamp(2, MOST)
}

/// Files that the process may hold open.
#[cfg(unix)]
fn allowed() -> usize {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: it writes the two numbers of `limit`.
    let known = unsafe { libc::getrlimit(libc::RLIMIT_NOFILE, &raw mut limit) } == 0;
    if known { usize::try_from(limit.rlim_cur).unwrap_or(usize::MAX) } else { 0 }
}

/// Files that the process may hold open: the least that the system's own library allows.
#[cfg(not(unix))]
fn allowed() -> usize {
    512
}
