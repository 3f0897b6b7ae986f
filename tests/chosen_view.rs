//! The view that is chosen where none is given: above the ground, repeatable from its decimals, and with lines in it.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::geo::read;
use hachure::plan::{Border, Method};
use hachure::surface::Surface;
use hachure::view::{Camera, Fixed, choose};

use crate::common::shared_dems;
use crate::frames::{count_ink, draw};
use crate::scenes::{level, rough};

const PAGE: [u32; 2] = [480, 270];

fn chosen(dem: &Dem, fixed: Fixed) -> Camera {
    choose(dem, fixed, 60.0, PAGE[0], PAGE[1]).expect("in memory")
}

/// Silhouette pixels in the chosen view of a DEM, after checks of the eye.
fn ink_in_view(dem: Dem) -> usize {
    let surface = Arc::new(Surface::new(dem));
    let camera = chosen(surface.dem(), Fixed::default());
    assert!(surface.height_below(camera.eye.truncate(), level(4)).is_none_or(|ground| camera.eye.z > ground));
    for x in camera.eye.to_array() {
        // What is printed is what was chosen, and short.
        assert!(format!("{x}").len() <= 16, "{x}");
    }
    count_ink(&draw(&surface, &camera, level(4), Method::Walk, Border::Off).raster)
}

#[test]
fn the_chosen_view_shows_the_relief() {
    let sample = read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif")), &Default::default());
    let ink = ink_in_view(sample.expect("the sample"));
    assert!(ink > 2000, "the sample: {ink} px");
    let ink = ink_in_view(rough(80, 60, 1.0, 0.0, false));
    assert!(ink > 1000, "rolling hills: {ink} px");
    // A hill of 0.1 m on cells of 5 mm.
    let height = |i: usize| {
        let (x, y) = ((i % 100) as f32 - 49.5, (i / 100) as f32 - 49.5);
        0.1 * (-(x * x + y * y) / 400.0).exp()
    };
    let small = Dem::from_heights(100, DVec2::splat(0.005), DVec2::new(5e5, 4e6), (0..10_000).map(height).collect());
    let ink = ink_in_view(small);
    assert!(ink > 150, "a small hill: {ink} px");
}

#[test]
fn the_chosen_view_shows_real_relief() {
    let Some(dems) = shared_dems() else { return };
    for name in ["west_temple_50m.tif", "yosemite_utm11n_30m.tif"] {
        let ink = ink_in_view(read(dems.join(name), &Default::default()).expect(name));
        assert!(ink > 1500, "{name}: {ink} px");
    }
}

#[test]
fn what_is_given_stays() {
    let dem = rough(80, 60, 1.0, 0.0, false);
    let [west, south, east, north] = dem.extent();
    let eye = DVec3::new(west, (south + north) / 2.0, 500.0);
    let camera = chosen(&dem, Fixed { eye: Some(eye), ..Fixed::default() });
    assert_eq!((camera.eye, camera.azimuth, camera.altitude), (eye, 90.0, 0.0), "a given eye looks at the middle");
    let northwards = DVec3::new((west + east) / 2.0, south, 500.0);
    assert_eq!(chosen(&dem, Fixed { eye: Some(northwards), ..Fixed::default() }).azimuth, 0.0);
    let camera = chosen(&dem, Fixed { azimuth: Some(33.0), altitude: Some(-7.5), ..Fixed::default() });
    assert_eq!((camera.azimuth, camera.altitude), (33.0, -7.5));
}
