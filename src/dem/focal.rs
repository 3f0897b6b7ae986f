//! Heights that depend on those around them: tiles of a grid, changed by what works on a window with a halo.
//!
//! Cost: a tile is read with its halo, so tiles are squares of their own, whatever those of the grid are; the grid's own are
//! kept while they fit, so that none is read anew for each halo it lies in. What comes of the work may be kept on disk
//! (`stored`), all of it once, and is read from there ever after; then neighbours are read together, for the grid's own
//! tiles may be as wide as it is. Memory: as much as the budget, but one tile at work and what is read for some at least.

use std::fmt::Debug;
use std::sync::Arc;

use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_128;

use super::filed::Filed;
use super::places::Places;
use super::stored::{Found, Stored, bytes_of, key};
use super::tiles::Tiles;
use super::tiling::{Tiling, copy};
use super::window::Window;
use crate::cache::{Cache, CacheObserver, NewEntry};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Side of a tile in halos: then no more than 2 1/4 samples are worked on for one.
const HALOS: usize = 4;
/// Shortest side of a tile, samples.
const SIDE: usize = 512;
/// Bytes a sample at work.
const WORK_BYTES: usize = 24;
/// Bytes of samples that may be read together whatever the budget.
const TOGETHER: usize = 16 << 20;

/// Work on heights that looks at those around.
///
/// A height must come out the same, bit for bit, whatever window is worked on, with the halo around it: fewer samples only
/// at the grid's own edge.
pub(crate) trait Focal: Debug + Send + Sync {
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
pub(crate) struct Worked<F> {
    of: Filed,
    by: F,
    tiling: Tiling,
    places: Places,
    stored: Option<Stored>,
}

impl<F: Focal> Worked<F> {
    /// All of `tiles`; half of `budget` bytes is for the tiles at work, a quarter for what is read of the grid and kept.
    pub(crate) fn new(tiles: Arc<dyn Tiles>, by: F, budget: usize) -> Self {
        let side = (HALOS * by.halo()).max(SIDE);
        let tiling = Tiling::whole([side; 2], tiles.size());
        let places = Places::new(budget / 2 / (WORK_BYTES * (side + 2 * by.halo()).pow(2)));
        Self { of: Filed::new(tiles, 1.0, budget / 2), by, tiling, places, stored: None }
    }

    /// What is wrong with keeping what comes of the work in the cache, where that has no room for it: then the work is done
    /// whenever heights are read.
    pub(crate) fn too_large_for(&self, cache: &Cache) -> Option<Message> {
        let bytes = bytes_of(&[self.whole()]);
        let needed =
            format!("smoothed heights are worked out anew in each run: they take {} MiB, ", bytes.div_ceil(1 << 20));
        (cache.folder().is_some() && bytes > cache.size())
            .then(|| message![needed, "more than ", Setting::CacheSize, " allows"])
    }

    /// The same, with what comes of the work found in the cache, or made and kept there; `of`: what it is made of, for people.
    /// Without a folder, or room in it, nothing is made yet. `progress` hears the share done.
    ///
    /// # Errors
    /// Those of reading the tiles, and of the work.
    pub(crate) fn kept_in(self, cache: &Cache, of: String, progress: &dyn Fn(f64)) -> Result<Self> {
        let folder = cache.folder().filter(|_| self.too_large_for(cache).is_none());
        let Some(stamp) = folder.and_then(|_| self.stamp()) else { return Ok(self) };
        let tiles = self.tiling().tiles(self.whole());
        // What is damaged is made anew; where nothing can be kept, those who keep more tell so.
        let hearing = CacheObserver { warn: &|_| (), progress };
        let stored = cache.get(
            &key(stamp, of),
            hearing,
            |kept| Stored::recall(kept, &tiles).map(Some),
            |sheet, progress| sheet.map_or(Ok(None), |sheet| self.make(sheet, &tiles, progress)),
        )?;
        Ok(Self { stored, ..self })
    }

    /// All of it.
    fn whole(&self) -> Window {
        Window { first: [0, 0], size: self.size() }
    }

    /// Works on all `tiles` and keeps what comes of it; `None` where it cannot be kept.
    fn make(&self, mut sheet: NewEntry, tiles: &[Window], progress: &dyn Fn(f64)) -> Result<Option<Stored>> {
        let mut hashes = Vec::with_capacity(tiles.len());
        for run in self.runs(tiles) {
            let width = run.iter().map(|tile| tile.size[0]).sum();
            let around =
                Window { first: run[0].first, size: [width, run[0].size[1]] }.with_halo(self.by.halo(), self.size());
            // Several threads read into several tiles of the grid, which take memory too.
            let read = match self.places.are_short() {
                true => self.of.read_alone(around)?,
                false => self.of.read(around, &|_| ())?,
            };
            for batch in run.chunks(self.places.together()) {
                let work = |tile: &Window| self.work(*tile, |onto| Ok(part(around, &read, onto)));
                let made: Vec<_> = batch.par_iter().map(work).collect::<Result<_>>()?;
                hashes.extend(made.iter().map(|heights| Stored::write(&mut sheet, heights)));
                progress(hashes.len() as f64 / tiles.len() as f64);
            }
        }
        // What was read of files that changed meanwhile is of neither state.
        self.check()?;
        let found = Found { marks: self.of.tiles().marks(), assumed: self.of.tiles().assumed() };
        Ok(Stored::finish(sheet, hashes, tiles, found))
    }

    /// What was found of the samples where all of them are kept: they are not read then.
    fn found(&self) -> Option<&Found> {
        self.stored.as_ref().map(Stored::found)
    }

