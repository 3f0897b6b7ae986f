//! Samples that stay in their files, read tile by tile as they are asked for.
//!
//! Tiles read are kept while they fit a budget; the one that was asked for longest ago goes first, the last one stays. Any number of threads
//! may ask at once: a tile that two want is read by one, the other waits. No core's work is stolen by a reading (nothing
//! in it is parallel), so that waiting cannot turn in a circle. Memory beside the budget: what the tiles take (those of
//! GDAL 32 MiB) and a few tiles on their way.

use std::collections::HashMap;
use std::fmt::{self, Debug, Formatter};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::overviews::Overviews;
use super::tiles::Tiles;
use super::tiling::{Tiling, gather};
use super::window::Window;
use crate::error::{Error, Result};

/// Most bytes of tiles that are kept: frames ask for samples place by place.
const MOST_KEPT: usize = 128 << 20;

/// Tiles that are read on demand.
pub(super) struct Filed {
    tiles: Arc<dyn Tiles>,
    exaggeration: f64,
    tiling: Tiling,
    /// Bytes of memory that all work with the samples may take.
    budget: usize,
    stamp: OnceLock<Option<u128>>,
    kept: Mutex<KeptTiles>,
    overviews: OnceLock<Overviews>,
    failure: OnceLock<Error>,
    /// How many samples were read from the files.
    samples_read: AtomicU64,
}

/// Exaggerated metres of a tile, NaN at voids, once they are read.
type TileHeights = Arc<Mutex<Option<Arc<[f32]>>>>;

/// Tiles by their spacing and first samples, each with the number of the request that came last, and the bytes of all.
#[derive(Default)]
struct KeptTiles {
    tiles: HashMap<(usize, [usize; 2]), (TileHeights, u64, usize)>,
    requests: u64,
    bytes: usize,
}

impl Filed {
    /// All of `tiles`, of which up to half of `budget` bytes are kept, [`MOST_KEPT`] at most.
    pub(super) fn new(tiles: Arc<dyn Tiles>, exaggeration: f64, budget: usize) -> Self {
        let tiling = tiles.tiling();
        Self {
            tiles,
            exaggeration,
            tiling,
            budget,
            stamp: OnceLock::new(),
            kept: Mutex::default(),
            overviews: OnceLock::new(),
            failure: OnceLock::new(),
            samples_read: AtomicU64::new(0),
        }
    }

    /// The same samples without exaggeration, nothing read yet.
    pub(super) fn plain(&self) -> Self {
        Self::new(self.tiles.clone(), 1.0, self.budget)
    }

    /// Where the samples come from.
    pub(super) fn tiles(&self) -> &dyn Tiles {
        &*self.tiles
    }

    /// Rows of a tile.
    pub(super) fn tile_rows(&self) -> usize {
        self.tiling.size[1]
    }

    /// Whether several threads gain by reading at once.
    pub(super) fn is_parallel(&self) -> bool {
        self.tiles.is_parallel()
    }

    /// Bytes of memory that all work with the samples may take.
    pub(super) fn budget(&self) -> usize {
        self.budget
    }

    /// Factor on every elevation.
    pub(super) fn exaggeration(&self) -> f64 {
        self.exaggeration
    }

    /// The stamp of the tiles, whatever the exaggeration. Cost: the first time, a look into each file.
    pub(super) fn stamp(&self) -> Option<u128> {
        *self.stamp.get_or_init(|| self.tiles.stamp())
    }

    /// Exaggerated metres of `window`, counted from the first sample, NaN at voids. `progress` hears the share done.
    pub(super) fn read(&self, window: Window, progress: &dyn Fn(f64)) -> Result<Vec<f32>> {
        let tiles = self.tiling.tiles(window);
        gather(window, &tiles, self.tiles.is_parallel(), |tile| self.tile(tile), progress)
    }

    /// The same on this thread alone, for whoever works inside a reading.
    pub(super) fn read_alone(&self, window: Window) -> Result<Vec<f32>> {
        gather(window, &self.tiling.tiles(window), false, |tile| self.tile(tile), &|_| ())
    }

    /// Exaggerated metres of one sample, NaN at a void.
    pub(super) fn height(&self, at: [usize; 2]) -> Result<f32> {
        let window = self.tiling.tile(at);
        let [c, r] = [0, 1].map(|i| at[i] - window.first[i]);
        Ok(self.tile(window)?[r * window.size[0] + c])
    }

