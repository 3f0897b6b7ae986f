//! Rasters whose samples fall on one grid: that of the first, run on over the others.
//!
//! Each file's numbers become metres by its own rules, voids marked, before anything is laid over anything: a tile in
//! feet may stand beside one in metres, and a void covers nothing. Of files that overlap the last wins. Samples are
//! copied. Only what a window needs is read, on the thread that asks; several may ask at once. Not handled: files on
//! other grids, which are [`Layers`](super::layers::Layers) of their own.

use std::path::Path;

use gdal::raster::{GdalType, RasterBand};
use glam::DVec2;
use xxhash_rust::xxh3::Xxh3;

use super::assumed::Tallied;
use super::crs::CrsPath;
use super::elevation::{Elevation, Reading};
use super::grid::{GeoGrid, span};
use super::ground::upright;
use super::handles::{Handles, Opening};
use super::lie::Lie;
use super::raster::Raster;
use super::said;
use super::source::{Source, heard};
use super::tally::{Tallies, Tally};
use crate::dem::{Crs, History, Tiling, Window};
use crate::error::{Result, shown};
use crate::geo::{Encoding, ReadOptions};

/// Samples read at once: 8 MiB of f64.
const BLOCK_SAMPLES: usize = 1 << 20;
/// Formats whose blocks are unpacked one by one and cost time: there, threads gain by reading at once. Others are read
/// as fast by one thread, or only in the order in which they are written.
const PARALLEL: [&str; 3] = ["GTiff", "COG", "VRT"];
/// Columns and rows of a float file that tell whether its numbers are multiples of a step at all.
const FIRST_SAMPLES: [usize; 2] = [512, 16];
/// Samples around a window that cubic convolution reaches, and one more.
const MARGIN: usize = 3;

/// Files on one grid.
pub(super) struct FileLayer {
    /// North-up wherever that takes no resampling.
    pub grid: GeoGrid,
    /// Side of a square as large as a cell, metres on the ground.
    pub cell: f64,
    /// The format of the first file, in GDAL's words.
    pub format: String,
    /// Whether it is all that there is of more than one file, or stands among other layers: messages name files then.
    several: bool,
    numbers: Vec<usize>,
    sources: Vec<Placed>,
}

/// A file and where it lies in the layer.
pub(super) struct Placed {
    handles: Handles,
    elevation: Elevation,
    /// Its own grid.
    pub grid: GeoGrid,
    /// First column and row in the layer.
    first: [i64; 2],
    /// Whether rows and columns are read backwards.
    flip: [bool; 2],
    /// Columns and rows of the blocks in which the file stores its samples.
    stored: [usize; 2],
    /// Whether several threads gain by reading it at once.
    parallel: bool,
    /// The format in GDAL's words.
    format: String,
}

impl FileLayer {
    /// Of `files`, at least one, each with its lie to the first's grid, north up, and their numbers among all that are named.
    /// `several`: whether messages name them.
    pub(super) fn of(files: Vec<(Placed, Lie)>, numbers: Vec<usize>, cell: f64, several: bool) -> Option<Self> {
        let (first, _) = files.first()?;
        let (base, format) = (first.grid.north_up(), first.format.clone());
        let lies = files.iter().map(|(placed, lie)| lie.bounds(&placed.grid));
        let (low, end) = lies.fold(([0; 2], [0; 2]), |(low, end), (first, last)| {
            ([0, 1].map(|i| first[i].min(low[i])), [0, 1].map(|i| last[i].max(end[i])))
        });
        let sources = files.into_iter().map(|(placed, lie)| placed.at(lie, low)).collect();
        let to_crs = base.to_crs * glam::DAffine2::from_translation(DVec2::new(low[0] as f64, low[1] as f64));
        let [columns, rows] = [0, 1].map(|i| (end[i] - low[i]) as usize);
        Some(Self { grid: GeoGrid { to_crs, columns, rows, ..base }, cell, format, several, numbers, sources })
    }

    /// The first file, for messages.
    pub(super) fn path(&self) -> &Path {
        self.sources[0].handles.path()
    }

    /// Whether several threads gain by reading at once.
    pub(super) fn is_parallel(&self) -> bool {
        self.sources.iter().all(|placed| placed.parallel)
    }

    /// The tiles in which a window is best read: about those of the first file.
    pub(super) fn tiling(&self, window: Window) -> Tiling {
        let Placed { first, stored, .. } = &self.sources[0];
        Tiling::of(*stored, [0, 1].map(|i| window.first[i] as i64 - first[i]), window.size)
    }

    /// Its files by their names alone, in a few words.
    pub(super) fn name(&self) -> String {
        let path = self.path();
        and_more(&shown(path.file_name().map_or(path, Path::new)), self.numbers.len())
    }

