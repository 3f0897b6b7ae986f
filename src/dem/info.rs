//! What a raster holds, in the words of `hachure info`.

use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

use super::read::{Grid, ReadOptions};
use crate::error::Result;

/// What is known of a DEM file after reading it whole. `Display` prints a few aligned lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// The file as the user named it.
    pub path: PathBuf,
    /// GDAL's name of the format.
    pub driver: String,
    /// Samples from west to east.
    pub columns: usize,
    /// Samples from north to south.
    pub rows: usize,
    /// Name of the coordinate reference system, empty when the file has none.
    pub crs: String,
    /// Its EPSG code, where the file names one.
    pub epsg: Option<u32>,
    /// West, south, east and north of the outermost sample centres, metres.
    pub extent: [f64; 4],
    /// Metres between columns and between rows.
    pub cell: [f64; 2],
    /// Lowest and highest elevation, metres.
    pub range: [f32; 2],
    /// Samples without elevation.
    pub voids: usize,
    /// What the file does not say and was taken as given, one clause each.
    pub assumed: Vec<String>,
}

impl Info {
    /// Share of the samples without elevation, 0 to 1.
    pub fn void_share(&self) -> f64 {
        self.voids as f64 / (self.columns * self.rows) as f64
    }
}

/// Reads `path` whole and says what it holds.
///
/// # Errors
/// Those of [`read`](super::read()) without crop.
pub fn info(path: &Path) -> Result<Info> {
    let options = ReadOptions::default();
    let grid = Grid::open(path, &options)?;
    let loaded = grid.load(&options)?;
    let dem = &loaded.dem;
    Ok(Info {
        path: path.to_owned(),
        driver: grid.source.dataset.driver().long_name(),
        columns: dem.columns(),
        rows: dem.rows(),
        crs: grid.georeference.crs.clone(),
        epsg: grid.georeference.epsg,
        extent: dem.extent(),
        cell: dem.cell().to_array(),
        range: dem.range().unwrap_or_default(),
        voids: dem.voids(),
        assumed: assumptions(&grid, loaded.sentinels),
    })
}

fn assumptions(grid: &Grid, sentinels: usize) -> Vec<String> {
    let bands = grid.source.dataset.raster_count();
    let list = [
        (sentinels > 0).then(|| {
            format!("{sentinels} samples at or below -32767 m or above 100000 m are voids (no such nodata is declared)")
        }),
        grid.georeference.crs.is_empty().then(|| "coordinates are metres (no coordinate system is named)".into()),
        (!grid.elevation.says_metres).then(|| "elevations are metres (no unit is named)".into()),
        (bands > 1).then(|| format!("elevations are in band 1 of {bands}")),
    ];
    list.into_iter().flatten().collect()
}

impl Display for Info {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [west, south, east, north] = self.extent;
        let crs = match (self.crs.as_str(), self.epsg) {
            ("", _) => "none".to_owned(),
            (name, Some(code)) => format!("{name} (EPSG:{code})"),
            (name, None) => name.to_owned(),
        };
        let samples = self.columns * self.rows;
        writeln!(f, "file       {} ({})", self.path.display(), self.driver)?;
        writeln!(f, "size       {} columns x {} rows = {samples} samples", self.columns, self.rows)?;
        writeln!(f, "crs        {crs}")?;
        writeln!(f, "extent     W {west:.2}  S {south:.2}  E {east:.2}  N {north:.2} m (outermost samples)")?;
        writeln!(f, "cell       {} m x {} m (east x north)", self.cell[0], self.cell[1])?;
        writeln!(f, "elevation  {:.1} to {:.1} m", self.range[0], self.range[1])?;
        write!(f, "voids      {} ({:.1} %)", self.voids, 100.0 * self.void_share())?;
        self.assumed.iter().try_for_each(|assumption| write!(f, "\nassumed    {assumption}"))
    }
}
