//! Peaks: cones of known prominence, ties, voids and the sea; the same as by a slow search; two that everyone knows.

use std::process::Command;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read};
use hachure::relief::{Base, Peak, peaks};

use crate::common::shared_dems;

fn dem(columns: usize, heights: Vec<f32>) -> Dem {
    Dem::from_heights(columns, DVec2::splat(10.0), DVec2::ZERO, heights)
}

/// 200 columns and 120 rows.
fn land(height: impl Fn(DVec2) -> f64) -> Dem {
    dem(200, (0..200 * 120).map(|i| height(DVec2::new(f64::from(i % 200), f64::from(i / 200))) as f32).collect())
}

/// A cone that falls by 5 m a cell.
fn cone(place: DVec2, [c, r, height]: [f64; 3]) -> f64 {
    height - 5.0 * place.distance(DVec2::new(c, r))
}

fn all(dem: &Dem) -> Vec<Peak> {
    peaks(dem, usize::MAX / 4, 1.0).expect("a held DEM")
}

#[test]
fn cones_have_their_prominence() {
    let cones = [[50.0, 60.0, 500.0], [150.0, 60.0, 400.0], [20.0, 20.0, 330.0]];
    let height = |place: DVec2| cones.iter().map(|at| cone(place, *at)).fold(100.0, f64::max);
    let found = all(&land(height));
    assert_eq!(found.len(), 3, "{found:?}");
    let [highest, east, north] = [0, 1, 2].map(|i| found[i]);
    assert_eq!((highest.at, highest.prominence), ([50, 60], 400.0));
    assert!(matches!(highest.base, Base::Lowest(_, height) if height == 100.0), "the plain");
    // On the row of both 500 - 5 (c - 50) = 400 - 5 (150 - c).
    assert_eq!((east.at, east.prominence, east.base), ([150, 60], 200.0, Base::Saddle([110, 60], 200.0)));
    assert_eq!((north.at, north.height), ([20, 20], 330.0));
    // Amid the line from one to the other, which no sample lies on: 290 m.
    let Base::Saddle(at, saddle) = north.base else { panic!("{north:?}") };
    assert!(
        (saddle - 290.0).abs() < 3.6 && DVec2::new(at[0] as f64, at[1] as f64).distance(DVec2::new(24.8, 26.4)) < 1.5,
        "{north:?}"
    );
    assert_eq!(north.prominence, 330.0 - saddle);
    assert!(found.iter().all(|peak| !peak.at_edge));
    // The most prominent are the first of all; heights are the land's own.
    let tripled = land(|place| 3.0 * height(place));
    assert_eq!(peaks(&tripled, 2, 3.0).expect("peaks"), found[..2]);
    assert_eq!(peaks(&tripled, 1, 3.0).expect("peaks"), found[..1]);
}

#[test]
fn of_equal_heights_the_first_is_the_higher() {
    let twins = all(&land(|place| {
        [[150.0, 60.0, 400.0], [50.0, 60.0, 400.0]].map(|at| cone(place, at)).into_iter().fold(50.0, f64::max)
    }));
    assert_eq!(
        twins.iter().map(|peak| (peak.at, peak.prominence)).collect::<Vec<_>>(),
        [([50, 60], 350.0), ([150, 60], 250.0)]
    );
    assert_eq!(twins[1].base, Base::Saddle([100, 60], 150.0));
    // A table mountain is one peak, a step in a slope none; nor is a plain.
    let table = all(&land(|place| cone(place, [100.0, 60.0, 400.0]).clamp(100.0, 300.0)));
    assert_eq!((table.len(), table[0].at, table[0].prominence), (1, [100, 40], 200.0));
    assert_eq!(all(&land(|_| 7.0)), []);
}

#[test]
fn voids_part_hills_and_the_sea_is_their_base() {
    let height = |place: DVec2| {
        let land =
            [[50.0, 60.0, 300.0], [150.0, 60.0, 200.0]].map(|at| cone(place, at)).into_iter().fold(-40.0, f64::max);
        if (place.x - 100.0).abs() <= 10.0 { f64::NAN } else { land }
    };
    let islands = all(&land(height));
    let found: Vec<_> = islands.iter().map(|peak| (peak.at, peak.prominence, peak.base)).collect();
    assert_eq!(found, [([50, 60], 300.0, Base::Sea), ([150, 60], 200.0, Base::Sea)]);
    // Half of a cone, and one that a void touches.
    let cut = all(&land(|place| cone(place, [0.0, 60.0, 400.0]).max(0.0)));
    assert!(cut.len() == 1 && cut[0].at_edge);
    let pierced =
        all(&land(|place| if place == DVec2::new(51.0, 61.0) { f64::NAN } else { cone(place, [50.0, 60.0, 400.0]) }));
    assert!(pierced[0].at_edge && !all(&land(|place| cone(place, [50.0, 60.0, 400.0])))[0].at_edge);
}

