//! Heights smoothed at a scale: noise and trees go, crests and planes stay, a window has the bits of the whole.

use std::f64::consts::TAU;

use glam::DVec2;
use hachure::dem::Window;
use hachure::door::dem::generalise::{generalise, halo};
use rayon::ThreadPoolBuilder;

use crate::scenes::Random;
use crate::tolerances::{CREST, NOISE_LEFT, PLANE_M};

const SIDE: usize = 256;
const MIDDLE: f64 = 127.7;

fn grid(height: impl Fn(f64, f64) -> f64) -> Vec<f32> {
    (0..SIDE * SIDE).map(|i| height((i % SIDE) as f64, (i / SIDE) as f64) as f32).collect()
}

/// Two slopes of 45 % that meet 90 m above the ground.
fn roof(x: f64, _: f64) -> f64 {
    400.0 + (90.0 - 0.45 * (x - MIDDLE).abs()).max(0.0)
}

/// A cone of slopes of 50 % and 100 m.
fn cone(x: f64, y: f64) -> f64 {
    400.0 + (100.0 - 0.5 * (x - MIDDLE).hypot(y - MIDDLE)).max(0.0)
}

/// Land with noise of 0.3 m and trees of 3 to 10 m, 2 to 4 m wide, on 3 % of it.
fn overgrown(mut heights: Vec<f32>, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    let mut trees = vec![0.0_f64; SIDE * SIDE];
    for _ in 0..SIDE * SIDE * 3 / 700 {
        let [x, y] = [0; 2].map(|_| random.between(4.0, SIDE as f64 - 4.0));
        let (high, radius) = (random.between(3.0, 10.0), random.between(1.0, 2.0));
        for i in (0..25).map(|i| (y as usize - 2 + i / 5) * SIDE + x as usize - 2 + i % 5) {
            let off = ((i % SIDE) as f64 - x).hypot((i / SIDE) as f64 - y) / radius;
            trees[i] = trees[i].max(high * (1.0 - off * off));
        }
    }
    for (height, tree) in heights.iter_mut().zip(trees) {
        let [one, other]: [f64; 2] = [0; 2].map(|_| random.between(1e-9, 1.0));
        let noise = 0.3 * (-2.0 * one.ln()).sqrt() * (TAU * other).cos();
        *height += (noise + tree) as f32;
    }
    heights
}

fn smooth(heights: &[f32], metres: f64) -> Vec<f32> {
    let mut heights = heights.to_vec();
    generalise(&mut heights, Window { first: [0, 0], size: [SIDE, SIDE] }, DVec2::ONE, metres, true);
    heights
}

/// Means over squares of so many samples more to each side.
fn blurred(heights: &[f32], more: usize) -> Vec<f32> {
    let near = |at: usize| at.saturating_sub(more)..(at + more + 1).min(SIDE);
    let mean = |i: usize| {
        let square: Vec<f32> =
            near(i / SIDE).flat_map(|r| near(i % SIDE).map(move |c| heights[r * SIDE + c])).collect();
        square.iter().sum::<f32>() / square.len() as f32
    };
    (0..heights.len()).map(mean).collect()
}

/// The mean square of what two grids differ by, away from the border.
fn energy(a: &[f32], b: &[f32]) -> f64 {
    let inside = |i: &usize| (24..SIDE - 24).contains(&(i % SIDE)) && (24..SIDE - 24).contains(&(i / SIDE));
    let squares: Vec<f64> = (0..a.len()).filter(inside).map(|i| (f64::from(a[i]) - f64::from(b[i])).powi(2)).collect();
    squares.iter().sum::<f64>() / squares.len() as f64
}

/// Height of a crest above the ground: the highest of some columns, on average over rows.
fn crest(heights: &[f32], rows: std::ops::Range<usize>) -> f64 {
    let highest = |r: usize| (118..138).map(|c| heights[r * SIDE + c]).fold(f32::MIN, f32::max);
    rows.clone().map(|r| f64::from(highest(r)) - 400.0).sum::<f64>() / rows.len() as f64
}

#[test]
fn trees_go_and_crests_stay() {
    let (roof, cone) = (grid(roof), grid(cone));
    for (name, land, rows) in [("roof", &roof, 24..SIDE - 24), ("cone", &cone, 128..129)] {
        let rough = overgrown(land.clone(), 5);
        let found = |surface: &[f32], bare: &[f32]| {
            let kept = [surface, bare].map(|heights| crest(heights, rows.clone()) / crest(land, rows.clone()));
            (kept, energy(surface, land) / energy(&rough, land))
        };
        for metres in [10.0, 15.0, 20.0] {
            let (kept, left) = found(&smooth(&rough, metres), &smooth(land, metres));
            println!("{name}, {metres} m: {kept:.4?} of the height, with trees and bare; {left:.4} of the noise left");
            assert!(kept.iter().all(|kept| *kept > CREST && *kept < 2.0 - CREST), "{name}, {metres} m: {kept:?}");
            assert!(left < NOISE_LEFT, "{name}, {metres} m: {left}");
        }
        // Negative control: a plain mean over 21 m wears crests down, and no mean leaves the noise.
        let (kept, left) = found(&blurred(&rough, 10), &blurred(land, 10));
        assert!(kept[1] < CREST, "{name}: {kept:?}, {left}");
        assert!(found(&rough, land).1 > NOISE_LEFT);
    }
}

