//! Every file on the disk that a raster is made of.
//!
//! Those are the file itself (for one in an archive or a container: the archive, the container), what GDAL lists of it
//! (`GDALGetFileList`), the same for every raster that VRTs name, and what stands beside each of them by its name and
//! that GDAL may read: headers, world files, projections, metadata, masks, overviews. Cost: a listing of each folder, one
//! opening of each raster in a VRT; where a key is asked for, 128 KiB of each file. Not handled: files that lie in a folder that
//! may be entered but not listed, unless GDAL lists them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsString;
use std::fs::{self, File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use gdal::{Dataset, GdalOpenFlags};
use rayon::prelude::*;
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use super::formats::FORMATS;
use super::name::{Name, RasterPlace};
use super::{lossless, vsi};

/// Endings of files beside a raster, behind its name or in the place of its own ending.
const BESIDE: [&str; 33] = [
    "aux.xml",
    "aux",
    "msk",
    "ovr",
    "rrd",
    "rde",
    "ige",
    "hdr",
    "prj",
    "wld",
    "stx",
    "clr",
    "qpj",
    "tab",
    "map",
    "rdc",
    "doc",
    "ref",
    "sgrd",
    "mgrd",
    "smp",
    "avl",
    "blw",
    "gfw",
    "bqw",
    "rpb",
    "imd",
    "met",
    "xml",
    "vat.dbf",
    "msk.ovr",
    "ovr.msk",
    "msk.aux.xml",
];
/// Bytes at each end of a file that are hashed.
const END: u64 = 1 << 16;

/// The files of one raster, as they were when it was opened.
#[derive(Debug, Clone)]
pub(super) struct Listed {
    files: BTreeMap<PathBuf, Option<State>>,
    /// Whether a part of it lies on a network.
    remote: bool,
}

/// What tells one state of a file from another without reading it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Device and inode.
    node: [u64; 2],
    /// Links to it, mode, owner and group.
    about: [u64; 4],
    /// Seconds and nanoseconds of the last change of any kind, which nobody can put back.
    changed: [i64; 2],
}

impl State {
    fn of(found: &Metadata) -> Self {
        #[cfg(unix)]
        let (node, about, changed) = {
            use std::os::unix::fs::MetadataExt;
            let about = [found.nlink(), found.mode().into(), found.uid().into(), found.gid().into()];
            ([found.dev(), found.ino()], about, [found.ctime(), found.ctime_nsec()])
        };
        #[cfg(not(unix))]
        let (node, about, changed) = ([0; 2], [0; 4], [0; 2]);
        Self { bytes: found.len(), modified: found.modified().ok(), node, about, changed }
    }

    /// Whether it is the state of other bytes than `other`; one more name for a file, another owner or mode change none.
    fn is_of_others(&self, other: &Self) -> bool {
        let changed = if self.about == other.about { other.changed } else { self.changed };
        Self { changed, about: self.about, ..*other } != *self
    }

    fn now(path: &Path) -> Option<Self> {
        fs::metadata(path).ok().map(|found| Self::of(&found))
    }
}

impl Listed {
    /// Of an open dataset, and of the `rasters` that an inspection found: it and those that VRTs name, as GDAL calls them.
    pub(super) fn new(dataset: &Dataset, rasters: &[(PathBuf, RasterPlace)], folders: &mut Folders) -> Self {
        let mut files: BTreeSet<PathBuf> = vsi::files_of(dataset).iter().filter_map(on_disk).collect();
        // The first raster is the dataset; its parts are opened for their lists alone.
        for (name, _) in rasters.iter().skip(1).filter(|(_, place)| !matches!(place, RasterPlace::Remote)) {
            let flags = GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY;
            if let (Some(part), _) = vsi::open(name, flags, &FORMATS) {
                files.extend(vsi::files_of(&part).iter().filter_map(on_disk));
            }
        }
        let of_rasters = rasters.iter().filter_map(|(_, place)| match place {
            RasterPlace::File(file) | RasterPlace::Archive(file) => Some(file.clone()),
            RasterPlace::Remote => None,
        });
        files.extend(of_rasters);
        files.extend(folders.beside(&files));
        // The time of a folder changes with whatever is written there.
        files.retain(|file| !file.is_dir());
        let remote = rasters.iter().any(|(_, place)| matches!(place, RasterPlace::Remote));
        Self { files: files.into_iter().map(|file| (file.clone(), State::now(&file))).collect(), remote }
    }

