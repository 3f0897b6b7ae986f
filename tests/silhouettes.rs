//! What must hold of silhouettes on any terrain: published counts, the plain seen at a grazing angle, undersides, stiff
//! surfaces, levels.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read};
use hachure::line::Kind;
use hachure::plan::{Border, Method, SharedVertices};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::closed_forms::GAUSSIAN;
use crate::common::shared_dems;
use crate::forms::{MIDDLE, from_middle};
use crate::frames::{METHODS, count_ink, draw};
use crate::judged::{centres, inked};
use crate::scenes::{level, look, rough};
use crate::tolerances::{COUNT_SHARE, FACETS_A_LEAP, LEVEL_STRAYS, REACH_PX};

fn west_temple(folder: &Path) -> Arc<Surface> {
    Arc::new(Surface::new(read(folder.join("west_temple_50m.tif"), &ReadOptions::default()).expect("west-temple")))
}

#[test]
fn west_temple_has_the_published_ink() {
    let Some(folder) = shared_dems() else { return };
    let surface = west_temple(&folder);
    let eye = DVec3::new(325_249.0, 4_117_889.0, 2_000.0);
    let camera = Camera { eye, azimuth: 310.0, altitude: 0.0, fov: 60.0, width: 1280, height: 720 };
    let runs = [
        (Method::TowardAway { wide: false }, 4, 3_821),
        (Method::Walk, 4, 4_215),
        (Method::Adjacency { share: SharedVertices::Edge }, 4, 244_975),
        (Method::Adjacency { share: SharedVertices::Corner }, 1, 4_571),
    ];
    let near = |ink: usize, published: u32| (ink as f64 / f64::from(published) - 1.0).abs() <= COUNT_SHARE;
    for (method, n, published) in runs {
        let ink = count_ink(&draw(&surface, &camera, level(n), method, Border::Off).raster);
        println!("west-temple {method:?} level {n}: {ink} px, published {published}");
        assert!(near(ink, published), "{method:?} at level {n}: {ink} px, published {published}");
    }
    // Negative control: another level of corner adjacency floods.
    let method = Method::Adjacency { share: SharedVertices::Corner };
    assert!(!near(count_ink(&draw(&surface, &camera, level(2), method, Border::Off).raster), 4_571));
}

/// A plain of 10 m cells, 65 columns wide and `rows` long; 600 m from its near end, if `hill`, a hill. At level 4 a
/// width and length of whole blocks: a block that the DEM's edge cuts is walked quad by quad.
fn plain(rows: usize, hill: bool) -> Arc<Surface> {
    let height = |c: usize, r: usize| {
        let d = DVec2::new(c as f64 - 32.0, r as f64 - (rows - 60) as f64).length_squared();
        if hill { (30.0 * (-d / 20.0).exp()) as f32 } else { 0.0 }
    };
    let heights = (0..65 * rows).map(|i| height(i % 65, i / 65)).collect();
    Arc::new(Surface::new(Dem::from_heights(65, DVec2::splat(10.0), MIDDLE, heights)))
}

#[test]
fn a_walk_over_a_plain_leaps_and_leaves_it_blank() {
    let rows = 601;
    let eye = MIDDLE.extend(0.0) + DVec3::new(320.0, -10.0 * (rows as f64 + 20.0), 12.0);
    let camera = Camera { eye, azimuth: 0.0, altitude: 0.0, fov: 60.0, width: 512, height: 192 };
    let flat = draw(&plain(rows, false), &camera, level(4), Method::Walk, Border::Off);
    assert_eq!(count_ink(&flat.raster), 0, "a plain has no silhouette");
    // With a hill on it the plain stays blank, and walks have to look.
    let surface = plain(rows, true);
    let frame = draw(&surface, &camera, level(4), Method::Walk, Border::Off);
    let ink = centres(&frame.raster, Kind::Silhouette);
    let foot = |x: f64| camera.project(MIDDLE.extend(0.0) + DVec3::new(320.0 + x, -10.0 * (rows - 60) as f64, 0.0)).0;
    let (west, east) = (foot(-100.0), foot(100.0));
    assert!(ink.len() > 20, "the hill has a silhouette");
    assert!(ink.iter().all(|p| p.y < west.y && p.x > west.x && p.x < east.x), "ink on the plain");
    // Facets between the two farthest neighbouring rows of pixels on the plain, along the middle column.
    let row = |k: f64| 12.0 * camera.focal() / (k + 0.5) / 10.0;
    let first = (1..90).map(f64::from).find(|&k| row(k) < rows as f64 - 45.0).expect("a row on the plain");
    let facets = (row(first) - row(first + 1.0)) * 4.0 * 2.0;
    // And from the hill to the far end of the plain.
    let beyond = (rows - 60) as f64 * 4.0 * 2.0;
    let [on_plain, beside_hill] = [flat.longest_walk, frame.longest_walk].map(f64::from);
    println!("plain: {facets:.0} facets between rows {first} and {}, longest walk {on_plain} nodes", first + 1.0);
    println!("plain with a hill: {beyond:.0} facets behind it, longest walk {beside_hill} nodes");
    assert!(facets > 400.0, "the view is not grazing");
    assert!(on_plain > 0.0 && on_plain * FACETS_A_LEAP <= facets);
    assert!(beside_hill > 0.0 && beside_hill * FACETS_A_LEAP <= beyond);
}

