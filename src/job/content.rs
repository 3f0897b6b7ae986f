//! What a DEM's files hold, as one hash, so that a frame is known to be of the same DEM wherever that lies.
//!
//! All bytes are hashed once, with the name of each file, which some formats take for a part of it; the outcome is kept by path,
//! size and time of each file, in the cache and in the manifest of a folder. A file that appears beside them under one of their
//! names may belong to them: then all are looked for anew. Cost: a read of the files; a look at each of them and at their
//! folders where it is kept. Not handled: files on a network, which count by their names alone, and files changed within the
//! resolution of their times.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use super::name::{self, Naming};
use crate::cache::{Cache, CacheKey, CacheKind, CacheObserver};
use crate::error::{Error, Message, Result};

const KIND: CacheKind =
    CacheKind { name: "content", format: 2, words: ["what the DEM's files hold", "what is known of the DEM's files"] };
/// Bytes read at a time.
const BUFFER: usize = 1 << 20;

/// A DEM's files, and what they held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Content {
    /// What was asked for, files and ways of reading: 32 digits.
    asked: String,
    files: Vec<Stamp>,
    /// Names beside them that begin as theirs do: 32 digits.
    beside: String,
    /// Of all their bytes: 32 digits.
    hash: String,
}

/// A file as it was.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp {
    path: PathBuf,
    bytes: u64,
    /// Nanoseconds since 1970.
    modified: i64,
}

impl Stamp {
    fn of(path: &Path) -> io::Result<Self> {
        let about = fs::metadata(path)?;
        let modified = match about.modified()?.duration_since(SystemTime::UNIX_EPOCH) {
            Ok(since) => since.as_nanos() as i64,
            Err(before) => -(before.duration().as_nanos() as i64),
        };
        Ok(Self { path: path.to_owned(), bytes: about.len(), modified })
    }
}

impl Content {
    /// The hash.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Whether it is what was asked for, whatever became of the files.
    pub fn is_of(&self, asked: u128) -> bool {
        self.asked == name::text(asked)
    }

    /// Whether it is what was asked for, and no file has changed since.
    pub fn holds(&self, asked: u128) -> bool {
        let same = |stamp: &Stamp| Stamp::of(&stamp.path).is_ok_and(|now| now == *stamp);
        let paths = || self.files.iter().map(|stamp| stamp.path.as_path());
        self.asked == name::text(asked) && self.files.iter().all(same) && self.beside == beside(paths())
    }

    /// Reads all files.
    fn read(asked: u128, mut files: Vec<PathBuf>) -> Result<Self> {
        files.sort();
        files.dedup();
        let read = |path: &PathBuf| {
            let failed =
                |error: io::Error| Error::input(path, format!("it cannot be read ({error})"), "look at its rights");
            if !path.exists() {
                return Ok((None, xxhash_rust::xxh3::xxh3_128(path.as_os_str().as_encoded_bytes())));
            }
            let stamp = Stamp::of(path).map_err(failed)?;
            Ok((Some(stamp), digest(path).map_err(failed)?))
        };
        let read = files.par_iter().map(read).collect::<Result<Vec<_>>>()?;
        // Folders play no part: a DEM that was moved is the same.
        let naming = files.iter().zip(&read).fold(Naming::bare(), |naming, (path, (_, hash))| {
            let name = path.file_name().unwrap_or_default().as_encoded_bytes();
            naming.with("name", name).with("bytes", hash.to_le_bytes())
        });
        let beside = beside(files.iter().map(PathBuf::as_path));
        let files = read.into_iter().filter_map(|(stamp, _)| stamp).collect();
        Ok(Self { asked: name::text(asked), files, beside, hash: name::text(naming.name()) })
    }
}

/// Of the names in the folders of files that begin as one of the files there does, up to its first dot.
fn beside<'a>(files: impl Iterator<Item = &'a Path>) -> String {
    let mut folders: BTreeMap<&Path, BTreeSet<Vec<u8>>> = BTreeMap::new();
    for file in files {
        let name = file.file_name().unwrap_or_default().as_encoded_bytes();
        let stem = name.split(|byte| *byte == b'.').next().unwrap_or_default();
        folders.entry(file.parent().unwrap_or(Path::new(""))).or_default().insert(stem.to_ascii_lowercase());
    }
    let mut naming = Naming::bare();
    for (folder, stems) in folders {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().as_encoded_bytes().to_ascii_lowercase());
        let stem = |name: &[u8]| name.split(|byte| *byte == b'.').next().unwrap_or_default().to_vec();
        let mut names: Vec<Vec<u8>> = names.filter(|name| stems.contains(&stem(name))).collect();
        names.sort_unstable();
        naming = names.iter().fold(naming.with("folder", []), |naming, name| naming.with("beside", name));
    }
    name::text(naming.name())
}

/// Of a file's bytes; of a folder, which some formats are, of all in it.
fn digest(path: &Path) -> io::Result<u128> {
    let mut hash = Xxh3::new();
    if path.is_dir() {
        let mut entries = fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
        entries.sort();
        for entry in entries {
            hash.update(entry.file_name().unwrap_or_default().as_encoded_bytes());
            hash.update(&digest(&entry)?.to_le_bytes());
        }
        return Ok(hash.digest128());
    }
    let (mut file, mut buffer) = (File::open(path)?, vec![0; BUFFER]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hash.digest128()),
            read => hash.update(&buffer[..read]),
        }
    }
}

impl Cache {
    /// What the files of a DEM hold, known or found; `files` are asked for where it is not known. What was `asked` for says
    /// of which files it is and how they are read.
    ///
    /// # Errors
    /// Those of `files`; [`Error::Input`] where one cannot be read.
    pub fn content(
        &self,
        asked: u128,
        of: &str,
        warn: &dyn Fn(&Message),
        files: impl FnOnce() -> Result<Vec<PathBuf>>,
    ) -> Result<Content> {
        let key = CacheKey { kind: KIND, hash: asked, of: of.to_owned() };
        let known = self.hold(&key).and_then(|kept| recall(kept).ok());
        match known {
            Some(known) if known.holds(asked) => return Ok(known),
            // Of files that have changed.
            Some(_) => self.remove(&key),
            None => {}
        }
        let make = |sheet: Option<crate::cache::NewEntry>, _: &dyn Fn(f64)| {
            let content = Content::read(asked, files()?)?;
            if let Some(mut sheet) = sheet {
                sheet.write(&serde_json::to_vec(&content).unwrap_or_default());
                sheet.publish().err().into_iter().for_each(|error| warn(&crate::cache::not_kept(&key, &error)));
            }
            Ok(content)
        };
        self.get(&key, CacheObserver { warn, progress: &|_| () }, recall, make)
    }
}

fn recall(mut kept: crate::cache::KeptEntry) -> io::Result<Content> {
    let mut bytes = Vec::new();
    kept.file.by_ref().take(kept.bytes).read_to_end(&mut bytes)?;
    serde_json::from_slice(&bytes).map_err(io::Error::from)
}
