//! Opens a raster file through GDAL and keeps GDAL silent.
//!
//! GDAL prints its complaints on stderr as they come, often several for one fault. The first use of this module
//! installs a process-wide GDAL error handler that prints nothing and keeps the first complaint of each thread as
//! context for our own one line. What a name means is settled in `name`, which member of an archive is meant in `archive`,
//! what a file would make GDAL open in `vrt`, and which drivers may read it in `formats`, before GDAL opens anything.
//! Not handled: directories that GDAL takes for one raster.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Once;

use gdal::errors::CplErrType;
use gdal::raster::{GdalDataType, RasterBand};
use gdal::{Dataset, GdalOpenFlags, config};

use super::archive::{self, Member};
use super::formats::{self, FORMATS, VECTORS};
use super::name::{Local, Name, RasterPlace};
use super::{grids, hgt, lossless, mistaken, outside, vrt, vsi};
use crate::error::{Error, Message, Result, Setting, shown};
use crate::message;

thread_local! {
    /// The first complaint of GDAL on this thread since `heard` last began.
    static COMPLAINT: Cell<Option<String>> = const { Cell::new(None) };
}

/// Smallest side of a grid: one cell needs four samples.
pub(super) const MIN_SIDE: usize = 2;

/// A raster file, open for reading, with at least one band of real numbers and 2 x 2 samples.
pub(super) struct Source {
    /// The file as the user named it.
    pub path: PathBuf,
    /// What opens just this again: of an archive the member that was taken.
    pub exact: PathBuf,
    /// The member of an archive that was taken, where the user named the archive alone.
    pub member: Option<String>,
    /// GDAL's handle.
    pub dataset: Dataset,
    /// Samples from the first to the last column.
    pub columns: usize,
    /// Samples from the first to the last row.
    pub rows: usize,
    /// The band of elevations, from 1.
    pub band: usize,
    /// It and all rasters that VRTs name, as GDAL calls them.
    pub rasters: Vec<(PathBuf, RasterPlace)>,
    /// Whether blocks are read with rows for columns: then they are asked for so, too.
    pub transposed: bool,
}

impl Source {
    /// Opens `path` for the elevations in `band`, counted from 1. Fails when it is missing, no file, empty, no raster of
    /// a format on the list, or no grid of real numbers; and, without `allow_remote`, when it or anything it names lies
    /// on a network or, for a VRT, outside its folder.
    pub(super) fn open(path: &Path, band: usize, allow_remote: bool) -> Result<Self> {
        formats::restrict(allow_remote);
        let Connection { name, place, exact, member } = connection(path, allow_remote)?;
        let vrt::Inspected { is_vrt, rasters } = vrt::inspect(path, &name, &place, allow_remote)?;
        // What was not inspected as a VRT is not opened as one.
        let drivers = if is_vrt { ["VRT"].as_slice() } else { &FORMATS };
        let flags =
            GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR;
        let (opened, complaint) = vsi::open(&name, flags, drivers);
        let dataset = opened.ok_or_else(|| cannot_open(path, &name, &place, complaint))?;
        let (columns, rows) = dataset.raster_size();
        let source =
            Self { path: path.to_owned(), exact, member, dataset, columns, rows, band, rasters, transposed: false };
        source.check_band(&name)?;
        source.check_length()?;
        Ok(source)
    }

