//! A folder for what takes long to make and depends on its inputs alone.
//!
//! Each artefact is a file named by its kind and by a hash of all that it depends on, the number of its format included.
//! Files are whole or not there, say inside what they are, and are made by one process while others wait (`lock`). Beyond
//! a size the one that was used longest ago goes, never one that is open in some process ([`shelf`]). Whatever is wrong with
//! the folder costs time and a warning, never the work. Not handled: folders on a network whose clocks are minutes apart: two
//! processes may make the same then.

pub(crate) mod entry;
mod lock;
pub(crate) mod shelf;

use std::path::{Path, PathBuf};

use crate::error::{Error, Message, Result, Setting, shown};
use crate::message;

pub(crate) use entry::{KeptEntry, NewEntry};
pub(crate) use shelf::{Cleared, ShelfEntry};

/// Bytes that a cache may take unless told otherwise.
#[doc(hidden)]
pub const SIZE: u64 = 2 << 30;

/// A kind of artefact.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CacheKind {
    /// Begins the names of its files.
    pub name: &'static str,
    /// Number of what its bytes mean and how they are found: raised when either changes, older files are no longer found then.
    pub format: u32,
    /// What it is in messages: just made, and kept.
    pub words: [&'static str; 2],
}

/// What an artefact is, of what, and by a hash of all that it depends on.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct CacheKey {
    /// Its kind.
    pub kind: CacheKind,
    /// Hash of what it depends on.
    pub hash: u128,
    /// What it was made of, for people.
    pub of: String,
}

/// A folder of artefacts, or none.
#[derive(Debug, Clone)]
pub struct Cache {
    folder: Option<PathBuf>,
    size: u64,
}

/// Who hears of the work.
#[derive(Clone, Copy)]
pub struct CacheObserver<'a> {
    /// Something the user should know: a damaged file, a folder that cannot be written. They cost time, nothing else.
    pub warn: &'a dyn Fn(&Message),
    /// The share of the making that is done, here or by another process.
    pub progress: &'a dyn Fn(f64),
}

impl Cache {
    /// The user's own, where the system has a place for it.
    pub fn of_user() -> Self {
        Self { folder: dirs::cache_dir().map(|folder| folder.join("hachure")), size: SIZE }
    }

    /// In a folder, which is made when something is kept.
    pub fn in_folder(folder: PathBuf) -> Self {
        Self { folder: Some(folder), size: SIZE }
    }

    /// Keeps nothing and finds nothing.
    pub fn none() -> Self {
        Self { folder: None, size: SIZE }
    }

    /// Where it is.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// How many bytes it may take.
    pub fn size(&self) -> u64 {
        self.size
    }

    fn path(&self, key: &CacheKey) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(key.file_name()))
    }

    /// Makes an artefact under its lock, and keeps it where it can be kept.
    fn make<T>(
        &self,
        path: &Path,
        key: &CacheKey,
        lock: &lock::Lock,
        hearing: CacheObserver<'_>,
        make: impl FnOnce(Option<NewEntry>, &dyn Fn(f64)) -> Result<T>,
    ) -> Result<T> {
        let sheet = NewEntry::create(path, key).inspect_err(|error| (hearing.warn)(&not_kept(key, error)));
        let made = make(sheet.ok(), &|share| {
            lock.tell(share);
            (hearing.progress)(share);
        });
        self.trim(Some(path));
        made
    }

    /// An artefact that is there, safe from removal as long as it is open: who needs several holds all of them first.
    pub fn hold(&self, key: &CacheKey) -> Option<KeptEntry> {
        self.path(key).and_then(|path| entry::open(&path, key).ok().flatten())
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Cache {
    /// The same, of at most so many bytes: what is in use or was just made stays, whatever its size.
    pub fn with_size(self, size: u64) -> Self {
        Self { size, ..self }
    }

    /// An artefact: found and read by `recall`, which fails where the bytes are not those that were written; else made by
    /// `make`, which gets a file to write it to, where it can be kept. One process makes, others wait and recall.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get<T>(
        &self,
        key: &CacheKey,
        hearing: CacheObserver<'_>,
        recall: impl Fn(KeptEntry) -> std::io::Result<T>,
        make: impl FnOnce(Option<NewEntry>, &dyn Fn(f64)) -> Result<T>,
    ) -> Result<T> {
        let Some(path) = self.path(key) else { return make(None, hearing.progress) };
        let mut damaged = false;
        loop {
            match found(&path, key, &recall) {
                Found::Whole(artefact) => {
                    self.trim(Some(&path));
                    return Ok(artefact);
                }
                Found::Strange(what) => {
                    (hearing.warn)(&strange(&path, what));
                    return make(None, hearing.progress);
                }
                Found::Damaged if !damaged => {
                    (hearing.warn)(&format!("{} is damaged: it is made anew", key.kind.words[1]).into());
                    damaged = true;
                }
                Found::Damaged | Found::Nothing => {}
            }
            let lock = match lock::Lock::take(&path) {
                Ok(lock) => Ok(lock),
                Err(lock::Refused::Impossible(why)) => Err(why),
                Err(lock::Refused::Held(held)) => match held.wait(hearing.progress) {
                    Ok(()) => continue,
                    Err(why) => Err(why),
                },
            };
            return match lock {
                Ok(lock) => {
                    // Another may have made it between the look and the lock.
                    let again = if damaged { Found::Nothing } else { found(&path, key, &recall) };
                    match again {
                        Found::Whole(artefact) => Ok(artefact),
                        _ => self.make(&path, key, &lock, hearing, make),
                    }
                }
                Err(why) => {
                    (hearing.warn)(&not_kept(key, &Error::output(&path, &why)));
                    make(None, hearing.progress)
                }
            };
        }
    }

    /// Removes an artefact that turned out damaged.
    pub fn remove(&self, key: &CacheKey) {
        // One that cannot be removed is found damaged again.
        let _ = self.path(key).map(std::fs::remove_file);
    }
}

/// What stands where an artefact belongs.
enum Found<T> {
    Whole(T),
    Nothing,
    /// Bytes that are not those that were written.
    Damaged,
    /// Something else than a file, in words.
    Strange(&'static str),
}

fn found<T>(path: &Path, key: &CacheKey, recall: impl Fn(KeptEntry) -> std::io::Result<T>) -> Found<T> {
    match entry::open(path, key) {
        Ok(None) => Found::Nothing,
        Ok(Some(kept)) => recall(kept).map_or(Found::Damaged, Found::Whole),
        Err(entry::Fault::Damaged) => Found::Damaged,
        Err(entry::Fault::Strange(what)) => Found::Strange(what),
    }
}

/// That something was made and could not be kept.
pub(crate) fn not_kept(key: &CacheKey, why: &Error) -> Message {
    let why = match why {
        Error::Output { path, what, .. } => format!("{}: {what}", shown(path)),
        other => other.to_string(),
    };
    let what = format!("{} is not cached: {why}; give another folder with ", key.kind.words[0]);
    message![what, Setting::Cache.with_value()]
}

fn strange(path: &Path, what: &str) -> Message {
    let what =
        format!("{}: {what} stands in the place of a cached file and is not used; remove it, or give ", shown(path));
    message![what, Setting::Cache.with_value()]
}
