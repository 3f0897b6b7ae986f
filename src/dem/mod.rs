//! The elevation grid: what every later stage reads. It knows files and systems of coordinates by traits alone:
//! [`Tiles`] and [`Transform`], which [`geo`](crate::geo) has for whatever GDAL opens.

mod bands;
pub(crate) mod filed;
pub(crate) mod focal;
pub mod fractal;
pub(crate) mod generalise;
mod georeference;
pub(crate) mod held;
mod history;
pub(crate) mod in_bands;
mod north;
mod overviews;
mod places;
mod samples;
pub(crate) mod scale;
pub(crate) mod smoothest;
mod stored;
mod survey;
mod systems;
mod tiles;
pub(crate) mod tiling;
pub(crate) mod validity;
pub(crate) mod water;
mod whereabouts;
mod window;

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};

use crate::error::{Error, Result};
use filed::Filed;

pub(crate) use bands::Band;
pub use georeference::Georeference;
pub(crate) use held::{LARGEST_SIDE, MAX_SAMPLES, held_bytes, mebibytes, not_held};
pub(crate) use history::FileSamples;
pub use history::History;
pub(crate) use north::convergence_in_words;
pub use north::{Bearings, North};
pub(crate) use overviews::{OverviewBuilder, OverviewEntry, Overviews};
pub(crate) use samples::Samples;
pub(crate) use survey::{Survey, SurveyBuilder};
pub use systems::{Crs, Transform, Unit};
pub use tiles::Tiles;
pub use tiling::Tiling;
pub(crate) use validity::{BLOCK_SIDE, Validity};
pub(crate) use whereabouts::Whereabouts;
pub use window::Window;

/// A north-up grid of elevations in metres.
///
/// Sample (c, r) counts columns east and rows south from the north-west corner. Heights are in metres and already
/// multiplied by the exaggeration. A void has no height: 0, where one must be given.
///
/// The samples are *held* in memory, or *filed*: they stay in their files and are read as they are asked for. Reading may
/// fail at any time, and what gives a `Result` says so. What gives none takes a sample that cannot be read for a void and
/// keeps the error: whoever relied on it asks [`Dem::check`] before showing anything.
#[derive(Debug, Clone)]
pub struct Dem {
    columns: usize,
    rows: usize,
    cell: DVec2,
    origin: DVec2,
    store: Store,
    survey: OnceLock<Survey>,
    georeference: Georeference,
    history: History,
    /// What it was read from, for people.
    label: String,
}

#[derive(Debug, Clone)]
enum Store {
    /// All samples, or those of a part.
    Held(Samples),
    Filed(Arc<Filed>),
}

impl Dem {
    /// A grid of `columns` x (heights.len() / columns) samples, held. `cell`: metres between columns and rows, both
    /// positive. `origin`: easting and northing of sample (0, 0), metres. A height that is not finite becomes a void.
    ///
    /// # Panics
    /// When `heights` is no whole number of rows, or there are fewer than 2 x 2 samples.
    pub fn from_heights(columns: usize, cell: DVec2, origin: DVec2, heights: Vec<f32>) -> Self {
        assert!(columns >= 2 && heights.len() >= 2 * columns && heights.len().is_multiple_of(columns));
        let size = [columns, heights.len() / columns];
        let samples = Samples::new(Window { first: [0, 0], size }, heights);
        Self::new(size, cell, origin, Store::Held(samples))
    }

    /// A grid of the samples of `tiles`, filed: they are read as they are asked for. `cell` and `origin` as those of
    /// [`Self::from_heights`]; `exaggeration` is a factor on every height. Half of `budget` bytes keep what was read last.
    ///
    /// # Panics
    /// When there are fewer than 2 x 2 samples.
    pub fn from_tiles(tiles: Arc<dyn Tiles>, cell: DVec2, origin: DVec2, exaggeration: f64, budget: usize) -> Self {
        let size = tiles.size();
        assert!(size.iter().all(|side| *side >= 2));
        Self::new(size, cell, origin, Store::Filed(Arc::new(Filed::new(tiles, exaggeration, budget))))
    }

    fn new([columns, rows]: [usize; 2], cell: DVec2, origin: DVec2, store: Store) -> Self {
        let (georeference, history) = (Georeference::unknown(), History::default());
        Self {
            columns,
            rows,
            cell,
            origin,
            store,
            survey: OnceLock::new(),
            georeference,
            history,
            label: String::new(),
        }
    }

    /// The same, read from this, in words for people.
    pub(crate) fn with_label(self, label: String) -> Self {
        Self { label, ..self }
    }

    /// What it was read from, as the user named it; empty for a DEM that was not.
    pub fn label(&self) -> String {
        self.label.clone()
    }

    /// Samples from west to east, at least 2.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Samples from north to south, at least 2.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Metres between neighbouring columns (x) and rows (y), both positive.
    pub fn cell(&self) -> DVec2 {
        self.cell
    }

    /// Where it lies on Earth.
    pub fn georeference(&self) -> &Georeference {
        &self.georeference
    }

    /// What was done to the files' samples, and what was assumed of them.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The error of those who need all samples in memory.
    pub(crate) fn not_held(&self) -> Error {
        held::not_held([self.columns, self.rows])
    }

    /// The samples of a window of `size` columns and rows, cut to the DEM.
    ///
    /// # Errors
    /// [`Error::Input`] when they cannot be read.
    pub fn window(&self, first: [usize; 2], size: [usize; 2]) -> Result<Samples> {
        let whole = [self.columns, self.rows];
        let first = [0, 1].map(|i| first[i].min(whole[i]));
        let window = Window { first, size: [0, 1].map(|i| size[i].min(whole[i] - first[i])) };
        let heights = match &self.store {
            Store::Held(samples) => samples.part(window),
            Store::Filed(filed) => filed.read(window, &|_| ())?,
        };
        Ok(Samples::new(window, heights))
    }

