//! What a file says of its band, by the names of the CF conventions, wherever its format keeps that: on the band, on the
//! variable it comes from, or in the file that a VRT takes it from, for a VRT is often made without.
//!
//! Cost: of a VRT one raster that it names is opened a second time. Not handled: VRTs of files that say different things
//! (the first speaks for all), and those that turn or bend the numbers, which speak for themselves.

use std::path::{Path, PathBuf};

use gdal::raster::RasterBand;
use gdal::{Dataset, GdalOpenFlags, Metadata};

use super::formats::FORMATS;
use super::name::RasterPlace;
use super::source::Source;
use super::{vsi, xml};

/// VRTs in VRTs that are looked through.
const DEPTH: usize = 8;
/// Endings of what HDF5 says of a variable, whose name goes before.
const OF_VARIABLE: [&str; 3] = ["_positive", "_standard_name", "_long_name"];
/// Elements with which a VRT changes numbers on their way.
const CHANGES: [&str; 3] = ["lut", "exponent", "pixelfunctiontype"];

/// The bands that speak for the elevations of a source: its own, and in a VRT those it is made of, the nearest first.
pub(super) struct Said<'a> {
    own: (&'a Dataset, usize),
    others: Vec<(Dataset, usize)>,
}

impl<'a> Said<'a> {
    /// Of the band of `source`.
    pub(super) fn of(source: &'a Source) -> Self {
        let mut said = Self { own: (&source.dataset, source.band), others: Vec::new() };
        let mut vrt = source.rasters.first().map(|(name, _)| name.clone());
        while let Some(name) = vrt.filter(|name| said.others.len() < DEPTH && xml::is_vrt(name)) {
            let (dataset, band) = said.others.last().map_or(said.own, |(dataset, band)| (dataset, *band));
            let Some((next, band)) = part(&name, dataset, band, &source.rasters) else { break };
            let drivers = if xml::is_vrt(&next) { ["VRT"].as_slice() } else { &FORMATS };
            let flags = GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY;
            let (Some(opened), _) = vsi::open(&next, flags, drivers) else { break };
            said.others.push((opened, band));
            vrt = Some(next);
        }
        said
    }

    /// What is said under that name, by the nearest that says it; empty where nobody does.
    pub(super) fn attribute(&self, name: &str) -> String {
        self.bands().find_map(|(dataset, band)| attribute(dataset, &band, name)).unwrap_or_default()
    }

    /// What the band and its variable are called.
    pub(super) fn names(&self) -> Vec<String> {
        let of = |(dataset, band): (&Dataset, RasterBand)| {
            [band.description().ok(), band.metadata_item("NETCDF_VARNAME", ""), variable(dataset, &band)]
        };
        self.bands().flat_map(of).flatten().filter(|name| !name.is_empty()).collect()
    }

    fn bands(&self) -> impl Iterator<Item = (&Dataset, RasterBand<'_>)> {
        let others = self.others.iter().map(|(dataset, band)| (dataset, *band));
        let all = std::iter::once(self.own).chain(others);
        all.filter_map(|(dataset, band)| Some((dataset, dataset.rasterband(band).ok()?)))
    }
}

/// The raster and band that `band` of a VRT called `name` is made of, the first where there are several. `rasters` are all
/// that was looked into and may be opened.
fn part(name: &Path, vrt: &Dataset, band: usize, rasters: &[(PathBuf, RasterPlace)]) -> Option<(PathBuf, usize)> {
    let texts = xml::entries(name).ok()?;
    let turns = |entry: &xml::XmlText| entry.name == "scaleratio" && entry.text.trim().starts_with('-');
    if texts.iter().any(|entry| CHANGES.contains(&entry.name.as_str()) || turns(entry)) {
        return None;
    }
    let place = rasters.iter().position(|(known, _)| known == name)? + 1;
    let local =
        || rasters[place..].iter().filter(|(_, place)| !matches!(place, RasterPlace::Remote)).map(|(name, _)| name);
    let listed = vrt.rasterband(band).ok()?.metadata_domain("vrt_sources").unwrap_or_default();
    let inner = |tag: &str| {
        let (_, rest) = listed.first()?.split_once(&format!("<{tag}"))?;
        let (_, rest) = rest.split_once('>')?;
        rest.split_once('<').map(|(text, _)| text.trim().to_owned())
    };
    let file = inner("SourceFilename");
    let called = |known: &&PathBuf| file.as_ref().is_some_and(|file| known.to_string_lossy().ends_with(file.as_str()));
    let next = local().find(called).or_else(|| local().next())?;
    Some((next.clone(), inner("SourceBand").and_then(|band| band.parse().ok()).unwrap_or(1)))
}

