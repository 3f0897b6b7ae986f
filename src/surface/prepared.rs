//! What takes a look at every sample of a DEM that stays in its file, kept on disk beside truths. A second view of the same
//! file starts from it.
//!
//! Two artefacts: `heights`, what the samples say (survey, overviews), of the DEM without exaggeration, which is multiplied in
//! when they are used; and `bounds`, the pyramid of the surface as it is drawn. Heights times a factor are the heights of
//! the exaggerated DEM bit for bit. Bounds are not: patches bend with the normals of their corners, and those do not turn in
//! proportion. Bounds derived from plain ones are looser, so that other facets are drawn than of a held DEM.
//!
//! Where both are missing one look at the samples makes both. Locks are taken in one order, bounds before heights: who wants
//! the same waits for both, who wants another exaggeration for the heights alone, and then looks for its bounds. Each is
//! noticed when it is damaged, and made anew by itself. Cost: with an exaggeration, samples that both need are read twice from
//! the file in that one look.

mod bounds;
mod heights;

use std::cell::RefCell;

use super::limits::Limits;
use super::{Pyramid, Surface};
use crate::cache::{Cache, CacheKey, CacheObserver, NewEntry};
use crate::dem::Dem;
use crate::error::{Message, Result};

use heights::{Heights, HeightsBuilder};

/// Either of them in messages: which one it is helps nobody.
const WORDS: [&str; 2] = ["what was made of the DEM", "what was kept of the DEM"];

/// A surface with what is to be found or made of it.
struct SurfaceWork<'a> {
    cache: &'a Cache,
    surface: &'a Surface,
    /// Its samples without exaggeration, where that is not 1.
    plain: Option<&'a Dem>,
    bounds: CacheKey,
    heights: CacheKey,
    warn: &'a dyn Fn(&Message),
}

impl Cache {
    /// Gives a surface over a DEM in its file what is kept of it, or makes and keeps it: of 400 million samples a minute
    /// against a tenth of a second. Other DEMs need nothing. `warn` hears of a damaged file and of a folder that cannot be
    /// written, `progress` the share done, by this process or by another that is making the same.
    ///
    /// # Errors
    /// As [`Dem::survey`] and [`Pyramid::new`]; where a file of the DEM changed meanwhile, as [`Dem::check`].
    pub fn prepare(&self, surface: &Surface, warn: &dyn Fn(&Message), progress: &dyn Fn(f64)) -> Result<()> {
        let dem = surface.dem();
        let Some(stamp) = self.folder().and_then(|_| dem.stamp()) else { return Ok(()) };
        let plain = dem.plain();
        let exaggeration = plain.as_ref().map_or(1.0, |(_, exaggeration)| *exaggeration);
        let work = SurfaceWork {
            cache: self,
            surface,
            plain: plain.as_ref().map(|(plain, _)| plain),
            bounds: bounds::key(dem, stamp, exaggeration, surface.limits()),
            heights: heights::key(dem, stamp),
            warn,
        };
        // Neither makes room for the other.
        let _in_use = [&work.bounds, &work.heights].map(|key| self.hold(key));
        let (pyramid, heights) = work.done(progress)?;
        heights.give(dem);
        surface.remember(pyramid);
        Ok(())
    }

    /// Whether all that is kept of a DEM in its file, without exaggeration, is there.
    pub fn keeps(&self, dem: &Dem) -> bool {
        let keys =
            dem.stamp().map(|stamp| [bounds::key(dem, stamp, 1.0, &Limits::default()), heights::key(dem, stamp)]);
        keys.is_some_and(|keys| keys.iter().all(|key| self.hold(key).is_some()))
    }

    /// Removes the heights of a DEM whose overviews turned out damaged, so that they are made anew next time. Nothing is wrong
    /// with what was drawn: it took the samples themselves. `warn` hears of it.
    pub fn discard_damaged(&self, dem: &Dem, warn: &dyn Fn(&Message)) {
        let stamp = self.folder().and_then(|_| dem.stamp());
        if let Some(stamp) = stamp.filter(|_| dem.has_damaged_overviews()) {
            warn(&format!("{} is damaged: it is made anew next time", WORDS[1]).into());
            self.remove(&heights::key(dem, stamp));
        }
    }
}

impl SurfaceWork<'_> {
    /// Both, found or made.
    fn done(&self, progress: &dyn Fn(f64)) -> Result<(Pyramid, Heights)> {
        let found = RefCell::new(None);
        let make = |sheet: Option<NewEntry>, progress: &dyn Fn(f64)| {
            let (pyramid, heights) = self.with_heights(sheet, progress)?;
            found.replace(Some(heights));
            Ok(pyramid)
        };
        let hearing = CacheObserver { warn: self.warn, progress };
        let pyramid = self.cache.get(&self.bounds, hearing, |kept| bounds::recall(self.surface.dem(), kept), make)?;
        let heights = match found.into_inner() {
            Some(heights) => heights,
            None => self.heights(hearing, |sheet, progress| heights::make(self.plain(), sheet, self.warn, progress))?,
        };
        Ok((pyramid, heights))
    }

    /// The bounds, made and kept in a sheet, and the heights, found or made in the same look.
    fn with_heights(&self, sheet: Option<NewEntry>, progress: &dyn Fn(f64)) -> Result<(Pyramid, Heights)> {
        // That nothing can be kept was told when there was no sheet.
        let warn = if sheet.is_some() { self.warn } else { &|_: &Message| () };
        let mut made = None;
        let heights = self.heights(CacheObserver { warn, progress }, |sheet, progress| {
            let (pyramid, heights) = self.in_one_look(sheet, warn, progress)?;
            made = Some(pyramid);
            Ok(heights)
        })?;
        let pyramid = match made {
            Some(pyramid) => pyramid,
            None => bounds::make(self.surface, progress, |_, _| Ok(()))?,
        };
        bounds::keep(&pyramid, sheet, warn);
        Ok((pyramid, heights))
    }

    fn in_one_look(
        &self,
        sheet: Option<NewEntry>,
        warn: &dyn Fn(&Message),
        progress: &dyn Fn(f64),
    ) -> Result<(Pyramid, Heights)> {
        let mut heights = HeightsBuilder::new(self.plain(), sheet);
        let pyramid = bounds::make(self.surface, progress, |samples, rows| {
            match self.plain {
                None => heights.take(samples, rows),
                Some(plain) => {
                    let size = [plain.columns(), rows.len() + 1];
                    heights.take(&plain.window([0, rows.start], size)?, rows);
                }
            }
            Ok(())
        })?;
        Ok((pyramid, heights.finish(warn)?))
    }

    /// The heights, found or made so.
    fn heights(
        &self,
        hearing: CacheObserver<'_>,
        make: impl FnOnce(Option<NewEntry>, &dyn Fn(f64)) -> Result<Heights>,
    ) -> Result<Heights> {
        self.cache.get(&self.heights, hearing, |kept| heights::recall(self.plain(), kept), make)
    }

    /// The DEM without exaggeration.
    fn plain(&self) -> &Dem {
        self.plain.unwrap_or(self.surface.dem())
    }
}
