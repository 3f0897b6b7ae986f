//! Slope lines that are kept from one process to the next are those that were made.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;

use hachure::cache::Cache;
use hachure::door::relief::slope::{SlopeBlock, SlopeRules, Slopes};
use xxhash_rust::xxh3::xxh3_64;

use super::{RULES, Scene, blocks, sample};

/// Least room that is asked for, cells.
const ROOM: f64 = 1.5;

/// Bytes of a kept file's tail: name, length of the text, hash, mark.
const TAIL: usize = 40;

/// A scene's lines by a cache.
fn slopes(scene: &Scene, cache: &Cache, rules: SlopeRules) -> Slopes {
    let slopes = Slopes::new(scene.surface.clone(), 1.0, rules, &scene.stops, Some(&scene.water)).expect("slopes");
    slopes.kept_in(cache, scene.surface.dem()).expect("a cache")
}

/// A kept file whose last point has other room: what is kept, a hash of that, a text, and a tail that tells the text's length.
fn with_other_room(file: &[u8]) -> Vec<u8> {
    let (before, tail) = file.split_at(file.len() - TAIL);
    let text = u64::from_le_bytes(tail[16..24].try_into().expect("8 bytes")) as usize;
    let end = before.len() - text - size_of::<u64>();
    let mut other = file.to_vec();
    other[end - 1] ^= 1;
    let hash = xxh3_64(&other[..end]).to_le_bytes();
    other[end..end + hash.len()].copy_from_slice(&hash);
    other
}

#[test]
fn lines_are_found_again_as_they_were_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let (scene, cache) = (sample(), Cache::in_folder(folder.path().to_owned()));
    let draw = |rules: SlopeRules| -> Vec<SlopeBlock> {
        let blocks = blocks(&slopes(&scene, &cache, rules), &|_| ROOM * scene.unit());
        blocks.iter().map(|block| SlopeBlock::clone(block)).collect()
    };
    // A file that is made anew is another one.
    let files = || -> Vec<(PathBuf, u64)> {
        let files = fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("an entry").path());
        let files =
            files.filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("slopes-")));
        files.map(|path| (path.clone(), fs::metadata(path).expect("a file").ino())).collect()
    };
    let made = draw(RULES);
    assert!(
        made == blocks(&scene.slopes(), &|_| ROOM * scene.unit())
            .iter()
            .map(|block| SlopeBlock::clone(block))
            .collect::<Vec<_>>()
    );
    let [(path, file)] = &files()[..] else { panic!("not one file") };
    assert!(draw(RULES) == made);
    assert_eq!(files(), [(path.clone(), *file)], "the file stays as it is");
    let whole = fs::read(path).expect("a file");
    // Found, not made: a file that says otherwise is believed, if it is whole.
    fs::write(path, with_other_room(&whole)).expect("a file");
    let found = draw(RULES);
    assert!(found != made && found.len() == made.len(), "lines were made that were there");
    // Negative control: a byte is another one; the lines are made anew, and the file.
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 1;
    fs::write(path, &damaged).expect("a file");
    assert!(draw(RULES) == made);
    assert!(fs::read(path).expect("a file") == whole, "the damage is left");
    // Other rules have lines of their own.
    assert!(draw(SlopeRules { min_slope: 8.0, ..RULES }) != made);
    assert_eq!(files().len(), 2);
}
