//! Files of every format that we parse ourselves, changed at random: bits, numbers, keys and lists in lists.
//!
//! All of them are read in one process, which is another one, for a hang, a crash and memory are the process's. It has 2 GiB
//! more than it starts with, and ten seconds of work for each file. For longer runs:
//!
//! ```sh
//! HACHURE_FUZZ_SECONDS=3600 cargo test --release -- --exact hostile::formats::child_reads_changed_files --ignored --nocapture
//! ```
//!
//! libFuzzer, which looks for what has not been reached yet, goes the same ways: see `tests/fuzz/README.md`.

#![cfg(unix)]

#[path = "../fuzz/formats.rs"]
mod ways;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::mutants;
use crate::cli::stderr;
use crate::scenes::Random;

/// The names of the formats, which are those of the fuzz targets and of the folders of seeds; caches have none of these, for
/// their seeds are made.
const FORMATS: [&str; 9] =
    ["views", "styles", "flights", "batches", "job_lines", "manifests", "seals", "values", "caches"];

/// How long a process may read, where that is asked for; else each format is read so many times.
const SECONDS: &str = "HACHURE_FUZZ_SECONDS";
const RUNS: u64 = 400;
/// Of what is kept all is asked for each time.
const RUNS_OF_CACHES: u64 = 60;
/// Most work for a file: time that this process had, for others want the machine too.
const MOST_WORK: Duration = Duration::from_secs(10);
/// Longest time for a file that is waited for, not worked at.
const PATIENCE: Duration = Duration::from_secs(300);
/// Bytes of addresses beyond those at the start.
#[cfg(target_os = "linux")]
const MEMORY: u64 = 2 << 30;

/// What numbers become.
const NUMBERS: [&str; 16] = [
    "0",
    "-1",
    "1",
    "4294967295",
    "4294967296",
    "2147483648",
    "18446744073709551615",
    "18446744073709551616",
    "1e300",
    "-1e-300",
    "1e999",
    "nan",
    "inf",
    "9999999",
    "0x7fffffffffffffff",
    "-9223372036854775808",
];

/// Changes a text, whose bytes are changed as those of any file now and then.
fn mutate(bytes: &mut Vec<u8>, others: &[Vec<u8>], random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() as u32 + 1) as usize;
        match random.below(8) {
            0 => mutants::mutate(bytes, random),
            1 | 2 => {
                // A number, all its digits.
                let is_digit = |byte: &u8| byte.is_ascii_digit();
                let Some(begin) = bytes[at..].iter().position(is_digit).map(|begin| at + begin) else { continue };
                let end = bytes[begin..].iter().position(|byte| !is_digit(byte)).map_or(bytes.len(), |end| begin + end);
                let number = NUMBERS[random.below(NUMBERS.len() as u32) as usize];
                drop(bytes.splice(begin..end, number.bytes()));
            }
            3 => {
                let open = ["[", "{\"a\":", "[[key]]\n", "a.", "{a=", "\"", "(", "[[drawing]]\n"];
                let open = open[random.below(open.len() as u32) as usize].repeat(1 << random.below(12));
                drop(bytes.splice(at..at, open.into_bytes()));
            }
            4 | 5 => {
                // Lines, or what stands between commas, once more elsewhere: keys twice, tables twice.
                let mark = if random.below(2) == 0 { b'\n' } else { b',' };
                let pieces: Vec<Vec<u8>> = bytes.split_inclusive(|byte| *byte == mark).map(<[u8]>::to_vec).collect();
                let Some(piece) = pieces.get(random.below(pieces.len().max(1) as u32) as usize) else { continue };
                let to = random.below(pieces.len() as u32 + 1) as usize;
                *bytes = [&pieces[..to], std::slice::from_ref(piece), &pieces[to..]].concat().concat();
            }
            6 => {
                let other = &others[random.below(others.len() as u32) as usize];
                let from = random.below(other.len() as u32 + 1) as usize;
                drop(bytes.splice(at.., other[from..].iter().copied()));
            }
            _ => bytes.truncate(at),
        }
    }
}

/// Files to change.
fn seeds(format: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds").join(format);
    let mut paths: Vec<_> =
        fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).expect("a seed")).collect()
}

