//! Heights that depend on those around them: tiles of a grid, changed by what works on a window with a halo.
//!
//! Cost: a tile is read with its halo, so tiles are larger than those of the grid; the grid's own are kept while they fit,
//! so that none is read anew for each halo it lies in. What comes of the work may be kept on disk (`stored`),
//! all of it once, and is read from there ever after. Memory: a quarter of the budget, a tile with its halo a thread.

use std::fmt::Debug;
use std::sync::Arc;

use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_128;

use super::filed::Filed;
use super::stored::{Stored, key};
use super::tiles::Tiles;
use super::tiling::{Tiling, copy};
use super::window::Window;
use crate::cache::{Cache, Hearing, Sheet};
use crate::error::{Error, Message, Result};

/// Tiles that each core works on before they are written.
const TILES_A_CORE: usize = 2;
/// Shortest side of a tile in halos: then no more than 2 1/4 samples are worked on for one.
const HALOS: usize = 4;

/// Work on heights that looks at those around.
///
/// A height must come out the same, bit for bit, whatever window is worked on, with the halo around it: fewer samples only
/// at the grid's own edge.
pub trait Focal: Debug + Send + Sync {
    /// Samples around a window on which the heights in it depend.
    fn halo(&self) -> usize;

    /// Changes metres, row-major, NaN at voids, of a window of the grid, its halo included. Not parallel: others wait for it.
    ///
    /// # Errors
    /// [`Error::Input`] when something must be read and cannot.
    fn apply(&self, heights: &mut [f32], window: Window) -> Result<()>;

    /// What tells this work from any other.
    fn stamp(&self) -> u128;
}

/// Tiles with work done on them.
#[derive(Debug)]
pub struct Worked<F> {
    of: Filed,
    by: F,
    stored: Option<Stored>,
}

impl<F: Focal> Worked<F> {
    /// All of `tiles`; half of `budget` bytes is for those who keep what comes of them.
    pub fn new(tiles: Arc<dyn Tiles>, by: F, budget: usize) -> Self {
        Self { of: Filed::new(tiles, 1.0, budget / 2), by, stored: None }
    }

    /// The same, with what comes of the work found in the cache, or made and kept there; `of`: what it is made of, for people.
    /// Without a folder nothing is made yet. `progress` hears the share done.
    ///
    /// # Errors
    /// Those of reading the tiles, and of the work.
    pub fn kept_in(self, cache: &Cache, of: String, progress: &dyn Fn(f64)) -> Result<Self> {
        let Some(stamp) = cache.folder().and_then(|_| self.stamp()) else { return Ok(self) };
        let tiles = self.tiling().tiles(Window { first: [0, 0], size: self.size() });
        // What is damaged is made anew; where nothing can be kept, those who keep more tell so.
        let hearing = Hearing { warn: &|_| (), progress };
        let stored = cache.get(
            &key(stamp, of),
            hearing,
            |kept| Stored::recall(kept, &tiles).map(Some),
            |sheet, progress| sheet.map_or(Ok(None), |sheet| self.make(sheet, &tiles, progress)),
        )?;
        Ok(Self { stored, ..self })
    }

    /// Works on all `tiles` and keeps what comes of it; `None` where it cannot be kept.
    fn make(&self, mut sheet: Sheet, tiles: &[Window], progress: &dyn Fn(f64)) -> Result<Option<Stored>> {
        let at_once = if self.is_parallel() { TILES_A_CORE * rayon::current_num_threads() } else { 1 };
        let mut hashes = Vec::with_capacity(tiles.len());
        for batch in tiles.chunks(at_once) {
            let made: Vec<_> = match batch {
                [tile] => vec![self.work(*tile)?],
                _ => batch.par_iter().map(|tile| self.work(*tile)).collect::<Result<_>>()?,
            };
            hashes.extend(made.iter().map(|heights| Stored::write(&mut sheet, heights)));
            progress(hashes.len() as f64 / tiles.len() as f64);
        }
        // What was read of files that changed meanwhile is of neither state.
        self.check()?;
        Ok(Stored::finish(sheet, hashes, tiles))
    }

    /// The heights of a tile after the work.
    fn work(&self, window: Window) -> Result<Vec<f32>> {
        let around = window.with_halo(self.by.halo(), self.size());
        let mut heights = self.of.read_alone(around)?;
        self.by.apply(&mut heights, around)?;
        let mut inside = vec![f32::NAN; window.samples() as usize];
        copy(around, &heights, window, &mut inside);
        Ok(inside)
    }
}

impl<F: Focal> Tiles for Worked<F> {
    fn size(&self) -> [usize; 2] {
        self.of.tiles().size()
    }

    fn tiling(&self) -> Tiling {
        self.of.tiles().tiling().at_least(HALOS * self.by.halo())
    }

    fn is_parallel(&self) -> bool {
        self.of.is_parallel()
    }

    fn read(&self, window: Window) -> Result<Vec<f32>> {
        let stored = self.stored.as_ref().and_then(|stored| stored.read(window));
        stored.map_or_else(|| self.work(window), Ok)
    }

    fn stamp(&self) -> Option<u128> {
        let of = self.of.tiles().stamp()?;
        Some(xxh3_128(bytemuck::bytes_of(&[of, self.by.stamp()])))
    }

    fn check(&self) -> Result<()> {
        self.of.check()
    }

    fn marks(&self) -> usize {
        self.of.tiles().marks()
    }

    fn assumed(&self) -> Vec<Message> {
        self.of.tiles().assumed()
    }

    fn all_void(&self) -> Error {
        self.of.tiles().all_void()
    }
}
