//! Lands of cases: whole numbers are hashed, f64 added and multiplied, heights rounded to sixteenths of a metre, so that they
//! are the same on every machine and have few binary digits.

use glam::DVec2;

use crate::dem::Dem;

/// Easting and northing of most lands: large, as in any map, and of few binary digits.
pub(crate) const ORIGIN: DVec2 = DVec2::new(325_248.0, 4_118_016.0);
/// Heights are whole multiples of a metre over this.
const STEPS: f64 = 16.0;

/// A grid of square cells with these heights in metres by column and row; not a number is a void.
pub(crate) fn grid([columns, rows]: [usize; 2], cell: f64, height: impl Fn(f64, f64) -> f64) -> Dem {
    placed([columns, rows], DVec2::splat(cell), ORIGIN, height)
}

/// A grid of cells of this size whose north-west sample lies there.
pub(crate) fn placed([columns, rows]: [usize; 2], cell: DVec2, origin: DVec2, height: impl Fn(f64, f64) -> f64) -> Dem {
    let heights = (0..columns * rows).map(|i| height((i % columns) as f64, (i / columns) as f64) as f32);
    Dem::from_heights(columns, cell, origin, heights.collect())
}

/// A height of few binary digits.
pub(crate) fn sixteenths(height: f64) -> f64 {
    (height * STEPS).round() / STEPS
}

/// Hills of 32, 16 and 8 cells that a surface between samples holds well, heights in cells, some 8 high; of few binary digits
/// where a cell is a power of two.
pub(crate) fn rolling(seed: u64, column: f64, row: f64) -> f64 {
    let octaves = [(32.0, 6.0), (16.0, 2.0), (8.0, 0.5)];
    let octave = |(i, (wide, high)): (u64, (f64, f64))| high * noise(seed * 8 + i, column / wide, row / wide);
    (0..).zip(octaves).map(octave).map(|height| (height * 4096.0).round() / 4096.0).sum()
}

/// Value noise, 0 to 1: one random number a node, steps with level ends between them.
pub(crate) fn noise(seed: u64, x: f64, y: f64) -> f64 {
    let (column, row) = (x.floor(), y.floor());
    let smooth = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (across, down) = (smooth(x - column), smooth(y - row));
    let node = |i: f64, j: f64| hashed(seed, column + i, row + j);
    let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
    mix(mix(node(0.0, 0.0), node(1.0, 0.0), across), mix(node(0.0, 1.0), node(1.0, 1.0), across), down)
}

/// A number from 0 to 1 for each column and row: SplitMix64 (Steele, Lea, Flood 2014) of its place, 16 bits of it.
pub(crate) fn hashed(seed: u64, column: f64, row: f64) -> f64 {
    let place = seed << 48 ^ (column as i64 as u64 & 0xff_ffff) << 24 ^ (row as i64 as u64 & 0xff_ffff);
    let mut bits = place.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 48) as f64 / 65_536.0
}
