//! Looks into a VRT, and into what GDAL opens beside any raster, before GDAL does.
//!
//! A VRT is XML that names other files, and GDAL opens whatever it names: addresses, files anywhere, code. Each name in
//! it must be a raster in the VRT's own folder, links followed; a VRT that it names is looked into in turn, and so are
//! VRTs that stand beside a file as its mask (`.msk`) or overview (`.ovr`) and the metadata in `.aux.xml`. Where
//! remote files are allowed names may lead anywhere, but never to code, connections or formats off the list. Cost: one parse
//! of each VRT, and for each file it names a look at its head. Not handled: VRTs in archives, steps that process
//! (`VRTProcessedDataset`), options for drivers: they are refused; and VRTs beside a file on a network.

use std::collections::HashSet;
use std::path::{Component, Path, PathBuf};

use super::archive;
use super::name::{Name, RasterPlace, names_remote};
use super::xml::{self, XmlText};
use crate::error::{Error, Message, Result, Setting, shown};
use crate::message;

/// VRTs in VRTs at most: nobody needs more, and recursion stays small.
const MAX_DEPTH: usize = 8;

/// What can stand beside a file and is opened by GDAL as a raster of any format.
const BESIDE: [&str; 4] = [".msk", ".MSK", ".ovr", ".OVR"];

/// Elements whose text is a raster that GDAL opens.
const SOURCES: [&str; 3] = ["sourcefilename", "sourcedataset", "dempath"];

/// Items of metadata whose text is a raster that GDAL may open.
const LINKS: [&str; 4] = ["x_dataset", "y_dataset", "overview_file", "filename"];

/// Kinds of datasets and bands in a VRT whose elements are known.
const KINDS: [&str; 7] = [
    "VRTWarpedDataset",
    "VRTPansharpenedDataset",
    "VRTSourcedRasterBand",
    "VRTDerivedRasterBand",
    "VRTRawRasterBand",
    "VRTWarpedRasterBand",
    "VRTPansharpenedRasterBand",
];

const PLAIN: &str = "make a plain raster of it where you trust it, with `gdal_translate IN OUT.tif`";
const RUN: &str = "make a plain raster of it where you trust that code, with \
                   `gdal_translate --config GDAL_VRT_ENABLE_PYTHON YES IN OUT.tif`";

/// What an inspection finds.
pub(super) struct Inspected {
    /// Whether the first file is a VRT.
    pub is_vrt: bool,
    /// It and all rasters that VRTs name, as GDAL calls them; some more than once.
    pub rasters: Vec<(PathBuf, RasterPlace)>,
}

/// Looks into what GDAL would open for `connection`. `path` is what the user calls it.
pub(super) fn inspect(path: &Path, connection: &Path, place: &RasterPlace, allow_remote: bool) -> Result<Inspected> {
    let (first, folder) = match place {
        RasterPlace::File(file) => (followed(file), followed(file).parent().map(Path::to_owned)),
        RasterPlace::Archive(file) => (connection.to_owned(), followed(file).parent().map(Path::to_owned)),
        RasterPlace::Remote => (connection.to_owned(), None),
    };
    let mut inspection =
        Inspection { path, first, folder, allow_remote, open: Vec::new(), seen: HashSet::new(), rasters: Vec::new() };
    inspection.raster(connection, place)?;
    Ok(Inspected { is_vrt: xml::is_vrt(connection), rasters: inspection.rasters })
}

struct Inspection<'a> {
    path: &'a Path,
    /// What is inspected, links followed.
    first: PathBuf,
    /// Where all must lie: its folder. None on a network.
    folder: Option<PathBuf>,
    allow_remote: bool,
    /// The VRTs around the present place, outermost first.
    open: Vec<PathBuf>,
    /// The VRTs that need not be looked into again.
    seen: HashSet<PathBuf>,
    /// The rasters so far.
    rasters: Vec<(PathBuf, RasterPlace)>,
}

