//! A large grid comes in quickly and in little memory.

use std::process::Command;
use std::time::Instant;

use hachure::cache::Cache;
use hachure::dem::fractal;
use hachure::door::measure::memory::peak;
use hachure::geo::{ReadOptions, read, write};
use hachure::surface::Surface;

use super::{Raster, folder, with_steps};
use crate::common::shared_dems;
use crate::tolerances::{FILED_MIB_BESIDE, READ_BYTES_BESIDE, SMOOTH_BYTES_BESIDE};

/// Bytes a sample of a DEM and its normals: height, a bit of validity, two gradients.
const DEM_BYTES: f64 = 12.125;

#[test]
#[cfg(target_os = "linux")]
fn korea_is_read_in_little_memory() {
    if shared_dems().is_none() {
        return;
    }
    let line = line_of("dem::large::child_reads_korea", "korea: ");
    let [kept, smoothed] = [1, 9].map(|word| line.split(' ').nth(word).unwrap().parse::<f64>().unwrap());
    assert!(kept <= READ_BYTES_BESIDE && smoothed <= SMOOTH_BYTES_BESIDE, "{line}");
}

/// The line that a test prints which runs alone in a process, for the peak is the process's.
#[cfg(target_os = "linux")]
fn line_of(child: &str, start: &str) -> String {
    let test = std::env::current_exe().unwrap();
    let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success(), "{said}");
    let line = said.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("no figures: {said}"));
    println!("{line}");
    line.to_owned()
}

#[test]
#[ignore = "run by korea_is_read_in_little_memory in a process of its own"]
#[cfg(target_os = "linux")]
fn child_reads_korea() {
    let shared = shared_dems().unwrap();
    let read = |options: &ReadOptions| {
        hachure::door::measure::memory::reset_peak();
        let before = peak().unwrap();
        let start = Instant::now();
        let dem = read(shared.join("korea_srtm3_4400.tif"), options).unwrap();
        let read_s = start.elapsed().as_secs_f64();
        let surface = Surface::new(dem);
        let seconds = start.elapsed().as_secs_f64();
        let samples = (surface.dem().columns() * surface.dem().rows()) as f64;
        let beside = (peak().unwrap() - before) as f64 / samples - DEM_BYTES;
        println!(
            "{samples} samples, {seconds:.2} s to normals ({read_s:.2} s to heights), {beside:.2} bytes a sample beside \
             grid and normals"
        );
        beside
    };
    let [kept, smoothed] = [with_steps(), ReadOptions::default()].each_ref().map(read);
    println!("korea: {kept:.2} bytes a sample beside grid and normals, {smoothed:.2} while steps are smoothed");
}

#[test]
fn relief_that_is_made_has_these_bits() {
    let rows = [0, 1, 5000].map(|r| fractal::row(9000, r));
    let bits = |row: &Vec<f32>| [0, 777, 8999].map(|c| row[c]);
    let known = [[1812.75, 1830.875, 1403.75], [1811.4375, 1831.0625, 1405.625], [1716.4375, 2704.75, 1925.3125]];
    assert_eq!(rows.each_ref().map(bits), known);
    let range = |row: &Vec<f32>| row.iter().fold([f32::MAX, f32::MIN], |[a, b], h| [a.min(*h), b.max(*h)]);
    assert!(rows.iter().all(|row| range(row)[1] - range(row)[0] > 1000.0), "no relief");
}

/// MiB that a DEM may take while it is filed; held, this one takes 100 MiB for its heights alone.
const FILED_MIB: u64 = 16;

#[test]
#[cfg(target_os = "linux")]
fn a_filed_dem_stays_within_its_budget() {
    let line = line_of("dem::large::child_reads_a_filed_dem", "filed: ");
    let [filed, held] = [1, 3].map(|word| line.split(' ').nth(word).unwrap().parse::<u64>().unwrap());
    assert!(filed <= FILED_MIB + FILED_MIB_BESIDE, "{line}");
    assert!(held > FILED_MIB + FILED_MIB_BESIDE, "a held one must be seen: {line}");
    let line = line_of("dem::large::child_smooths_strips", "smoothed: ");
    let smoothed = line.split(' ').nth(1).unwrap().parse::<u64>().unwrap();
    assert!(smoothed <= FILED_MIB + FILED_MIB_BESIDE, "{line}");
}

#[test]
#[ignore = "run by a_filed_dem_stays_within_its_budget in a process of its own"]
#[cfg(target_os = "linux")]
fn child_reads_a_filed_dem() {
    let dir = folder();
    let path = dir.path().join("large.tif");
    let row = |r: usize| (0..5200).map(|c| ((c * 7 + r * 3) % 1000) as f32).collect();
    write(&path, [5200, 5200], fractal::CELL, row, &|_| ()).unwrap();
    let grown = |memory: u64| {
        hachure::door::measure::memory::reset_peak();
        let before = peak().unwrap();
        let surface = Surface::new(read(&path, &ReadOptions { memory, ..with_steps() }).unwrap());
        assert_eq!(surface.dem().survey(&|_| ()).unwrap().range, Some([0.0, 999.0]));
        let rows: usize = surface.bands(2).map(|band| band.unwrap().rows.len()).sum();
        assert_eq!(rows, 5200);
        (peak().unwrap() - before) >> 20
    };
    let filed = grown(FILED_MIB << 20);
    println!("filed: {filed} MiB {} MiB held", grown(1 << 30));
}

#[test]
#[ignore = "run by a_filed_dem_stays_within_its_budget in a process of its own"]
#[cfg(target_os = "linux")]
fn child_smooths_strips() {
    let dir = folder();
    // Strips as wide as the file.
    let values = (0..9000 * 900).map(|i| ((i % 9000) / 7 + i / 9000 * 3) as i16).collect();
    let path = Raster::<i16>::new(9000, values).write("GTiff", &dir.path().join("strips.tif"));
    hachure::door::measure::memory::reset_peak();
    let before = peak().unwrap();
    let options = ReadOptions {
        memory: FILED_MIB << 20,
        cache: Cache::in_folder(dir.path().join("cache")),
        ..Default::default()
    };
    let dem = read(&path, &options).unwrap();
    assert!(dem.is_filed() && dem.history().steps() == [1.0]);
    let patches = dem.survey(&|_| ()).unwrap().patches;
    assert_eq!(patches, 2 * 8999 * 899);
    println!("smoothed: {} MiB", (peak().unwrap() - before) >> 20);
}
