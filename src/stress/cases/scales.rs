//! Lengths and coordinates at the ends of numbers.

use glam::DVec2;

use super::{CELL, Make, hills};
use crate::dem::Dem;
use crate::stress::case::{PAGE, above, look};
use crate::stress::lands::{ORIGIN, grid, placed, rolling};
use crate::stress::{Case, Group, Promise};
use crate::surface::Level;

pub(super) const CASES: &[Make] = &[
    millimetres,
    ten_kilometres,
    northing_0,
    northing_4e6,
    northing_1e7,
    deep,
    high,
    near_eye,
    far_eye,
    under_a_pixel,
    one_facet,
];

fn scale(name: &'static str, about: &'static str, dem: Dem) -> Case {
    Case::new(Group::Scales, name, about, dem)
}

/// Hills of cells of this size, at a northing.
fn sized(cell: f64, origin: DVec2) -> Dem {
    placed([65, 65], DVec2::splat(cell), origin, |c, r| cell * rolling(14, c, r))
}

/// From so many cells above.
fn over(case: Case, cell: f64) -> Case {
    case.seen("across", [32.0, 74.0, 6.0 * cell], [32.0, 24.0, 0.0])
}

/// Cells of a millimetre: what f32 knows of heights still suffices near sea level.
fn millimetres() -> Case {
    over(scale("cell-1-mm", "cells of a millimetre", sized(0.001, DVec2::ZERO)), 0.001)
}

fn ten_kilometres() -> Case {
    over(scale("cell-10-km", "cells of 10 km", sized(10_000.0, DVec2::ZERO)), 10_000.0)
}

fn at_northing(name: &'static str, about: &'static str, northing: f64) -> Case {
    over(scale(name, about, sized(CELL, DVec2::new(500_000.0, northing))), CELL).exact()
}

fn northing_0() -> Case {
    at_northing("northing-0", "a northing of 0", 0.0)
}

fn northing_4e6() -> Case {
    at_northing("northing-4e6", "a northing of 4 000 000 m", 4e6)
}

fn northing_1e7() -> Case {
    at_northing("northing-1e7", "a northing of 10 000 000 m", 1e7).flown().in_short()
}

/// Hills so many metres higher.
fn raised(name: &'static str, about: &'static str, metres: f64) -> Case {
    let dem = grid([65, 65], CELL, |c, r| metres + (CELL * rolling(14, c, r) * 4.0).round() / 4.0);
    over(scale(name, about, dem), CELL).exact()
}

fn deep() -> Case {
    raised("deep", "land at -11 000 m", -11_000.0)
}

/// Quarters of a metre are the last that f32 knows up there.
fn high() -> Case {
    raised("high", "land at 1 000 000 m", 1e6).in_short()
}

fn near_eye() -> Case {
    scale("near-eye", "the eye a metre from what it looks at", hills(65, 15, 1.0))
        .seen("ground", [30.0, 40.0, 1.0], [30.03125, 39.96875, -0.5])
        .exact()
        .flown()
}

/// From 1 000 km off, as large on the page as it would be from 3 km.
fn far_eye() -> Case {
    let dem = hills(65, 15, 1.0);
    let target = above(&dem, [32.0, 32.0, 0.0]);
    let eye = target + glam::DVec3::new(-600_000.0, -796_000.0, 64_000.0);
    scale("far-eye", "the eye 1 000 km away", dem).view("telescope", look(eye, target, 0.15, PAGE)).exact()
}

/// The whole land is smaller than a pixel.
fn under_a_pixel() -> Case {
    let dem = hills(65, 15, 1.0);
    let target = above(&dem, [32.0, 32.0, 0.0]);
    let eye = target + glam::DVec3::new(-600_000.0, -796_000.0, 64_000.0);
    scale("under-a-pixel", "the whole land smaller than a pixel", dem)
        .view("far", look(eye, target, 60.0, PAGE))
        .exact()
        .without(Promise::Accurate)
}

/// One facet fills the page.
fn one_facet() -> Case {
    let dem = Dem::from_heights(2, DVec2::splat(CELL), ORIGIN, vec![0.0, 4.0, 2.0, 8.0]);
    scale("one-facet", "one facet over the whole page", dem)
        .view("down", {
            let dem = Dem::from_heights(2, DVec2::splat(CELL), ORIGIN, vec![0.0, 4.0, 2.0, 8.0]);
            look(above(&dem, [0.25, 0.75, 4.0]), above(&dem, [0.265625, 0.734375, 0.0]), 60.0, PAGE)
        })
        .drawn(Level::new(1).unwrap_or_default())
        .exact()
}
