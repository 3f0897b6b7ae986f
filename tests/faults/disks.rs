//! Disks that are full and folders that go while something is drawn into them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{DRAW, ended, files, undisturbed};
use crate::cli::Place;

/// A disk of so many bytes in a folder; none where not everybody may mount one.
struct SmallDisk(PathBuf);

impl SmallDisk {
    fn new(folder: PathBuf, bytes: u64) -> Option<Self> {
        fs::create_dir_all(&folder).expect("a folder");
        let size = format!("size={bytes}");
        let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", &size, "none"]).arg(&folder).status();
        let disk = mounted.is_ok_and(|status| status.success()).then_some(Self(folder));
        if disk.is_none() {
            println!("SKIP small disks can be made by root alone");
        }
        disk
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let unmounted = Command::new("umount").arg(&self.0).status();
        assert!(std::thread::panicking() || unmounted.is_ok_and(|status| status.success()));
    }
}

#[test]
fn a_full_disk_is_told_by_its_file_and_holds_no_half_of_one() {
    let place = Place::new();
    let Some(disk) = SmallDisk::new(place.path("out"), 8192) else { return };
    let full = ["cannot be written (No space left on device", "; make room there or choose another output path"];
    let list = "[[drawing]]\ndem = \"hill.asc\"\noutput = \"out/b.svg\"\nsize = \"320x200\"\nhachures = \"tone\"\n";
    fs::write(place.path("list.toml"), list.replace("tone", "slope")).expect("a list");
    for run in [&DRAW[..], &["batch", "list.toml"], &["generate", "dem", "-o", "out/large.tif", "--size", "400x400"]] {
        let output = place.run(run);
        let [whole, half] = files(&disk.0);
        let pictures: Vec<_> = whole.iter().map(|(name, _)| name).filter(|name| !name.ends_with(".json")).collect();
        assert!(pictures.is_empty() && half.is_empty(), "{run:?} left {pictures:?}, {}", half.len());
        ended(&output, 1, &["error: "], run[0]);
        ended(&output, 1, if run[0] == "draw" { &full } else { &[] }, run[0]);
        whole.iter().for_each(|(name, _)| fs::remove_file(disk.0.join(name)).expect("a manifest"));
    }
}

#[test]
fn a_cache_on_a_full_disk_costs_a_warning_alone() {
    let place = Place::new();
    let draw = [&DRAW[..], &["--memory", "1KiB", "--cache", "kept"]].concat();
    fs::create_dir(place.path("out")).expect("a folder");
    let whole = undisturbed(&place, &draw);
    fs::remove_dir_all(place.path("kept")).expect("a cache");
    fs::create_dir(place.path("out")).expect("a folder");
    let Some(disk) = SmallDisk::new(place.path("kept"), 8192) else { return };
    let output = place.run(&draw);
    ended(&output, 0, &["warning: "], "a cache");
    assert!(files(&place.path("out")) == [whole, Vec::new()], "another picture");
    let [_, half] = files(&disk.0);
    assert!(half.iter().all(|(name, _)| !name.contains(".hachure-")), "half-made files in the cache");
}

/// Starts it and waits until something of this name is there.
fn begun(place: &Place, run: &[&str], folder: &Path, is_begun: impl Fn(&str) -> bool) -> Child {
    let mut child = place.command(run).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let began = Instant::now();
    let names = || fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    while !names().any(|name| is_begun(&name.to_string_lossy())) {
        assert!(child.try_wait().expect("a child").is_none(), "{run:?} ended before anything was there");
        assert!(began.elapsed() < Duration::from_secs(60), "{run:?} begins nothing");
        sleep(Duration::from_millis(1));
    }
    child
}

fn removed(folder: &Path) {
    // Between two files of a folder that is being removed another may be made.
    while fs::remove_dir_all(folder).is_err() && folder.exists() {}
}

fn end(child: Child) -> Output {
    child.wait_with_output().expect("it ends")
}

#[test]
fn a_folder_that_is_removed_is_told_and_a_cache_that_is_removed_is_not_missed() {
    let place = Place::new();
    let draw = [&DRAW[..], &["--memory", "1KiB", "--cache", "kept"]].concat();
    fs::create_dir(place.path("out")).expect("a folder");
    let whole = undisturbed(&place, &draw);
    fs::create_dir(place.path("out")).expect("a folder");
    let child = begun(&place, &draw, &place.path("out"), |_| true);
    removed(&place.path("out"));
    ended(&end(child), 1, &["error: out/", "cannot be written (", "; choose another output path"], "the folder goes");
    removed(&place.path("kept"));
    fs::create_dir(place.path("out")).expect("a folder");
    let child = begun(&place, &draw, &place.path("kept"), |_| true);
    removed(&place.path("kept"));
    ended(&end(child), 0, &[], "the cache goes");
    assert!(files(&place.path("out")) == [whole, Vec::new()], "another picture");
    let compare = ["compare", "hill.asc", "-o", "report", "--size", "64x48", "--levels", "1", "--methods", "walk"];
    let child = begun(&place, &compare, &place.path(""), |name| name == "report");
    removed(&place.path("report"));
    ended(&end(child), 1, &["error: report"], "the folder of a report goes");
}
