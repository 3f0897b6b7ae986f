//! A window of a layer as a DEM asks for it: read tile by tile, the files' numbers tallied as they come.

use std::collections::HashSet;
use std::fmt::{self, Debug, Formatter};
use std::sync::{Mutex, MutexGuard, PoisonError};

use xxhash_rust::xxh3::Xxh3;

use super::assumed::{assumed, units};
use super::layer::Layer;
use super::raster::Raster;
use super::tally::{Tallies, merge};
use crate::dem::tiling::gather;
use crate::dem::{Tiles, Tiling, Window};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Some samples of a layer.
pub(super) struct Part {
    layer: Layer,
    window: Window,
    counted: Mutex<Counted>,
}

/// The numbers of the windows read so far.
#[derive(Default)]
struct Counted {
    of: HashSet<[usize; 2]>,
    tallies: Tallies,
}

impl Part {
    /// `window` of `layer`, nothing read yet.
    pub fn new(layer: Layer, window: Window) -> Self {
        Self { layer, window, counted: Mutex::default() }
    }

    /// All samples. `progress` hears the share done.
    pub fn raster(&self, progress: &dyn Fn(f64)) -> Result<Raster> {
        let whole = Window { first: [0, 0], ..self.window };
        let tiles = self.tiling().tiles(whole);
        let metres = gather(whole, &tiles, self.is_parallel(), |tile| self.read(tile), progress)?;
        Ok(Raster { grid: self.layer.grid.part(self.window), metres })
    }

    /// The layer that it is of.
    pub fn layer(&self) -> &Layer {
        &self.layer
    }

    /// What has to be assumed of the numbers of all `parts` that were read.
    pub fn assumed_of(parts: &[Self]) -> Vec<Message> {
        let counted: Vec<_> = parts.iter().map(Self::counted).collect();
        let files = parts.iter().zip(&counted).flat_map(|(part, counted)| part.layer.tallied(&counted.tallies));
        assumed(&files.collect::<Vec<_>>(), parts.iter().any(|part| part.layer.is_of_several()))
    }

    /// The error for files without any elevation among `samples`; a unit that would make elevations of their numbers is
    /// named.
    pub fn void(&self, samples: u64) -> Error {
        let inside = if self.window == self.layer.grid.whole() { "" } else { " inside the crop" };
        let what = format!("holds no elevation{inside}, all {samples} samples are void");
        match units(&self.layer.tallied(&self.counted().tallies)) {
            Some(units) => Error::input(
                self.layer.path(),
                format!("{what} or above 100000 m"),
                message!["if the heights are in another unit, add ", units],
            ),
            None => Error::input(
                self.layer.path(),
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

    fn counted(&self) -> MutexGuard<'_, Counted> {
        self.counted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Tiles for Part {
    fn size(&self) -> [usize; 2] {
        self.window.size
    }

    fn tiling(&self) -> Tiling {
        self.layer.tiling(self.window)
    }

    fn is_parallel(&self) -> bool {
        self.layer.is_parallel()
    }

    fn read(&self, window: Window) -> Result<Vec<f32>> {
        let first = [0, 1].map(|i| self.window.first[i] + window.first[i]);
        let (raster, tallies) = self.layer.read(Window { first, ..window }, &|_| ())?;
        self.counted().add(window.first, tallies);
        Ok(raster.metres)
    }

    /// Of names, sizes, times and both ends of all files, and of the way of reading them.
    fn stamp(&self) -> Option<u128> {
        let mut hash = Xxh3::new();
        hash.update(format!("{:?}", self.window).as_bytes());
        self.layer.hash(&mut hash).map(|()| hash.digest128())
    }

    fn check(&self) -> Result<()> {
        self.layer.check()
    }

    fn marks(&self) -> usize {
        self.counted().tallies.values().map(|tally| tally.marks).sum()
    }

    fn assumed(&self) -> Vec<Message> {
        Self::assumed_of(std::slice::from_ref(self))
    }

    fn all_void(&self) -> Error {
        self.void(self.window.samples())
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

impl Debug for Part {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Part").field("path", &self.layer.path()).field("window", &self.window).finish_non_exhaustive()
    }
}
