//! Leaving out changes time, never the picture: every frame is drawn with all shortcuts and with none, bit for bit. And
//! what a frame says it did without, it did without.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use glam::DVec3;
use hachure::door::plan::frame::KeptLattice;
use hachure::door::plan::{Frame, PassName, detail};
use hachure::door::surface::Tile;
use hachure::plan::{Border, Culling, Curves, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::shared_dems;
use crate::frames::{METHODS, Planned};
use crate::quadtrees::moor;
use crate::scenes::{Random, gpu, level, rough};

const PAGE: [u32; 2] = [123, 77];
/// Frames of each scene and method.
const FRAMES: usize = 24;

/// Eyes in, over, under and beside the DEM, looking anywhere, with narrow and wide fields of view.
fn anywhere(surface: &Surface, random: &mut Random) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let [low, high] = surface.dem().range().expect("land").map(f64::from);
    let (wide, tall) = (east - west, north - south);
    let relief = (high - low).max(wide / 20.0);
    Camera {
        eye: DVec3::new(
            random.between(west - 0.3 * wide, east + 0.3 * wide),
            random.between(south - 0.3 * tall, north + 0.3 * tall),
            random.between(low - 0.2 * relief, high + 1.5 * relief),
        ),
        azimuth: random.between(0.0, 360.0),
        altitude: random.between(-90.0, 40.0),
        fov: random.between(2.0, 120.0),
        width: PAGE[0],
        height: PAGE[1],
    }
}

/// Compares frames of one scene; returns how many pixels were inked in all.
fn compare(surface: &Arc<Surface>, detail: Detail, method: Method, frames: usize, seed: u64) -> usize {
    let make = |culling| Planned::new(gpu(), surface, Plan { culling, ..Plan::new(detail, method, Border::On) });
    let (mut culls, mut whole) = (make(Culling::On), make(Culling::Off));
    let mut random = Random::new(seed);
    let mut inked = 0;
    for _ in 0..frames {
        let camera = anywhere(surface, &mut random);
        let expected = whole.bytes(&camera);
        assert!(culls.bytes(&camera) == expected, "{method:?}, {detail:?}: {camera:?} differs");
        inked += expected.chunks_exact(8).filter(|p| p[0] & 2 != 0).count();
    }
    inked
}

/// Chunks whose contours are looked for, as curve.wgsl notes it.
const DRAWN: u32 = 8;

#[test]
fn what_is_left_out_changes_no_curve() {
    let surface = Arc::new(Surface::new(rough(90, 75, 1.0, 0.5, false)));
    let [west, south, east, north] = surface.dem().extent();
    let [low, _] = surface.dem().range().expect("land").map(f64::from);
    for detail in [Detail::Uniform(level(2)), Detail::Uniform(level(8))] {
        let plan = |culling| Plan { culling, curves: Curves::On, ..Plan::new(detail, Method::Walk, Border::On) };
        let frames = [Culling::On, Culling::Off].map(|culling| Planned::new(gpu(), &surface, plan(culling)));
        let [mut culls, mut whole] = frames;
        let (mut random, mut left_out, mut points) = (Random::new(5), 0, 0);
        for _ in 0..6 {
            let (x, y) = (random.between(west, east), random.between(south, north));
            let eye = DVec3::new(x, y, low + random.between(20.0, 60.0));
            let azimuth = random.between(0.0, 360.0);
            let camera = Camera { eye, azimuth, altitude: -5.0, fov: 60.0, width: 256, height: 160 };
            let curves = [&mut culls, &mut whole].map(|renderer| {
                renderer.draw(&camera).expect("a frame");
                renderer.curves().expect("curves")
            });
            assert!(curves[0] == curves[1], "{detail:?}: {camera:?} differs");
            points += curves[0].iter().map(|curve| curve.points.len()).sum::<usize>();
            let drawn = |renderer: &Planned| {
                let words: Vec<u32> = renderer.values("turning", renderer.lattice().chunks().len());
                words.iter().filter(|word| **word & DRAWN != 0).count()
            };
            left_out += drawn(&whole) - drawn(&culls);
        }
        println!("{detail:?}: {points} points of curves, {left_out} chunks left out");
        assert!(points > 400 && left_out > 50, "{points} points, {left_out} chunks left out");
    }
}

#[test]
fn what_is_left_out_changes_no_bit() {
    let scenes = [rough(60, 50, 3.0, 5.0, false), rough(60, 50, 2.0, 2.0, true)].map(|dem| Arc::new(Surface::new(dem)));
    for (surface, seed) in scenes.iter().zip([1, 2]) {
        for (_, method) in METHODS {
            for n in [1, 4] {
                let inked = compare(surface, level(n).into(), method, FRAMES, seed * 1000 + u64::from(n));
                assert!(inked > 500, "{method:?}, level {n}: {inked} px, too little ink to compare");
            }
        }
    }
}

#[test]
fn what_is_left_out_of_real_terrain_changes_no_bit() {
    let Some(dems) = shared_dems() else { return };
    let read = |name: &str| hachure::geo::read(dems.join(name), &Default::default()).expect(name);
    let surface = Arc::new(Surface::new(read("west_temple_50m.tif")));
    assert!(compare(&surface, level(4).into(), Method::Walk, FRAMES, 77) > 1000);
}

/// Frames of several levels by every method; `frames` of each scene, method and error.
fn compare_levels(frames: usize, errors: &[f64]) {
    let scenes = [rough(60, 50, 3.0, 5.0, false), rough(60, 50, 2.0, 2.0, true), moor()];
    let mut all_inked = 0;
    for (surface, seed) in scenes.map(|dem| Arc::new(Surface::new(dem))).iter().zip([11, 12, 13]) {
        for (_, method) in METHODS {
            for error_px in errors {
                let detail = Detail::Adaptive { error_px: *error_px };
                all_inked += compare(surface, detail, method, frames, seed * 1000 + (error_px * 8.0) as u64);
            }
        }
    }
    assert!(all_inked > 1000 * frames, "{all_inked} px, too little ink to compare");
}

