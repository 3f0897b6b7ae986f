//! Whether all that the processes of a sequence were to make is there: their manifests together, held against the files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::manifest::ManifestEntry;
use super::{Frames, JobFile, Manifest, Shard, name};
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
    /// Shards without a manifest that would hold some of those, where the folder knows of some of as many.
    pub absent: Vec<Shard>,
    /// Of each job the first picture of its drawing, from the folder; `None` where one has none.
    pub pictures: Option<Vec<PathBuf>>,
    /// Why jobs failed that are not whole.
    pub failed: Vec<(u32, String)>,
}

impl Merged {
    /// Of each sequence in a folder, in the order of their manifests.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no manifest, one cannot be read, or those of a sequence are not of one look.
    pub fn all(folder: &Path) -> Result<Vec<Self>> {
        let mut sequences: Vec<Vec<Manifest>> = Vec::new();
        for manifest in Manifest::all(folder)? {
            match sequences.iter_mut().find(|others| others[0].sequence == manifest.sequence) {
                Some(others) => others.push(manifest),
                None => sequences.push(vec![manifest]),
            }
        }
        if sequences.is_empty() {
            return Err(Error::input(folder, "no manifest is in it", "give a folder into which frames were drawn"));
        }
        sequences.iter().map(|manifests| Self::of(folder, manifests)).collect()
    }

    fn of(folder: &Path, manifests: &[Manifest]) -> Result<Self> {
        let first = manifests[0].clone();
        if let Some(other) = manifests.iter().find(|other| other.job != first.job) {
            let what = format!("{} is of another look than {}", other.file_name(), first.file_name());
            return Err(Error::input(folder, what, "remove the manifest of the look that is not wanted"));
        }
        let mut entries: BTreeMap<u32, &ManifestEntry> = BTreeMap::new();
        for entry in manifests.iter().flat_map(|manifest| &manifest.jobs) {
            let known = entries.entry(entry.n).or_insert(entry);
            // What failed once may have been made by another.
            if known.failed.is_some() && entry.failed.is_none() {
                *known = entry;
            }
        }
        let is_whole = |entry: &ManifestEntry| {
            let made =
                |(path, text): &(PathBuf, String)| Some(JobFile { path: folder.join(path), name: name::parse(text)? });
            entry.files.iter().all(|file| made(file).is_some_and(|made| made.is_there()))
        };
        let (whole, broken): (Vec<&ManifestEntry>, Vec<&ManifestEntry>) =
            entries.values().partition(|entry| is_whole(entry));
        Ok(Self {
            manifests: manifests.len(),
            unknown: (0..first.count).filter(|n| !entries.contains_key(n)).collect(),
            absent: absent(manifests, first.count, &entries),
            failed: broken.iter().filter_map(|entry| Some((entry.n, entry.failed.clone()?))).collect(),
            whole: whole.iter().map(|entry| entry.n).collect(),
            broken: broken.iter().map(|entry| entry.n).collect(),
            pictures: entries.values().map(|entry| entry.picture()).collect(),
            manifest: first,
        })
    }

    /// How many jobs are not whole.
    pub fn missing(&self) -> usize {
        (self.manifest.count as usize).saturating_sub(self.whole.numbers().len())
    }
}

/// Shards without a manifest that would hold a job of which no manifest knows, where one of as many shards of the same jobs has
/// one.
fn absent(manifests: &[Manifest], count: u32, known: &BTreeMap<u32, &ManifestEntry>) -> Vec<Shard> {
    let mut absent = BTreeSet::new();
    for manifest in manifests {
        let of = manifest.shard[1];
        let all = manifest.part.as_ref().and_then(|part| part.parse().ok()).unwrap_or_else(|| Frames::first(count));
        let is_there = |shard: Shard| {
            let same = |other: &&Manifest| other.part == manifest.part && other.shard == [shard.index, shard.count];
            manifests.iter().find(same).is_some()
        };
        let lacks = |shard: Shard| shard.of(&all).numbers().iter().any(|n| !known.contains_key(n));
        let shards = (0..of).map(|index| Shard { index, count: of });
        absent
            .extend(shards.filter(|shard| !is_there(*shard) && lacks(*shard)).map(|shard| [shard.count, shard.index]));
    }
    absent.into_iter().map(|[count, index]| Shard { index, count }).collect()
}