#[test]
fn planes_stay_planes() {
    let plane = grid(|x, y| 1000.0 + 0.31 * x - 0.17 * y);
    let flat = grid(|_, _| 77.3);
    for metres in [3.0, 15.0, 120.0] {
        let off = smooth(&plane, metres).iter().zip(&plane).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        println!("{metres} m: a plane moves by {off:.2e} m");
        assert!(off < PLANE_M, "{metres} m: {off}");
        assert_eq!(smooth(&flat, metres), flat);
    }
}

#[test]
fn a_scale_below_the_cells_changes_nothing() {
    let rough = overgrown(grid(cone), 9);
    for metres in [0.0, 1.0, 2.4, -5.0, f64::NAN] {
        assert_eq!(halo(metres, DVec2::ONE), 0);
        assert_eq!(smooth(&rough, metres), rough, "{metres} m");
    }
    assert_eq!(halo(2.6, DVec2::ONE), 8);
    assert_ne!(smooth(&rough, 2.6), rough);
}

/// Trees with voids, in the columns and rows that a window has.
fn with_voids(seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    let mut heights = overgrown(grid(cone), seed);
    for (i, height) in heights.iter_mut().enumerate() {
        if random.below(60) == 0 || (i % SIDE / 30 + i / SIDE / 20).is_multiple_of(9) {
            *height = f32::NAN;
        }
    }
    heights
}

fn cut(samples: &[f32], columns: usize, window: Window) -> Vec<f32> {
    let rows = window.first[1]..window.first[1] + window.size[1];
    rows.flat_map(|r| &samples[r * columns + window.first[0]..][..window.size[0]]).copied().collect()
}

fn bits(heights: &[f32]) -> Vec<u32> {
    heights.iter().map(|height| height.to_bits()).collect()
}

/// A window of generalised heights, from samples up to `halo` around it.
fn in_window(rough: &[f32], window: Window, halo: usize, cell: DVec2, metres: f64) -> Vec<f32> {
    let first = window.first.map(|first| first.saturating_sub(halo));
    let end = [0, 1].map(|i| (window.first[i] + window.size[i] + halo).min(SIDE));
    let around = Window { first, size: [0, 1].map(|i| end[i] - first[i]) };
    let mut heights = cut(rough, SIDE, around);
    generalise(&mut heights, around, cell, metres, false);
    cut(&heights, around.size[0], Window { first: [0, 1].map(|i| window.first[i] - first[i]), ..window })
}

#[test]
fn a_window_with_its_halo_has_the_bits_of_the_whole() {
    let rough = with_voids(31);
    let mut random = Random::new(32);
    for (metres, cell) in [(4.0, DVec2::ONE), (11.0, DVec2::ONE), (30.0, DVec2::new(2.0, 3.0)), (33.0, DVec2::ONE)] {
        let mut whole = rough.clone();
        generalise(&mut whole, Window { first: [0, 0], size: [SIDE; 2] }, cell, metres, true);
        let halo = halo(metres, cell);
        let mut blind = 0;
        for _ in 0..8 {
            let size = [0; 2].map(|_| 1 + random.below(40) as usize);
            let first = [0, 1].map(|i| random.below((SIDE - size[i]) as u32) as usize);
            let window = Window { first, size };
            let expected = bits(&cut(&whole, SIDE, window));
            assert_eq!(bits(&in_window(&rough, window, halo, cell, metres)), expected, "{metres} m, {window:?}");
            blind += usize::from(bits(&in_window(&rough, window, halo / 4, cell, metres)) == expected);
        }
        assert!(blind < 4, "a quarter of the halo must be too little at {metres} m");
    }
}

#[test]
fn what_is_not_finite_is_a_void() {
    let rough = with_voids(51);
    let infinite: Vec<f32> = rough.iter().map(|height| if height.is_nan() { f32::INFINITY } else { *height }).collect();
    let [rough, infinite] = [rough, infinite].map(|heights| smooth(&heights, 12.0));
    assert!(rough.iter().zip(&infinite).all(|(a, b)| a == b || a.is_nan() && b.is_nan()));
}

#[test]
fn tiles_and_threads_change_no_bit_and_voids_stay() {
    // Longer than a tile.
    let (columns, rows) = (700, 300);
    let rough: Vec<f32> = with_voids(41).iter().cycle().take(columns * rows).copied().collect();
    let window = Window { first: [3, 8], size: [columns, rows] };
    let smooth = |parallel| {
        let mut heights = rough.clone();
        generalise(&mut heights, window, DVec2::ONE, 12.0, parallel);
        heights
    };
    let alone = smooth(false);
    for threads in [1, 3] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert_eq!(bits(&pool.install(|| smooth(true))), bits(&alone), "{threads} threads");
    }
    let voids = |heights: &[f32]| heights.iter().map(|height| height.is_nan()).collect::<Vec<_>>();
    assert_eq!(voids(&alone), voids(&rough));
    // A tile is a window like any other.
    let part = Window { first: [200, 100], size: [150, 60] };
    let more = halo(12.0, DVec2::ONE);
    let around = Window { first: part.first.map(|at| at - more), size: part.size.map(|size| size + 2 * more) };
    let mut heights = cut(&rough, columns, around);
    let counted = Window { first: [around.first[0] + 3, around.first[1] + 8], ..around };
    generalise(&mut heights, counted, DVec2::ONE, 12.0, false);
    let inside = cut(&heights, around.size[0], Window { first: [more; 2], ..part });
    assert_eq!(bits(&inside), bits(&cut(&alone, columns, part)));
}