    /// The band of elevations.
    pub(super) fn band(&self) -> Result<RasterBand<'_>> {
        self.dataset.rasterband(self.band).map_err(|_| {
            let count = self.dataset.raster_count();
            let bands = if count == 1 { "1 band".to_owned() } else { format!("{count} bands") };
            let remedy = message!["give `", Setting::Band.with_value(), format!("` with N from 1 to {count}")];
            self.error(format!("has {bands}, none of them is band {}", self.band), remedy)
        })
    }

    /// An error about this file.
    pub(super) fn error(&self, what: impl Into<Message>, remedy: impl Into<Message>) -> Error {
        Error::input(&self.path, what, remedy)
    }

    /// The error for samples that cannot be read, with GDAL's words where it has any: it says once, not twice, that a
    /// part of a mosaic is missing.
    pub(super) fn unreadable(&self, words: Option<&str>) -> Error {
        if let Some(words) = words.filter(|words| lacks_memory(words)) {
            return Error::limit(
                format!("{}: not enough memory to read it ({})", shown(&self.path), one_line(words, &self.path)),
                message![
                    "use a smaller ",
                    Setting::Memory,
                    " or a ",
                    Setting::Crop,
                    ", or allow more (`ulimit -v` says how much)"
                ],
            );
        }
        let what = match words {
            Some(words) => format!("is damaged or cut short ({})", one_line(words, &self.path)),
            None => "is damaged or cut short, or lacks a file that it refers to".to_owned(),
        };
        self.error(what, "copy or download it again")
    }

    /// One band of real numbers, wide and high enough for a cell.
    fn check_band(&self, name: &Path) -> Result<()> {
        if self.dataset.raster_count() == 0 {
            return Err(grids::unchosen(&self.path, name, &self.dataset));
        }
        self.check_type()?;
        if self.columns < MIN_SIDE || self.rows < MIN_SIDE {
            let what = format!("is {} x {} samples; a surface needs at least 2 x 2", self.columns, self.rows);
            return Err(self.error(what, "give a larger grid"));
        }
        Ok(())
    }

    /// Real numbers.
    pub(super) fn check_type(&self) -> Result<()> {
        if self.band()?.band_type() == GdalDataType::Unknown {
            return Err(self.error(
                "holds complex numbers, not elevations",
                "give a file of real numbers, for instance made by `gdal_translate -ot Float32 IN OUT.tif`",
            ));
        }
        Ok(())
    }

    /// GDAL fills the missing end of an ENVI file with zeros, and zeros would pass for sea.
    fn check_length(&self) -> Result<()> {
        if self.dataset.driver().short_name() != "ENVI" || starts_with_gzip(&self.path) {
            return Ok(());
        }
        let bytes = self.dataset.rasterbands().flatten().map(|b| u64::from(b.band_type().bytes())).sum::<u64>();
        let promised = self.columns as u64 * self.rows as u64 * bytes;
        match fs::metadata(&self.path) {
            Ok(file) if file.len() < promised => {
                Err(self.unreadable(Some(&format!("{} of {promised} bytes are there", file.len()))))
            }
            _ => Ok(()),
        }
    }
}

/// Runs `work` and returns what it returns and the first complaint GDAL made meanwhile.
pub(super) fn heard<T>(work: impl FnOnce() -> T) -> (T, Option<String>) {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        config::set_error_handler(|class, _, words| {
            if matches!(class, CplErrType::Failure | CplErrType::Fatal) {
                let words = words.to_owned();
                COMPLAINT.with(|complaint| complaint.set(complaint.take().or(Some(words))));
            }
        });
    });
    COMPLAINT.take();
    let result = work();
    (result, COMPLAINT.take())
}

/// What GDAL is asked to open.
struct Connection {
    /// In GDAL's words.
    name: PathBuf,
    /// Where that lies.
    place: RasterPlace,
    /// The same in the user's words: of an archive the member that was taken.
    exact: PathBuf,
    /// The member, where the user named the archive alone.
    member: Option<String>,
}

