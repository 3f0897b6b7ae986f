//! What rasters hold.

use std::fmt::{self, Display, Formatter, Write};
use std::path::PathBuf;

use glam::{DMat2, DVec2};

use super::{ReadOptions, ReadStage, Reading};
use crate::dem::{Crs, Dem, History, convergence_in_words};
use crate::error::{Message, Result, shown};

/// What GDAL calls systems that nobody named.
const UNNAMED: [&str; 3] = ["", "unknown", "unnamed"];

/// What is known of a DEM after reading it whole. `Display` prints a few aligned lines, settings by their names.
///
/// Size, extent, cell and range are those of the DEM as it is drawn; where its files are on another grid, `source` says so.
/// Where heights stay in their files and are smoothed when they are drawn, the range is that of the files' numbers: it is not
/// worth smoothing all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// The files as the user named them.
    pub paths: Vec<PathBuf>,
    /// GDAL's name of the format of the first.
    pub driver: String,
    /// The files' own grid in words, where the DEM is warped from it or its axes are turned.
    pub source: Option<String>,
    /// Samples from west to east.
    pub columns: usize,
    /// Samples from north to south.
    pub rows: usize,
    /// The coordinate reference system of the DEM as drawn.
    pub crs: Crs,
    /// West, south, east and north of the outermost sample centres, metres.
    pub extent: [f64; 4],
    /// Degrees of longitude and latitude of the DEM's middle, where its system is of a globe.
    pub middle: Option<[f64; 2]>,
    /// The system of `middle`.
    pub globe: Option<Crs>,
    /// Degrees from true north clockwise to grid north of the files' system, at the middle of the DEM, where both are known.
    pub convergence: Option<f64>,
    /// Metres between columns and between rows.
    pub cell: [f64; 2],
    /// Lowest and highest elevation, metres.
    pub range: [f32; 2],
    /// Whether that is the range before heights are smoothed.
    pub before_smoothing: bool,
    /// Samples without elevation.
    pub voids: usize,
    /// What was done to the files' samples and what was assumed of them.
    pub history: History,
}

impl Info {
    /// Share of the samples without elevation, 0 to 1.
    pub fn void_share(&self) -> f64 {
        self.voids as f64 / (self.columns * self.rows) as f64
    }
}

/// Reads `paths` as [`read_all`](super::read_all()) does and says what they hold.
///
/// # Errors
/// Those of [`read_all`](super::read_all()).
pub fn info(paths: &[PathBuf], options: &ReadOptions, progress: &dyn Fn(ReadStage, f64)) -> Result<Info> {
    info_and_dem(paths, options, progress).map(|(info, _)| info)
}

/// The same, and the DEM, which has the files' own heights where it stays in them.
///
/// # Errors
/// Those of [`info()`].
pub(crate) fn info_and_dem(
    paths: &[PathBuf],
    options: &ReadOptions,
    progress: &dyn Fn(ReadStage, f64),
) -> Result<(Info, Dem)> {
    let reading = Reading::new(paths, options)?;
    let (driver, source) = (reading.format().to_owned(), reading.warped_from());
    let dem = reading.finish_as_read(progress)?;
    let survey = dem.survey(&|done| progress(ReadStage::Read, done))?;
    let mut history = dem.history().clone();
    survey.assumed.iter().for_each(|clause| history.assume(clause.clone()));
    let [west, south, east, north] = dem.extent();
    let middle = DVec2::new((west + east) / 2.0, (south + north) / 2.0);
    let lonlat = dem.georeference().lonlat(middle)?;
    let globe = dem.georeference().globe()?;
    let info = Info {
        paths: paths.to_owned(),
        driver,
        source,
        columns: dem.columns(),
        rows: dem.rows(),
        crs: dem.georeference().world().clone(),
        extent: dem.extent(),
        middle: lonlat.map(|place| place.to_array()),
        globe,
        convergence: dem.georeference().bearings(middle)?.convergence(),
        cell: dem.cell().to_array(),
        range: survey.range.unwrap_or_default(),
        before_smoothing: dem.is_filed() && (options.generalise.is_some() || !dem.history().steps().is_empty()),
        voids: survey.voids,
        history,
    };
    Ok((info, dem))
}

