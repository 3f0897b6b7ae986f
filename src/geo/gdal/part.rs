//! A window of a layer as a DEM asks for it: read tile by tile, the files' numbers tallied as they come, and what they show
//! of steps.

use std::collections::HashSet;
use std::fmt::{self, Debug, Formatter};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use xxhash_rust::xxh3::Xxh3;

use super::assumed::{assumed, units};
use super::layer::FileLayer;
use super::raster::Raster;
use super::smoothing::{self, Smoothing};
use super::steps::Steps;
use super::tally::{Tallies, merge};
use crate::cache::{Cache, CacheObserver};
use crate::dem::in_bands::in_bands;
use crate::dem::smoothest::HALO;
use crate::dem::tiling::gather;
use crate::dem::water::WaterBuilder;
use crate::dem::{Tiles, Tiling, Window};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Most samples that are looked at together: 64 MiB.
const BAND: usize = 1 << 24;

/// Some samples of a layer.
pub(super) struct Part {
    layer: FileLayer,
    window: Window,
    keep_steps: bool,
    counted: Mutex<Counted>,
    smoothing: OnceLock<Option<Smoothing>>,
}

/// The numbers of the windows read so far.
#[derive(Default)]
struct Counted {
    of: HashSet<[usize; 2]>,
    tallies: Tallies,
}

impl Part {
    /// `window` of `layer`, nothing read yet. `keep_steps`: heights stay as the files have them.
    pub(super) fn new(layer: FileLayer, window: Window, keep_steps: bool) -> Self {
        Self { layer, window, keep_steps, counted: Mutex::default(), smoothing: OnceLock::new() }
    }

    /// All samples, the smoothest within their steps. `progress` hears the share done.
    pub(super) fn raster(&self, progress: &dyn Fn(f64)) -> Result<Raster> {
        let whole = self.whole();
        let tiles = self.tiling().tiles(whole);
        let mut metres = gather(whole, &tiles, self.is_parallel(), |tile| self.read(tile), progress)?;
        let steps = if self.keep_steps { None } else { self.steps_of(&self.counted().tallies) };
        let found = steps.map(|steps| {
            let mut water = WaterBuilder::new(whole.size[0]);
            water.take(&metres);
            Smoothing { steps, water: water.finish() }
        });
        if let Some(smoothing) = self.smoothing.get_or_init(|| found) {
            in_bands(&mut metres, whole.size, HALO, |heights, window| smoothing.smooth(self, heights, window, true))?;
        }
        Ok(Raster { grid: self.layer.grid.part(self.window), metres })
    }

    /// The layer that it is of.
    pub(super) fn layer(&self) -> &FileLayer {
        &self.layer
    }

    /// What has to be assumed of the numbers of all `parts` that were read.
    pub(super) fn assumed_of(parts: &[Self]) -> Vec<Message> {
        let counted: Vec<_> = parts.iter().map(Self::counted).collect();
        let files = parts.iter().zip(&counted).flat_map(|(part, counted)| part.layer.tallied(&counted.tallies));
        assumed(&files.collect::<Vec<_>>(), parts.iter().any(|part| part.layer.is_of_several()))
    }

    /// Finds the steps of samples that stay in their files, in the cache or in a look at all of them; the cache
    /// names them by `label`.
    pub(super) fn look(&self, cache: &Cache, label: String, progress: &dyn Fn(f64)) -> Result<()> {
        if self.keep_steps || !self.layer.may_have_steps(self.window)? {
            return Ok(());
        }
        let found = match self.stamp() {
            None => self.looked(progress)?,
            Some(stamp) => {
                let key = smoothing::key(stamp, label);
                // What was kept and is damaged is made anew, without a word: it takes no longer than the first time.
                cache.get(&key, CacheObserver { warn: &|_| (), progress }, smoothing::recall, |sheet, progress| {
                    let found = self.looked(progress)?;
                    sheet.into_iter().for_each(|sheet| smoothing::keep(found.as_ref(), sheet));
                    Ok(found)
                })?
            }
        };
        self.smoothing.get_or_init(|| found);
        Ok(())
    }

    /// What is known of steps after [`Self::raster`] or [`Self::look`], where there are any.
    pub(super) fn smoothing(&self) -> Option<&Smoothing> {
        self.smoothing.get()?.as_ref()
    }

    /// Half the step of each sample of `window`, by the file that gives it, metres.
    pub(super) fn halves(&self, steps: &Steps, window: Window) -> Result<Vec<f32>> {
        let mut halves = vec![0.0; window.samples() as usize];
        let window = self.in_layer(window);
        for place in self.layer.meeting(window) {
            let (raster, _) = self.layer.read_of(place, window)?;
            let given = halves.iter_mut().zip(raster.metres).filter(|(_, metres)| !metres.is_nan());
            given.for_each(|(half, _)| *half = steps.half(place));
        }
        Ok(halves)
    }

    /// A look at all samples, band by band, that ends as soon as no file can have a step.
    fn looked(&self, progress: &dyn Fn(f64)) -> Result<Option<Smoothing>> {
        let [columns, rows] = self.window.size;
        let (mut water, tallies) = (WaterBuilder::new(columns), Mutex::<Tallies>::default());
        let mut from = 0;
        while from < rows {
            let tile = self.tiling().tile([0, from]);
            let most = (BAND / columns).max(1);
            let height = (tile.first[1] + tile.size[1] - from).min(most);
            let band = Window { first: [0, from], size: [columns, height] };
            let cut = |tile: Window| Window { first: [tile.first[0], from], size: [tile.size[0], height] };
            let tiles: Vec<_> = self.tiling().tiles(band).into_iter().map(cut).collect();
            let load = |tile| {
                let (raster, of_tile) = self.layer.read(self.in_layer(tile), &|_| ())?;
                merge(&mut tallies.lock().unwrap_or_else(PoisonError::into_inner), of_tile);
                Ok(raster.metres)
            };
            water.take(&gather(band, &tiles, self.is_parallel(), load, &|_| ())?);
            let tallies = tallies.lock().unwrap_or_else(PoisonError::into_inner);
            if tallies.len() == self.layer.count() && !tallies.values().any(|tally| tally.grain.may_have()) {
                return Ok(None);
            }
            from += height;
            progress(from as f64 / rows as f64);
        }
        // What was read of files that changed meanwhile is of neither state.
        self.layer.check()?;
        let steps = self.steps_of(&tallies.into_inner().unwrap_or_else(PoisonError::into_inner));
        Ok(steps.map(|steps| Smoothing { steps, water: water.finish() }))
    }

    fn steps_of(&self, tallies: &Tallies) -> Option<Steps> {
        let tallied = self.layer.tallied(tallies);
        Steps::of(self.layer.count(), tallies.keys().copied().zip(&tallied))
    }

    /// All samples, counted as windows are.
    fn whole(&self) -> Window {
        Window { first: [0, 0], ..self.window }
    }

    /// Where a window lies in the layer.
    fn in_layer(&self, window: Window) -> Window {
        Window { first: [0, 1].map(|i| self.window.first[i] + window.first[i]), ..window }
    }

    /// The error for files without any elevation among `samples`; a unit that would make elevations of their numbers is
    /// named.
    pub(super) fn void(&self, samples: u64) -> Error {
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
        let (raster, tallies) = self.layer.read(self.in_layer(window), &|_| ())?;
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
