//! A stranger's channels: `topotoolbox`, which geomorphologists use.
//!
//! It gets the smoothed heights, fills and carves them in its own way, and routes flats by distance from their rims. What differs:
//! ways over flats and lakes, which no height tells, and water at the edge, which leaves here where the land falls outwards
//! and there runs along it.

use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use hachure::geo::{ReadOptions, read};
use hachure::relief::Relief;

use crate::common::shared_dems;
use crate::tolerances::STRANGERS_CHANNELS;

/// Samples that make a channel.
const CELLS: u32 = 100;

/// Reads heights of each DEM as rows of f32 and writes the samples above each as the same.
const SCRIPT: &str = "
import sys, numpy, topotoolbox
for k in range(1, len(sys.argv), 5):
    columns, rows, cell, heights, areas = sys.argv[k:k + 5]
    dem = topotoolbox.GridObject()
    dem.z = numpy.fromfile(heights, dtype=numpy.float32).reshape(int(rows), int(columns))
    dem.cellsize = float(cell)
    topotoolbox.FlowObject(dem).flow_accumulation().z.astype(numpy.float32).tofile(areas)
";

/// DEMs, and which part of the third: west, south, east, north.
const DEMS: [(&str, Option<[f64; 4]>); 3] = [
    ("west_temple_50m.tif", None),
    ("yosemite_utm11n_30m.tif", None),
    ("sthelens_utm10n_10m.tif", Some([557_000.0, 5_112_000.0, 565_000.0, 5_120_000.0])),
];

/// Python with it, as the set-up of the tests installs it. `None`, with a line that says so, where there is none: the test that
/// called is skipped.
fn python() -> Option<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/topotoolbox/bin/python3");
    let has = |python: &Path| {
        let ran = Command::new(python).args(["-c", "import topotoolbox"]).output();
        ran.is_ok_and(|ran| ran.status.success())
    };
    let found = [own, PathBuf::from("python3")].into_iter().find(|python| has(python));
    if found.is_none() {
        // Past the capture of the test harness, which shows nothing of a test that passes.
        let _ = writeln!(stderr(), "SKIP {}: install topotoolbox", thread::current().name().unwrap_or("test"));
    }
    found
}

/// Share of `ours` with one of `theirs` within a sample.
fn near(ours: &[bool], theirs: &[bool], columns: usize) -> f64 {
    let rows = ours.len() / columns;
    let is_near = |i: usize| {
        let (c, r) = (i % columns, i / columns);
        let mut rows = r.saturating_sub(1)..(r + 2).min(rows);
        rows.any(|r| theirs[r * columns + c.saturating_sub(1)..r * columns + (c + 2).min(columns)].contains(&true))
    };
    let all: Vec<usize> = (0..ours.len()).filter(|i| ours[*i]).collect();
    all.iter().filter(|i| is_near(**i)).count() as f64 / all.len() as f64
}

#[test]
fn channels_are_where_a_stranger_has_them() {
    let (Some(python), Some(dems)) = (python(), shared_dems()) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |what: &str, name: &str| folder.path().join(format!("{what}-{name}"));
    let mut command = Command::new(&python);
    command.args(["-c", SCRIPT]);
    let ours = DEMS.map(|(name, crop)| {
        let dem = read(dems.join(name), &ReadOptions { crop, ..ReadOptions::default() }).expect("a DEM");
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let frame = relief.flow().frame();
        let smoothed: Vec<f32> = frame.indices().map(|i| relief.grid().smoothed[i]).collect();
        std::fs::write(at("heights", name), bytemuck::cast_slice(&smoothed)).expect("heights");
        command.args([frame.size[0].to_string(), frame.size[1].to_string(), frame.cell.x.to_string()]);
        command.args([at("heights", name), at("areas", name)]);
        let ours: Vec<bool> = frame.indices().map(|i| relief.area().cells[i] >= CELLS).collect();
        (name, ours, dem.columns())
    });
    let ran = command.output().expect("python runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    for (name, ours, columns) in ours {
        let bytes = std::fs::read(at("areas", name)).expect("areas");
        let theirs = bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
        let theirs: Vec<bool> = theirs.map(|area| area >= CELLS as f32).collect();
        let shares = [near(&ours, &theirs, columns), near(&theirs, &ours, columns)];
        println!("{name}: {shares:.3?} of ours and theirs");
        assert!(shares.iter().all(|share| *share >= STRANGERS_CHANNELS), "{name}: {shares:?}");
        // Two samples to the side they are not.
        let moved: Vec<bool> = (0..ours.len()).map(|i| i >= 2 && ours[i - 2]).collect();
        assert!(near(&moved, &theirs, columns) < STRANGERS_CHANNELS, "{name}: the check must see two samples");
    }
}
