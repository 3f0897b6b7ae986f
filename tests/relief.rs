//! Lines on the land: where water goes, where it parts, and the lines along both.

mod coarse;
mod costs;
mod flow;
mod forms;
mod kept;
mod laid;
mod orders;
mod stranger;
mod told;

use std::path::Path;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read};
use hachure::relief::SurfaceLine;

use crate::scenes::Random;

/// Metres of a cell here.
const CELL: f64 = 10.0;

/// A DEM of a height, metres, at every column and row.
fn dem([columns, rows]: [usize; 2], height: impl Fn(DVec2) -> f64) -> Dem {
    let at = |i: usize| DVec2::new((i % columns) as f64, (i / columns) as f64);
    let heights = (0..columns * rows).map(|i| height(at(i)) as f32).collect();
    Dem::from_heights(columns, DVec2::splat(CELL), DVec2::ZERO, heights)
}

/// The sample of this repository.
fn sample() -> Dem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    read(&path, &ReadOptions::default()).expect("the sample")
}

/// Rough land with a sea, voids and flats.
fn rough(seed: u64, size: [usize; 2]) -> Dem {
    let mut random = Random::new(seed);
    let mut noise = || random.below(1 << 16) as f64 / 65536.0;
    let [columns, rows] = size;
    let heights = (0..columns * rows).map(|i| {
        let (c, r) = ((i % columns) as f64, (i / columns) as f64);
        let wave = 60.0 * ((c / 9.0).sin() + (r / 7.0).cos()) + 20.0 * noise();
        match noise() {
            void if void < 0.01 => f32::NAN,
            // Steps of 10 m: flats.
            flat if flat < 0.5 && c > 40.0 => ((wave / 10.0).round() * 10.0) as f32,
            _ => wave.max(0.0) as f32,
        }
    });
    Dem::from_heights(columns, DVec2::new(CELL, 1.3 * CELL), DVec2::ZERO, heights.collect())
}

/// How far a place lies from a line, cells.
fn distance(line: &SurfaceLine, place: DVec2) -> f64 {
    let to = |pair: &[hachure::relief::SurfacePoint]| {
        let [a, b] = [pair[0].at, pair[1].at];
        let along = b - a;
        let share = ((place - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        place.distance(a + along * share)
    };
    line.points.windows(2).map(to).fold(f64::INFINITY, f64::min)
}

/// Cells from the first to the last point along a line.
fn length(line: &SurfaceLine) -> f64 {
    line.points.windows(2).map(|pair| pair[0].at.distance(pair[1].at)).sum()
}
