//! The raster in an archive: zip and tar, the latter packed with gzip or not.
//!
//! GDAL opens a member that is named, not the archive. Of an archive with one readable raster that one is taken; files
//! that belong to it (an overview, a mask, a header) are no others. Each member is opened and read a little before a
//! driver sees it: GDAL's driver of .hgt files ends the process where it cannot. Cost: a look at the head of each member,
//! and an opening of those that may be rasters, at most [`MEMBERS`]. Not handled: archives in archives, members that are
//! damaged beyond their head (that shows as they are read), and VRTs, which name other files; all these are to be unpacked.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use gdal::{GdalOpenFlags, Metadata};

use super::formats::FORMATS;
use super::name::RasterPlace;
use super::shell::{self, quoted};
use super::zip::packing;
use super::{hgt, lossless, mistaken, outside, vrt, vsi, xml};
use crate::error::{Error, Result, shown};

/// Members that are looked into.
const MEMBERS: usize = 1000;
/// Members that are listed.
const LISTED: usize = 12;
/// Endings of archives and packed files.
const PACKED: [&str; 8] = ["zip", "tar", "tgz", "gz", "bz2", "xz", "7z", "rar"];
/// Endings of files in which people keep points, lines and areas.
const VECTOR: [&str; 6] = ["shp", "geojson", "gpkg", "kml", "kmz", "gpx"];
/// Endings of files in which people keep elevations.
const RASTER: [&str; 16] =
    ["tif", "tiff", "hgt", "asc", "img", "dem", "bil", "flt", "adf", "nc", "dt0", "dt1", "dt2", "h5", "xyz", "grd"];

/// The raster of an archive.
pub(super) struct Member {
    /// What GDAL is asked to open.
    pub connection: PathBuf,
    /// What the user would type.
    pub typed: PathBuf,
    /// Its way in the archive.
    pub inner: String,
}

/// What is found of the members.
#[derive(Default)]
struct Found {
    /// Ways of readable rasters, and all files that belong to them.
    rasters: Vec<(String, Vec<PathBuf>)>,
    /// A member that cannot be read, and why.
    unreadable: Option<(String, String, String)>,
    /// The first refusal of a raster for what stands beside it.
    refused: Option<Error>,
}

/// The one raster below `folder`, an archive or a folder in it, that the user calls `path`; `None` where that is no
/// folder. `before` is the way into archives of that kind.
pub(super) fn member(
    path: &Path,
    before: &str,
    folder: &Path,
    place: &RasterPlace,
    allow_remote: bool,
) -> Result<Option<Member>> {
    let Some(files) = vsi::files_below(folder) else { return Ok(None) };
    let files: Vec<_> = files.iter().map(|file| lossless::text(file)).filter(|file| !is_hidden(file)).collect();
    let found = Found::among(&files, path, folder, place, allow_remote);
    let shown = path.to_string_lossy();
    let typed = |file: &str| match shown.starts_with(before) {
        true => joined(path, file),
        false => joined(&before_of(before, path), file),
    };
    if let Some((file, what, remedy)) = found.unreadable.as_ref().filter(|_| found.rasters.len() < 2) {
        return Err(Error::input(path, format!("its member {} {what}", said(file)), remedy.clone()));
    }
    match found.alone(path) {
        [(inner, _)] => {
            Ok(Some(Member { connection: joined(folder, inner), typed: typed(inner), inner: inner.clone() }))
        }
        [] => Err(found.refused.unwrap_or_else(|| holds_none(path, before, folder, place, &files))),
        several => {
            let names = several.iter().take(LISTED);
            let names: Vec<_> = names.map(|(file, _)| format!("`{}`", quoted(typed(file).as_os_str()))).collect();
            let more = several.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", or one of {more} more") } else { String::new() };
            let what = format!("holds {} rasters, and which one is meant is not said", several.len());
            Err(Error::input(path, what, format!("name one: {}{more}", names.join(", "))))
        }
    }
}

/// Fails where a file in an archive cannot be read, before GDAL's drivers see it: what is wrong and what to do.
pub(super) fn check(connection: &Path, place: &RasterPlace) -> std::result::Result<(), (String, String)> {
    let packed = match place {
        RasterPlace::Archive(archive) => {
            parts(connection, archive).and_then(|[_, inner]| packing(archive, inner.as_os_str().as_encoded_bytes()))
        }
        RasterPlace::File(_) | RasterPlace::Remote => None,
    };
    let unpack = |command: &str| format!("unpack it first: `{command}`");
    match packed {
        Some(packed) if packed.encrypted => {
            // Passwords of the old kind are known to every program, the others are method 99.
            let command = if packed.method == 99 { "7z x IN" } else { "unzip -P PASSWORD IN" };
            Err((format!("is {}", packed.words()), unpack(command)))
        }
        _ if vsi::head(connection).is_some() => Ok(()),
        Some(packed) if ![0, 8].contains(&packed.method) => {
            let command = if [9, 12].contains(&packed.method) { "unzip IN" } else { "python3 -m zipfile -e IN FOLDER" };
            Err((format!("is {}, which GDAL does not read", packed.words()), unpack(command)))
        }
        _ => Err(("is empty, or damaged or cut short".into(), "copy or download it again".into())),
    }
}

