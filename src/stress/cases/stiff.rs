//! Stiff land: heights that change more from sample to sample than a smooth surface between them likes.

use glam::DVec2;

use super::{CELL, Make, hills};
use crate::dem::Dem;
use crate::stress::lands::{ORIGIN, grid, hashed, placed, rolling, sixteenths};
use crate::stress::{Case, Group};
use crate::surface::Level;

pub(super) const CASES: &[Make] = &[
    exaggeration_10,
    exaggeration_100,
    exaggeration_1000,
    cliff_10,
    cliff_100,
    cliff_10000,
    terraces,
    needle,
    saw_tooth,
    cells_1_to_1000,
    folds,
    folds_limited,
];

fn stiff(name: &'static str, about: &'static str, dem: Dem) -> Case {
    Case::new(Group::Stiff, name, about, dem).exact()
}

/// Rolling hills times a factor, from above their lowest land.
fn exaggerated(name: &'static str, about: &'static str, times: f64) -> Case {
    let high = 8.0 * CELL * times;
    stiff(name, about, hills(65, 1, times)).seen("across", [32.0, 90.0, 0.3 * high], [32.0, 32.0, 0.0]).seen(
        "above",
        [4.0, 80.0, 1.5 * high],
        [32.0, 32.0, 0.0],
    )
}

fn exaggeration_10() -> Case {
    exaggerated("exaggeration-10", "hills 10 times as high", 10.0)
}

fn exaggeration_100() -> Case {
    exaggerated("exaggeration-100", "hills 100 times as high", 100.0).flown().in_short()
}

fn exaggeration_1000() -> Case {
    exaggerated("exaggeration-1000", "hills 1 000 times as high", 1000.0)
}

/// A plateau that falls by `slope` cells from one sample to the next, its edge aslant to the grid.
fn cliff(name: &'static str, about: &'static str, slope: f64) -> Case {
    let high = slope * CELL;
    let dem = grid([65, 65], CELL, |c, r| {
        let plateau = if 2.0 * c + r > 96.0 { high } else { 0.0 };
        plateau + CELL * rolling(2, c, r)
    });
    stiff(name, about, dem).seen("below", [2.0, 50.0, 0.4 * high], [50.0, 20.0, 0.0])
}

/// The same case from above too: higher cliffs are all that such an eye sees.
fn along(case: Case, slope: f64) -> Case {
    case.seen("along", [36.0, 75.0, 1.2 * slope * CELL + 300.0], [34.0, 20.0, 0.0])
}

fn cliff_10() -> Case {
    along(cliff("cliff-10", "a cliff of slope 10 between two samples", 10.0), 10.0).flown().in_short()
}

fn cliff_100() -> Case {
    along(cliff("cliff-100", "a cliff of slope 100 between two samples", 100.0), 100.0)
}

fn cliff_10000() -> Case {
    cliff("cliff-10000", "a cliff of slope 10 000 between two samples", 10_000.0)
}

/// Level treads of one to three cells, steps of 40 m.
fn terraces() -> Case {
    let dem = grid([65, 65], CELL, |c, r| (CELL * rolling(3, c, r) / 40.0).floor() * 40.0);
    stiff("terraces", "hills in steps of 40 m", dem)
        .seen("across", [32.0, 72.0, 150.0], [32.0, 24.0, 0.0])
        .seen("above", [0.0, 64.0, 900.0], [36.0, 30.0, 0.0])
        .flown()
}

fn needle() -> Case {
    let dem = grid([65, 65], CELL, |c, r| {
        let needle = if c == 32.0 && r == 32.0 { 10_000.0 } else { 0.0 };
        needle + CELL * rolling(4, c, r) / 8.0
    });
    stiff("needle", "one sample 10 km high on gentle land", dem)
        .seen("foot", [32.0, 62.0, 200.0], [32.0, 32.0, -8_500.0])
        .seen("above", [20.0, 160.0, 9_000.0], [32.0, 32.0, -6_000.0])
        .flown()
        .in_short()
}

/// Every other column 16 m high.
fn saw_tooth() -> Case {
    let dem = grid([65, 65], CELL, |c, r| if c % 2.0 == 0.0 { 0.0 } else { 16.0 } + CELL * rolling(5, c, r) / 4.0);
    stiff("saw-tooth", "every other column 16 m high", dem)
        .seen("across", [2.0, 40.0, 120.0], [40.0, 30.0, 0.0])
        .seen("along", [30.0, 70.0, 60.0], [34.0, 20.0, 0.0])
        .flown()
        .truth_to(Level::SIXTEEN)
}

/// Cells of 1 m by 1 000 m, nearly: by 1 024 m.
fn cells_1_to_1000() -> Case {
    let dem = placed([65, 33], DVec2::new(1.0, 1024.0), ORIGIN, |c, r| sixteenths(8.0 * rolling(6, c, r)));
    stiff("cells-1-to-1000", "cells of 1 m x 1 024 m", dem)
        .seen("along", [32.0, 32.5, 60.0], [32.0, 30.0, 0.0])
        .seen("across", [-60.0, 31.0, 90.0], [32.0, 30.6, 0.0])
        .truth_to(Level::SIXTEEN)
}

/// White noise ten cells high.
fn noise(name: &'static str, about: &'static str) -> Case {
    let dem = grid([33, 33], CELL, |c, r| sixteenths(10.0 * CELL * hashed(7, c, r)));
    stiff(name, about, dem).seen("above", [16.0, 50.0, 900.0], [16.0, 16.0, 0.0])
}

/// Patches fold over.
fn folds() -> Case {
    noise("folds", "white noise 10 cells high: patches fold over").flown()
}

/// The same land with tangents limited: none folds.
fn folds_limited() -> Case {
    noise("folds-limited", "white noise 10 cells high, tangents limited: no patch folds").limited()
}
