//! Marks that nobody declared, units that are not metres, signs that were lost.

use std::path::{Path, PathBuf};
use std::process::Command;

use hachure::door::cli::words::line;
use hachure::geo::{ReadOptions, read, read_all};

use super::{Bands, SIDE, assumed, cured, doubt, folder, land, marked, one, same, with_steps};
use crate::common::{shared_dems, words};

/// Metres that a whole height of the land loses as f32 in a small unit.
const UNIT_METRES: f64 = 1e-3;

/// A file of the land with a mark, in the type that people write it in.
fn with_mark(mark: f64, kind: &str, path: &Path) -> PathBuf {
    let numbers = marked(mark, &land());
    match kind {
        "u16" => one(&numbers, |n| n as u16).write(path),
        "i16" => one(&numbers, |n| n as i16).write(path),
        "i32" => one(&numbers, |n| n as i32).write(path),
        "u32" => one(&numbers, |n| n as u32).write(path),
        _ => one(&numbers, |n| n as f32).write(path),
    }
}

#[test]
fn marks_are_told_and_become_voids() {
    let dir = folder();
    let path = dir.path().join("mark.tif");
    let without = marked(f64::NAN, &land());
    for (mark, kind) in [
        (-9999.0, "f32"),
        (-9999.0, "i16"),
        (9999.0, "f32"),
        (-999.0, "f32"),
        (9999.9, "f32"),
        (0.0, "i16"),
        (0.0, "f32"),
        (65535.0, "u16"),
        (65535.0, "f32"),
        (32767.0, "i16"),
        (32767.0, "i32"),
        (8888.0, "i16"),
    ] {
        with_mark(mark, kind, &path);
        let words = ["225 samples (3.5 %)", &format!("exactly {mark} "), &format!("--nodata {mark})")];
        let line = doubt(&path, &words);
        same(&cured(&path, &line, "--nodata"), &without, 0.0);
    }
    for (mark, kind) in [(-32768.0, "i16"), (2_147_483_647.0, "i32"), (4_294_967_295.0, "u32"), (-3.4028235e38, "f32")]
    {
        with_mark(mark, kind, &path);
        let line = doubt(&path, &["225 samples at or below -32767 or above 100000 m are voids"]);
        same(&cured(&path, &line, "--nodata"), &without, 0.0);
    }
}

#[test]
fn several_marks_are_one_flag() {
    let dir = folder();
    let mut numbers = marked(-9999.0, &land());
    numbers[SIDE * 50..SIDE * 52].fill(9999.0);
    let path = one(&numbers, |n| n as f32).write(&dir.path().join("two.tif"));
    let line = doubt(&path, &["exactly 9999", "exactly -9999", "all others are 400 to 1309"]);
    let void: Vec<_> = numbers.iter().map(|n| if n.abs() == 9999.0 { f64::NAN } else { *n }).collect();
    same(&cured(&path, &line, "--nodata"), &void, 0.0);
}

#[test]
fn ordinary_land_is_not_doubted() {
    let dir = folder();
    let plain = one(&land(), |n| n as f32).write(&dir.path().join("plain.tif"));
    assert_eq!(assumed(&[plain], &with_steps()), Vec::<String>::new());
    // A sea and its shore, a lake, a plateau, a drawing of two heights, a deep sea beside a mountain.
    let shapes: [fn(f64) -> f64; 5] = [
        |n| (n - 600.0).max(0.0),
        |n| n.max(500.0),
        |n| n.min(900.0),
        |n| if n > 700.0 { 1000.0 } else { 0.0 },
        |n| (n - 800.0) * 15.0,
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let numbers: Vec<_> = land().into_iter().map(shape).collect();
        let path = one(&numbers, |n| n as f32).write(&dir.path().join("shape.tif"));
        assert_eq!(assumed(&[path], &with_steps()), Vec::<String>::new(), "shape {i}");
    }
}

