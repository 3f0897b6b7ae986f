//! Few samples, few pixels, facets as coarse and as fine as there are.

use super::{CELL, Make, hills};
use crate::dem::Dem;
use crate::stress::case::{above, look};
use crate::stress::lands::{grid, rolling};
use crate::stress::{Case, Group, Promise};
use crate::surface::Level;

pub(super) const CASES: &[Make] =
    &[samples_2x2, samples_2xn, samples_3x3, image_1x1, image_7x3, image_16384x1, level_1, level_64];

fn size(name: &'static str, about: &'static str, dem: Dem) -> Case {
    Case::new(Group::Sizes, name, about, dem).exact()
}

/// A saddle of one cell.
fn samples_2x2() -> Case {
    let dem = grid([2, 2], CELL, |c, r| if c == r { 16.0 } else { 0.0 });
    size("samples-2x2", "a saddle of 2 x 2 samples", dem).seen("above", [-0.5, 2.0, 20.0], [0.5, 0.5, 0.0])
}

/// A strip one cell wide.
fn samples_2xn() -> Case {
    let dem = grid([2, 129], CELL, |c, r| CELL * rolling(16, 3.0 * c, r));
    size("samples-2xn", "a strip of 2 x 129 samples", dem).seen("beside", [-30.0, 90.0, 200.0], [0.0, 50.0, 0.0])
}

/// One sample with land all about it.
fn samples_3x3() -> Case {
    let dem = grid([3, 3], CELL, |c, r| if c == 1.0 && r == 1.0 { 40.0 } else { 0.0 });
    size("samples-3x3", "a peak of 3 x 3 samples", dem).seen("beside", [-1.0, 4.0, 12.0], [1.0, 1.0, -20.0])
}

/// Hills on a page of this size.
fn on_page(name: &'static str, about: &'static str, page: [u32; 2]) -> Case {
    let dem = hills(65, 1, 1.0);
    let camera = look(above(&dem, [32.0, 70.0, 100.0]), above(&dem, [32.0, 24.0, 0.0]), 60.0, page);
    size(name, about, dem).view("across", camera)
}

fn image_1x1() -> Case {
    on_page("image-1x1", "a page of one pixel", [1, 1]).without(Promise::Accurate)
}

fn image_7x3() -> Case {
    on_page("image-7x3", "a page of 7 x 3 pixels", [7, 3]).without(Promise::Accurate)
}

fn image_16384x1() -> Case {
    on_page("image-16384x1", "a page of 16 384 x 1 pixels", [16_384, 1])
}

/// Facets as large as half cells: truth is that of the same facets.
fn level_1() -> Case {
    let one = Level::new(1).unwrap_or_default();
    size("level-1", "facets of level 1, and truth of the same", hills(65, 1, 1.0))
        .seen("across", [32.0, 70.0, 100.0], [32.0, 24.0, 0.0])
        .drawn(one)
        .truth_to(one)
}

/// Facets as small as there are.
fn level_64() -> Case {
    size("level-64", "facets of level 64", hills(9, 17, 1.0))
        .seen("across", [4.0, 11.0, 40.0], [4.0, 3.0, 0.0])
        .drawn(Level::FINEST)
        .truth_to(Level::FINEST)
        .flown()
        .in_short()
}