    /// `tiles`, row by row of them, those together for which the grid is read at once.
    fn runs<'a>(&self, tiles: &'a [Window]) -> impl Iterator<Item = &'a [Window]> {
        let (side, halo) = (self.tiling.size[1], self.by.halo());
        let columns = (self.of.budget() / 2).max(TOGETHER) / (size_of::<f32>() * (side + 2 * halo));
        let most = (columns.saturating_sub(2 * halo) / side).max(1);
        tiles.chunk_by(|a, b| a.first[1] == b.first[1]).flat_map(move |row| row.chunks(most))
    }

    /// The heights of a tile after the work; `read` gives those of a window before. Waits while too many are at work.
    fn work(&self, tile: Window, read: impl FnOnce(Window) -> Result<Vec<f32>>) -> Result<Vec<f32>> {
        let _place = self.places.take();
        let around = tile.with_halo(self.by.halo(), self.size());
        let mut heights = read(around)?;
        self.by.apply(&mut heights, around)?;
        Ok(part(around, &heights, tile))
    }
}

impl<F: Focal> Tiles for Worked<F> {
    fn size(&self) -> [usize; 2] {
        self.of.tiles().size()
    }

    fn tiling(&self) -> Tiling {
        self.tiling
    }

    fn is_parallel(&self) -> bool {
        self.of.is_parallel()
    }

    fn read(&self, window: Window) -> Result<Vec<f32>> {
        let stored = self.stored.as_ref().and_then(|stored| stored.read(window));
        stored.map_or_else(|| self.work(window, |around| self.of.read_alone(around)), Ok)
    }

    fn stamp(&self) -> Option<u128> {
        let of = self.of.tiles().stamp()?;
        Some(xxh3_128(bytemuck::bytes_of(&[of, self.by.stamp()])))
    }

    fn check(&self) -> Result<()> {
        self.of.check()
    }

    fn marks(&self) -> usize {
        self.found().map_or_else(|| self.of.tiles().marks(), |found| found.marks)
    }

    fn assumed(&self) -> Vec<Message> {
        self.found().map_or_else(|| self.of.tiles().assumed(), |found| found.assumed.clone())
    }

    fn all_void(&self) -> Error {
        self.of.tiles().all_void()
    }
}

/// The samples of a part of a window.
fn part(of: Window, samples: &[f32], part: Window) -> Vec<f32> {
    let mut inside = vec![f32::NAN; part.samples() as usize];
    copy(of, samples, part, &mut inside);
    inside
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

    use super::*;

    const SIZE: [usize; 2] = [6000, 1100];

    /// A file in strips as wide as it is, which counts what is read of it.
    #[derive(Debug, Default)]
    struct Strips {
        read: AtomicU64,
    }

    impl Tiles for Strips {
        fn size(&self) -> [usize; 2] {
            SIZE
        }

        fn tiling(&self) -> Tiling {
            Tiling::of([SIZE[0], 1], [0; 2], SIZE)
        }

        fn is_parallel(&self) -> bool {
            true
        }

        fn read(&self, window: Window) -> Result<Vec<f32>> {
            self.read.fetch_add(window.samples(), Ordering::Relaxed);
            Ok((0..window.samples()).map(|i| (i % 1000) as f32).collect())
        }

        fn stamp(&self) -> Option<u128> {
            Some(1)
        }

        fn check(&self) -> Result<()> {
            Ok(())
        }

        fn marks(&self) -> usize {
            0
        }

        fn assumed(&self) -> Vec<Message> {
            Vec::new()
        }

        fn all_void(&self) -> Error {
            Error::limit("nothing", "nothing")
        }
    }

    /// Work that adds one, and counts how many work at once.
    #[derive(Debug, Default)]
    struct More {
        at_work: AtomicUsize,
        most: Arc<AtomicUsize>,
    }

    impl Focal for More {
        fn halo(&self) -> usize {
            10
        }

        fn apply(&self, heights: &mut [f32], _: Window) -> Result<()> {
            let at_work = self.at_work.fetch_add(1, Ordering::SeqCst) + 1;
            self.most.fetch_max(at_work, Ordering::SeqCst);
            heights.iter_mut().for_each(|height| *height += 1.0);
            self.at_work.fetch_sub(1, Ordering::SeqCst);
            Ok(())
        }

        fn stamp(&self) -> u128 {
            2
        }
    }

    #[test]
    fn strips_are_worked_on_in_squares_and_read_about_once() {
        let dir = tempfile::tempdir().expect("a folder");
        let cache = Cache::in_folder(dir.path().to_owned());
        let (strips, by) = (Arc::new(Strips::default()), More::default());
        let most = by.most.clone();
        // Fewer bytes than any tile takes.
        let worked = Worked::new(strips.clone(), by, 1 << 10);
        assert_eq!(worked.tiling().size, [SIDE; 2]);
        let worked = worked.kept_in(&cache, String::new(), &|_| ()).expect("heights");
        let [read, all] = [strips.read.load(Ordering::Relaxed), SIZE.iter().product::<usize>() as u64];
        assert!((all..all * 5 / 4).contains(&read), "{read} samples read of {all}");
        assert_eq!(most.load(Ordering::SeqCst), 1, "tiles at work at once");
        let tile = worked.tiling().tile([2000, 600]);
        let before = strips.read.load(Ordering::Relaxed);
        assert!(
            worked.stored.is_some() && worked.read(tile).is_ok_and(|heights| heights.len() as u64 == tile.samples())
        );
        assert_eq!(strips.read.load(Ordering::Relaxed), before, "read from the files again");
    }
}
