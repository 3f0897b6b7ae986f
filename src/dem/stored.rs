//! Heights of tiles, kept on disk: what took long to make is read as fast as a plain file.
//!
//! ```text
//! tiles, row by row of them, 4 bytes a sample | a hash of each | hash of the hashes
//! ```
//!
//! A tile is checked when it is read; whoever asks for a damaged one works it out again.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::sync::{Mutex, PoisonError};

use xxhash_rust::xxh3::xxh3_64;

use super::window::Window;
use crate::cache::{Kept, Key, Kind, Sheet};

/// Raise it when the bytes mean something else.
const FORMAT: u32 = 2;
const KIND: Kind =
    Kind { name: "smooth", format: FORMAT, words: ["what was made of the heights", "what was kept of the heights"] };

/// Tiles in their file.
#[derive(Debug)]
pub(super) struct Stored {
    file: Mutex<File>,
    /// By the first sample: size, place in the file, hash.
    tiles: HashMap<[usize; 2], ([usize; 2], u64, u64)>,
}

/// What the heights of tiles with this stamp depend on.
pub(super) fn key(stamp: u128, of: String) -> Key {
    Key { kind: KIND, hash: stamp, of }
}

impl Stored {
    /// Writes the heights of the next tile, and gives their hash.
    pub fn write(sheet: &mut Sheet, heights: &[f32]) -> u64 {
        let bytes = bytemuck::cast_slice(heights);
        sheet.write(bytes);
        xxh3_64(bytes)
    }

    /// The file of all `tiles` when they are written, each with its hash; `None` where it cannot be kept.
    pub fn finish(mut sheet: Sheet, hashes: Vec<u64>, tiles: &[Window]) -> Option<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(&hashes);
        sheet.write(bytes);
        sheet.write(&xxh3_64(bytes).to_le_bytes());
        let Kept { file, .. } = sheet.publish().ok()?;
        Some(Self::new(file, tiles, &hashes))
    }

    /// Reads what was kept of `tiles`. Fails where the hashes are not those that were written.
    pub fn recall(Kept { mut file, bytes, .. }: Kept, tiles: &[Window]) -> io::Result<Self> {
        let damaged = || io::Error::from(ErrorKind::InvalidData);
        let mut hashes = vec![0_u64; tiles.len() + 1];
        let begin = tiles.iter().map(|tile| tile.samples()).sum::<u64>() * size_of::<f32>() as u64;
        if begin + size_of_val(&hashes[..]) as u64 != bytes {
            return Err(damaged());
        }
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(bytemuck::cast_slice_mut(&mut hashes))?;
        let whole = hashes.pop().ok_or_else(damaged)?;
        if u64::from_le(whole) != xxh3_64(bytemuck::cast_slice(&hashes)) {
            return Err(damaged());
        }
        Ok(Self::new(file, tiles, &hashes))
    }

    fn new(file: File, tiles: &[Window], hashes: &[u64]) -> Self {
        let mut place = 0;
        let placed = tiles.iter().zip(hashes).map(|(tile, hash)| {
            let from = place;
            place += tile.samples() * size_of::<f32>() as u64;
            (tile.first, (tile.size, from, *hash))
        });
        Self { tiles: placed.collect(), file: Mutex::new(file) }
    }

    /// The heights of a tile; `None` where it is none, or damaged.
    pub fn read(&self, tile: Window) -> Option<Vec<f32>> {
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
