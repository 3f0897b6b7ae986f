//! Faults of the machine: each ends in time, in one line with a remedy, by a promised exit code, and leaves whole files or none.
//!
//! | fault | here | elsewhere |
//! |---|---|---|
//! | the disk is full | `disks` | `fly`, `georeferenced`, `limits`; standard output: `cli`, `shell` |
//! | the folder is removed | `disks` | `fly` |
//! | SIGTERM, SIGKILL at every stage | `ends` | `cli`, `compare`, `fly`, `serve`, `farm`, `hostile` |
//! | memory ends, which a software driver draws in | | `limits` |
//! | the device is lost | `devices` | answers of a server: `serve` |
//! | the driver hangs | `devices`, `pace` | |

mod devices;
mod disks;
mod ends;
mod pace;

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::cli::{Place, stderr};

/// What `hachure draw` is asked for here.
const DRAW: [&str; 10] =
    ["draw", "hill.asc", "-o", "out/a.png", "-o", "out/a.svg", "--mask", "out/m.png", "--size", "320x200"];

/// Files below a folder, by their paths, with their bytes; those without a final name apart.
fn files(folder: &Path) -> [Vec<(String, Vec<u8>)>; 2] {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            match path.is_dir() {
                true => open.push(path),
                // What a process that is killed has half made may go meanwhile.
                false => found.extend(fs::read(&path).ok().map(|bytes| (path, bytes))),
            }
        }
    }
    let name = |path: &Path| path.strip_prefix(folder).expect("below").to_string_lossy().into_owned();
    let mut named: Vec<_> = found.into_iter().map(|(path, bytes)| (name(&path), bytes)).collect();
    named.sort();
    let (half, whole) = named.into_iter().partition(|(name, _)| name.starts_with('.') || name.contains("/."));
    [whole, half]
}

/// What it drew into `out`, undisturbed.
fn undisturbed(place: &Place, arguments: &[&str]) -> Vec<(String, Vec<u8>)> {
    let output = place.run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let [whole, half] = files(&place.path("out"));
    assert!(!whole.is_empty() && half.is_empty());
    fs::remove_dir_all(place.path("out")).expect("it is there");
    whole
}

/// Fails unless it ended with `code` in one line of these words.
fn ended(output: &Output, code: i32, words: &[&str], about: &str) {
    let said = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{about}: {said}");
    let errors: Vec<_> = said.lines().filter(|line| !line.starts_with("warning: ")).collect();
    assert_eq!(errors.len(), usize::from(code != 0), "{about}: {said}");
    words.iter().for_each(|words| assert!(said.contains(words), "{about} should say `{words}`: {said}"));
}