    /// The same DEM with these samples of it in memory and all others void.
    pub(crate) fn with_samples(&self, samples: Samples) -> Self {
        let (georeference, history) = (self.georeference.clone(), self.history.clone());
        Self {
            georeference,
            history,
            ..Self::new([self.columns, self.rows], self.cell, self.origin, Store::Held(samples))
        }
    }

    /// Exaggerated metres of sample (c, r), `None` at a void, outside, and where it cannot be read: see [`Self::check`].
    pub fn height(&self, c: usize, r: usize) -> Option<f32> {
        match &self.store {
            Store::Held(samples) => samples.height(c, r),
            Store::Filed(filed) if c < self.columns && r < self.rows => {
                self.kept(filed.height([c, r])).filter(|height| height.is_finite())
            }
            Store::Filed(_) => None,
        }
    }

    /// What was read, or nothing: then the error is kept for [`Self::check`].
    pub(crate) fn kept<T>(&self, read: Result<T>) -> Option<T> {
        match (read, &self.store) {
            (Ok(read), _) => Some(read),
            (Err(error), Store::Filed(filed)) => {
                filed.fail(error);
                None
            }
            (Err(_), Store::Held(_)) => None,
        }
    }

    /// The same DEM of land whose heights were exaggerated by this factor, without it: of a held one to the last bit but one.
    pub(crate) fn lowered(&self, exaggeration: f64) -> Self {
        match &self.store {
            Store::Filed(_) => self.plain().map_or_else(|| self.clone(), |(plain, _)| plain),
            Store::Held(samples) => {
                let lower =
                    |height: Option<f32>| height.map_or(f32::NAN, |height| (f64::from(height) / exaggeration) as f32);
                let rows = (0..self.rows).flat_map(|r| samples.row_from(0, r).map(lower)).collect();
                let whole = Window { first: [0, 0], size: [self.columns, self.rows] };
                self.with_samples(Samples::new(whole, rows))
            }
        }
    }

    /// World position of sample (c, r): easting, northing, exaggerated height, metres. Height 0 where there is none.
    pub fn position(&self, c: usize, r: usize) -> DVec3 {
        let xy = self.origin + DVec2::new(c as f64, -(r as f64)) * self.cell;
        xy.extend(f64::from(self.height(c, r).unwrap_or(0.0)))
    }

    /// West, south, east and north of the outermost samples, metres.
    pub fn extent(&self) -> [f64; 4] {
        let far = self.origin + DVec2::new((self.columns - 1) as f64, -((self.rows - 1) as f64)) * self.cell;
        [self.origin.x, far.y, far.x, self.origin.y]
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Dem {
    /// The same grid with where it lies on Earth and how it came about.
    pub fn with_source(self, georeference: Georeference, history: History) -> Self {
        Self { georeference, history, ..self }
    }

    /// All samples, which a held DEM has in memory.
    ///
    /// # Errors
    /// [`Error::Limit`] for a filed DEM.
    pub fn held(&self) -> Result<&Samples> {
        match &self.store {
            Store::Held(samples) => Ok(samples),
            Store::Filed(_) => Err(self.not_held()),
        }
    }

    /// Whether the samples stay in their files.
    pub fn is_filed(&self) -> bool {
        matches!(self.store, Store::Filed(_))
    }

    /// Whether several threads gain by reading samples at once: not where they come from a file that one thread must read.
    pub fn is_parallel(&self) -> bool {
        match &self.store {
            Store::Held(_) => true,
            Store::Filed(filed) => filed.is_parallel(),
        }
    }

    /// The first error of those who gave a void in the place of a sample, and whether the files are still those that
    /// were opened: where they are not, what was read of them may not belong together.
    ///
    /// # Errors
    /// [`Error::Input`]; the first of samples that could not be read is kept.
    pub fn check(&self) -> Result<()> {
        match &self.store {
            Store::Held(_) => Ok(()),
            Store::Filed(filed) => filed.check(),
        }
    }

    /// A stamp of a filed DEM: as long as it stays the same, so do the samples but for their exaggeration, as far as names,
    /// sizes, times and both ends of all its files and the way of reading them tell. `None` for held DEMs and for files that
    /// are not on the disk.
    pub fn stamp(&self) -> Option<u128> {
        match &self.store {
            Store::Held(_) => None,
            Store::Filed(filed) => filed.stamp(),
        }
    }

    /// How many samples were read from the files of a filed DEM so far, each as often as it was; 0 for a held one.
    pub fn samples_read(&self) -> u64 {
        match &self.store {
            Store::Held(_) => 0,
            Store::Filed(filed) => filed.samples_read(),
        }
    }

    /// The same samples of a filed DEM without exaggeration, and the factor that they lack; `None` for a held DEM, and where
    /// that is 1.
    pub fn plain(&self) -> Option<(Self, f64)> {
        let Store::Filed(filed) = &self.store else { return None };
        let (georeference, history) = (self.georeference.clone(), self.history.clone());
        let store = Store::Filed(Arc::new(filed.plain()));
        let plain = Self::new([self.columns, self.rows], self.cell, self.origin, store);
        let plain = plain.with_source(georeference, history).with_label(self.label());
        (filed.exaggeration() != 1.0).then(|| (plain, filed.exaggeration()))
    }

    /// Column and row, fractional, of a world place in metres; outside the grid they run on.
    pub fn grid_place(&self, place: DVec2) -> DVec2 {
        (place - self.origin) * DVec2::new(1.0, -1.0) / self.cell
    }
}