/// Items in which files say what they are and who made them, in the order in which that is told.
const CREDITS: [&str; 10] = [
    "TIFFTAG_IMAGEDESCRIPTION",
    "NC_GLOBAL#title",
    "TITLE",
    "TIFFTAG_ARTIST",
    "NC_GLOBAL#institution",
    "NC_GLOBAL#source",
    "ATTRIBUTION",
    "NC_GLOBAL#attribution",
    "TIFFTAG_COPYRIGHT",
    "COPYRIGHT",
];

/// What a file says of itself, for those who show it to thank.
pub(super) fn credits(dataset: &Dataset) -> Vec<String> {
    CREDITS.iter().filter_map(|item| dataset.metadata_item(item, "")).collect()
}

/// What the file says of the band, or of the variable that it comes from.
fn attribute(dataset: &Dataset, band: &RasterBand, name: &str) -> Option<String> {
    if let Some(said) = band.metadata_item(name, "") {
        return Some(said);
    }
    let hdf5 = || band.metadata_item(&format!("{}_{name}", hdf5_variable(band)?), "");
    let netcdf = || dataset.metadata_item(&format!("{}#{name}", variable(dataset, band)?), "");
    let alone = || dataset.metadata_item(name, "").filter(|_| dataset.raster_count() == 1);
    hdf5().or_else(netcdf).or_else(alone)
}

/// The variable that a band comes from, where that is known or can only be one.
fn variable(dataset: &Dataset, band: &RasterBand) -> Option<String> {
    band.metadata_item("NETCDF_VARNAME", "").or_else(|| hdf5_variable(band)).or_else(|| {
        // A conversion may keep what was said of all variables, and not which one the band is.
        let all = dataset.metadata_domain("").unwrap_or_default();
        let of = |key: &str| -> Vec<String> {
            all.iter().filter_map(|line| line.split_once(key).map(|(name, _)| name.to_owned())).collect()
        };
        let axes: Vec<_> = ["#axis=", "#bounds="].into_iter().flat_map(of).collect();
        let mut placed = ["#positive=", "#standard_name=", "#long_name="].into_iter().flat_map(of).collect::<Vec<_>>();
        placed.retain(|name| !axes.contains(name) && !is_place(name));
        placed.sort_unstable();
        placed.dedup();
        let alone = dataset.raster_count() == 1 && placed.len() == 1;
        if alone { placed.pop() } else { band.description().ok().filter(|name| !name.is_empty()) }
    })
}

/// The variable of HDF5 that a band comes from, if what is said of the band names just one.
fn hdf5_variable(band: &RasterBand) -> Option<String> {
    let all = band.metadata_domain("").unwrap_or_default();
    let of = |line: &String| {
        let (key, _) = line.split_once('=')?;
        OF_VARIABLE.iter().find_map(|ending| key.strip_suffix(ending)).map(str::to_owned)
    };
    let mut found: Vec<_> = all.iter().filter_map(of).collect();
    found.dedup();
    found.pop().filter(|_| found.is_empty())
}

/// Whether a variable is one of the coordinates, or of the system they are in.
fn is_place(name: &str) -> bool {
    let names = ["x", "y", "lon", "lat", "longitude", "latitude", "easting", "northing", "time", "crs", "spatial_ref"];
    names.contains(&name.to_lowercase().as_str()) || name == "NC_GLOBAL"
}
