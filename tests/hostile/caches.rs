//! Caches that something else wrote, cut short or put in their place.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Yard, typed, words, write_hill};
use crate::scenes::Random;

/// Files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

/// Ways of doing harm.
const HARMS: usize = 8;

/// Does harm to a file of the cache in one of these ways; says what.
fn harm(way: usize, file: &Path, other: &Path, random: &mut Random) -> &'static str {
    let mut bytes = fs::read(file).expect("a file");
    let at = random.below(bytes.len() as u32) as usize;
    fs::remove_file(file).expect("removed");
    match way {
        0 => {
            bytes.truncate(at);
            fs::write(file, bytes).expect("written");
            "cut short"
        }
        1 | 2 => {
            bytes[at] ^= 1 << random.below(8);
            fs::write(file, bytes).expect("written");
            "a bit flipped"
        }
        3 => {
            fs::write(file, []).expect("written");
            "empty"
        }
        4 => {
            bytes.extend_from_slice(&[7; 100]);
            fs::write(file, bytes).expect("written");
            "longer"
        }
        5 => {
            fs::create_dir(file).expect("a folder");
            "a folder"
        }
        #[cfg(unix)]
        6 => {
            let made = std::process::Command::new("mkfifo").arg(file).status().expect("mkfifo runs");
            assert!(made.success());
            "a FIFO"
        }
        #[cfg(unix)]
        7 => {
            std::os::unix::fs::symlink(other, file).expect("a link");
            "a link"
        }
        _ => "gone",
    }
}

#[test]
fn harm_to_a_cache_changes_no_picture() {
    let yard = Yard::new();
    write_hill(&yard.path("hill.tif"), 100);
    let run = words("draw hill.tif -o out.png --mask out-mask.png --size 120x80 --memory 16KiB");
    let draw = |what: &str| {
        let ended = yard.run(&run);
        ended.check(what);
        assert_eq!(ended.code, Some(0), "{what}: {}", ended.said);
        ["out.png", "out-mask.png"].map(|name| fs::read(yard.path(name)).expect(name))
    };
    let right = draw("the first run");
    let kept = files(&yard.path("cache"));
    assert!(kept.len() > 3, "little is kept of a DEM in its file: {kept:?}");
    let outside = yard.path("outside");
    fs::write(&outside, b"not ours").expect("written");
    let mut random = Random::new(4);
    // Each harm is to another file than that before, which is read here as it was made anew.
    for (way, file) in (0..HARMS).zip(kept.iter().cycle()) {
        let done = harm(way, file, &outside, &mut random);
        let what = format!("{} with {} {done}", typed(&run), file.display());
        assert!(draw(&what) == right, "{what}: another picture");
        assert_eq!(fs::read(&outside).expect("still there"), b"not ours", "{what}: written through a link");
        yard.check_files(&what);
        // What is no file stays, to be removed by its owner.
        if file.is_symlink() || !file.is_file() {
            fs::remove_file(file).or_else(|_| fs::remove_dir(file)).expect("gone");
        }
    }
    assert!(draw("the last run") == right, "another picture at last");
}