/// The error for a member that is not in its archive; `None` where it is, or nothing is known.
pub(super) fn missing(path: &Path, connection: &Path, place: &RasterPlace) -> Option<Error> {
    let RasterPlace::Archive(archive) = place else { return None };
    let [before, after] = parts(connection, archive)?;
    let files: Vec<_> = vsi::files_below(&before)?.iter().map(|file| lossless::text(file)).collect();
    let after = lossless::text(after.as_os_str());
    let first = files.iter().find(|file| !is_hidden(file))?;
    let there = after.is_empty() || files.contains(&after);
    let typed = || lossless::text(path.as_os_str()).strip_suffix(&after).map(|archive| format!("{archive}{first}"));
    let first = typed().unwrap_or_else(|| first.clone());
    let remedy = format!("name a file that it holds, such as `{}`", quoted(&lossless::name(&first)));
    (!there).then(|| Error::input(path, "there is no such file in that archive", remedy))
}

/// The archive and the way in it of a file in one, without the slash between them.
fn parts(connection: &Path, archive: &Path) -> Option<[PathBuf; 2]> {
    let (name, archive) = (connection.as_os_str().as_encoded_bytes(), archive.as_os_str().as_encoded_bytes());
    let end = name.windows(archive.len().max(1)).position(|part| part == archive)? + archive.len();
    let part = |bytes: &[u8]| PathBuf::from(lossless::name(&lossless::text_of(bytes)));
    Some([part(&name[..end]), part(name.get(end + 1..)?)])
}

/// Fails where `file`, opened by the driver of .hgt files as an archive, has a member that cannot be read.
pub(super) fn check_tile(file: &Path, place: &RasterPlace) -> std::result::Result<(), (String, String)> {
    let RasterPlace::File(_) = place else { return Ok(()) };
    if !is_tile(&lossless::text(file.as_os_str())) {
        return Ok(());
    }
    let folder = before_of("/vsizip/", file);
    let files = vsi::files_below(&folder).unwrap_or_default();
    let place = RasterPlace::Archive(file.to_owned());
    if files.is_empty() {
        return Err(("is damaged or cut short".into(), "copy or download it again".into()));
    }
    files.iter().try_for_each(|inner| check(&joined(&folder, &lossless::text(inner)), &place))
}

/// Whether GDAL's driver of .hgt files takes a zip archive of that name for a tile.
pub(super) fn is_tile(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".hgt.zip") || name.ends_with(".raw.zip")
}

impl Found {
    fn among(files: &[String], path: &Path, folder: &Path, place: &RasterPlace, allow_remote: bool) -> Self {
        let mut found = Self::default();
        for file in files.iter().take(MEMBERS).filter(|file| !PACKED.contains(&ending(file).as_str())) {
            let connection = joined(folder, file);
            if let Err((what, remedy)) = check(&connection, place) {
                if RASTER.contains(&ending(file).as_str()) && found.unreadable.is_none() {
                    found.unreadable = Some((file.clone(), what, remedy));
                }
                continue;
            }
            if xml::is_vrt(&connection) || !xml::is_raster(&connection) {
                continue;
            }
            if let Err(error) = vrt::inspect(path, &connection, place, allow_remote) {
                found.refused.get_or_insert(error);
                continue;
            }
            let flags = GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY;
            if let (Some(dataset), _) = vsi::open(&connection, flags, &FORMATS) {
                let grids = dataset.metadata_domain("SUBDATASETS").unwrap_or_default().len();
                if dataset.raster_count() > 0 || grids > 0 {
                    found.rasters.push((file.clone(), vsi::files_of(&dataset)));
                }
            }
        }
        found.drop_parts(folder);
        found
    }

    /// The rasters, of a `N45E006.hgt.zip` the tile of that name alone.
    fn alone(&self, path: &Path) -> &[(String, Vec<PathBuf>)] {
        let corner =
            path.file_name().map(lossless::text).filter(|name| is_tile(name)).and_then(|name| hgt::corner(&name));
        let named = |(file, _): &(String, Vec<PathBuf>)| corner.is_some() && hgt::corner(file) == corner;
        match self.rasters.iter().position(named) {
            Some(place) if self.rasters.iter().filter(|raster| named(raster)).count() == 1 => {
                &self.rasters[place..=place]
            }
            _ => &self.rasters,
        }
    }