impl Display for Info {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.write(f, &Message::to_string)
    }
}

impl Info {
    /// The lines of `Display`, with clauses in the words of `told`.
    pub fn told(&self, told: impl Fn(&Message) -> String) -> String {
        let mut lines = String::new();
        // A string takes all that is written.
        let _ = self.write(&mut lines, &told);
        lines
    }

    /// Least and greatest coordinates in the files, where their axes are turned.
    fn extent_in_file(&self) -> Option<[DVec2; 2]> {
        let axes = self.crs.axes();
        let metres = self.crs.metres_per_unit().filter(|_| axes != DMat2::IDENTITY)?;
        let [west, south, east, north] = self.extent;
        let corner = |x, y| axes.transpose() * DVec2::new(x, y) / metres;
        let (one, other) = (corner(west, south), corner(east, north));
        Some([one.min(other), one.max(other)])
    }

    fn write(&self, f: &mut impl Write, told: &dyn Fn(&Message) -> String) -> fmt::Result {
        let [west, south, east, north] = self.extent;
        let crs = name_of(&self.crs);
        for (i, path) in self.paths.iter().enumerate() {
            let driver = if i == 0 { format!(" ({})", self.driver) } else { String::new() };
            writeln!(f, "file       {}{driver}", shown(path))?;
        }
        self.source.iter().try_for_each(|source| writeln!(f, "source     {source}"))?;
        writeln!(f, "size       {} columns x {} rows = {} samples", self.columns, self.rows, self.columns * self.rows)?;
        writeln!(f, "crs        {crs}")?;
        match self.extent_in_file() {
            None => {
                writeln!(f, "extent     W {west:.2}  S {south:.2}  E {east:.2}  N {north:.2} m (outermost samples)")?
            }
            Some([low, high]) => writeln!(
                f,
                "extent     x {:.2} to {:.2}  y {:.2} to {:.2} {} of the file (outermost samples)",
                low.x,
                high.x,
                low.y,
                high.y,
                self.crs.units()
            )?,
        }
        if let (Some([longitude, latitude]), Some(globe)) = (self.middle, &self.globe) {
            writeln!(
                f,
                "middle     longitude {longitude:.5}, latitude {latitude:.5} degrees ({})",
                name_of_globe(globe)
            )?;
        }
        if let Some(apart) = self.convergence.and_then(convergence_in_words) {
            writeln!(f, "north      at the middle {apart}")?;
        }
        let [across, down] = self.cell.map(short);
        writeln!(f, "cell       {across} m x {down} m (east x north)")?;
        let before = if self.before_smoothing { ", before they are smoothed" } else { "" };
        writeln!(f, "elevation  {:.1} to {:.1} m{before}", self.range[0], self.range[1])?;
        write!(f, "voids      {} ({:.1} %)", self.voids, 100.0 * self.void_share())?;
        self.history.converted().iter().try_for_each(|clause| write!(f, "\nconverted  {}", told(clause)))?;
        let assumed = self.history.assumed().iter().chain(self.history.usual());
        assumed.into_iter().try_for_each(|clause| write!(f, "\nassumed    {}", told(clause)))
    }
}

/// Its label, or that there is none.
pub(super) fn name_of(crs: &Crs) -> String {
    match crs.label() {
        label if label.is_empty() => "none".to_owned(),
        label => label,
    }
}

/// The name of longitude and latitude, or that they are on the DEM's own ellipsoid.
fn name_of_globe(globe: &Crs) -> &str {
    if UNNAMED.contains(&globe.name()) { "the DEM's own ellipsoid" } else { globe.name() }
}

/// With at most four decimals.
fn short(metres: f64) -> f64 {
    (metres * 1e4).round() / 1e4
}
