//! Ill-conditioned views: eyes and directions in which a rounding decides what is seen.

use glam::{DVec2, DVec3};

use super::{CELL, Make, hills};
use crate::dem::Dem;
use crate::stress::case::{PAGE, above, look};
use crate::stress::lands::{grid, hashed, sixteenths};
use crate::stress::{Case, Group, Promise};
use crate::surface::Level;
use crate::view::Camera;

pub(super) const CASES: &[Make] = &[
    edge_on,
    noisy_plain,
    dunes,
    on_the_land,
    on_a_sample,
    in_the_ground,
    in_a_spike,
    straight,
    fov,
    pixel_centres,
    tangent,
    cusp,
    outside,
    near_plane,
];

fn views(name: &'static str, about: &'static str, dem: Dem) -> Case {
    Case::new(Group::Views, name, about, dem).exact()
}

/// A camera that looks level to an azimuth.
fn level(eye: DVec3, azimuth: f64) -> Camera {
    Camera { eye, azimuth, altitude: 0.0, fov: 60.0, width: PAGE[0], height: PAGE[1] }
}

/// A plane that holds the eye: no facet faces it, none faces away for certain. Truth is noise there too, so that nothing is held to
/// it but that ink does not spread.
fn edge_on() -> Case {
    let flat = grid([65, 65], CELL, |c, r| 8.0 * c + 4.0 * r);
    let in_plane = |column: f64, row: f64| {
        let place = flat.position(0, 0) + DVec3::new(column, -row, 0.0) * CELL;
        place.with_z(8.0 * column + 4.0 * row)
    };
    let (inside, outside, target) = (in_plane(20.0, 50.0), in_plane(-40.0, 90.0), in_plane(40.0, 20.0));
    views("edge-on", "a plane that holds the eye", flat)
        .view("inside", look(inside, target, 60.0, PAGE))
        .view("outside", look(outside, target, 60.0, PAGE))
        .without(Promise::Accurate)
        .without(Promise::Conditioned)
        .without(Promise::Turned)
        .without(Promise::TurnedFar)
}

/// A plain with noise of 6 cm from 2 m above it, to the horizon.
fn noisy_plain() -> Case {
    let dem = grid([257, 257], CELL, |c, r| sixteenths(hashed(8, c, r) / 16.0 * 2.0));
    views("noisy-plain", "a plain with noise of a sixteenth of a metre, from 2 m", dem)
        .seen("horizon", [128.0, 250.0, 2.0], [128.0, 10.0, 2.0])
        .flown()
        .truth_to(Level::EIGHT)
        .in_short()
}

/// Dunes whose crests lie as high as the eye.
fn dunes() -> Case {
    let dem = grid([129, 129], CELL, |c, r| {
        let wave = ((c + 0.25 * r) / 16.0 * std::f64::consts::TAU).sin();
        sixteenths(12.0 * wave + 0.05 * r)
    });
    let eye = above(&dem, [64.0, 126.0, 0.0]).with_z(18.0);
    let level_eye = Camera { azimuth: 350.0, ..level(eye, 0.0) };
    views("dunes", "dunes whose crests lie as high as the eye", dem)
        .view("grazing", level_eye)
        .view("across", level(eye.with_z(15.0), 290.0))
        .flown()
}

/// The eye on an edge between two samples, and in a facet.
fn on_the_land() -> Case {
    let dem = hills(65, 9, 1.0);
    let [a, b, c] = [[30.0, 40.0, 0.0], [31.0, 41.0, 0.0], [31.0, 40.0, 0.0]].map(|at| above(&dem, at));
    let (edge, facet) = (a.midpoint(b), (a * 2.0 + b + c) / 4.0);
    views("on-the-land", "the eye on an edge, in a facet", dem)
        .view("edge", level(edge, 10.0))
        .view("facet", level(facet, 10.0))
}

/// The eye on a sample: all facets about it hold it, and count as facing away, or not, by a rounding. Truth has 1 132 px of line there
/// at level 32 and none at level 64, so that nothing is held to it but that ink does not spread.
fn on_a_sample() -> Case {
    let dem = hills(65, 9, 1.0);
    let sample = above(&dem, [30.0, 40.0, 0.0]);
    views("on-a-sample", "the eye on a sample", dem).view("sample", level(sample, 10.0)).without(Promise::Accurate)
}

/// The eye 5 m and 500 m below the ground.
fn in_the_ground() -> Case {
    views("in-the-ground", "the eye below the ground", hills(65, 9, 1.0))
        .seen("shallow", [30.0, 40.0, -5.0], [32.0, 10.0, 100.0])
        .seen("deep", [32.0, 60.0, -500.0], [32.0, 10.0, 100.0])
}

