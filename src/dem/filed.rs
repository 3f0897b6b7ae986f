//! Samples that stay in their files, read tile by tile as they are asked for.
//!
//! Tiles read are kept while they fit a budget; the one that was asked for longest ago goes first, the last one stays. Any number of threads
//! may ask at once: a tile that two want is read by one, the other waits. No core's work is stolen by a reading (nothing
//! in it is parallel), so that waiting cannot turn in a circle. Memory beside the budget: GDAL's own cache (32 MiB) and
//! a few tiles on their way.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Debug, Formatter};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use xxhash_rust::xxh3::Xxh3;

use super::assumed::{assumed, units};
use super::grid::Window;
use super::mosaic::Mosaic;
use super::overviews::Overviews;
use super::raster::Raster;
use super::tally::{Tallies, merge};
use super::tiling::{Tiling, gather};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Most bytes of tiles that are kept: frames ask for samples place by place.
const MOST_KEPT: usize = 128 << 20;

/// A window of a mosaic whose samples are read on demand.
pub(super) struct Filed {
    mosaic: Arc<Mosaic>,
    window: Window,
    exaggeration: f64,
    tiling: Tiling,
    /// Bytes of memory that all work with the samples may take.
    budget: usize,
    stamp: OnceLock<Option<u128>>,
    kept: Mutex<Kept>,
    counted: Mutex<Counted>,
    overviews: OnceLock<Overviews>,
    failure: OnceLock<Error>,
    /// How many samples were read from the files.
    samples_read: AtomicU64,
}

/// Exaggerated metres of a tile, NaN at voids, once they are read.
type Tile = Arc<Mutex<Option<Arc<[f32]>>>>;

/// Tiles by their spacing and first samples, each with the number of the request that came last, and the bytes of all.
#[derive(Default)]
struct Kept {
    tiles: HashMap<(usize, [usize; 2]), (Tile, u64, usize)>,
    requests: u64,
    bytes: usize,
}

/// The numbers of the tiles read so far.
#[derive(Default)]
struct Counted {
    of: HashSet<[usize; 2]>,
    tallies: Tallies,
}

impl Filed {
    /// `window` of `mosaic`, with up to half of `budget` bytes of tiles kept, [`MOST_KEPT`] at most.
    pub fn new(mosaic: Mosaic, window: Window, exaggeration: f64, budget: usize) -> Self {
        Self::of(Arc::new(mosaic), window, exaggeration, budget)
    }

    /// The same samples of the same files without exaggeration, nothing read yet.
    pub fn plain(&self) -> Self {
        Self::of(self.mosaic.clone(), self.window, 1.0, self.budget)
    }

    fn of(mosaic: Arc<Mosaic>, window: Window, exaggeration: f64, budget: usize) -> Self {
        let tiling = mosaic.tiling(window);
        Self {
            mosaic,
            window,
            exaggeration,
            tiling,
            budget,
            stamp: OnceLock::new(),
            kept: Mutex::default(),
            counted: Mutex::default(),
            overviews: OnceLock::new(),
            failure: OnceLock::new(),
            samples_read: AtomicU64::new(0),
        }
    }

    /// Rows of a tile.
    pub fn tile_rows(&self) -> usize {
        self.tiling.size[1]
    }

    /// Whether several threads gain by reading at once.
    pub fn is_parallel(&self) -> bool {
        self.mosaic.is_parallel()
    }

    /// Bytes of memory that all work with the samples may take.
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// Factor on every elevation.
    pub fn exaggeration(&self) -> f64 {
        self.exaggeration
    }

    /// What tells one state of the files, one way of reading them and one window from any other, whatever the exaggeration;
    /// `None` where a part is not on the disk. Cost: the first time, a look into each file.
    pub fn stamp(&self) -> Option<u128> {
        *self.stamp.get_or_init(|| {
            let mut hash = Xxh3::new();
            hash.update(format!("{:?}", self.window).as_bytes());
            self.mosaic.hash(&mut hash).map(|()| hash.digest128())
        })
    }

    /// All samples, metres, and a tally of the files' numbers. `progress` hears the share done.
    pub fn raster(&self, progress: &dyn Fn(f64)) -> Result<(Raster, Tallies)> {
        if self.mosaic.apart().is_some() {
            return self.mosaic.read(self.window, progress);
        }
        let metres = self.read(Window { first: [0, 0], ..self.window }, progress)?;
        Ok((Raster { grid: self.mosaic.grid.part(self.window), metres }, self.tallies()))
    }

    /// Exaggerated metres of `window`, counted from the first sample, NaN at voids. `progress` hears the share done.
    pub fn read(&self, window: Window, progress: &dyn Fn(f64)) -> Result<Vec<f32>> {
        let tiles = self.tiling.tiles(window);
        gather(window, &tiles, self.mosaic.is_parallel(), |tile| self.tile(tile), progress)
    }