#[test]
fn what_is_left_out_of_several_levels_changes_no_bit() {
    compare_levels(6, &[1.0]);
}

#[test]
#[ignore = "minutes: while working on what is left out"]
fn what_is_left_out_of_a_thousand_frames_changes_no_bit() {
    compare_levels(70, &[0.25, 2.0, 15.0]);
}

#[test]
fn what_is_left_out_of_views_of_real_terrain_changes_no_bit() {
    let Some(dems) = shared_dems() else { return };
    let views = [
        ("west_temple_50m.tif", DVec3::new(325_249.0, 4_117_889.0, 2000.0), 310.0, 0.0),
        ("yosemite_utm11n_30m.tif", DVec3::new(273_209.0, 4_179_010.0, 2225.0), 66.0, -4.0),
        ("SainteHelens.dem", DVec3::new(561_000.0, 5_121_500.0, 2700.0), 172.0, -3.0),
    ];
    for (name, eye, azimuth, altitude) in views {
        let dem = hachure::geo::read(dems.join(name), &Default::default()).expect(name);
        let surface = Arc::new(Surface::new(dem));
        let camera = Camera { eye, azimuth, altitude, fov: 60.0, width: 640, height: 360 };
        let [culls, whole] = [Culling::On, Culling::Off].map(|culling| {
            let plan = Plan { culling, ..Plan::default() };
            Planned::new(gpu(), &surface, plan).bytes(&camera)
        });
        assert!(culls == whole, "{name} differs");
        assert!(whole.chunks_exact(8).filter(|p| p[0] & 2 != 0).count() > 500, "{name}: too little ink");
    }
}

#[test]
fn another_frame_is_noticed() {
    let surface = Arc::new(Surface::new(rough(60, 50, 3.0, 5.0, false)));
    let plan = Plan::new(level(1), Method::Walk, Border::On);
    let page = |culling, camera| Planned::new(gpu(), &surface, Plan { culling, ..plan }).bytes(camera);
    let [west, south, _, _] = surface.dem().extent();
    let camera = Camera {
        eye: DVec3::new(west, south, 400.0),
        azimuth: 45.0,
        altitude: -10.0,
        ..anywhere(&surface, &mut Random::new(5))
    };
    let moved = Camera { azimuth: camera.azimuth + 0.1, ..camera };
    assert!(page(Culling::On, &moved) != page(Culling::Off, &camera));
}

/// What a frame does without, by rule and in the order of telling.
fn expected(frame: &Frame, surface: &Surface) -> Vec<&'static str> {
    let Frame { plan, lattice, .. } = frame;
    let (dem, chunks) = (surface.dem(), lattice.chunks());
    let is_adaptive = matches!(plan.detail, Detail::Adaptive { .. });
    let tiles: HashSet<Tile> = chunks.iter().map(Tile::of).collect();
    let all_tiles = [dem.columns(), dem.rows()].map(|samples| (samples - 1).div_ceil(16)).iter().product();
    let beside = detail::across(surface, lattice, &frame.camera).expect("a pyramid").any(|across| !across);
    let rules = [
        ("fine facets", is_adaptive),
        ("rasterizing", (frame.seen as usize) < chunks.len()),
        ("samples", is_adaptive && tiles.len() < all_tiles),
        ("chunks", !is_adaptive && plan.culling == Culling::On && beside),
        ("seam pass", chunks.iter().all(|chunk| chunk.coarser == 0)),
        ("border pass", plan.border == Border::Off),
        ("void tests", dem.voids() == 0),
    ];
    rules.into_iter().filter(|(_, is_left_out)| *is_left_out).map(|(what, _)| what).collect()
}

#[test]
fn frames_say_what_they_do_without() {
    let scenes = [rough(60, 50, 3.0, 5.0, false), rough(60, 50, 2.0, 2.0, true)].map(Surface::new);
    let details: [Detail; 3] = [level(2).into(), Detail::default(), Detail::Adaptive { error_px: 9.0 }];
    let mut random = Random::new(41);
    let (mut frames, mut told) = (0, BTreeMap::<&str, usize>::new());
    for (surface, (name, method)) in scenes.iter().flat_map(|surface| METHODS.map(|method| (surface, method))) {
        for (detail, int64) in details.into_iter().flat_map(|detail| [(detail, true), (detail, false)]) {
            for culling in [Culling::On, Culling::Off] {
                for border in [Border::On, Border::Off] {
                    let plan = Plan { culling, ..Plan::new(detail, method, border) };
                    let camera = anywhere(surface, &mut random);
                    let frame =
                        Frame::new(&plan, surface, &camera, int64, &mut KeptLattice::default()).expect("a frame");
                    let left_out = frame.left_out(surface).expect("words");
                    let whats: Vec<_> = left_out.iter().map(|left_out| left_out.what).collect();
                    assert_eq!(whats, expected(&frame, surface), "{name}, {plan:?}, {camera:?}");
                    let lacks = |pass| frame.passes.iter().all(|planned| planned.name != pass);
                    let passes = [("seam pass", PassName::Seam), ("border pass", PassName::Border)];
                    assert!(passes.iter().all(|(what, pass)| whats.contains(what) == lacks(*pass)), "{whats:?}");
                    frames += 1;
                    whats.into_iter().for_each(|what| *told.entry(what).or_default() += 1);
                }
            }
        }
    }
    assert!(told.len() == 7 && told.values().all(|n| *n > 0 && *n < frames), "of {frames} frames: {told:?}");
}
