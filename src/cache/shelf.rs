//! The files of a cache: listed, trimmed to a size, cleared. Only files of hachure's own names are ever touched, and none that
//! some process has open or is making.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::{Cache, entry, lock};

/// Kinds of files by how their names begin; the last one is of earlier versions, and goes in its turn.
const KINDS: [&str; 6] = ["bounds-", "heights-", "smooth-", "steps-", "truth-", "prepared-"];
/// Letters of a name behind that.
const DIGITS: usize = 32;
/// How the names of files in the making begin; outputs of other kinds in the same folder are called otherwise.
pub(super) const TEMPORARY: &str = ".hachure-cache-";
/// Files in the making that are older and not open were left behind by a process that was killed.
const LEFT_BEHIND: Duration = Duration::from_secs(60);

/// A file of the cache.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShelfEntry {
    /// Its name in the folder.
    pub name: String,
    /// What it is: its name up to the first dash.
    pub kind: &'static str,
    /// How large it is.
    pub bytes: u64,
    /// When it was last used.
    pub used: SystemTime,
    /// What it was made of, where it says so.
    pub of: Option<String>,
}

/// What went when a cache was cleared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cleared {
    /// Files that are gone.
    pub files: usize,
    /// Their bytes.
    pub bytes: u64,
    /// Files that stayed: some process has them open, or they cannot be removed.
    pub stayed: usize,
}

impl Cache {
    /// Removes what was used longest ago until the rest fits; `fresh` stays, and so does what some process has open.
    pub(super) fn trim(&self, fresh: Option<&Path>) {
        self.sweep();
        let mut files: Vec<_> = self.files().collect();
        let mut bytes: u64 = files.iter().map(|(_, shown)| shown.bytes).sum();
        files.sort_by_key(|(_, shown)| shown.used);
        for (path, shown) in files.iter().filter(|(path, _)| Some(path.as_path()) != fresh) {
            if bytes <= self.size() {
                return;
            }
            if remove(path) {
                bytes -= shown.bytes;
            }
        }
    }

    /// Removes what processes that were killed left behind.
    fn sweep(&self) {
        let old = |path: &Path, age: Duration| {
            let modified =
                fs::symlink_metadata(path).ok().filter(fs::Metadata::is_file).and_then(|m| m.modified().ok());
            modified.and_then(|modified| modified.elapsed().ok()).is_some_and(|since| since > age)
        };
        for (path, name) in self.names() {
            let lock = name.strip_suffix(lock::ENDING).is_some_and(|name| kind_of(name).is_some());
            if lock && old(&path, lock::AGE) || name.starts_with(TEMPORARY) && old(&path, LEFT_BEHIND) {
                remove(&path);
            }
        }
    }

    /// The files that are artefacts by their names, what they were made of left out.
    fn files(&self) -> impl Iterator<Item = (PathBuf, ShelfEntry)> {
        self.names().filter_map(|(path, name)| {
            let kind = kind_of(&name)?;
            let found = fs::symlink_metadata(&path).ok().filter(fs::Metadata::is_file)?;
            let used = found.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            Some((path, ShelfEntry { name, kind, bytes: found.len(), used, of: None }))
        })
    }

    fn names(&self) -> impl Iterator<Item = (PathBuf, String)> {
        let entries = self.folder().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        entries.filter_map(|entry| Some((entry.path(), entry.file_name().into_string().ok()?)))
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Cache {
    /// Its files, the one used last first.
    pub fn list(&self) -> Vec<ShelfEntry> {
        let mut files: Vec<ShelfEntry> =
            self.files().map(|(path, shown)| ShelfEntry { of: entry::made_of(&path), ..shown }).collect();
        files.sort_by(|a, b| b.used.cmp(&a.used).then_with(|| a.name.cmp(&b.name)));
        files
    }

    /// Removes all that nobody uses.
    pub fn clear(&self) -> Cleared {
        let mut cleared = Cleared::default();
        for (path, shown) in self.files() {
            if remove(&path) {
                cleared.files += 1;
                cleared.bytes += shown.bytes;
            } else {
                cleared.stayed += 1;
            }
        }
        self.sweep();
        cleared
    }
}

/// The kind of a file by its name.
fn kind_of(name: &str) -> Option<&'static str> {
    let is_hash =
        |rest: &str| rest.len() == DIGITS && rest.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
    KINDS.iter().find(|kind| name.strip_prefix(**kind).is_some_and(is_hash)).map(|kind| kind.trim_end_matches('-'))
}

/// Removes a file that nobody has open; whether it is gone.
fn remove(path: &Path) -> bool {
    let Ok(Some(file)) = entry::open_plain(path) else { return false };
    // Where there are no locks nothing is known of readers.
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => false,
        Ok(()) | Err(fs::TryLockError::Error(_)) => fs::remove_file(path).is_ok(),
    }
}