/// What GDAL is asked to open and where that lies: absolute, so that no file name is taken for something else; of an
/// archive its one raster, and a member that can be read.
fn connection(path: &Path, allow_remote: bool) -> Result<Connection> {
    let name = match path.exists() {
        true => Name::Local(Local::by_ending(path)),
        false => Name::of(&lossless::text(path.as_os_str())),
    };
    let (name, place, way) = match name {
        Name::Local(mut local) => {
            check_file(path, &local.file)?;
            local.file = std::path::absolute(&local.file).map_err(|e| unreadable_file(path, &e))?;
            (local.connection(), local.place(), local.way().to_owned())
        }
        Name::Remote(name) if allow_remote => remote(name),
        Name::Remote(_) => {
            return Err(Error::input(
                path,
                "lies on a network",
                message!["download it first, or add `", Setting::AllowRemote, "` if you trust where it comes from"],
            ));
        }
        Name::Other => {
            return Err(Error::input(
                path,
                "is no file, but a connection to something else",
                "save the raster to a file and name that",
            ));
        }
    };
    let in_archive = ["/vsizip/", "/vsitar/"].contains(&way.as_str());
    let member = if in_archive { archive::member(path, &way, &name, &place, allow_remote)? } else { None };
    let connection = match member {
        Some(Member { connection, typed, inner }) => {
            Connection { name: connection, place, exact: typed, member: Some(inner) }
        }
        None => Connection { name, place, exact: path.to_owned(), member: None },
    };
    let unnamed = connection.member.is_none() && !matches!(connection.place, RasterPlace::File(_));
    let whole = |archive: &Path| {
        connection.name.as_os_str().as_encoded_bytes().ends_with(archive.as_os_str().as_encoded_bytes())
    };
    let whole = in_archive && matches!(&connection.place, RasterPlace::Archive(archive) if whole(archive));
    if unnamed && (whole || archive::is_tile(&lossless::text(connection.name.as_os_str()))) {
        // GDAL's driver of .hgt files would look for a tile in it, and end the process where it cannot be read.
        return Err(damaged_archive(path, &connection.place));
    }
    if !way.is_empty()
        && let Err((what, remedy)) = archive::check(&connection.name, &connection.place)
    {
        let missing = || archive::missing(path, &connection.name, &connection.place);
        let told = told_of_archive(path, &connection.place).or_else(missing);
        return Err(told.unwrap_or_else(|| Error::input(path, what, remedy)));
    }
    Ok(connection)
}

/// A file on a network, read through where it is an archive.
fn remote(name: PathBuf) -> (PathBuf, RasterPlace, String) {
    let local = Local::by_ending(&name);
    let through = ["/vsizip/", "/vsitar/"].contains(&local.way()) && !name.starts_with(local.way());
    match through {
        true => (local.connection(), RasterPlace::Remote, local.way().to_owned()),
        false => (name, RasterPlace::Remote, String::new()),
    }
}

/// What a file that is called an archive is instead.
fn told_of_archive(path: &Path, place: &RasterPlace) -> Option<Error> {
    let RasterPlace::Archive(archive) = place else { return None };
    let head = vsi::head(archive)?;
    let packed = head.starts_with(b"PK\x03") || head.starts_with(b"\x1f\x8b") || mistaken::is_tar(&head);
    let told = if packed { None } else { mistaken::what(&head, "").or_else(|| mistaken::answer(&head)) };
    told.map(|(what, remedy)| Error::input(path, what, remedy))
}

fn damaged_archive(path: &Path, place: &RasterPlace) -> Error {
    told_of_archive(path, place).or_else(|| outside::error(path, place)).unwrap_or_else(|| {
        Error::input(path, "is a damaged archive, or one in another", "copy or download it again, or unpack it first")
    })
}

/// A regular file that is there, readable and not empty.
pub(super) fn check_file(path: &Path, file: &Path) -> Result<()> {
    let found = fs::metadata(file).map_err(|e| unreadable_file(path, &e))?;
    if found.is_dir() {
        return Err(Error::input(path, "is a directory", "name the file in it"));
    }
    if !found.is_file() {
        return Err(Error::input(path, "is not a regular file", "save it to a file and name that"));
    }
    if found.len() == 0 {
        return Err(Error::input(path, "is empty (0 bytes)", "copy or download it again"));
    }
    File::open(file).map(drop).map_err(|e| unreadable_file(path, &e))
}

