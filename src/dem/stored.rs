//! Heights of tiles, kept on disk: what took long to make is read as fast as a plain file.
//!
//! ```text
//! tiles, row by row of them, 4 bytes a sample | a hash of each | what was found, JSON | bytes of that, hash from the hashes on
//! ```
//!
//! Found is what only those see who read the samples that the heights were made of.
//! A tile is checked when it is read; whoever asks for a damaged one works it out again.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::sync::{Mutex, PoisonError};

use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use super::window::Window;
use crate::cache::{CacheKey, CacheKind, KeptEntry, NewEntry};
use crate::error::Message;

/// Raise it when the bytes mean something else.
const FORMAT: u32 = 3;
const KIND: CacheKind = CacheKind {
    name: "smooth",
    format: FORMAT,
    words: ["what was made of the heights", "what was kept of the heights"],
};

/// Tiles in their file.
#[derive(Debug)]
pub(super) struct Stored {
    file: Mutex<File>,
    /// By the first sample: size, place in the file, hash.
    tiles: HashMap<[usize; 2], ([usize; 2], u64, u64)>,
    found: Found,
}

/// What a look at all samples finds, see [`Tiles`](super::tiles::Tiles).
#[derive(Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Found {
    pub marks: usize,
    pub assumed: Vec<Message>,
}

/// What the heights of tiles with this stamp depend on.
pub(super) fn key(stamp: u128, of: String) -> CacheKey {
    CacheKey { kind: KIND, hash: stamp, of }
}

/// Bytes of the heights of some tiles.
pub(super) fn bytes_of(tiles: &[Window]) -> u64 {
    tiles.iter().map(|tile| tile.samples()).sum::<u64>() * size_of::<f32>() as u64
}

impl Stored {
    /// Writes the heights of the next tile, and gives their hash.
    pub(super) fn write(sheet: &mut NewEntry, heights: &[f32]) -> u64 {
        let bytes = bytemuck::cast_slice(heights);
        sheet.write(bytes);
        xxh3_64(bytes)
    }

    /// The file of all `tiles` when they are written, each with its hash; `None` where it cannot be kept.
    pub(super) fn finish(mut sheet: NewEntry, hashes: Vec<u64>, tiles: &[Window], found: Found) -> Option<Self> {
        // Words are always JSON; a file without them is damaged, and made anew.
        let words = serde_json::to_vec(&found).unwrap_or_default();
        let mut hash = Xxh3::new();
        for bytes in [bytemuck::cast_slice(&hashes), words.as_slice(), &(words.len() as u64).to_le_bytes()] {
            hash.update(bytes);
            sheet.write(bytes);
        }
        sheet.write(&hash.digest().to_le_bytes());
        let KeptEntry { file, .. } = sheet.publish().ok()?;
        Some(Self::new(file, tiles, &hashes, found))
    }

    /// Reads what was kept of `tiles`. Fails where the bytes behind them are not those that were written.
    pub(super) fn recall(KeptEntry { mut file, bytes, .. }: KeptEntry, tiles: &[Window]) -> io::Result<Self> {
        let damaged = || io::Error::from(ErrorKind::InvalidData);
        let begin = bytes_of(tiles);
        let mut rest = vec![0; bytes.checked_sub(begin).ok_or_else(damaged)? as usize];
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(&mut rest)?;
        let (rest, written) = rest.split_last_chunk::<8>().ok_or_else(damaged)?;
        if u64::from_le_bytes(*written) != xxh3_64(rest) {
            return Err(damaged());
        }
        let (hashes, words) = rest.split_at_checked(size_of::<u64>() * tiles.len()).ok_or_else(damaged)?;
        let (words, length) = words.split_last_chunk::<8>().ok_or_else(damaged)?;
        if u64::from_le_bytes(*length) != words.len() as u64 {
            return Err(damaged());
        }
        let found = serde_json::from_slice(words).map_err(|_| damaged())?;
        let hashes: Vec<u64> = hashes.chunks_exact(size_of::<u64>()).map(bytemuck::pod_read_unaligned).collect();
        Ok(Self::new(file, tiles, &hashes, found))
    }

    fn new(file: File, tiles: &[Window], hashes: &[u64], found: Found) -> Self {
        let mut place = 0;
        let placed = tiles.iter().zip(hashes).map(|(tile, hash)| {
            let from = place;
            place += bytes_of(std::slice::from_ref(tile));
            (tile.first, (tile.size, from, *hash))
        });
        Self { tiles: placed.collect(), file: Mutex::new(file), found }
    }

    /// What was found when they were made.
    pub(super) fn found(&self) -> &Found {
        &self.found
    }

    /// The heights of a tile; `None` where it is none, or damaged.
    pub(super) fn read(&self, tile: Window) -> Option<Vec<f32>> {
        let (size, place, hash) = *self.tiles.get(&tile.first)?;
        let mut heights = vec![0.0_f32; tile.samples() as usize];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut heights);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(place)).ok()?;
        file.read_exact(bytes).ok()?;
        drop(file);
        (size == tile.size && xxh3_64(bytes) == hash).then_some(heights)
    }
}