    /// Their paths.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.keys().map(PathBuf::as_path)
    }

    /// The first of them that is another than when it was opened, or gone: a look at each, none inside.
    pub(super) fn changed(&self) -> Option<&Path> {
        let changed = |(file, then): &(&PathBuf, &Option<State>)| match (then, State::now(file)) {
            (Some(then), Some(now)) => then.is_of_others(&now),
            (then, now) => then.is_some() != now.is_some(),
        };
        self.files.iter().find(changed).map(|(file, _)| file.as_path())
    }

    /// Takes what tells their state from any other into a hash: real path, size, times and both ends of each. `None` where a
    /// part is not on the disk or cannot be read.
    pub(super) fn hash(&self, hash: &mut Xxh3) -> Option<()> {
        if self.remote {
            return None;
        }
        let of = |(file, state): (&PathBuf, &Option<State>)| -> io::Result<String> {
            let Some(State { bytes, modified, changed, .. }) = state else {
                return Ok(format!("{file:?} is not there\n"));
            };
            let real = file.canonicalize()?;
            Ok(format!("{real:?} {bytes} {modified:?} {changed:?} {:032x}\n", ends(file)?))
        };
        let states: Vec<_> = self.files.par_iter().map(of).collect();
        states.into_iter().try_for_each(|state| state.map(|state| hash.update(state.as_bytes())).ok())
    }
}

/// Hash of the first and the last bytes of a file.
fn ends(path: &Path) -> io::Result<u128> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut bytes = Vec::new();
    file.by_ref().take(END).read_to_end(&mut bytes)?;
    file.seek(SeekFrom::Start(length.saturating_sub(END).max(END.min(length))))?;
    file.take(END).read_to_end(&mut bytes)?;
    Ok(xxh3_128(&bytes))
}

/// The file, container or archive on the disk that GDAL means by `name`.
fn on_disk(name: &PathBuf) -> Option<PathBuf> {
    if name.exists() {
        return std::path::absolute(name).ok();
    }
    match Name::of(&lossless::text(name.as_os_str())) {
        Name::Local(local) => std::path::absolute(local.file).ok().filter(|file| file.exists()),
        Name::Remote(_) | Name::Other => None,
    }
}

/// What stands in folders, each listed once: names by what they are in lower case.
#[derive(Default)]
pub(super) struct Folders(HashMap<PathBuf, BTreeMap<String, Vec<OsString>>>);

impl Folders {
    /// What stands beside files by their names, links of both the file and its folder followed and not.
    fn beside(&mut self, files: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let followed = files.iter().filter_map(|file| file.canonicalize().ok());
        for file in files.iter().cloned().chain(followed) {
            let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else { continue };
            let names = self.0.entry(folder.to_owned()).or_insert_with(|| names_in(folder));
            let name = name.to_string_lossy().to_lowercase();
            for start in stems(&name) {
                let start = format!("{start}.");
                let of_start = names.range(start.clone()..).take_while(|(lower, _)| lower.starts_with(&start));
                let beside = of_start.filter(|(lower, _)| is_beside(&lower[start.len()..]));
                found.extend(beside.flat_map(|(_, names)| names.iter().map(|name| folder.join(name))));
            }
        }
        found
    }
}

/// The names in a folder by what they are in lower case.
fn names_in(folder: &Path) -> BTreeMap<String, Vec<OsString>> {
    let mut names: BTreeMap<String, Vec<OsString>> = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        names.entry(name.to_string_lossy().to_lowercase()).or_default().push(name);
    }
    names
}

/// A name, and what is left of it as its endings go: `a.b.c`, `a.b`, `a`.
fn stems(name: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(Some(name), |name| {
        name.rsplit_once('.').map(|(stem, _)| stem).filter(|stem| !stem.is_empty())
    })
}

/// Whether a file of this ending may be read with the raster that it stands beside.
fn is_beside(ending: &str) -> bool {
    // World files: .tfw, .tifw, .jgw, .pgw …
    let is_world = (3..=5).contains(&ending.len()) && ending.ends_with('w') && !ending.contains('.');
    is_world || BESIDE.contains(&ending)
}
