//! Signals at any moment of a run.

#![cfg(unix)]

use std::fs;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use super::{Ended, Yard, each, pick, typed, words, write_hill};
use crate::cli::stderr;

const RUNS: u64 = 7;
/// A run lasts about as long, ms.
const LONGEST: f64 = 700.0;

#[test]
fn signals_leave_whole_files_or_none() {
    let original = Yard::new();
    write_hill(&original.path("hill.tif"), 120);
    each(3, RUNS, |seed, random| {
        let yard = Yard::new();
        fs::copy(original.path("hill.tif"), yard.path("hill.tif")).expect("a copy");
        let memory = pick(random, &["", " --memory 16KiB"]);
        let run =
            words(&format!("draw hill.tif -o out.png --mask out-mask.png --size 240x180 --json report.json{memory}"));
        let signal = pick(random, &["-TERM", "-INT", "-HUP"]);
        let wait = random.between(0.0, LONGEST);
        let what = format!("seed {seed:#x}, {} {signal} after {wait:.0} ms", typed(&run));
        let child = yard.command(&run).spawn().expect("hachure runs");
        sleep(Duration::from_secs_f64(wait / 1e3));
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).output().expect("kill runs");
        let output = child.wait_with_output().expect("a status");
        let ended = Ended { code: output.status.code(), said: stderr(&output) };
        let written = ["out.png", "out-mask.png", "report.json"].map(|name| yard.path(name).exists());
        // Before the program's own first line the system ends it.
        let early = ended.code.is_none() && written == [false; 3];
        let ends = early || [Some(75), Some(0)].contains(&ended.code);
        assert!(ends || !sent.status.success(), "{what}: {:?}, {}", ended.code, ended.said);
        yard.check_files(&what);
        assert!(ended.code != Some(0) || written == [true; 3], "{what}: {written:?}");
        // What was kept, or half kept, of the DEM is no hindrance.
        let again = yard.run(&run);
        again.check(&what);
        assert_eq!(again.code, Some(0), "{what}, then again: {}", again.said);
    });
}
