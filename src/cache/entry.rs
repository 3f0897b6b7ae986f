//! A file of the cache: what was written, then a text that says of what it was made, then a tail with its name.
//!
//! The tail proves that a file is the artefact it is called; its content proves itself. Files are opened without following a
//! link and without waiting for the other end of a pipe, and locked while they are open: shared by readers, so that nobody
//! removes what another reads. Not handled: file systems without locks; there what is open may go, which systems that
//! keep open files allow and others refuse.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use bytemuck::{Pod, Zeroable};
use xxhash_rust::xxh3::{Xxh3, xxh3_64, xxh3_128};

use super::shelf::TEMPORARY;
use super::{CacheKey, CacheKind};
use crate::error::{Error, Result};
use crate::files::Output;

/// What every file of the cache ends with.
const MAGIC: [u8; 8] = *b"hachure.";
/// Longest text that says of what a file was made.
const LONGEST: u64 = 1 << 16;

/// The last bytes of a file.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct Tail {
    /// Of kind, format and what it depends on: its name.
    name: [u64; 2],
    /// Bytes of the text before.
    text: u64,
    /// Of the text and the name.
    hash: u64,
    magic: [u8; 8],
}

/// Why a file cannot be used.
#[derive(Debug)]
pub(super) enum Fault {
    /// It is not what was written.
    Damaged,
    /// It is no file, in a few words.
    Strange(&'static str),
}

/// An artefact, open for reading and safe from removal as long as it is.
#[derive(Debug)]
pub struct KeptEntry {
    /// From the first byte on.
    pub file: File,
    /// Bytes of the artefact; what follows is not its own.
    pub bytes: u64,
    /// Where it lies.
    pub path: PathBuf,
}

/// An artefact in the making.
#[derive(Debug)]
pub struct NewEntry {
    output: Output,
    /// The same file, locked, as it will be read.
    file: File,
    path: PathBuf,
    key: CacheKey,
    bytes: u64,
    failed: Option<Error>,
}

impl CacheKey {
    /// What its file is called.
    pub fn file_name(&self) -> String {
        format!("{}-{:032x}", self.kind.name, self.name())
    }

    fn name(&self) -> u128 {
        let CacheKind { name, format, .. } = self.kind;
        xxh3_128(format!("{name} {format} {:032x}", self.hash).as_bytes())
    }

    /// Of what it was made, no longer than a file has room for.
    fn text(&self) -> &str {
        let end = (0..=self.of.len().min(LONGEST as usize)).rev().find(|end| self.of.is_char_boundary(*end));
        &self.of[..end.unwrap_or(0)]
    }
}

impl Tail {
    fn new(name: u128, text: &[u8]) -> Self {
        let mut hash = Xxh3::new();
        hash.update(text);
        hash.update(&name.to_le_bytes());
        let name = [name as u64, (name >> 64) as u64];
        Self { name, text: text.len() as u64, hash: hash.digest(), magic: MAGIC }
    }
}

/// Opens a regular file without following a link or waiting; `None` where there is none.
pub(super) fn open_plain(path: &Path) -> std::result::Result<Option<File>, Fault> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NOFOLLOW | libc::O_NONBLOCK);
    let found = match std::fs::symlink_metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        // A folder that is none, or may not be entered, shows when the file is made.
        Err(_) => return Ok(None),
    };
    let strange = |kind: std::fs::FileType| match kind {
        kind if kind.is_symlink() => "a link",
        kind if kind.is_dir() => "a folder",
        _ => "a pipe or device",
    };
    if !found.is_file() {
        return Err(Fault::Strange(strange(found.file_type())));
    }
    let file = match options.open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(_) => return Err(Fault::Strange("a file that cannot be opened")),
    };
    // It may have been exchanged since.
    match file.metadata() {
        Ok(opened) if opened.is_file() => Ok(Some(file)),
        _ => Err(Fault::Strange("a pipe or device")),
    }
}

/// Opens the artefact of a key and notes that it is used; `None` where there is none.
pub(super) fn open(path: &Path, key: &CacheKey) -> std::result::Result<Option<KeptEntry>, Fault> {
    let Some(mut file) = open_plain(path)? else { return Ok(None) };
    // Where there are no locks the file is used without.
    let _ = file.try_lock_shared();
    let (bytes, tail, _) = tail(&mut file).map_err(|_| Fault::Damaged)?;
    if tail.name != [key.name() as u64, (key.name() >> 64) as u64] {
        return Err(Fault::Damaged);
    }
    file.rewind().map_err(|_| Fault::Damaged)?;
    // The time of a file is that of its last use. Another user's cannot be set.
    let _ = file.set_modified(SystemTime::now());
    Ok(Some(KeptEntry { file, bytes, path: path.to_owned() }))
}

