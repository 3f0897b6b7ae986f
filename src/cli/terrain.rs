//! Flags of every subcommand that reads a DEM.

use std::path::{Path, PathBuf};

use super::talk::Talk;
use super::words::told;
use super::{scene, values};
use crate::cache::Cache;
use crate::dem::Dem;
use crate::error::{Error, Result, Setting, shown};
use crate::geo::{ElevationUnit, Encoding, Nodata, Order, ReadOptions, ReadStage, Reading};
use crate::job::Content;
use crate::job::name::Naming;
use crate::surface::Surface;

/// Which files, and what of them.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct TerrainArguments {
    /// The DEM: any raster; several are laid together, the finest on top, of those on one grid the last
    ///
    /// `hachure info --help` says which formats are read, and what is done with a file.
    #[arg(required = true, value_name = "DEM")]
    pub dems: Vec<PathBuf>,

    /// Take a part only: west, south, east, north in the CRS of the DEM (metres, feet or degrees, as it has them);
    /// degrees whose west is beyond their east cross 180: 179,-17,-179,-16
    #[arg(long, value_name = "E0,N0,E1,N1", value_parser = values::crop, allow_hyphen_values = true, help_heading = "Surface")]
    crop: Option<[f64; 4]>,
    /// The band with the elevations, from 1 [default: the one called elevation, dem, height, idw or mean, else the first]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Surface")]
    band: Option<u16>,
    /// Metres between samples, for a DEM that does not say where it lies (an image)
    #[arg(long, value_name = "M", value_parser = values::metres, allow_hyphen_values = true, help_heading = "Surface")]
    cell: Option<f64>,
    /// Which of several files lie on top where their grids differ: the finest, blended along its edges, or the last of those
    /// given, as it is
    #[arg(long, value_name = "finest|given", value_parser = values::order, default_value_t = Order::default(), help_heading = "Surface")]
    order: Order,
    /// The file, one of the DEM, whose cells are drawn [default: the finest whose samples fit --memory]
    #[arg(long, value_name = "FILE", help_heading = "Surface")]
    cell_of: Option<PathBuf>,
    /// Resample to square cells of so many metres, cubic; larger ones are means [default: only what is not north-up in a map that is true]
    #[arg(long, value_name = "M", value_parser = values::metres, allow_hyphen_values = true, help_heading = "Surface")]
    resample: Option<f64>,
    /// Leave a map in metres as it is where they are off those on the ground by over 1 % (shear, unequal scale) [default:
    /// warp it to UTM]
    #[arg(long, help_heading = "Surface")]
    no_warp: bool,
    /// Fill voids up to 100 samples from data, by GDAL's inverse distance weighting
    #[arg(long, help_heading = "Surface")]
    fill_voids: bool,
    /// The unit of elevations: m, dm, cm, mm, km, ft or us-ft [default: as the DEM says, else metres]
    #[arg(long, value_name = "UNIT", value_parser = values::elevation_unit, help_heading = "Surface")]
    elevation_unit: Option<ElevationUnit>,
    /// Numbers in the file that are no data, beside the one it declares; A..B is all from A to B
    #[arg(long, value_name = "V,A..B", value_parser = values::nodata, allow_hyphen_values = true, help_heading = "Surface")]
    nodata: Option<Nodata>,
    /// What the numbers in the file stand for: terrain-rgb or terrarium, colours of a picture; signed, unsigned numbers
    /// the upper half of which is below 0; elevations or depths, whatever the file says [default: as the file says]
    #[arg(long, value_name = "NAME", value_parser = values::encoding, help_heading = "Surface")]
    encoding: Option<Encoding>,
    /// Keep heights that are multiples of a step (whole metres, feet, tenths) as they are, stairs and all [default: draw the
    /// smoothest surface within half a step of them]
    #[arg(long, help_heading = "Surface")]
    keep_steps: bool,
    /// Smooth heights at a scale of so many metres (2.5 to 256 cells), after any warp, crests kept: for surface models of trees and
    /// roofs
    ///
    /// What is narrower is smoothed away (walls, hair of 1 m lidar). A roof keeps 99 % of its height; the top of a cone loses its slope
    /// times a fifth of M.
    #[arg(long, value_name = "M", value_parser = values::metres, allow_hyphen_values = true, help_heading = "Surface")]
    generalise: Option<f64>,
    /// Limit tangents of the surface where patches fold over, so that none does; elsewhere it stays as it is
    #[arg(long, help_heading = "Surface")]
    limit_folds: bool,
    /// Open files on a network, and VRTs that refer to files outside their folder
    #[arg(long, help_heading = "Surface")]
    allow_remote: bool,
    /// Memory for samples and normals, in B, KiB, MiB, GiB or TiB; of a larger DEM samples are read as they are needed
    #[arg(long, value_name = "SIZE", value_parser = values::bytes, default_value = "1GiB", help_heading = "Surface")]
    memory: u64,
    /// Whether the crop is a sheet of a map.
    #[arg(skip)]
    is_sheet: bool,
}

impl TerrainArguments {
    /// Whether files on a network may be opened.
    pub(crate) fn allows_remote(&self) -> bool {
        self.allow_remote
    }

    /// How to read, with this exaggeration; what is found of steps is kept in `cache`.
    pub(crate) fn options(&self, exaggeration: f64, cache: Cache) -> ReadOptions {
        ReadOptions {
            crop: self.crop,
            exaggeration,
            band: self.band.map(usize::from),
            cell: self.cell,
            order: self.order,
            cell_of: self.cell_of.clone(),
            resample: self.resample,
            warp: !self.no_warp,
            fill_voids: self.fill_voids,
            elevation_unit: self.elevation_unit,
            nodata: self.nodata.clone().unwrap_or_default(),
            encoding: self.encoding,
            keep_steps: self.keep_steps,
            generalise: self.generalise,
            cache,
            allow_remote: self.allow_remote,
            memory: self.memory,
        }
    }