#[test]
fn small_units_and_feet_are_named() {
    let dir = folder();
    let path = dir.path().join("unit.tif");
    let times = |factor: f64| land().iter().map(|n| n * factor).collect::<Vec<_>>();
    for (unit, factor) in [("dm", 10.0), ("cm", 100.0), ("ft", 1.0 / 0.3048)] {
        let heights = if unit == "ft" { land().iter().map(|n| n + 2500.0).collect() } else { land() };
        let numbers: Vec<_> = heights.iter().map(|n| n * factor).collect();
        one(&numbers, |n| n as f32).write(&path);
        let all = assumed(std::slice::from_ref(&path), &with_steps());
        let line = all.last().unwrap();
        let advised = format!("--elevation-unit {unit}:");
        assert!(line.contains("above all land on Earth (8900 m)") && line.contains(&advised), "{line}");
        let from = &line[line.find(&advised).unwrap()..];
        same(&cured(&path, from, "--elevation-unit"), &heights, UNIT_METRES);
    }
    // All of them pass for marks.
    one(&times(1000.0), |n| n as i32).write(&path);
    let line = line(&read(&path, &with_steps()).unwrap_err());
    same(&cured(&path, &line, "--elevation-unit"), &land(), UNIT_METRES);
    // Both at once: each is told.
    one(&marked(65535.0, &times(10.0)), |n| n as u16).write(&path);
    let both = assumed(&[path], &with_steps());
    assert!(
        both.len() == 2 && both[0].contains("--nodata 65535") && both[1].contains("--elevation-unit dm"),
        "{both:?}"
    );
}

#[test]
fn spikes_are_told_by_number() {
    let dir = folder();
    let mut numbers = land();
    (numbers[900], numbers[2000]) = (15_000.0, 23_000.0);
    let path = one(&numbers, |n| n as f32).write(&dir.path().join("spikes.tif"));
    let line = doubt(&path, &["2 samples (under 0.1 %) of 15000 to 23000"]);
    (numbers[900], numbers[2000]) = (f64::NAN, f64::NAN);
    same(&cured(&path, &line, "--nodata"), &numbers, 0.0);
    // Too many to be named one by one.
    let below: Vec<_> = land().iter().map(|n| if *n > 1260.0 { -12_000.0 - n } else { *n }).collect();
    let path = one(&below, |n| n as f32).write(&dir.path().join("below.tif"));
    let line = doubt(&path, &["below all land on Earth (-11100 m)", "--nodata -13309..-132"]);
    let void: Vec<_> = below.iter().map(|n| if *n < 0.0 { f64::NAN } else { *n }).collect();
    same(&cured(&path, &line, "--nodata"), &void, 0.0);
}

#[test]
fn lost_signs_are_found_again() {
    let dir = folder();
    let path = dir.path().join("signs.tif");
    let coast: Vec<_> = land().iter().map(|n| n - 500.0).collect();
    one(&coast, |n| n as i16 as u16).write(&path);
    let line = doubt(&path, &["from 65436 to 65535", "look like -100 to -1"]);
    same(&cured(&path, &line, "--encoding"), &coast, 0.0);
    one(&coast, |n| n as i32 as u32).write(&path);
    let all = assumed(std::slice::from_ref(&path), &with_steps());
    same(&cured(&path, &all[1], "--encoding"), &coast, 0.0);
    one(&coast, |n| f32::from(n as i16 as u16)).write(&path);
    let line = doubt(&path, &["look like -100 to -1"]);
    same(&cured(&path, &line, "--encoding"), &coast, 0.0);
}