/// Bytes of the artefact in a file, its tail, and of what it was made.
fn tail(file: &mut File) -> io::Result<(u64, Tail, String)> {
    let damaged = || io::Error::from(ErrorKind::InvalidData);
    let mut tail = Tail::zeroed();
    let end = file.seek(SeekFrom::End(0))?;
    let before = end.checked_sub(size_of::<Tail>() as u64).ok_or_else(damaged)?;
    file.seek(SeekFrom::Start(before))?;
    file.read_exact(bytemuck::bytes_of_mut(&mut tail))?;
    let begin = before.checked_sub(tail.text).filter(|_| tail.text <= LONGEST).ok_or_else(damaged)?;
    let mut text = vec![0; tail.text as usize];
    file.seek(SeekFrom::Start(begin))?;
    file.read_exact(&mut text)?;
    let name = u128::from(tail.name[0]) | u128::from(tail.name[1]) << 64;
    if Tail::new(name, &text) != tail {
        return Err(damaged());
    }
    Ok((begin, tail, String::from_utf8_lossy(&text).into_owned()))
}

/// Of what a file of the cache was made, where it says so.
pub(super) fn made_of(path: &Path) -> Option<String> {
    let mut file = open_plain(path).ok()??;
    tail(&mut file).ok().map(|(_, _, text)| text)
}

impl KeptEntry {
    /// The bytes that [`NewEntry::publish_whole`] wrote.
    ///
    /// # Errors
    /// The system's; [`ErrorKind::InvalidData`] for other bytes.
    pub fn whole(mut self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.file.by_ref().take(self.bytes).read_to_end(&mut bytes)?;
        let (before, hash) = bytes.split_last_chunk::<8>().ok_or(ErrorKind::InvalidData)?;
        if xxh3_64(before) != u64::from_le_bytes(*hash) {
            return Err(ErrorKind::InvalidData.into());
        }
        bytes.truncate(bytes.len() - size_of::<u64>());
        Ok(bytes)
    }
}

impl NewEntry {
    /// Begins the file of a key.
    pub(super) fn create(path: &Path, key: &CacheKey) -> Result<Self> {
        let output = Output::create_as(path, TEMPORARY)?;
        let file = output.duplicate().map_err(|why| Error::output(path, &why))?;
        // From here on nobody takes it for a leftover, nor away when it has its name.
        let _ = file.try_lock_shared();
        Ok(Self { output, file, path: path.to_owned(), key: key.clone(), bytes: 0, failed: None })
    }

    /// Writes the next bytes; the first error is kept for [`Self::publish`].
    pub fn write(&mut self, bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        if self.failed.is_none() {
            self.failed = self.output.write(|file| file.write_all(bytes)).err();
        }
    }

    /// All bytes at once, and a hash of them, by which [`KeptEntry::whole`] knows them again.
    ///
    /// # Errors
    /// As [`Self::publish`].
    pub fn publish_whole(mut self, bytes: &[u8]) -> Result<KeptEntry> {
        self.write(bytes);
        self.write(&xxh3_64(bytes).to_le_bytes());
        self.publish()
    }

    /// How many bytes were written.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// What it is of.
    pub fn key(&self) -> &CacheKey {
        &self.key
    }

    /// Gives the file its name and leaves it open.
    ///
    /// # Errors
    /// [`Error::Output`] where it could not be written, or something else than a file has its name.
    pub fn publish(mut self) -> Result<KeptEntry> {
        let (bytes, text) = (self.bytes, self.key.text().as_bytes().to_vec());
        self.write(&text);
        self.write(bytemuck::bytes_of(&Tail::new(self.key.name(), &text)));
        let Self { output, mut file, path, failed, .. } = self;
        failed.map_or(Ok(()), Err)?;
        if let Err(Fault::Strange(what)) = open_plain(&path) {
            return Err(Error::output(&path, &io::Error::other(format!("{what} is in its place"))));
        }
        output.publish()?;
        file.rewind().map_err(|why| Error::output(&path, &why))?;
        Ok(KeptEntry { file, bytes, path })
    }
}
