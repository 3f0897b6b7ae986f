//! What the lines of a million samples take: time and memory.

use std::time::Instant;

use glam::DVec2;
use hachure::dem::{Dem, fractal};
use hachure::door::relief::slope::SlopePoint;

use super::Scene;
use crate::tolerances::SLOPE_SECONDS;

/// Room of lines that are asked for, cells: all levels down to a spacing of one cell.
const ROOM: f64 = 1.3;

#[test]
fn lines_of_a_million_samples_take_little() {
    let side = 1024;
    let heights = (0..side).flat_map(|r| fractal::row(side, r)).collect();
    let scene = Scene::of("fractal", Dem::from_heights(side, DVec2::splat(fractal::CELL), DVec2::ZERO, heights));
    scene.surface.pyramid().expect("a pyramid");
    let slopes = scene.slopes();
    let start = Instant::now();
    let blocks = slopes.blocks(&|_| ROOM * scene.unit()).expect("blocks");
    let first = start.elapsed().as_secs_f64();
    let start = Instant::now();
    slopes.blocks(&|_| ROOM * scene.unit()).expect("blocks");
    let again = start.elapsed().as_secs_f64();
    let (finest, points) = (blocks.iter().map(|needed| needed.block.level).max(), slopes.points());
    assert_eq!(finest, Some(10));
    println!("{points} points of {} bytes: {first:.3} s, {again:.4} s again", size_of::<SlopePoint>());
    assert!(first <= SLOPE_SECONDS, "{first} s");
    assert_eq!(size_of::<SlopePoint>(), 32);
}