    /// Leaves out what belongs to another raster; of several that name one another the first stays.
    fn drop_parts(&mut self, folder: &Path) {
        let mut kept: Vec<(String, Vec<PathBuf>)> = Vec::new();
        let all = std::mem::take(&mut self.rasters);
        for (i, (file, belongs)) in all.iter().enumerate() {
            let connection = joined(folder, file);
            let names = |(j, (other, files)): (usize, &(String, Vec<PathBuf>))| {
                // Both may name each other, as the parts of an Arc/Info grid do.
                let mutual = belongs.contains(&joined(folder, other));
                j != i && files.contains(&connection) && (j < i || !mutual)
            };
            if !all.iter().enumerate().any(names) {
                kept.push((file.clone(), belongs.clone()));
            }
        }
        self.rasters = kept;
    }
}

/// The error for an archive without a readable raster.
fn holds_none(path: &Path, before: &str, folder: &Path, place: &RasterPlace, files: &[String]) -> Error {
    let with = |endings: &[&str]| files.iter().find(|file| endings.contains(&ending(file).as_str()));
    let unpack = if before == "/vsizip/" { "unzip IN" } else { "tar -xkf IN" };
    let told = |what: String, remedy: String| Error::input(path, what, remedy);
    if let Some(file) = files.iter().find(|file| xml::is_vrt(&joined(folder, file))) {
        let what = format!("holds a VRT ({}), which names other files", said(file));
        return told(what, format!("unpack all of it, and name the VRT: `{unpack}`"));
    }
    if let Some(file) = with(&PACKED) {
        let what = format!("holds another archive ({}), and archives in archives are not read", said(file));
        return told(what, format!("unpack it, and name what comes out: `{unpack}`"));
    }
    if let Some(file) = with(&VECTOR) {
        let what = format!("holds points, lines or areas ({}), not a raster of elevations", said(file));
        return told(what, "give a DEM raster; contours and points become one with `gdal_grid`".into());
    }
    let Some(first) = with(&RASTER).or(files.first()) else {
        return told("is an archive without a file".into(), "download it again".into());
    };
    if ending(first) == "hgt" {
        let corner = hgt::corner(first).or(hgt::corner(&path.to_string_lossy())).unwrap_or("N45E006".into());
        let called = lossless::name(&outside::called(first, place));
        let known = |archive: &Path| packing(archive, called.as_encoded_bytes()).is_some();
        let exact = matches!(place, RasterPlace::Archive(archive) if known(archive));
        let command = match before {
            "/vsizip/" => format!("unzip -p IN {}", shell::unzipped(&called.to_string_lossy(), exact)),
            _ => format!("tar -xOf IN -- {}", quoted(&called)),
        };
        let what =
            format!("its member {} is a .hgt tile, whose place is its name alone, and that says none", said(first));
        // No file that is there already is written over.
        let remedy = format!("unpack it to the name of its south-west corner: `(set -C; {command} > {corner}.hgt)`");
        return told(what, remedy);
    }
    let head = vsi::head(&joined(folder, first)).unwrap_or_default();
    let answer = || with(&RASTER).and_then(|_| mistaken::answer(&head));
    if let Some((what, remedy)) = mistaken::what(&head, &first.to_ascii_lowercase()).or_else(answer) {
        return told(format!("its member {} {what}", said(first)), remedy);
    }
    let count = if files.len() == 1 { "1 file".to_owned() } else { format!("{} files", files.len()) };
    let what = format!("holds no raster that hachure reads ({count}, {} for one)", said(first));
    told(what, "download an archive with a GeoTIFF or another DEM raster in it".into())
}

/// A member's way as it is printed.
fn said(file: &str) -> String {
    shown(Path::new(&lossless::name(file)))
}

/// What systems leave in archives beside what is meant.
fn is_hidden(file: &str) -> bool {
    file.starts_with("__MACOSX/") || file.rsplit('/').next().is_some_and(|name| name.starts_with('.'))
}

fn ending(file: &str) -> String {
    Path::new(file).extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase()
}

/// What lies at `file` below `folder`; a way from the root leads below it, too.
fn joined(folder: &Path, file: &str) -> PathBuf {
    let mut name = folder.as_os_str().to_owned();
    if !name.as_encoded_bytes().ends_with(b"/") {
        name.push("/");
    }
    name.push(lossless::name(file));
    name.into()
}

/// A way into archives and what follows it, which may begin at the root.
fn before_of(before: &str, path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(before);
    name.push(path);
    name.into()
}