    /// How the DEM is read, as far as its surface depends on it.
    pub(crate) fn read_as(&self) -> String {
        let Self { crop, band, cell, order, cell_of, resample, no_warp, fill_voids, .. } = self;
        let Self { elevation_unit, nodata, encoding, keep_steps, generalise, .. } = self;
        let grid = (crop, band, cell, order, cell_of, resample, no_warp, fill_voids);
        // Files by their places in the list: on one grid the last one is on top.
        let names: Vec<_> = self.dems.iter().map(|dem| dem.file_name().unwrap_or_default()).collect();
        // Of several the finest whose samples fit gives the cells.
        let memory = (self.dems.len() > 1 && cell_of.is_none()).then_some(self.memory);
        let limited = if self.limit_folds { " limited" } else { "" };
        format!("{grid:?} {:?}{limited}", (names, memory, elevation_unit, nodata, encoding, keep_steps, generalise))
    }

    /// Which files are read, wherever from they are named; of which some may lie outside a crop, but not of sheets, which
    /// share them.
    pub(crate) fn asked(&self) -> u128 {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let dems: Vec<PathBuf> = self.dems.iter().map(absolute).collect();
        let crop = self.crop.filter(|_| !self.is_sheet);
        Naming::bare().with("files", format!("{dems:?} {crop:?} {:?} {:?}", self.cell_of, self.band)).name()
    }

    /// The surface of a DEM that was read, its tangents limited where that is asked for.
    ///
    /// # Errors
    /// As [`Cache::prepare`] and [`Surface::limited`].
    pub(crate) fn surface(&self, dem: Dem, cache: &Cache, talk: &Talk) -> Result<Surface> {
        let surface = Surface::new(dem);
        if !self.limit_folds {
            return Ok(surface);
        }
        scene::prepare(&surface, cache, talk)?;
        talk.progress("limiting folds", 0.2);
        surface.limited()
    }

    /// Whether tangents are to be limited.
    pub(crate) fn limits_folds(&self) -> bool {
        self.limit_folds
    }

    /// What the DEM's files hold, known or found.
    ///
    /// # Errors
    /// As [`Self::open`] where it is not known, and [`Cache::content`].
    pub(crate) fn content(&self, exaggeration: f64, cache: &Cache, talk: &Talk) -> Result<Content> {
        let of = self.dems.iter().map(|dem| shown(dem)).collect::<Vec<_>>().join(", ");
        let files = || {
            let whole = Self { crop: self.crop.filter(|_| !self.is_sheet), ..self.clone() };
            let reading = whole.open(&self.dems, exaggeration, cache.clone())?;
            Ok(reading.files().map(Path::to_owned).collect::<Vec<_>>())
        };
        cache.content(self.asked(), &of, &|message| talk.warn(&told(message)), files)
    }

    /// The same of a part.
    ///
    /// # Errors
    /// [`Error::Setting`] where it is a part already.
    pub(crate) fn cropped(&self, crop: [f64; 4]) -> Result<Self> {
        match self.crop {
            None => Ok(Self { crop: Some(crop), is_sheet: true, ..self.clone() }),
            Some(_) => Err(Error::setting(Setting::Crop, "each sheet is a part by itself", "leave it out")),
        }
    }

    /// Opens `files` as one DEM: before any output is opened, which may be none of its files.
    ///
    /// # Errors
    /// As [`Reading::new`].
    pub(crate) fn open(&self, files: &[PathBuf], exaggeration: f64, cache: Cache) -> Result<Reading> {
        Reading::new(files, &self.options(exaggeration, cache))
    }

    /// Reads a DEM that was opened, with progress, and says what was converted and assumed.
    ///
    /// # Errors
    /// As [`Reading::finish`].
    pub(crate) fn read(&self, reading: Reading, talk: &Talk) -> Result<Dem> {
        let dem = reading.finish(&|stage, share| talk.progress(words(stage), share))?;
        dem.history().assumed().iter().for_each(|clause| talk.warn(&format!("assumed that {}", told(clause))));
        dem.history().converted().iter().try_for_each(|clause| talk.say(&format!("converted: {}", told(clause))))?;
        dem.history().usual().iter().try_for_each(|clause| talk.detail(&format!("assumed: {}", told(clause))))?;
        Ok(dem)
    }
}

/// Warns of what a look at all samples of a DEM found, where they stay in their file: of others [`TerrainArguments::read`]
/// has told.
///
/// # Errors
/// As [`Dem::survey`], which looks where nobody has looked before.
pub(crate) fn warn_of_survey(dem: &Dem, talk: &Talk) -> Result<()> {
    if dem.is_filed() {
        let survey = dem.survey(&|_| ())?;
        survey.assumed.iter().for_each(|clause| talk.warn(&format!("assumed that {}", told(clause))));
    }
    Ok(())
}

/// A stage of reading, for its progress bar.
pub(crate) fn words(stage: ReadStage) -> &'static str {
    match stage {
        ReadStage::Read => "reading the DEM",
        ReadStage::Warp => "warping it to metres",
        ReadStage::Fill => "filling voids",
        ReadStage::Look => "looking for steps",
        ReadStage::Smooth => "smoothing heights, once for this file",
    }
}
