//! Whether all that the processes of a sequence were to make is there: their manifests together, held against the files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::manifest::Entry;
use super::{Frames, Made, Manifest, name};
use crate::error::{Error, Result};

/// What the manifests of a folder say together, and what of it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// One of the manifests.
    pub manifest: Manifest,
    /// How many there are.
    pub manifests: usize,
    /// Jobs whose files are all there.
    pub whole: Frames,
    /// Jobs that a manifest names, of which a file is not there, or made of something else.
    pub broken: Frames,
    /// Jobs that no manifest names.
    pub unknown: Frames,
    /// Shards without a manifest, where the folder knows of some of as many.
    pub absent: Vec<[u32; 2]>,
    /// Of each job the first picture of its drawing, from the folder; `None` where one has none.
    pub pictures: Option<Vec<PathBuf>>,
    /// Why jobs failed that are not whole.
    pub failed: Vec<(u32, String)>,
}

impl Merged {
    /// Of a folder.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no manifest, one cannot be read, or they are not of one sequence in one look.
    pub fn of(folder: &Path) -> Result<Self> {
        let manifests = Manifest::all(folder)?;
        let Some(first) = manifests.first().cloned() else {
            return Err(Error::input(folder, "no manifest is in it", "give a folder into which frames were drawn"));
        };
        if let Some(other) =
            manifests.iter().find(|other| (&other.sequence, &other.job) != (&first.sequence, &first.job))
        {
            let what = match other.sequence == first.sequence {
                true => format!("{} is of another look than {}", other.file_name(), first.file_name()),
                false => format!("{} is of {}, {} of {}", other.file_name(), other.of, first.file_name(), first.of),
            };
            return Err(Error::input(folder, what, "remove the manifest of what is not wanted"));
        }
        let mut entries: BTreeMap<u32, &Entry> = BTreeMap::new();
        for entry in manifests.iter().flat_map(|manifest| &manifest.jobs) {
            let known = entries.entry(entry.n).or_insert(entry);
            // What failed once may have been made by another.
            if known.failed.is_some() && entry.failed.is_none() {
                *known = entry;
            }
        }
        let is_whole = |entry: &Entry| {
            let made =
                |(path, text): &(PathBuf, String)| Some(Made { path: folder.join(path), name: name::parse(text)? });
            entry.files.iter().all(|file| made(file).is_some_and(|made| made.is_there()))
        };
        let (whole, broken): (Vec<&Entry>, Vec<&Entry>) = entries.values().partition(|entry| is_whole(entry));
        Ok(Self {
            manifests: manifests.len(),
            unknown: (0..first.count).filter(|n| !entries.contains_key(n)).collect(),
            absent: absent(&manifests),
            failed: broken.iter().filter_map(|entry| Some((entry.n, entry.failed.clone()?))).collect(),
            whole: whole.iter().map(|entry| entry.n).collect(),
            broken: broken.iter().map(|entry| entry.n).collect(),
            pictures: entries.values().map(|entry| entry.picture()).collect(),
            manifest: first,
        })
    }

    /// Whether nothing is missing.
    pub fn is_whole(&self) -> bool {
        self.whole.numbers().len() == self.manifest.count as usize
    }
}

/// Of each number of shards that some manifest has, the shards without one.
fn absent(manifests: &[Manifest]) -> Vec<[u32; 2]> {
    let shards: BTreeSet<[u32; 2]> = manifests.iter().map(|manifest| manifest.shard).collect();
    let counts: BTreeSet<u32> = shards.iter().map(|[_, count]| *count).collect();
    let all = counts.iter().flat_map(|count| (0..*count).map(move |index| [index, *count]));
    all.filter(|shard| !shards.contains(shard)).collect()
}