    /// Numbers of its files among all that are named.
    pub(super) fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    /// Every file on the disk that it is made of.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.sources.iter().flat_map(|placed| placed.handles.listed().paths())
    }

    /// The error where one of its files is another than when it was opened: a look at each, none inside.
    pub(super) fn check(&self) -> Result<()> {
        self.sources.iter().try_for_each(|placed| placed.handles.check())
    }

    /// Takes what tells one state of the files from any other, and how they are read and laid, into a hash; `None` where a
    /// part is not on the disk.
    pub(super) fn hash(&self, hash: &mut Xxh3) -> Option<()> {
        hash.update(format!("{:?}", self.grid).as_bytes());
        for Placed { handles, elevation, first, flip, grid, .. } in &self.sources {
            hash.update(format!("{elevation:?} {first:?} {flip:?} {grid:?}\n").as_bytes());
            handles.hash(hash)?;
        }
        Some(())
    }

    /// Reads the samples of `window`, with a tally of the files' numbers. `progress` hears the share done.
    pub(super) fn read(&self, window: Window, progress: &dyn Fn(f64)) -> Result<(Raster, Tallies)> {
        let mut raster = Raster::void(self.grid.part(window))?;
        let mut tallies = Tallies::new();
        for (i, placed) in self.sources.iter().enumerate() {
            let share = |done: f64| progress((i as f64 + done) / self.sources.len() as f64);
            let mut tally = Tally::new(&placed.elevation);
            placed.read(window, &mut raster, &mut tally, &share)?;
            if tally.samples > 0 {
                tallies.insert(i, tally);
            }
        }
        progress(1.0);
        Ok((raster, tallies))
    }

    /// Reads the samples of `window` that the file at this place has, as if it were alone.
    pub(super) fn read_of(&self, place: usize, window: Window) -> Result<(Raster, Tally)> {
        let (mut raster, placed) = (Raster::void(self.grid.part(window))?, &self.sources[place]);
        let mut tally = Tally::new(&placed.elevation);
        placed.read(window, &mut raster, &mut tally, &|_| ())?;
        Ok((raster, tally))
    }

    /// Whether the files' numbers may be multiples of a step, by their type and, where that leaves it open, by the first
    /// samples of each in `window`.
    pub(super) fn may_have_steps(&self, window: Window) -> Result<bool> {
        if self.sources.iter().any(|placed| placed.elevation.is_whole()) {
            return Ok(true);
        }
        for place in self.meeting(window) {
            let Window { first, size } = self.shared(place, window);
            let size = [0, 1].map(|i| size[i].min(FIRST_SAMPLES[i]));
            if self.read_of(place, Window { first, size })?.1.grain.may_have() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The places of the files that have samples in `window`, or voids.
    pub(super) fn meeting(&self, window: Window) -> impl Iterator<Item = usize> {
        (0..self.sources.len()).filter(move |place| self.shared(*place, window).samples() > 0)
    }

    /// What the file at this place and `window` share.
    fn shared(&self, place: usize, window: Window) -> Window {
        let placed = &self.sources[place];
        let size = [placed.grid.columns, placed.grid.rows];
        let end = [0, 1].map(|i| (placed.first[i] + size[i] as i64).max(0) as usize);
        let first = [0, 1].map(|i| (placed.first[i].max(0) as usize).max(window.first[i]));
        let end = [0, 1].map(|i| end[i].min(window.first[i] + window.size[i]));
        Window { first, size: [0, 1].map(|i| end[i].saturating_sub(first[i])) }
    }

    /// The files of which numbers are tallied, each with its rules and its tally.
    pub(super) fn tallied<'a>(&'a self, tallies: &'a Tallies) -> Vec<Tallied<'a>> {
        let of = |(i, tally): (&usize, &'a Tally)| {
            let placed = self.sources.get(*i)?;
            Some(Tallied { path: placed.handles.path(), elevation: &placed.elevation, tally })
        };
        tallies.iter().filter_map(of).collect()
    }

    /// How many files it is made of.
    pub(super) fn count(&self) -> usize {
        self.sources.len()
    }

    /// Whether messages name files, for there are several.
    pub(super) fn is_of_several(&self) -> bool {
        self.several
    }

    /// The grid of the first file.
    pub(super) fn first_grid(&self) -> &GeoGrid {
        &self.sources[0].grid
    }
}

impl Placed {
    /// Opens a file and checks all that can be checked without reading samples. `alone`: whether it is the only one. `like`: a system
    /// whose axes are turned to east and north; others of its definition are turned as they are.
    pub(super) fn open(
        path: &Path,
        options: &ReadOptions,
        alone: bool,
        like: Option<&Crs>,
        opening: &mut Opening,
        history: &mut History,
    ) -> Result<Self> {
        let source = Source::open(path, options.band.unwrap_or(1), options.allow_remote)?;
        let source = source.with_chosen_band(options, history)?;
        said::credits(&source.dataset).iter().for_each(|text| history.credit(text));
        if let Some(member) = &source.member {
            history.convert(format!("{member} is taken of the archive, its only raster"));
        }
        let grid = GeoGrid::of(&source, options.cell, alone, history)?;
        history.sample(grid.samples());
        let grid = upright(grid, like, history);
        let (grid, transposed) = grid.transposed().map_or((grid, false), |grid| (grid, true));
        if transposed {
            history.convert("rows are read for columns, north up");
        }
        let elevation = Elevation::of(&source, &grid.crs, options, history)?;
        let (width, height) = source.band()?.block_size();
        let stored = if transposed { [height, width] } else { [width, height] };
        let driver = source.dataset.driver();
        let (parallel, format) = (PARALLEL.contains(&driver.short_name().as_str()), driver.long_name());
        let handles = Handles::new(Source { transposed, ..source }, options.allow_remote, opening);
        let (first, flip) = ([0; 2], [false; 2]);
        Ok(Self { handles, elevation, grid, first, flip, stored, parallel, format })
    }

    /// The file as it was named.
    pub(super) fn path(&self) -> &Path {
        self.handles.path()
    }

    /// The same, lying so to a grid whose first column and row become `low`.
    fn at(self, lie: Lie, low: [i64; 2]) -> Self {
        let flip = if let Lie::Aligned { flip, .. } = lie { flip } else { self.flip };
        let (first, _) = lie.moved(low).bounds(&self.grid);
        Self { first, flip, ..self }
    }

    /// Lays what falls into `window` of the layer over `raster`, which holds just that, and counts it in `tally`.
    fn read(&self, window: Window, raster: &mut Raster, tally: &mut Tally, progress: &dyn Fn(f64)) -> Result<()> {
        let first = [0, 1].map(|i| self.first[i] - window.first[i] as i64);
        let (own, there) = ([self.grid.columns, self.grid.rows], window.size);
        if (0..2).any(|i| first[i] >= there[i] as i64 || first[i] + own[i] as i64 <= 0) {
            // Not even opened: there may be thousands of files.
            return Ok(());
        }
        self.handles.read(|source| self.copy(source, first, raster, tally, progress))
    }

    /// Copies the samples, as metres, to where `raster` has them: the file's first column and row, after flipping, at
    /// `first`. Voids cover nothing.
    fn copy(
        &self,
        source: &Source,
        first: [i64; 2],
        raster: &mut Raster,
        tally: &mut Tally,
        progress: &dyn Fn(f64),
    ) -> Result<()> {
        let band = source.band()?;
        let (mask, words) = heard(|| match band.mask_flags()?.is_per_dataset() {
            true => band.open_mask_band().map(Some),
            // GDAL takes no transparency for a mask that is not of whole numbers.
            false => Ok(source.alpha()),
        });
        // Without it what is masked would pass for land.
        let mask = mask.map_err(|_| source.unreadable(words.as_deref()))?;
        let (own, there) = ([self.grid.columns, self.grid.rows], [raster.grid.columns, raster.grid.rows]);
        let low = [0, 1].map(|i| first[i].max(0));
        let end = [0, 1].map(|i| (first[i] + own[i] as i64).min(there[i] as i64));
        let window = Window { first: low.map(|v| v as usize), size: [0, 1].map(|i| (end[i] - low[i]) as usize) };
        let mut done = 0;
        for Window { first: at, size } in window.blocks(block_size(self.stored, own[0])) {
            // The first sample of the block in the file, counted backwards where flipped.
            let from = [0, 1].map(|i| {
                let offset = (at[i] as i64 - first[i]) as usize;
                if self.flip[i] { own[i] - offset - size[i] } else { offset }
            });
            let mut raw = numbers(source, &band, mask.as_ref(), self.elevation.picture(), from, size)?;
            turn(&mut raw, size[0], self.flip);
            for (row, raw) in raw.chunks_exact(size[0]).enumerate() {
                let place = (at[1] + row) * there[0] + at[0];
                self.cover(&mut raster.metres[place..place + size[0]], raw, tally);
            }
            done += size[0] * size[1];
            progress(done as f64 / window.samples() as f64);
        }
        Ok(())
    }

    /// Covers `metres` with those of the numbers `raw`, and counts them in `tally`.
    fn cover(&self, metres: &mut [f32], raw: &[f64], tally: &mut Tally) {
        for (metres, raw) in metres.iter_mut().zip(raw) {
            let reading = self.elevation.reading(*raw);
            tally.add(self.elevation.number(*raw), reading);
            if let Reading::Metres(value) = reading {
                *metres = value as f32;
            }
        }
    }
}

/// A block of a file's numbers, decoded where it is a picture, NaN where the file masks them.
fn numbers(
    source: &Source,
    band: &RasterBand,
    mask: Option<&RasterBand>,
    picture: Option<Encoding>,
    from: [usize; 2],
    size: [usize; 2],
) -> Result<Vec<f64>> {
    let mut raw = match picture {
        Some(encoding) => encoding.decode(source, from, size)?,
        None => block::<f64>(source, band, from, size)?,
    };
    if let Some(mask) = mask {
        let seen = block::<f32>(source, mask, from, size)?;
        raw.iter_mut().zip(seen).filter(|(_, seen)| *seen == 0.0).for_each(|(raw, _)| *raw = f64::NAN);
    }
    Ok(raw)
}

/// One block of numbers, or the error for a damaged file; where `source` is transposed, in its order.
pub(super) fn block<T: GdalType + Copy>(
    source: &Source,
    band: &RasterBand,
    from: [usize; 2],
    size: [usize; 2],
) -> Result<Vec<T>> {
    let swapped = |[x, y]: [usize; 2]| if source.transposed { (y, x) } else { (x, y) };
    let ((column, row), size) = (swapped(from), swapped(size));
    let (block, complaint) = heard(|| band.read_as::<T>((column as isize, row as isize), size, size, None));
    match (block, complaint) {
        (Ok(block), None) if source.transposed => Ok(transposed(&block.into_shape_and_vec().1, size.0)),
        (Ok(block), None) => Ok(block.into_shape_and_vec().1),
        // A driver that complains and goes on has made the numbers up.
        (_, words) => Err(source.unreadable(words.as_deref())),
    }
}

/// The columns of `block`, which has rows of `width`, one after another.
fn transposed<T: Copy>(block: &[T], width: usize) -> Vec<T> {
    (0..width).flat_map(|column| block.iter().skip(column).step_by(width).copied()).collect()
}

/// The samples of `source` that cubic convolution needs for all of `target`; `None` where they do not meet.
pub(super) fn reach(target: &GeoGrid, source: &GeoGrid) -> Option<Window> {
    let mut places = target.outline(target.whole());
    CrsPath::between(&target.crs, &source.crs)?.carry(&mut places);
    source.pixels(&mut places);
    places.retain(|place| place.is_finite());
    let [low, high] = span(&places);
    // Larger cells gather from as many more samples.
    let ratio = (high - low) / DVec2::new(target.columns as f64, target.rows as f64);
    let margin = MARGIN as f64 * ratio.max_element().max(1.0);
    let sizes = [source.columns as f64, source.rows as f64];
    let [low, end] = [(low - margin).floor().to_array(), (high + margin).ceil().to_array()];
    let first = [0, 1].map(|i| low[i].clamp(0.0, sizes[i]));
    let end = [0, 1].map(|i| end[i].clamp(0.0, sizes[i]));
    let meet = first[0] < end[0] && first[1] < end[1];
    meet.then(|| Window { first: first.map(|v| v as usize), size: [0, 1].map(|i| (end[i] - first[i]) as usize) })
}

/// Columns and rows to read at once of a file of `columns` stored in such blocks: whole ones, about [`BLOCK_SAMPLES`] in
/// all, so that none is unpacked twice.
fn block_size([width, height]: [usize; 2], columns: usize) -> [usize; 2] {
    let height = height.clamp(1, BLOCK_SAMPLES / width.clamp(1, BLOCK_SAMPLES));
    let across = (BLOCK_SAMPLES / height / width.max(1)).max(1) * width;
    let across = across.min(columns);
    [across, (BLOCK_SAMPLES / height / across).max(1) * height]
}

/// Turns a block of rows of `width` numbers round, along the rows and down the columns.
fn turn(raw: &mut [f64], width: usize, [along, down]: [bool; 2]) {
    if along && down {
        raw.reverse();
    } else if along {
        raw.chunks_mut(width).for_each(<[f64]>::reverse);
    } else if down {
        let rows = raw.len() / width;
        for r in 0..rows / 2 {
            let (upper, lower) = raw.split_at_mut((rows - 1 - r) * width);
            upper[r * width..(r + 1) * width].swap_with_slice(&mut lower[..width]);
        }
    }
}

/// A name, and how many more there are of so many in all.
pub(super) fn and_more(first: &str, all: usize) -> String {
    if all > 1 { format!("{first} and {} more", all - 1) } else { first.to_owned() }
}