impl Inspection<'_> {
    /// A raster and what stands beside it.
    fn raster(&mut self, connection: &Path, place: &RasterPlace) -> Result<()> {
        self.rasters.push((connection.to_owned(), place.clone()));
        self.vrt(connection, place)?;
        let (beside, archive) = match place {
            RasterPlace::File(file) => (file.as_path(), false),
            RasterPlace::Archive(_) => (connection, true),
            // Each look would be a request, mostly in vain.
            RasterPlace::Remote => return Ok(()),
        };
        for ending in BESIDE {
            let name = with_ending(beside, ending);
            let place = if archive { place.clone() } else { RasterPlace::File(name.clone()) };
            self.vrt(&name, &place)?;
        }
        let auxiliary = with_ending(beside, ".aux.xml");
        // None there, or none that GDAL can parse either, is no danger.
        let entries = xml::entries(&auxiliary).unwrap_or_default();
        entries.iter().filter(|entry| entry.metadata).try_for_each(|entry| self.stays_here(entry, &auxiliary))
    }

    /// What a VRT names, and what that names; nothing for other files.
    fn vrt(&mut self, connection: &Path, place: &RasterPlace) -> Result<()> {
        if !xml::is_vrt(connection) {
            return Ok(());
        }
        let name = match place {
            // GDAL, too, follows links before it looks for what a VRT names.
            RasterPlace::File(file) => followed(file),
            RasterPlace::Archive(_) | RasterPlace::Remote => connection.to_owned(),
        };
        if matches!(place, RasterPlace::Archive(_)) {
            return Err(self.refused(&name, "is a VRT in an archive", "unpack it with the files it names"));
        }
        if self.open.contains(&name) {
            return Err(self.refused(&name, "is a VRT that names itself", "copy or download it again"));
        }
        if self.open.len() == MAX_DEPTH {
            return Err(self.refused(&name, format!("is a VRT in VRTs, more than {MAX_DEPTH} deep"), PLAIN));
        }
        if !self.seen.insert(name.clone()) {
            return Ok(());
        }
        let entries = xml::entries(connection).map_err(|words| {
            let words = words.map(|words| format!(" ({})", words.lines().next().unwrap_or_default()));
            self.refused(&name, format!("is a damaged VRT{}", words.unwrap_or_default()), "copy or download it again")
        })?;
        self.open.push(name.clone());
        entries.iter().try_for_each(|entry| self.entry(entry, &name, matches!(place, RasterPlace::Remote)))?;
        self.open.pop();
        Ok(())
    }

    /// One text of `vrt`.
    fn entry(&mut self, entry: &XmlText, vrt: &Path, remote: bool) -> Result<()> {
        let text = &entry.text;
        match entry.name.as_str() {
            name if SOURCES.contains(&name) => match self.source(entry, vrt, remote)? {
                (name, RasterPlace::Remote) => self.raster(&name, &RasterPlace::Remote),
                (name, _) if !entry.raw && !xml::is_raster(&name) => Err(self.refused(
                    vrt,
                    format!("names {text:?}, which is in no raster format that hachure reads"),
                    "convert that with `gdal_translate IN OUT.tif` and name the result",
                )),
                (name, place) => self.raster(&name, &place),
            },
            "pixelfunctionlanguage" if !text.trim().eq_ignore_ascii_case("c") => {
                Err(self.refused(vrt, format!("holds code ({}), which is never run", text.escape_debug()), RUN))
            }
            "subclass" if !KINDS.contains(&text.as_str()) => {
                Err(self.refused(vrt, format!("is a VRT of a kind that is not read ({})", text.escape_debug()), PLAIN))
            }
            // A choice of overview, as `gdalwarp` leaves it, is the one option that leads nowhere for certain.
            "ooi" if entry.key.as_deref() != Some("OVERVIEW_LEVEL") => {
                Err(self.refused(vrt, "is a VRT with options for GDAL's drivers, which are not read", PLAIN))
            }
            _ => self.stays_here(entry, vrt),
        }
    }

    /// The raster that `entry` of `vrt` names: GDAL's name of it and its place.
    fn source(&self, entry: &XmlText, vrt: &Path, remote: bool) -> Result<(PathBuf, RasterPlace)> {
        let text = &entry.text;
        let names = |what: &str, remedy: &str| Err(self.refused(vrt, format!("names {text:?}, {what}"), remedy));
        let relative = entry.relative.as_deref() == Some("1");
        if !relative && !matches!(entry.relative.as_deref(), None | Some("0")) {
            return names("with a relativeToVRT that is neither 0 nor 1", "copy or download it again");
        }
        let mut local = match Name::of(text) {
            Name::Remote(_) if !self.allow_remote => return Err(self.away(entry, vrt)),
            Name::Remote(name) if name != Path::new(text) => {
                return names("which GDAL knows by another name", &format!("write `{}` there", shown(&name)));
            }
            Name::Remote(name) => return Ok((name, RasterPlace::Remote)),
            Name::Other => return names("which is no file", PLAIN),
            Name::Local(local) => local,
        };
        if remote {
            let Some(name) = local.beside(vrt).filter(|_| relative) else {
                return names("which does not lie beside it on the network", "download it with the files it names");
            };
            return Ok((name, RasterPlace::Remote));
        }
        // In an archive's name GDAL takes a way as it stands, whatever is said of it.
        if relative && !local.archive {
            local.file = vrt.parent().unwrap_or(Path::new("")).join(&local.file);
        }
        // A way up through a link leads elsewhere by its text than on the disk: not even inside the folder.
        if !self.allow_remote && local.file.components().any(|part| part == Component::ParentDir) {
            return Err(self.outside(entry, vrt));
        }
        if !local.file.is_absolute() {
            return names("which means another file in each working folder", "write it with relativeToVRT=\"1\" there");
        }
        let Ok(file) = local.file.canonicalize() else {
            let what = format!("is damaged or cut short: {text:?}, which it names, is not there");
            return Err(self.refused(vrt, what, "copy or download it again"));
        };
        if !self.allow_remote && !self.folder.as_ref().is_some_and(|folder| file.starts_with(folder)) {
            return Err(self.outside(entry, vrt));
        }
        if !file.is_file() {
            return names("which is no file", "name the raster file itself");
        }
        let (connection, place) = (local.connection(), local.place());
        let readable = match place {
            RasterPlace::Archive(_) => archive::check(&connection, &place),
            _ => archive::check_tile(&file, &place),
        };
        match readable {
            Ok(()) => Ok((connection, place)),
            Err((what, remedy)) => names(&format!("which {what}"), &remedy),
        }
    }

    /// A text that is no source by its element, but that GDAL might come to open.
    fn stays_here(&self, entry: &XmlText, at: &Path) -> Result<()> {
        let text = &entry.text;
        let away = if entry.metadata {
            // An address may stand inside, as in `NETCDF:"http://…":lon`.
            let is_link = entry.key.as_ref().is_some_and(|key| LINKS.contains(&key.to_ascii_lowercase().as_str()));
            is_link && text.char_indices().any(|(place, _)| names_remote(&text[place..]))
        } else {
            names_remote(text.trim_start())
        };
        if away && !self.allow_remote { Err(self.away(entry, at)) } else { Ok(()) }
    }

    fn away(&self, entry: &XmlText, at: &Path) -> Error {
        let what = format!("names {:?}, which lies on a network", entry.text);
        self.refused(at, what, message!["download it first, or add `", Setting::AllowRemote, "` if you trust it"])
    }

    fn outside(&self, entry: &XmlText, at: &Path) -> Error {
        let what = format!("names {:?}, which lies outside its folder", entry.text);
        let remedy = message!["move both into one folder, or add `", Setting::AllowRemote, "` if you trust the file"];
        self.refused(at, what, remedy)
    }

    /// The error for what stands in `at`.
    fn refused(&self, at: &Path, what: impl Into<String>, remedy: impl Into<Message>) -> Error {
        let what = what.into();
        if at == self.first {
            return Error::input(self.path, what, remedy);
        }
        let part = self.folder.as_ref().and_then(|folder| at.strip_prefix(folder).ok()).unwrap_or(at);
        Error::input(self.path, format!("its part {part:?} {what}"), remedy)
    }
}

/// `file` without links.
fn followed(file: &Path) -> PathBuf {
    file.canonicalize().unwrap_or_else(|_| file.to_owned())
}

fn with_ending(file: &Path, ending: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(ending);
    name.into()
}
