//! Voids, steps, and heights that files should not have.

use super::{CELL, Make, hills};
use crate::dem::Dem;
use crate::stress::lands::{grid, rolling};
use crate::stress::{Case, Group};

pub(super) const CASES: &[Make] = &[
    void_sample,
    void_checkerboard,
    void_islands,
    void_half,
    void_ring,
    constant,
    denormal,
    whole_metres,
    doubled_rows,
];

fn data(name: &'static str, about: &'static str, dem: Dem) -> Case {
    Case::new(Group::Data, name, about, dem).exact()
}

/// Hills that are void where `is_void` says, seen across and from above.
fn with_voids(name: &'static str, about: &'static str, is_void: fn(f64, f64) -> bool) -> Case {
    let height = |c, r| if is_void(c, r) { f64::NAN } else { CELL * rolling(18, c, r) };
    // The skyline lies on the page, and not along its edge: beyond that no pixel is looked at.
    let case = data(name, about, grid([65, 65], CELL, height));
    let case = case.seen("across", [32.0, 76.0, 200.0], [32.0, 24.0, 0.0]);
    case.seen("above", [32.0, 64.0, 900.0], [32.0, 30.0, 0.0])
}

fn void_sample() -> Case {
    with_voids("void-sample", "one void sample", |c, r| c == 30.0 && r == 40.0)
}

/// Squares of 4 x 4 samples, every other one void.
fn void_checkerboard() -> Case {
    with_voids("void-checkerboard", "voids as on a checkerboard", |c, r| {
        ((c / 4.0).floor() + (r / 4.0).floor()) % 2.0 == 0.0
    })
    .in_short()
}

/// Islands of land that do not touch.
fn void_islands() -> Case {
    with_voids("void-islands", "islands in voids", |c, r| (c % 16.0 - 8.0).hypot(r % 16.0 - 8.0) > 6.0).flown()
}

fn void_half() -> Case {
    with_voids("void-half", "half of the land void, aslant", |c, r| c + r > 64.0)
}

fn void_ring() -> Case {
    with_voids("void-ring", "a ring of voids", |c, r| (9.0..11.0).contains(&(c - 32.0).hypot(r - 32.0)))
}

fn constant() -> Case {
    data("constant", "all heights the same", grid([65, 65], CELL, |_, _| 7.0))
        .seen("across", [32.0, 60.0, 20.0], [32.0, 20.0, 0.0])
        .seen("outside", [32.0, 80.0, 100.0], [32.0, 32.0, 0.0])
}

/// Steps smaller than the smallest normal number of f32.
fn denormal() -> Case {
    let dem = grid([65, 65], CELL, |c, r| if (c + r) % 2.0 == 0.0 { 0.0 } else { 1e-40 });
    Case::new(Group::Data, "denormal", "steps of 1e-40 m", dem)
        .seen("across", [32.0, 60.0, 2.0], [32.0, 20.0, 0.0])
        .seen("outside", [32.0, 80.0, 100.0], [32.0, 32.0, 0.0])
}

/// Hills in whole metres, as they are without smoothing.
fn whole_metres() -> Case {
    let dem = grid([129, 129], CELL, |c, r| (CELL * rolling(19, c, r) / 4.0).round());
    data("whole-metres", "gentle hills in steps of a metre", dem)
        .seen("across", [64.0, 124.0, 30.0], [64.0, 40.0, 0.0])
        .flown()
        .in_short()
}

/// Every row twice, as in files that were resampled badly.
fn doubled_rows() -> Case {
    let dem = hills(65, 20, 1.0);
    let height = |c: f64, r: f64| f64::from(dem.height(c as usize, (r / 2.0) as usize).unwrap_or(0.0));
    data("doubled-rows", "every row there twice", grid([65, 65], CELL, height))
        .seen("across", [32.0, 72.0, 200.0], [32.0, 24.0, 0.0])
        .flown()
}
