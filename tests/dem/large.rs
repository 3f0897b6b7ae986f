//! A large grid comes in quickly and in little memory.

use std::process::Command;
use std::time::Instant;

use hachure::dem::{ReadOptions, read};
use hachure::report::memory::peak;
use hachure::surface::Surface;

use crate::common::shared_dems;
use crate::tolerances::READ_BYTES_BESIDE;

/// Bytes a sample of a DEM and its normals: height, a bit of validity, two gradients.
const DEM_BYTES: f64 = 12.125;

#[test]
#[cfg(target_os = "linux")]
fn korea_is_read_in_little_memory() {
    if shared_dems().is_none() {
        return;
    }
    // Alone in a process, for the peak is the process's.
    let test = std::env::current_exe().unwrap();
    let child = "dem::large::child_reads_korea";
    let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success(), "{said}");
    let line = said.lines().find(|line| line.starts_with("korea: ")).unwrap_or_else(|| panic!("no figures: {said}"));
    println!("{line}");
    let beside: f64 = line.split(", ").nth(2).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(beside <= READ_BYTES_BESIDE, "{line}");
}

#[test]
#[ignore = "run by korea_is_read_in_little_memory in a process of its own"]
#[cfg(target_os = "linux")]
fn child_reads_korea() {
    let shared = shared_dems().unwrap();
    let before = peak().unwrap();
    let start = Instant::now();
    let dem = read(shared.join("korea_srtm3_4400.tif"), &ReadOptions::default()).unwrap();
    let read_s = start.elapsed().as_secs_f64();
    let surface = Surface::new(dem);
    let seconds = start.elapsed().as_secs_f64();
    let samples = (surface.dem().columns() * surface.dem().rows()) as f64;
    let beside = (peak().unwrap() - before) as f64 / samples - DEM_BYTES;
    println!(
        "korea: {samples} samples, {seconds:.2} s to normals ({read_s:.2} s to heights), {beside:.2} bytes a sample beside grid and normals"
    );
}
