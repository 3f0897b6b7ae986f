//! The level at which no edge that is seen is longer than a pixel, on ground of which edges can be measured directly.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::surface::Surface;
use hachure::truth::Terrain;
use hachure::view::Camera;

use crate::forms::MIDDLE;
use crate::scenes::{level, look};

/// Metres between samples.
const CELL: f64 = 10.0;
/// Samples along each side.
const SIDE: usize = 41;

/// Ground about [`MIDDLE`] whose height depends on metres east and north of it.
fn ground(height: impl Fn(f64, f64) -> f64) -> Surface {
    let half = (SIDE / 2) as f64 * CELL;
    let at = |i: usize| height((i % SIDE) as f64 * CELL - half, half - (i / SIDE) as f64 * CELL) as f32;
    let corner = MIDDLE + DVec2::new(-half, half);
    Surface::new(Dem::from_heights(SIDE, DVec2::splat(CELL), corner, (0..SIDE * SIDE).map(at).collect()))
}

/// A camera about [`MIDDLE`].
fn from(eye: DVec3, target: DVec3, size: [u32; 2]) -> Camera {
    look(MIDDLE.extend(0.0) + eye, MIDDLE.extend(0.0) + target, 60.0, size)
}

/// Longest side of a patch on the page, px, of cells whose north-west corner `counts`, given metres from the middle,
/// and that have a corner on the page.
fn longest_side(surface: &Surface, camera: &Camera, counts: impl Fn(DVec2) -> bool) -> f64 {
    let dem = surface.dem();
    let page = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let mut longest = 0.0_f64;
    for (r, c) in (0..SIDE - 1).flat_map(|r| (0..SIDE - 1).map(move |c| (r, c))) {
        let [nw, ne, sw, se] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dc, dr)| dem.position(c + dc, r + dr));
        let places = [nw, ne, sw, se].map(|p| camera.project(p));
        let shows = places.iter().any(|(p, w)| *w > 0.0 && p.cmpge(DVec2::ZERO).all() && p.cmplt(page).all());
        if shows && counts(nw.truncate() - MIDDLE) {
            let [nw, ne, sw, se] = places.map(|(p, _)| p);
            let sides = [(nw, sw), (sw, se), (se, nw), (se, ne), (ne, nw)];
            longest = sides.iter().map(|(a, b)| a.distance(*b)).fold(longest, f64::max);
        }
    }
    longest
}

#[test]
fn a_plain_from_above_has_the_level_of_its_diagonals() {
    let plain = ground(|_, _| 0.0);
    let terrain = Terrain::new(&plain);
    for (height, expected) in [(10_000.0, 1), (400.0, 8), (150.0, 32), (100.0, 32), (75.0, 64), (12.0, 64)] {
        let camera = Camera { altitude: -90.0, ..from(DVec3::Z * height, DVec3::Y, [200, 160]) };
        let diagonal = camera.focal() * CELL * 2.0_f64.sqrt() / height;
        let found = terrain.level_for(&camera).map(|level| level.subdivisions());
        println!("from {height} m: diagonals of {diagonal:.2} px, level {found:?}");
        assert_eq!(found, Some(expected), "from {height} m: diagonals of {diagonal:.2} px");
        let measured = longest_side(&plain, &camera, |_| true);
        assert!((measured - diagonal).abs() < 1e-6 * diagonal, "{measured} px measured, {diagonal} px by formula");
        assert!(expected == 64 || diagonal / f64::from(expected) <= 1.0, "from {height} m: edges longer than a pixel");
        assert!(expected == 1 || diagonal * 2.0 / f64::from(expected) > 1.0, "from {height} m: half would do");
    }
}

#[test]
fn no_edge_of_a_hill_is_longer_than_a_pixel() {
    let hill = ground(|x, y| 60.0 * (-(x * x + y * y) / 8000.0).exp());
    let terrain = Terrain::new(&hill);
    let mut levels = Vec::new();
    for (distance, height) in [(3000.0, 900.0), (900.0, 500.0), (600.0, 120.0), (320.0, 200.0), (240.0, 60.0)] {
        let camera = from(DVec3::new(0.2 * distance, -distance, height), DVec3::Z * 20.0, [320, 240]);
        let found = terrain.level_for(&camera).expect("the hill is in view").subdivisions();
        // From so high and far all cells of the near side are seen, and they are the largest.
        let longest = longest_side(&hill, &camera, |_| true);
        println!("from {distance} m: sides of {longest:.2} px, level {found}");
        assert!(longest / f64::from(found) <= 1.0, "level {found} of sides of {longest:.2} px");
        assert!(found == 1 || longest * 2.0 / f64::from(found) > 1.0, "level {found} of sides of {longest:.2} px");
        levels.push(found);
    }
    levels.dedup();
    assert!(levels.len() > 3, "only levels {levels:?}");
}

#[test]
fn where_nothing_is_in_view_there_is_no_level() {
    let plain = ground(|_, _| 0.0);
    let eye = DVec3::new(0.0, -400.0, 100.0);
    let towards = |target| Terrain::new(&plain).level_for(&from(eye, target, [200, 160]));
    assert_eq!(towards(DVec3::new(0.0, 0.0, 700.0)), None, "the sky");
    assert_eq!(towards(DVec3::new(0.0, -900.0, 100.0)), None, "away from the ground");
    assert!(towards(DVec3::ZERO).is_some(), "the ground");
}

#[test]
fn what_a_ridge_hides_does_not_count() {
    // A ridge along the whole ground, gentle on both sides for three cells; behind it a cliff with the longest edges.
    let cliff = |_: f64, y: f64| match y {
        y if y <= 0.0 => 30.0 + 0.2 * y.max(-100.0),
        y if y <= 20.0 => 30.0 - 0.5 * y,
        _ => -300.0,
    };
    let ground = ground(cliff);
    let terrain = Terrain::new(&ground);
    let found = |eye| {
        let camera = from(eye, DVec3::new(0.0, 0.0, 30.0), [320, 240]);
        let [all, front] = [f64::INFINITY, 0.0].map(|end| longest_side(&ground, &camera, |nw| nw.y <= end));
        let level = |sides: f64| level((sides.ceil() as u32).next_power_of_two().min(64));
        println!("from {eye}: sides of {all:.1} px, {front:.1} px before the ridge");
        (terrain.level_for(&camera).expect("the ridge is in view"), level(front), level(all))
    };
    let (low, front, all) = found(DVec3::new(0.0, -700.0, 60.0));
    assert!(front < all, "the cliff is no longer than the ridge");
    assert_eq!(low, front, "from below, the cliff is hidden");
    let (high, _, all) = found(DVec3::new(0.0, -700.0, 900.0));
    assert_eq!(high, all, "from above, the cliff is seen");
}
