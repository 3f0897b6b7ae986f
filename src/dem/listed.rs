//! Every file on the disk that a raster is made of.
//!
//! Those are the file itself (for one in an archive or a container: the archive, the container), what GDAL lists of it
//! (`GDALGetFileList`), the same for every raster that VRTs name, and what stands beside each of them by its name and
//! that GDAL may read: headers, world files, projections, metadata, masks, overviews. Cost: a listing of each folder, one
//! opening of each raster in a VRT; where a key is asked for, 128 KiB of each file. Not handled: files that lie in a folder that
//! may be entered but not listed, unless GDAL lists them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::{CStr, OsString};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use gdal::{Dataset, DatasetOptions, GdalOpenFlags};
use rayon::prelude::*;
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use super::formats::FORMATS;
use super::name::{Name, Place};
use super::source::heard;

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
/// A folder that has not changed for so long has another time when it changes again.
const SETTLED: Duration = Duration::from_secs(2);
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
}

impl State {
    fn now(path: &Path) -> Option<Self> {
        let found = fs::metadata(path).ok()?;
        Some(Self { bytes: found.len(), modified: found.modified().ok() })
    }
}

impl Listed {
    /// Of an open dataset, and of the `rasters` that an inspection found: it and those that VRTs name, as GDAL calls them.
    pub fn new(dataset: &Dataset, rasters: &[(PathBuf, Place)]) -> Self {
        let mut files: BTreeSet<PathBuf> = file_list(dataset).iter().filter_map(on_disk).collect();
        // The first raster is the dataset; its parts are opened for their lists alone.
        for (name, _) in rasters.iter().skip(1).filter(|(_, place)| !matches!(place, Place::Remote)) {
            let open_flags = GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_READONLY;
            let options = DatasetOptions { open_flags, allowed_drivers: Some(&FORMATS), ..Default::default() };
            if let (Ok(part), _) = heard(|| Dataset::open_ex(name, options)) {
                files.extend(file_list(&part).iter().filter_map(on_disk));
            }
        }
        let of_rasters = rasters.iter().filter_map(|(_, place)| match place {
            Place::File(file) | Place::Archive(file) => Some(file.clone()),
            Place::Remote => None,
        });
        files.extend(of_rasters);
        files.extend(beside(&files));
        // The time of a folder changes with whatever is written there.
        files.retain(|file| !file.is_dir());
        let remote = rasters.iter().any(|(_, place)| matches!(place, Place::Remote));
        Self { files: files.into_iter().map(|file| (file.clone(), State::now(&file))).collect(), remote }
    }

    /// Their paths.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.keys().map(PathBuf::as_path)
    }

    /// Whether one of them is another than when it was opened, or gone: a look at each, none inside.
    pub fn have_changed(&self) -> bool {
        self.files.iter().any(|(file, state)| State::now(file) != *state)
    }

    /// Takes what tells their state from any other into a hash: real path, size, time and both ends of each. `None` where a
    /// part is not on the disk or cannot be read.
    pub fn hash(&self, hash: &mut Xxh3) -> Option<()> {
        if self.remote {
            return None;
        }
        let of = |(file, state): (&PathBuf, &Option<State>)| -> io::Result<String> {
            let Some(State { bytes, modified, .. }) = state else { return Ok(format!("{file:?} is not there\n")) };
            let real = file.canonicalize()?;
            Ok(format!("{real:?} {bytes} {modified:?} {:032x}\n", ends(file)?))
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
fn on_disk(name: &OsString) -> Option<PathBuf> {
    let path = Path::new(name);
    if path.exists() {
        return std::path::absolute(path).ok();
    }
    match Name::of(name.to_str()?) {
        Name::Local(local) => std::path::absolute(local.file).ok().filter(|file| file.exists()),
        Name::Remote(_) | Name::Other => None,
    }
}

/// The names that GDAL lists for a dataset.
fn file_list(dataset: &Dataset) -> Vec<OsString> {
    let mut names = Vec::new();
    // SAFETY: the handle is that of an open dataset; the list ends in a null pointer and is freed once, after its last use.
    unsafe {
        let list = gdal_sys::GDALGetFileList(dataset.c_dataset());
        let mut at = list;
        while !at.is_null() && !(*at).is_null() {
            names.push(os_string(CStr::from_ptr(*at)));
            at = at.add(1);
        }
        gdal_sys::CSLDestroy(list);
    }
    names
}

#[cfg(unix)]
fn os_string(name: &CStr) -> OsString {
    use std::os::unix::ffi::OsStrExt;
    std::ffi::OsStr::from_bytes(name.to_bytes()).to_owned()
}

#[cfg(not(unix))]
fn os_string(name: &CStr) -> OsString {
    name.to_string_lossy().into_owned().into()
}

/// What stands beside files by their names, links of both the file and its folder followed and not.
fn beside(files: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
    let mut folders: HashMap<PathBuf, Arc<Names>> = HashMap::new();
    let mut found = Vec::new();
    let followed = files.iter().filter_map(|file| file.canonicalize().ok());
    for file in files.iter().cloned().chain(followed) {
        let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else { continue };
        let names = folders.entry(folder.to_owned()).or_insert_with(|| names_in(folder));
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

/// The names in a folder by what they are in lower case.
type Names = BTreeMap<String, Vec<OsString>>;

/// The names in a folder. Many files of one folder are opened one after the other: the last listing serves while the
/// folder has not changed, nor had just changed then, for its time has coarse steps.
fn names_in(folder: &Path) -> Arc<Names> {
    static LAST: Mutex<Option<(PathBuf, SystemTime, Arc<Names>)>> = Mutex::new(None);
    let changed = fs::metadata(folder).and_then(|found| found.modified()).ok();
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, _, names)) = last.as_ref().filter(|(of, then, _)| of == folder && Some(*then) == changed) {
        return names.clone();
    }
    let names = Arc::new(listing(folder));
    let settled = changed.filter(|changed| changed.elapsed().is_ok_and(|since| since > SETTLED));
    *last = settled.map(|changed| (folder.to_owned(), changed, names.clone()));
    names
}

fn listing(folder: &Path) -> Names {
    let mut names = Names::new();
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
