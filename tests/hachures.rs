//! Hachures on maps: tone, and how strokes lie on the land.

mod map;
mod pops;

use glam::DVec2;
use hachure::dem::Dem;

use map::{Map, classes, lehmann};

/// A cone of one slope, degrees, in a square of land.
fn cone(slope: f64) -> Dem {
    let side = 161;
    let height = |i: usize| {
        let off = DVec2::new((i % side) as f64, (i / side) as f64) - 80.0;
        (5000.0 - off.length() * 30.0 * slope.to_radians().tan()) as f32
    };
    Dem::from_heights(
        side,
        DVec2::splat(30.0),
        DVec2::new(500_000.0, 4_000_000.0),
        (0..side * side).map(height).collect(),
    )
}

#[test]
fn ink_is_as_the_slope_on_cones() {
    for slope in [7.5, 12.5, 17.5, 22.5, 27.5, 32.5, 37.5, 42.5] {
        let map = Map::new(cone(slope), 50_000.0, lehmann());
        let [share, wanted, ink] = classes(&map)[(slope / 5.0) as usize];
        println!("cone of {slope} degrees: {share:.2} of the map, {wanted:.3} of it to be ink, {ink:.3} is");
        assert!((ink - wanted).abs() <= 0.04, "{slope} degrees: {ink} of the paper is ink, not {wanted}");
    }
}