/// The height of the best way from a sample to a higher one, by widening: the slow way.
fn saddle(columns: usize, heights: &[f32], from: usize) -> Option<f32> {
    let higher =
        |one: usize, other: usize| heights[one] > heights[other] || heights[one] == heights[other] && one < other;
    let rows = heights.len() / columns;
    let mut levels: Vec<f32> = heights.iter().copied().filter(|height| *height <= heights[from]).collect();
    levels.sort_by(|a, b| b.total_cmp(a));
    levels.into_iter().find(|level| {
        let (mut seen, mut open) = (vec![false; heights.len()], vec![from]);
        while let Some(i) = open.pop() {
            if seen[i] {
                continue;
            }
            seen[i] = true;
            if higher(i, from) {
                return true;
            }
            let (c, r) = (i % columns, i / columns);
            for r in r.saturating_sub(1)..(r + 2).min(rows) {
                let around = (c.saturating_sub(1)..(c + 2).min(columns)).map(|c| r * columns + c);
                open.extend(around.filter(|other| heights[*other] >= *level));
            }
        }
        false
    })
}

#[test]
fn a_slow_search_finds_the_same() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    for steps in [1000.0, 9.0] {
        // Of few heights many are equal.
        let heights: Vec<f32> = (0..30 * 24).map(|_| (random() * steps).floor() as f32).collect();
        let found = all(&dem(30, heights.clone()));
        let mut wanted: Vec<(f32, usize)> = (0..heights.len())
            .filter_map(|i| {
                let base =
                    saddle(30, &heights, i).unwrap_or_else(|| heights.iter().copied().fold(f32::INFINITY, f32::min));
                Some((heights[i] - base, i)).filter(|(prominence, _)| *prominence > 0.0)
            })
            .collect();
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let found: Vec<_> = found.iter().map(|peak| (peak.prominence as f32, peak.at[1] * 30 + peak.at[0])).collect();
        assert!(found == wanted && found.len() > 20, "{} and {} peaks", found.len(), wanted.len());
    }
}

#[test]
fn half_dome_and_mount_st_helens_are_found() {
    let Some(folder) = shared_dems() else { return };
    for (name, lonlat, height, prominence, rank) in [
        ("yosemite_utm11n_30m.tif", DVec2::new(-119.5332, 37.7459), 2682.0, 380.0..430.0, 20),
        ("sthelens_utm10n_10m.tif", DVec2::new(-122.1944, 46.1914), 2537.0, 1900.0..2000.0, 1),
    ] {
        let dem = read(folder.join(name), &ReadOptions::default()).expect(name);
        let found = peaks(&dem, rank, 1.0).expect("peaks");
        let near = |peak: &&Peak| {
            let place = dem
                .georeference()
                .lonlat(dem.position(peak.at[0], peak.at[1]).truncate())
                .ok()
                .flatten()
                .expect("a place");
            // Degrees of latitude: 400 m.
            ((place - lonlat) * DVec2::new(0.75, 1.0)).length() < 0.004
        };
        let peak = found.iter().find(near).unwrap_or_else(|| panic!("{name}: {found:?}"));
        println!("{name}: {peak:?}");
        assert!((peak.height - height).abs() < 25.0 && prominence.contains(&peak.prominence), "{peak:?}");
    }
}

fn info(arguments: &[&str]) -> (Option<i32>, String, String) {
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let output =
        Command::new(env!("CARGO_BIN_EXE_hachure")).args(["info", dem]).args(arguments).output().expect("hachure runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn info_lists_them() {
    let (code, told, _) = info(&["--peaks", "2"]);
    let lines: Vec<&str> = told.lines().collect();
    assert_eq!(code, Some(0));
    let at = lines.iter().position(|line| line.starts_with("peaks      2, the most prominent first; ")).expect("peaks");
    assert_eq!(lines.len(), at + 3);
    assert!(
        lines[at + 1].starts_with("peak 1     338.4 m at 54")
            && lines[at + 1].contains(" (longitude, latitude -122.49"),
        "{told}"
    );
    assert!(
        lines[at + 1].contains(", prominence 338.4 m above the sea") && lines[at + 2].contains(" m above the saddle, "),
        "{told}"
    );
    let plain = info(&[]).1;
    assert!(told.starts_with(plain.trim_end()) && !plain.contains("peak"));
    assert_eq!(info(&["--peaks"]).1.matches("\npeak ").count(), 20);
    let (code, told, said) = info(&["--peaks", "--memory", "64KiB"]);
    assert!(code == Some(1) && told.is_empty(), "{told}");
    assert!(
        said.contains("500 x 500 = 250000 samples stay in their files") && said.contains("use --crop to take a part"),
        "{said}"
    );
    let (code, _, said) = info(&["--peaks", "0"]);
    assert!(code == Some(2) && said.contains("want how many peaks, from 1 to 1000000, after the DEM"), "{said}");
}