#[test]
fn marks_are_found_before_a_warp_and_by_file() {
    let dir = folder();
    let numbers: Vec<f32> = marked(-9999.0, &land()).iter().map(|n| *n as f32).collect();
    let degrees = [10.0, 1.0 / 2400.0, 0.0, 45.0, 0.0, -1.0 / 2400.0];
    let path =
        Bands { epsg: 4326, transform: degrees, ..Bands::new(vec![numbers.clone()]) }.write(&dir.path().join("d.tif"));
    let line = doubt(&path, &["225 samples (3.5 %) of exactly -9999"]);
    let dem = cured(&path, &line, "--nodata");
    assert!(dem.range().unwrap()[0] > 390.0 && dem.voids() > 100, "{:?}", dem.range());
    let first = one(&land(), |n| n as f32).write(&dir.path().join("first.tif"));
    let east = [500_000.0 + 30.0 * SIDE as f64, 30.0, 0.0, 5_000_000.0, 0.0, -30.0];
    let second = Bands { transform: east, ..Bands::new(vec![numbers]) }.write(&dir.path().join("second.tif"));
    let told = assumed(&[first, second.clone()], &with_steps());
    assert!(told.len() == 1 && told[0].starts_with(&format!("{}: 225 samples", second.display())), "{told:?}");
}

#[test]
fn other_planets_have_other_limits() {
    let dir = folder();
    let numbers: Vec<_> = land().iter().map(|n| (n - 400.0) * 20.0 - 5000.0).collect();
    let path = one(&numbers, |n| n as i16).write(&dir.path().join("mars.tif"));
    doubt(&path, &["above all land on Earth"]);
    let mars = gdal::spatial_ref::SpatialRef::from_proj4("+proj=eqc +a=3396190 +b=3396190 +units=m +no_defs").unwrap();
    let options = gdal::DatasetOptions { open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE, ..Default::default() };
    let mut file = gdal::Dataset::open_ex(&path, options).unwrap();
    file.set_spatial_ref(&mars).unwrap();
    file.close().unwrap();
    let told = words(read(&path, &with_steps()).unwrap().history().assumed());
    assert!(told.iter().all(|clause| !clause.contains("land on Earth")), "{told:?}");
}

#[test]
fn of_shared_terrain_crater_lake_alone_is_doubted() {
    let Some(shared) = shared_dems() else { return };
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let folders = [shared.clone(), shared.join("formats")];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let mut read = 0;
    for path in files.chain([sample]) {
        // Those that stay in their file take long to be looked at.
        let options = ReadOptions { memory: 1 << 32, ..with_steps() };
        let Ok(dem) = read_all(std::slice::from_ref(&path), &options, &|_, _| ()) else { continue };
        let doubts = ["are heights", "are voids", "8-bit", "in band", "below zero"];
        let told = words(dem.history().assumed());
        let doubted = told.iter().find(|clause| doubts.iter().any(|word| clause.contains(word)));
        let crater_lake = path.ends_with("craterlake-elev-16bit-30m.tif");
        assert_eq!(doubted.is_some(), crater_lake, "{}: {doubted:?}", path.display());
        read += 1;
    }
    assert!(read > 20, "only {read} files");
}

#[test]
fn draw_warns_of_a_dem_in_its_file_each_time() {
    let dir = folder();
    let path = with_mark(-9999.0, "f32", &dir.path().join("mark.tif"));
    for _ in 0..2 {
        let done = Command::new(env!("CARGO_BIN_EXE_hachure"))
            .args(["draw", "--memory", "16KiB", "--size", "64x48", "--level", "1", "--eye", "501200,4998000,3000"])
            .args(["--azimuth", "0", "--altitude", "-60", "--adapter", "cpu", "-o"])
            .arg(dir.path().join("page.png"))
            .arg("--json")
            .arg(dir.path().join("page.json"))
            .arg(&path)
            .env("XDG_CACHE_HOME", dir.path())
            .output()
            .unwrap();
        let words = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{words}");
        assert!(words.contains("warning: assumed that 225 samples (3.5 %) of exactly -9999 are heights"), "{words}");
        let report = std::fs::read_to_string(dir.path().join("page.json")).unwrap();
        assert!(report.contains("of exactly -9999 are heights"), "{report}");
    }
}
