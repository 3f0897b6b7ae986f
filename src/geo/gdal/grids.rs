//! Containers of several grids (netCDF, HDF5, GeoPackage): which there are, as names to type.
//!
//! GDAL lists them with the file's absolute name; here they are named with the file as the user called it, the one first
//! whose name says that it is the elevation. Each listed name is taken apart as if it were typed, so none is listed that
//! would be refused. Not handled: containers in archives and on networks, whose grids no name leads to.

use std::path::Path;

use gdal::{Dataset, GdalOpenFlags};

use super::name::{Local, Name, RasterPlace};
use super::{choice, lossless, shell, vsi};
use crate::error::{Error, Result};

/// Grids that are listed.
const LISTED: usize = 12;
/// Drivers by the prefix of their containers' names.
const DRIVERS: [(&str, &str); 7] = [
    ("NETCDF", "netCDF"),
    ("HDF5", "HDF5"),
    ("BAG", "BAG"),
    ("GPKG", "GPKG"),
    ("GTIFF_DIR", "GTiff"),
    ("HDF4_SDS", "HDF4"),
    ("HDF4_EOS", "HDF4"),
];

/// The error for a container of several grids, or of none: `path`, which GDAL calls `name`.
pub(super) fn unchosen(path: &Path, name: &Path, dataset: &Dataset) -> Error {
    let grids = vsi::grids_of(dataset);
    let count = grids.len();
    if count == 0 {
        return Error::input(path, "holds no grid", "give a file with a raster band of elevations");
    }
    let unpack = [("/vsizip/", "unzip IN"), ("/vsitar/", "tar -xkf IN"), ("/vsigzip/", "gunzip -k IN")];
    if let Some((_, command)) =
        unpack.iter().find(|(way, _)| name.as_os_str().as_encoded_bytes().starts_with(way.as_bytes()))
    {
        let what = format!("holds {count} grids, which cannot be named inside an archive");
        return Error::input(path, what, format!("unpack it first, and name one of what comes out: `{command}`"));
    }
    let names = typed(&grids, name, path);
    if !names.is_empty() {
        let what = format!("holds {count} grids, and which one is meant is not said");
        return Error::input(path, what, name_one(&names));
    }
    if name.to_string_lossy().starts_with("/vsi") {
        let what = format!("holds {count} grids, which cannot be named on a network");
        return Error::input(path, what, "download it first, and name one of them");
    }
    let what = format!("holds {count} grids, which cannot be named for the signs in the file's own name");
    let ending =
        path.extension().and_then(|ending| ending.to_str()).filter(|e| e.bytes().all(|b| b.is_ascii_alphanumeric()));
    let copy = format!("`cp -n {} dem.{}`", shell::file(path.as_os_str()), ending.unwrap_or("nc"));
    Error::input(path, what, format!("copy it to a plain name first: {copy}"))
}

/// Fails where `path`, which GDAL calls `name`, names a grid that its container does not hold; not for other names, nor
/// where the container cannot be opened.
pub(super) fn missing(path: &Path, name: &Path, place: &RasterPlace) -> Result<()> {
    let RasterPlace::File(file) = place else { return Ok(()) };
    let Name::Local(Local { file: typed_file, .. }) = Name::of(&lossless::text(path.as_os_str())) else {
        return Ok(());
    };
    let name = lossless::text(name.as_os_str());
    let driver = DRIVERS
        .iter()
        .find(|(prefix, _)| name.split_once(':').is_some_and(|(start, _)| start.eq_ignore_ascii_case(prefix)));
    let Some((_, driver)) = driver.filter(|_| typed_file != path) else { return Ok(()) };
    let flags = GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY;
    let (Some(dataset), _) = vsi::open(file, flags, &[driver]) else { return Ok(()) };
    let grids = vsi::grids_of(&dataset);
    let absolute = lossless::text(file.as_os_str());
    let key = |grid: &str| {
        around(grid, &absolute)
            .map(|(before, after)| (before.to_uppercase(), after.trim_matches([':', '/']).to_owned()))
    };
    let asked = key(&name);
    if asked.is_none() || grids.iter().any(|grid| key(grid) == asked) {
        return Ok(());
    }
    let what = "there is no such grid in that file";
    let names = typed(&grids, file, &typed_file);
    match names.is_empty() {
        false => Err(Error::input(path, what, name_one(&names))),
        true if grids.is_empty() && dataset.raster_count() > 0 => {
            let remedy = format!("it holds one: name the file alone, `{}`", shell::quoted(typed_file.as_os_str()));
            Err(Error::input(path, what, remedy))
        }
        true => Ok(()),
    }
}

/// GDAL's names of grids as a user types them who calls the file `path`, that of elevations first.
fn typed(grids: &[String], absolute: &Path, path: &Path) -> Vec<String> {
    let (absolute, file) = (lossless::text(absolute.as_os_str()), lossless::text(path.as_os_str()));
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+=,@%".contains(c);
    // GDAL splits the name at colons outside quotes; it does so when the name is absolute again, too.
    let quote = if file.chars().chain(absolute.chars()).all(is_plain) { "" } else { "\"" };
    let mut names: Vec<_> = grids.iter().filter_map(|grid| around(grid, &absolute)).collect();
    names.sort_by_key(|(_, after)| choice::rank(after));
    let whole = names.into_iter().map(|(before, after)| {
        // GDAL takes no quotes there.
        let quote = if before.starts_with("GTIFF_DIR") { "" } else { quote };
        format!("{before}{quote}{file}{quote}{after}")
    });
    let leads = |name: &String| matches!(Name::of(name), Name::Local(Local { file, .. }) if file == path);
    whole.filter(leads).map(|name| shell::quoted(&lossless::name(&name))).collect()
}

/// What stands before and after the file in GDAL's name of a grid, without quotes.
fn around<'a>(grid: &'a str, file: &str) -> Option<(&'a str, &'a str)> {
    let (before, after) = grid.split_once(file)?;
    Some((before.strip_suffix('"').unwrap_or(before), after.strip_prefix('"').unwrap_or(after)))
}

fn name_one(names: &[String]) -> String {
    let listed: Vec<_> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = names.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(", or one of {more} more") } else { String::new() };
    format!("name one: {}{more}", listed.join(", "))
}
