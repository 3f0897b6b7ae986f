//! Caches that something else wrote, cut short or put in their place.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Yard, each, typed, words, write_hill};
use crate::scenes::Random;

const RUNS: u64 = 8;

/// Files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

/// Does harm to a file of the cache; says what.
fn harm(file: &Path, other: &Path, random: &mut Random) -> &'static str {
    let mut bytes = fs::read(file).expect("a file");
    let at = random.below(bytes.len() as u32) as usize;
    fs::remove_file(file).expect("removed");
    match random.below(8) {
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
    let original = Yard::new();
    write_hill(&original.path("hill.tif"), 300);
    let run = words("draw hill.tif -o out.png --mask out-mask.png --size 120x80 --memory 512KiB");
    let first = original.run(&run);
    first.check("the first run");
    let right = fs::read(original.path("out-mask.png")).expect("a mask");
    each(4, RUNS, |seed, random| {
        let yard = Yard::new();
        fs::copy(original.path("hill.tif"), yard.path("hill.tif")).expect("a copy");
        let before = words("draw hill.tif -o out.png --size 16x16 --memory 512KiB");
        assert_eq!(yard.run(&before).code, Some(0));
        let kept = files(&yard.path("cache"));
        assert!(!kept.is_empty(), "{seed:#x}: nothing is kept of a DEM in its file");
        let outside = yard.path("outside");
        fs::write(&outside, b"not ours").expect("written");
        let done = harm(&kept[random.below(kept.len() as u32) as usize], &outside, random);
        let what = format!("seed {seed:#x}, {} with a cache file {done}", typed(&run));
        for _ in 0..2 {
            let ended = yard.run(&run);
            ended.check(&what);
            assert_eq!(ended.code, Some(0), "{what}: {}", ended.said);
            assert!(fs::read(yard.path("out-mask.png")).expect("a mask") == right, "{what}: another picture");
        }
        assert_eq!(fs::read(&outside).expect("still there"), b"not ours", "{what}: written through a link");
        yard.check_files(&what);
    });
}