pub(super) fn unreadable_file(path: &Path, error: &std::io::Error) -> Error {
    match error.kind() {
        std::io::ErrorKind::NotFound => {
            Error::input(path, "there is no such file", "check the spelling and the folder")
        }
        std::io::ErrorKind::PermissionDenied => {
            Error::input(path, "may not be read", "ask its owner for permission to read it")
        }
        _ if is_out_of_files(error) => {
            Error::input(path, format!("cannot be read ({error})"), "let the program open more: `ulimit -n 1024`")
        }
        _ => Error::input(path, format!("cannot be read ({error})"), "check the file and the disk"),
    }
}

/// Whether the system lets this process, or all together, open no more files.
#[cfg(unix)]
fn is_out_of_files(error: &std::io::Error) -> bool {
    [Some(libc::EMFILE), Some(libc::ENFILE)].contains(&error.raw_os_error())
}

/// Other systems have no such limit that is met.
#[cfg(not(unix))]
fn is_out_of_files(_: &std::io::Error) -> bool {
    false
}

/// Why GDAL did not open `name`: vector data, something else in a raster's place, a fault that GDAL names, or no raster.
fn cannot_open(path: &Path, name: &Path, place: &RasterPlace, complaint: Option<String>) -> Error {
    if let Err(error) = grids::missing(path, name, place) {
        return error;
    }
    let (vector, _) = vsi::open(name, GdalOpenFlags::GDAL_OF_VECTOR, &VECTORS);
    if vector.is_some_and(|v| v.layer_count() > 0) {
        return Error::input(
            path,
            "holds points, lines or areas, not a raster of elevations",
            "give a DEM raster; contours and points become one with `gdal_grid`",
        );
    }
    if let Some((what, remedy)) = told(path, name, place) {
        return Error::input(path, what, remedy);
    }
    match complaint.filter(|words| !words.contains("not recognized as a supported file format")) {
        Some(words) if words.contains("header file") => Error::input(
            path,
            format!("cannot be opened as a raster ({})", one_line(&words, path)),
            "name the file with the samples beside it (`gdalinfo IN` says whether that is one)",
        ),
        Some(words) => Error::input(
            path,
            format!("cannot be opened as a raster ({})", one_line(&words, path)),
            "copy or download it again, or see what `gdalinfo IN` says of it",
        ),
        None => Error::input(
            path,
            "is in no raster format that hachure reads",
            "give a DEM such as GeoTIFF, .asc, .flt, .bil or .dem, perhaps made by `gdal_translate IN OUT.tif`",
        ),
    }
}

/// What the file is instead of a raster, by its first bytes and its name.
fn told(path: &Path, name: &Path, place: &RasterPlace) -> Option<mistaken::Told> {
    let file = if let RasterPlace::File(file) = place { file } else { name };
    let named = lossless::text(path.as_os_str()).to_ascii_lowercase();
    let tile = || hgt::what(path, fs::metadata(file).ok()?.len());
    let head = vsi::head(file).unwrap_or_default();
    mistaken::what(&head, &named).or_else(|| mistaken::answer(&head)).or_else(tile)
}

/// The first sentence of GDAL's words, with the file as the user named it, and no full stop.
pub(super) fn one_line(words: &str, path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_default();
    // First of all: a name may hold what ends a line or a sentence. The words are text, whatever the name is.
    let words = match absolute.to_string_lossy() {
        absolute if absolute.is_empty() => words.to_owned(),
        absolute => words.replace(&*absolute, &shown(path)),
    };
    let sentence = words.lines().next().unwrap_or_default().split(". ").next().unwrap_or_default();
    sentence.trim().trim_end_matches('.').to_owned()
}

/// Whether GDAL complains of memory, not of the file.
fn lacks_memory(words: &str) -> bool {
    let words = words.to_lowercase();
    ["cannot allocate", "out of memory", "memory allocation"].iter().any(|known| words.contains(known))
}

fn starts_with_gzip(path: &Path) -> bool {
    let mut start = [0; 2];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok_and(|()| start == [0x1f, 0x8b])
}