/// The eye inside a spike of one sample.
fn in_a_spike() -> Case {
    let dem = grid([33, 33], CELL, |c, r| {
        let spike = if c == 16.0 && r == 16.0 { 640.0 } else { 0.0 };
        spike + CELL * super::rolling(10, c, r)
    });
    let inside = above(&dem, [16.0, 16.0, -320.0]);
    views("in-a-spike", "the eye inside a spike of one sample", dem).view("out", level(inside, 15.0))
}

/// Straight down and straight up.
fn straight() -> Case {
    let dem = hills(65, 11, 1.0);
    let eye = above(&dem, [32.25, 31.5, 1500.0]);
    let below = eye.with_z(-900.0);
    views("straight", "straight down and straight up", dem)
        .view("down", Camera { altitude: -90.0, ..level(eye, 30.0) })
        .view("up", Camera { altitude: 90.0, ..level(below, 30.0) })
}

/// Fields of view from a thousandth of a degree to nearly all.
fn fov() -> Case {
    let dem = hills(65, 1, 1.0);
    let (eye, target) = (above(&dem, [32.0, 63.0, 150.0]), above(&dem, [30.0, 20.0, 0.0]));
    let near = look(eye, target, 60.0, PAGE);
    // From far off the ground between two samples fills the page.
    let far = DVec3::new(-40.0, -900.0, 40.0) * CELL;
    views("fov", "fields of view of 0.001, 1, 170 and 179.9 degrees", dem)
        .view("0.001", look(target + far, target, 0.001, PAGE))
        .view("1", look(target + far, target, 1.0, PAGE))
        .view("170", Camera { fov: 170.0, ..near })
        .view("179.9", Camera { fov: 179.9, ..near })
}

/// A roof whose ridge runs along the centres of a row of pixels.
fn pixel_centres() -> Case {
    let dem = grid([65, 65], CELL, |_, r| 512.0 - 16.0 * (r - 32.0).abs());
    // At 90 degrees across a pixel is 1/160 of the distance: the ridge lies half a pixel below the middle of the page.
    let back = 40.0 * CELL;
    let ridge = dem.position(32, 32);
    let eye = ridge + DVec3::new(0.0, -back, back / 320.0);
    views("pixel-centres", "a ridge along the centres of a row of pixels", dem)
        .view("row", Camera { fov: 90.0, ..level(eye, 0.0) })
        .in_short()
}

/// A long round ridge along which the eye looks: its contour is nearly tangent to the line of sight.
fn tangent() -> Case {
    let dem = grid([65, 257], CELL, |c, r| sixteenths(300.0 - (c - 32.0) * (c - 32.0) * 0.75 - 0.01 * r));
    let crest = above(&dem, [32.0, 250.0, 0.0]);
    views("tangent", "a contour nearly along the line of sight for 8 km", dem)
        .view("crest", level(crest + DVec3::new(60.0, 0.0, 1.0), 0.5))
        .view("flank", level(crest + DVec3::new(200.0, 0.0, 10.0), 359.0))
}

/// A crater: contours end in cusps, where they turn back.
fn cusp() -> Case {
    let dem = grid([65, 65], CELL, |c, r| {
        let d = DVec2::new(c - 32.0, r - 32.0).length_squared() / 144.0;
        sixteenths(500.0 * (0.3 + d) * (-d).exp())
    });
    views("cusp", "a crater, whose contours turn back in cusps", dem)
        .seen("rim", [20.0, 90.0, 600.0], [32.0, 32.0, 0.0])
        .seen("low", [32.0, 80.0, 220.0], [32.0, 32.0, 0.0])
        .flown()
}

/// The eye outside the land: beside it, below its rim, and under it.
fn outside() -> Case {
    views("outside", "the eye beside the land, below its rim, under it", hills(65, 12, 1.0))
        .seen("beside", [32.0, 100.0, 300.0], [32.0, 32.0, 0.0])
        .seen("below-the-rim", [32.0, 70.0, -60.0], [32.0, 32.0, 60.0])
        .seen("under", [32.0, 32.0, -900.0], [36.0, 20.0, 0.0])
}

/// The near plane cuts the land before the eye.
fn near_plane() -> Case {
    let dem = hills(65, 13, 1.0);
    // The near plane lies 1/1024 of a cell before the eye.
    let close = CELL / 4096.0;
    let on = above(&dem, [30.0, 40.0, close]);
    views("near-plane", "the near plane cuts the land", dem)
        .view("ahead", Camera { altitude: -20.0, ..level(on, 10.0) })
        .view("down", Camera { altitude: -80.0, ..level(on, 10.0) })
        .flown()
}
