//! The elevation grid: what every later stage reads. GDAL is known in this folder alone.

mod crs;
mod elevation;
mod formats;
mod georeference;
mod grid;
mod history;
pub mod info;
mod inscribed;
mod mosaic;
mod name;
mod raster;
pub mod read;
mod source;
mod target;
mod vrt;
mod xml;

use glam::{DVec2, DVec3};

pub use crs::Crs;
pub use elevation::ElevationUnit;
pub use georeference::Georeference;
pub use history::History;
pub use info::{Info, info};
pub use read::{ReadOptions, Stage, read, read_all};
pub use target::MAX_SAMPLES;

/// A north-up grid of elevations in metres.
///
/// Sample (c, r) counts columns east and rows south from the north-west corner; `heights` is row-major. Heights are
/// in metres and already multiplied by the exaggeration. Where `valid` is false the height is 0 and must not be used.
#[derive(Debug, Clone)]
pub struct Dem {
    columns: usize,
    rows: usize,
    cell: DVec2,
    origin: DVec2,
    heights: Vec<f32>,
    valid: Vec<bool>,
    georeference: Georeference,
    history: History,
}

impl Dem {
    /// A grid of `columns` x (heights.len() / columns) samples. `cell`: metres between columns and rows, both positive.
    /// `origin`: easting and northing of sample (0, 0), metres. A height that is not finite becomes a void.
    ///
    /// # Panics
    /// When `heights` is no whole number of rows, or there are fewer than 2 x 2 samples.
    pub fn from_heights(columns: usize, cell: DVec2, origin: DVec2, mut heights: Vec<f32>) -> Self {
        assert!(columns >= 2 && heights.len() >= 2 * columns && heights.len().is_multiple_of(columns));
        let valid = heights.iter().map(|h| h.is_finite()).collect();
        heights.iter_mut().filter(|h| !h.is_finite()).for_each(|h| *h = 0.0);
        let rows = heights.len() / columns;
        let georeference = Georeference::unknown();
        Self { columns, rows, cell, origin, heights, valid, georeference, history: History::default() }
    }

    /// The same grid with where it lies on Earth and how it came about.
    fn with_source(self, georeference: Georeference, history: History) -> Self {
        Self { georeference, history, ..self }
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

    /// Exaggerated metres, row-major from the north-west; 0 at voids.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Whether each sample holds an elevation, in the order of `heights`.
    pub fn valid(&self) -> &[bool] {
        &self.valid
    }

    /// Exaggerated metres of sample (c, r), `None` at a void.
    pub fn height(&self, c: usize, r: usize) -> Option<f32> {
        let i = r * self.columns + c;
        self.valid[i].then(|| self.heights[i])
    }

    /// World position of sample (c, r): easting, northing, exaggerated height, metres. Height 0 at a void.
    pub fn position(&self, c: usize, r: usize) -> DVec3 {
        let xy = self.origin + DVec2::new(c as f64, -(r as f64)) * self.cell;
        xy.extend(f64::from(self.heights[r * self.columns + c]))
    }

    /// Column and row, fractional, of a world place in metres; outside the grid they run on.
    pub fn grid_place(&self, place: DVec2) -> DVec2 {
        (place - self.origin) * DVec2::new(1.0, -1.0) / self.cell
    }

    /// West, south, east and north of the outermost samples, metres.
    pub fn extent(&self) -> [f64; 4] {
        let far = self.origin + DVec2::new((self.columns - 1) as f64, -((self.rows - 1) as f64)) * self.cell;
        [self.origin.x, far.y, far.x, self.origin.y]
    }

    /// Lowest and highest valid height in exaggerated metres, `None` when all is void.
    pub fn range(&self) -> Option<[f32; 2]> {
        let valid = self.heights.iter().zip(&self.valid).filter(|(_, v)| **v).map(|(h, _)| *h);
        valid.fold(None, |range: Option<[f32; 2]>, h| {
            Some(range.map_or([h, h], |[low, high]| [low.min(h), high.max(h)]))
        })
    }

    /// How many samples are void.
    pub fn voids(&self) -> usize {
        self.valid.iter().filter(|v| !**v).count()
    }
}