    /// Exaggerated metres of `window` of every `spacing`-th sample and row, NaN at voids; `None` where no overviews have
    /// them, or damaged ones. Overviews themselves are not exaggerated.
    pub(super) fn overview(&self, spacing: usize, window: Window) -> Option<Vec<f32>> {
        let overviews = self.overviews()?;
        let tiles = overviews.tiling(spacing)?.tiles(window);
        let load = |tile: Window| {
            self.kept(spacing, tile, || {
                let mut metres = overviews.read(spacing, tile)?;
                exaggerate(&mut metres, self.exaggeration);
                Ok(metres.into())
            })
        };
        gather(window, &tiles, false, load, &|_| ()).ok()
    }

    /// Takes overviews, unless there are some.
    pub(super) fn remember(&self, overviews: Overviews) {
        let _ = self.overviews.set(overviews);
    }

    /// What was taken.
    pub(super) fn overviews(&self) -> Option<&Overviews> {
        self.overviews.get()
    }

    /// How many samples were read from the files so far, each as often as it was.
    pub(super) fn samples_read(&self) -> u64 {
        self.samples_read.load(Ordering::Relaxed)
    }

    /// Keeps the first error of those who could not return it.
    pub(super) fn fail(&self, error: Error) {
        let _ = self.failure.set(error);
    }

    /// The first error of those who could not return it, and whether the files are still those that were opened.
    pub(super) fn check(&self) -> Result<()> {
        let noticed = self.failure.get().cloned().map_or_else(|| self.tiles.check(), Err);
        noticed.inspect_err(|error| self.fail(error.clone()))
    }

    fn tile(&self, window: Window) -> Result<Arc<[f32]>> {
        self.kept(1, window, || {
            let mut metres = self.tiles.read(window)?;
            self.samples_read.fetch_add(window.samples(), Ordering::Relaxed);
            exaggerate(&mut metres, self.exaggeration);
            Ok(metres.into())
        })
    }

    /// The tile over `window` of every `spacing`-th sample, read unless it is kept.
    fn kept(&self, spacing: usize, window: Window, read: impl FnOnce() -> Result<Arc<[f32]>>) -> Result<Arc<[f32]>> {
        let tile = lock(&self.kept).tile(spacing, window, (self.budget / 2).min(MOST_KEPT));
        let mut samples = lock(&tile);
        match &*samples {
            Some(samples) => Ok(samples.clone()),
            None => Ok(samples.insert(read()?).clone()),
        }
    }
}

impl KeptTiles {
    /// The tile of a window, new ones in the place of old ones beyond `budget` bytes.
    fn tile(&mut self, spacing: usize, window: Window, budget: usize) -> TileHeights {
        self.requests += 1;
        let place = (spacing, window.first);
        if let Some((tile, request, _)) = self.tiles.get_mut(&place) {
            *request = self.requests;
            return tile.clone();
        }
        let (tile, bytes) = (TileHeights::default(), window.samples() as usize * size_of::<f32>());
        while self.bytes + bytes > budget {
            let oldest = self.tiles.iter().min_by_key(|(_, (_, request, _))| *request).map(|(place, _)| *place);
            // The last one stays, however large: whoever asks sample by sample would read it for each.
            let Some((_, _, freed)) = oldest.and_then(|place| self.tiles.remove(&place)) else { break };
            self.bytes -= freed;
        }
        self.bytes += bytes;
        self.tiles.insert(place, (tile.clone(), self.requests, bytes));
        tile
    }
}

impl Debug for Filed {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Filed").field("tiles", &self.tiles).finish_non_exhaustive()
    }
}

/// Multiplies metres by the exaggeration.
pub(crate) fn exaggerate(metres: &mut [f32], exaggeration: f64) {
    metres.iter_mut().for_each(|height| *height = (f64::from(*height) * exaggeration) as f32);
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tile_asked_for_longest_ago_makes_room() {
        let tile = |c: usize| Window { first: [c, 0], size: [100, 10] };
        let mut kept = KeptTiles::default();
        let tiles: Vec<_> = (0..3).map(|c| kept.tile(1, tile(c), 12_000)).collect();
        assert!(Arc::ptr_eq(&tiles[0], &kept.tile(1, tile(0), 12_000)), "all three fit");
        let _ = kept.tile(1, tile(3), 12_000);
        assert_eq!(kept.bytes, 12_000);
        assert!(Arc::ptr_eq(&tiles[0], &kept.tile(1, tile(0), 12_000)), "asked for since");
        assert!(!Arc::ptr_eq(&tiles[1], &kept.tile(1, tile(1), 12_000)), "gone");
        let mut one = KeptTiles::default();
        let last = [0, 1].map(|c| one.tile(1, tile(c), 3_999));
        assert!(Arc::ptr_eq(&last[1], &one.tile(1, tile(1), 3_999)), "the last one, though larger than the budget");
        assert_eq!((one.bytes, one.tiles.len()), (4_000, 1), "but no other");
    }
}