#[test]
fn undersides_are_paper() {
    let surface = Arc::new(Surface::new(GAUSSIAN.dem(|_, _| true)));
    // Below the ground, looking level, up at the hill from inside it, and straight up.
    let views = [(DVec3::new(-300.0, -200.0, -150.0), 60.0, 0.0), (DVec3::new(0.0, 0.0, 20.0), 10.0, 30.0)];
    let views = views.into_iter().chain([(DVec3::new(100.0, -300.0, -400.0), 0.0, 90.0)]);
    for (eye, azimuth, altitude) in views {
        let camera = Camera { eye: from_middle(eye), azimuth, altitude, fov: 60.0, width: 256, height: 256 };
        for (name, method) in METHODS {
            let raster = draw(&surface, &camera, level(1), method, Border::On).raster;
            assert_eq!(count_ink(&raster), 0, "{name} draws on an underside");
            assert!(raster.pixels.iter().all(|p| p.kind() == Kind::Sky), "{name}: an underside hides nothing");
        }
    }
    // Negative control: the same hill from above.
    let camera = look(from_middle(DVec3::new(0.0, -1000.0, 140.0)), from_middle(DVec3::ZERO), 60.0, [256, 256]);
    assert!(count_ink(&draw(&surface, &camera, level(1), Method::Walk, Border::On).raster) > 0);
}

#[test]
fn a_stiff_and_folded_surface_draws() {
    let surface = Arc::new(Surface::new(rough(60, 50, 100.0, 8.0, true)));
    let [west, south, east, north] = surface.dem().extent();
    let top = f64::from(surface.dem().range().expect("heights")[1]);
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    for eye in [DVec3::new(-900.0, -700.0, 0.4 * top), DVec3::new(20.0, 30.0, 1.2 * top)] {
        let camera = look(middle + eye, middle, 60.0, [256, 256]);
        for (name, method) in METHODS {
            let raster = draw(&surface, &camera, level(4), method, Border::On).raster;
            println!("stiff, {name}: {} px of ink", count_ink(&raster));
            assert!(count_ink(&raster) > 0, "{name} draws nothing");
        }
    }
}

#[test]
fn levels_converge() {
    // 25 m cells seen from a few hundred metres: facets of level 1 are many pixels wide.
    let surface = Arc::new(Surface::new(rough(18, 18, 1.0, 4.0, false)));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let camera = look(middle + DVec3::new(-120.0, -330.0, 130.0), middle, 60.0, [384, 288]);
    let ink = [4, 16, 32, 64]
        .map(|n| inked(&draw(&surface, &camera, level(n), Method::Walk, Border::Off).raster, Kind::Silhouette));
    let strays = |a: usize, b: usize| {
        let near = |p: DVec2| ink[b].iter().any(|q| q.0.distance(p) <= REACH_PX);
        ink[a].iter().filter(|p| !near(p.0)).count() as f64 / ink[a].len() as f64
    };
    let pairs = [(0, 3), (1, 2), (2, 1), (2, 3), (3, 2)];
    println!(
        "levels 4, 16, 32, 64: {:?} px, strays {:?}",
        ink.each_ref().map(Vec::len),
        pairs.map(|(a, b)| strays(a, b))
    );
    for (a, b) in &pairs[1..] {
        assert!(strays(*a, *b) <= LEVEL_STRAYS, "levels {a} and {b} of 4, 16, 32, 64 differ");
    }
    // Negative control: level 4 is not there yet.
    assert!(strays(0, 3) > LEVEL_STRAYS, "the comparison is blind");
}
