//! What a DEM's files hold, as one hash, so that a frame is known to be of the same DEM wherever that lies.
//!
//! All bytes are hashed once; the outcome is kept by path, size and time of each file, in the cache and in the manifest of a
//! folder. Cost: a read of the files; a look at each of them where it is kept. Not handled: files on a network, which count by
//! their names alone, and files changed within the resolution of their times.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use super::name::{self, Naming};
use crate::cache::{Cache, Hearing, Key, Kind};
use crate::error::{Error, Message, Result};

const KIND: Kind =
    Kind { name: "content", format: 1, words: ["what the DEM's files hold", "what is known of the DEM's files"] };
/// Bytes read at a time.
const BUFFER: usize = 1 << 20;

/// A DEM's files, and what they held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Content {
    /// What was asked for, files and ways of reading: 32 digits.
    asked: String,
    files: Vec<Stamp>,
    /// Of all their bytes: 32 digits.
    hash: String,
}

/// A file as it was.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp {
    path: PathBuf,
    bytes: u64,
    /// Nanoseconds since 1970.
    modified: u64,
}

impl Stamp {
    fn of(path: &Path) -> io::Result<Self> {
        let about = fs::metadata(path)?;
        let since = about.modified()?.duration_since(SystemTime::UNIX_EPOCH).map_err(io::Error::other)?;
        Ok(Self { path: path.to_owned(), bytes: about.len(), modified: since.as_nanos() as u64 })
    }
}

impl Content {
    /// The hash.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Whether it is what was asked for, and no file has changed since.
    pub fn holds(&self, asked: u128) -> bool {
        let same = |stamp: &Stamp| Stamp::of(&stamp.path).is_ok_and(|now| now == *stamp);
        self.asked == name::text(asked) && self.files.iter().all(same)
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
        // Names of files play no part: a DEM that was moved is the same, in whatever order its files are listed then.
        let mut hashes: Vec<u128> = read.iter().map(|(_, hash)| *hash).collect();
        hashes.sort_unstable();
        let naming = hashes.iter().fold(Naming::bare(), |naming, hash| naming.with("file", hash.to_le_bytes()));
        let files = read.into_iter().filter_map(|(stamp, _)| stamp).collect();
        Ok(Self { asked: name::text(asked), files, hash: name::text(naming.name()) })
    }
}

/// Of a file's bytes; of a folder, which some formats are, those of nothing.
fn digest(path: &Path) -> io::Result<u128> {
    let mut hash = Xxh3::new();
    if path.is_dir() {
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
        let key = Key { kind: KIND, hash: asked, of: of.to_owned() };
        let known = self.hold(&key).and_then(|kept| recall(kept).ok());
        match known {
            Some(known) if known.holds(asked) => return Ok(known),
            // Of files that have changed.
            Some(_) => self.remove(&key),
            None => {}
        }
        let make = |sheet: Option<crate::cache::Sheet>, _: &dyn Fn(f64)| {
            let content = Content::read(asked, files()?)?;
            if let Some(mut sheet) = sheet {
                sheet.write(&serde_json::to_vec(&content).unwrap_or_default());
                sheet.publish().err().into_iter().for_each(|error| warn(&crate::cache::not_kept(&key, &error)));
            }
            Ok(content)
        };
        self.get(&key, Hearing { warn, progress: &|_| () }, recall, make)
    }
}

fn recall(mut kept: crate::cache::Kept) -> io::Result<Content> {
    let mut bytes = Vec::new();
    kept.file.by_ref().take(kept.bytes).read_to_end(&mut bytes)?;
    serde_json::from_slice(&bytes).map_err(io::Error::from)
}
