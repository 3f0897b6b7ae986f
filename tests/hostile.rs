//! Hostile runs, seeded: files with bytes changed, flags nobody meant, signals at any moment, caches that something else
//! wrote. Whatever comes, the program ends in time with a promised exit code and one line, and leaves whole files or none.
//!
//! The same runs every time; a failure prints its seed and what was run. Each run is a process of its own, so that a crash
//! is seen as one.

mod caches;
mod flags;
mod formats;
mod mutants;
mod signals;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use tempfile::TempDir;

use crate::cli::stderr;
use crate::common::shader_cache;
use crate::scenes::Random;

/// A run that lasts longer hangs; a hundred times as long as those that do not, for machines with other work.
const PATIENCE: Duration = Duration::from_secs(30);
/// Exit codes that are promised: done, failed, wrong usage, try again.
const CODES: [i32; 4] = [0, 1, 2, 75];

/// What came of a run.
struct Ended {
    code: Option<i32>,
    said: String,
}

/// A folder in which the program runs, with a cache of its own.
struct Yard(TempDir);

impl Yard {
    fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The program as typed here.
    fn command(&self, arguments: &[String]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.current_dir(self.0.path()).args(arguments).env("XDG_CACHE_HOME", self.path("cache"));
        command.envs(shader_cache());
        command.env("RUST_BACKTRACE", "0").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Runs it to its end, which must come in time.
    fn run(&self, arguments: &[String]) -> Ended {
        let mut child = self.command(arguments).spawn().expect("hachure runs");
        let began = Instant::now();
        while child.try_wait().expect("a status").is_none() {
            if began.elapsed() > PATIENCE {
                let _ = child.kill();
                panic!("{} hangs", typed(arguments));
            }
            sleep(Duration::from_millis(2));
        }
        let output = child.wait_with_output().expect("a status");
        Ended { code: output.status.code(), said: stderr(&output) }
    }

    /// Fails where a temporary file is left, or a picture is there that is not whole.
    fn check_files(&self, what: &str) {
        for entry in fs::read_dir(self.0.path()).expect("the folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            assert!(!name.starts_with(".hachure-"), "{what} left {name}");
            if name.starts_with("out") && name.ends_with(".png") {
                assert!(image::open(&path).is_ok(), "{what}: {name} is not whole");
            }
        }
    }
}

impl Ended {
    /// Fails where the end is not one that is promised.
    fn check(&self, what: &str) {
        let Self { code, said } = self;
        assert!(code.is_some_and(|code| CODES.contains(&code)), "{what} ended with {code:?}: {said}");
        assert!(!said.contains("panicked"), "{what}: {said}");
        let lines = || said.lines().filter(|line| !line.starts_with("warning: "));
        match code {
            Some(0) => assert_eq!(lines().count(), 0, "{what} is done and says {said}"),
            Some(1) => {
                assert_eq!(lines().count(), 1, "{what} fails and says {said}");
                assert!(lines().all(|line| line.starts_with("error: ") && line.contains("; ")), "{what}: {said}");
            }
            _ => assert!(code == &Some(75) || said.starts_with("error: "), "{what}: {said}"),
        }
    }
}

/// The words of a command line.
fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// A command line for messages.
fn typed(arguments: &[String]) -> String {
    format!("hachure {}", arguments.join(" "))
}

/// One of `of`.
fn pick<'a, T: ?Sized>(random: &mut Random, of: &[&'a T]) -> &'a T {
    of[random.below(of.len() as u32) as usize]
}

/// Does so many runs, each with random numbers of its own, on every core.
fn each(kind: u64, runs: u64, run: impl Fn(u64, &mut Random) + Sync) {
    (1..=runs).into_par_iter().for_each(|i| {
        let seed = kind << 32 | i;
        run(seed, &mut Random::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    });
}

fn write_hill(path: &Path, size: usize) {
    let height = |c: usize, r: usize| {
        let (x, y) = (c as f64 / size as f64 - 0.5, r as f64 / size as f64 - 0.5);
        (400.0 + 300.0 * (-20.0 * (x * x + y * y)).exp() + 20.0 * (31.0 * x).sin() * (23.0 * y).cos()) as f32
    };
    let row = |r| (0..size).map(|c| height(c, r)).collect();
    hachure::geo::write(path, [size; 2], 30.0, row, &|_| ()).expect("a DEM");
}