    /// Exaggerated metres of one sample, NaN at a void.
    pub fn height(&self, at: [usize; 2]) -> Result<f32> {
        let window = self.tiling.tile(at);
        let [c, r] = [0, 1].map(|i| at[i] - window.first[i]);
        Ok(self.tile(window)?[r * window.size[0] + c])
    }

    /// Exaggerated metres of `window` of every `spacing`-th sample and row, NaN at voids; `None` where no overviews have
    /// them, or damaged ones. Overviews themselves are not exaggerated.
    pub fn overview(&self, spacing: usize, window: Window) -> Option<Vec<f32>> {
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
    pub fn remember(&self, overviews: Overviews) {
        let _ = self.overviews.set(overviews);
    }

    /// What was taken.
    pub fn overviews(&self) -> Option<&Overviews> {
        self.overviews.get()
    }

    /// How many samples were read from the files so far, each as often as it was.
    pub fn samples_read(&self) -> u64 {
        self.samples_read.load(Ordering::Relaxed)
    }

    /// The numbers read so far.
    pub fn tallies(&self) -> Tallies {
        lock(&self.counted).tallies.clone()
    }

    /// What had to be assumed of the numbers tallied, in words as those of a history.
    pub fn assumed(&self, tallies: &Tallies) -> Vec<Message> {
        assumed(&self.mosaic.tallied(tallies), self.mosaic.is_of_several())
    }

    /// Keeps the first error of those who could not return it.
    pub fn fail(&self, error: Error) {
        let _ = self.failure.set(error);
    }

    /// The first error of those who could not return it, and whether the files are still those that were opened.
    pub fn check(&self) -> Result<()> {
        let noticed = self.failure.get().cloned().map_or_else(|| self.mosaic.check(), Err);
        noticed.inspect_err(|error| self.fail(error.clone()))
    }

    /// The error for files without any elevation among `samples`; a unit that would make elevations of their numbers is
    /// named.
    pub fn all_void(&self, samples: usize, tallies: &Tallies) -> Error {
        let inside = if self.window == self.mosaic.grid.whole() { "" } else { " inside the crop" };
        let what = format!("holds no elevation{inside}, all {samples} samples are void");
        match units(&self.mosaic.tallied(tallies)) {
            Some(units) => Error::input(
                self.mosaic.path(),
                format!("{what} or above 100000 m"),
                message!["if the heights are in another unit, add ", units],
            ),
            None => Error::input(
                self.mosaic.path(),
                what,
                message![
                    "check the band and its nodata value with `gdalinfo -stats`, choose another ",
                    Setting::Band,
                    ", or move ",
                    Setting::Crop
                ],
            ),
        }
    }

    fn tile(&self, window: Window) -> Result<Arc<[f32]>> {
        self.kept(1, window, || {
            let first = [0, 1].map(|i| self.window.first[i] + window.first[i]);
            let (raster, tallies) = self.mosaic.read(Window { first, ..window }, &|_| ())?;
            self.samples_read.fetch_add(window.samples(), Ordering::Relaxed);
            lock(&self.counted).add(window.first, tallies);
            let mut metres = raster.metres;
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

impl Kept {
    /// The tile of a window, new ones in the place of old ones beyond `budget` bytes.
    fn tile(&mut self, spacing: usize, window: Window, budget: usize) -> Tile {
        self.requests += 1;
        let place = (spacing, window.first);
        if let Some((tile, request, _)) = self.tiles.get_mut(&place) {
            *request = self.requests;
            return tile.clone();
        }
        let (tile, bytes) = (Tile::default(), window.samples() as usize * size_of::<f32>());
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

impl Counted {
    fn add(&mut self, tile: [usize; 2], tallies: Tallies) {
        // A tile may come more than once.
        if self.of.insert(tile) {
            merge(&mut self.tallies, tallies);
        }
    }
}

impl Debug for Filed {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Filed").field("path", &self.mosaic.path()).field("window", &self.window).finish_non_exhaustive()
    }
}

/// Multiplies metres by the exaggeration.
pub(super) fn exaggerate(metres: &mut [f32], exaggeration: f64) {
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
        let mut kept = Kept::default();
        let tiles: Vec<_> = (0..3).map(|c| kept.tile(1, tile(c), 12_000)).collect();
        assert!(Arc::ptr_eq(&tiles[0], &kept.tile(1, tile(0), 12_000)), "all three fit");
        let _ = kept.tile(1, tile(3), 12_000);
        assert_eq!(kept.bytes, 12_000);
        assert!(Arc::ptr_eq(&tiles[0], &kept.tile(1, tile(0), 12_000)), "asked for since");
        assert!(!Arc::ptr_eq(&tiles[1], &kept.tile(1, tile(1), 12_000)), "gone");
        let mut one = Kept::default();
        let last = [0, 1].map(|c| one.tile(1, tile(c), 3_999));
        assert!(Arc::ptr_eq(&last[1], &one.tile(1, tile(1), 3_999)), "the last one, though larger than the budget");
        assert_eq!((one.bytes, one.tiles.len()), (4_000, 1), "but no other");
    }
}