/// The bytes of a run.
fn changed(format: &str, seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    // Of caches bytes say what is done to which.
    if seeds.is_empty() {
        assert_eq!(format, "caches", "no seeds");
        return (0..4 + random.below(24)).map(|_| random.bits() as u8).collect();
    }
    let mut bytes = seeds[random.below(seeds.len() as u32) as usize].clone();
    mutate(&mut bytes, seeds, random);
    bytes
}

/// When a file was begun, by both clocks.
struct Began {
    at: Instant,
    work: Duration,
}

impl Began {
    fn now() -> Self {
        Self { at: Instant::now(), work: work() }
    }
}

/// What this process had of the cores.
fn work() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: it writes the two numbers of a time.
    assert_eq!(unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) }, 0);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Ends the process where a file takes too long.
fn watch(reading: &'static Mutex<Option<(String, Began)>>) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_millis(100));
            if let Some((what, began)) = reading.lock().expect("no panic").as_ref()
                && (work() - began.work > MOST_WORK || began.at.elapsed() > PATIENCE)
            {
                println!("{what} takes {:?} and {:?} of work", began.at.elapsed(), work() - began.work);
                std::process::abort();
            }
        }
    });
}

#[test]
fn changed_files_of_our_own_formats_are_read_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let test = std::env::current_exe().expect("this program");
    let child = "hostile::formats::child_reads_changed_files";
    let ran = Command::new(test)
        .args(["--exact", child, "--ignored", "--nocapture"])
        // What was being read is found there.
        .env("TMPDIR", folder.path())
        .env_remove(SECONDS)
        .output()
        .expect("a child");
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    let all = FORMATS.iter().all(|format| said.contains(&format!("{format}: ")));
    assert!(ran.status.success() && all, "{said}{}", stderr(&ran));
}

#[test]
#[ignore = "run by changed_files_of_our_own_formats_are_read_or_refused in a process of its own; by itself for long runs"]
fn child_reads_changed_files() {
    static READING: Mutex<Option<(String, Began)>> = Mutex::new(None);
    let seconds = std::env::var(SECONDS).ok().map(|seconds| seconds.parse::<u64>().expect("seconds"));
    watch(&READING);
    // Before memory is limited: what is kept of a DEM is made.
    ways::read("caches", &[0]);
    #[cfg(target_os = "linux")]
    limit_memory();
    for (kind, format) in (100..).zip(FORMATS) {
        let seeds = seeds(format);
        let share = seconds.map(|seconds| Duration::from_secs(seconds) / FORMATS.len() as u32);
        let (began, mut runs, mut slowest) = (Instant::now(), 0, Duration::ZERO);
        let most = if format == "caches" { RUNS_OF_CACHES } else { RUNS };
        while share.map_or(runs < most, |share| began.elapsed() < share) {
            let seed = kind << 32 | runs;
            let bytes = changed(format, &seeds, &mut Random::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
            let what = format!("{format}, seed {seed:#x}");
            *READING.lock().expect("no panic") = Some((what.clone(), Began::now()));
            let read = std::panic::catch_unwind(|| ways::read(format, &bytes));
            let took =
                READING.lock().expect("no panic").take().map_or(Duration::ZERO, |(_, began)| work() - began.work);
            slowest = slowest.max(took);
            assert!(read.is_ok(), "{what}: {}", String::from_utf8_lossy(&bytes).escape_debug());
            runs += 1;
        }
        println!("{format}: {runs} files in {:.0?}, the slowest in {slowest:.0?}", began.elapsed());
    }
}

/// Lets the process have so much memory more.
#[cfg(target_os = "linux")]
fn limit_memory() {
    let pages = fs::read_to_string("/proc/self/statm").expect("memory");
    let pages: u64 = pages.split(' ').next().and_then(|pages| pages.parse().ok()).expect("pages");
    let most = pages * 4096 + MEMORY;
    let limit = libc::rlimit { rlim_cur: most, rlim_max: most };
    // SAFETY: it reads two numbers.
    assert_eq!(unsafe { libc::setrlimit(libc::RLIMIT_AS, &limit) }, 0);
}

#[test]
fn a_changed_text_is_another_one() {
    let mut random = Random::new(6);
    let seeds = seeds("batches");
    let changed = (0..100).filter(|_| !seeds.contains(&changed("batches", &seeds, &mut random)));
    assert!(changed.count() > 90, "mutants that are none");
}
