//! What cannot be drawn is refused with what, where and remedy, before anything is allocated.

use glam::DVec2;
use hachure::cli::words::{exit_code, line};
use hachure::dem::Dem;
use hachure::error::{Error, Result};
use hachure::gpu::{AdapterChoice, CameraUniform, Gpu, Int64};
use hachure::plan::{Border, Method, Pieces, Plan};
use hachure::render::Renderer;
use hachure::surface::{Lattice, Surface};
use hachure::view::Camera;

use crate::common::gpu;
use crate::drawn::{BY_ID, look, over, renderer, rough};
use crate::scenes::level;

/// The error of a call that must fail, with the words it must contain.
fn refused<T>(outcome: Result<T>, words: &[&str]) -> Error {
    let Err(error) = outcome else { panic!("this must be refused: {words:?}") };
    let line = line(&error);
    assert!(!line.contains('\n'), "one line: {line}");
    words.iter().for_each(|word| assert!(line.contains(word), "`{word}` is missing in: {line}"));
    error
}

fn flat(columns: usize, rows: usize) -> Dem {
    Dem::from_heights(columns, DVec2::splat(30.0), DVec2::ZERO, vec![0.0; columns * rows])
}

#[test]
fn an_adapter_of_no_name_is_refused_with_those_there_are() {
    let there = &gpu().info.name;
    let choice = AdapterChoice::Named("no such".into());
    let error = refused(Gpu::open(&choice, Int64::IfPresent), &["no such", "there is: ", there]);
    assert!(matches!(error, Error::NoAdapter { .. }));
    assert_eq!(exit_code(&error), 1);
}

#[test]
fn a_camera_of_another_page_is_refused() {
    let scene = Surface::new(flat(4, 4));
    let renderer =
        Renderer::new(gpu(), &scene, Plan::new(level(1), Method::Walk, Border::On), [64, 48]).expect("small");
    let eye = glam::DVec3::new(50.0, -200.0, 100.0);
    let camera = |width, height| Camera { eye, azimuth: 0.0, altitude: -20.0, fov: 60.0, width, height };
    assert!(renderer.frame(&camera(64, 48)).is_ok());
    refused(renderer.frame(&camera(65, 48)), &["65x48", "64x48"]);
}

#[test]
fn facets_beyond_their_ids_are_refused_with_numbers() {
    // 2896 x 2896 chunks of 512 facets have IDs, 2900 x 2900 have not; at level 64 a chunk is a quarter of a cell.
    assert!(Lattice::uniform(&flat(725, 725), level(64)).is_ok());
    let error =
        refused(Lattice::uniform(&flat(726, 726), level(64)), &["level 64", "4305920000 facets", "8388607", "--level"]);
    assert!(matches!(error, Error::Limit { .. }));
    refused(Lattice::uniform(&flat(131_001, 2), level(1)), &["131001 x 2", "131000", "--crop"]);
    assert!(Lattice::uniform(&flat(131_000, 2), level(1)).is_ok());
    // 2048 x 4096 chunks would need an ID of 2^32 - 1, and a pixel holds ID + 1.
    refused(Lattice::uniform(&flat(513, 1025), level(64)), &["level 64", "8388608 chunks"]);
    assert!(Lattice::uniform(&flat(512, 1025), level(64)).is_ok());
}

#[test]
fn pages_too_large_are_refused_with_numbers() {
    let scene = Surface::new(flat(4, 4));
    let draw = |size| Renderer::new(gpu(), &scene, Plan::new(level(1), Method::Walk, Border::On), size);
    let piece = |size| Pieces::new(size, size);
    for (size, words) in [
        (piece([5000, 4000]), ["5000x4000", "20000000", "16777216", "--size"]),
        (piece([16_385, 16]), ["16385x16", "16384", "in one piece", "--size"]),
        (Pieces::from([65_537, 16]), ["65537x16", "65536", "page side", "--size"]),
        (Pieces::from([16, 70_000]), ["16x70000", "65536", "page side", "--size"]),
    ] {
        assert!(matches!(refused(draw(size), &words), Error::Limit { .. }));
    }
    assert!(draw(piece([16_384, 16])).is_ok());
    // One piece can be read back whole, of several the device holds the last alone.
    let cut = draw(Pieces::new([64, 48], [33, 48])).expect("two pieces");
    let eye = glam::DVec3::new(50.0, -200.0, 100.0);
    let camera = Camera { eye, azimuth: 0.0, altitude: -20.0, fov: 60.0, width: 64, height: 48 };
    refused(cut.draw(&camera), &["2 pieces", "--size"]);
}

#[test]
fn an_eye_out_of_reach_is_wrong_usage() {
    let scene = rough(1, [8, 8], 50.0, 40.0);
    let renderer = renderer(gpu(), &scene, 1, BY_ID, [64, 64]);
    let near = look(over(&scene, 3.0, 3.0, 50.0), 0.0, 0.0, [64, 64]);
    renderer.frame(&near).expect("an eye over the DEM");
    for eye in [near.eye * 1e6, near.eye.with_x(f64::NAN), near.eye.with_y(f64::INFINITY)] {
        let far = hachure::view::Camera { eye, ..near };
        let error = refused(renderer.frame(&far), &["--eye", "million cells", "CRS"]);
        assert!(matches!(error, Error::Setting { .. }));
        assert_eq!(exit_code(&error), 2);
        assert!(CameraUniform::new(scene.dem(), &far).is_err());
    }
}

#[test]
#[should_panic(expected = "this must be refused")]
fn a_refusal_that_does_not_come_is_noticed() {
    refused(Lattice::uniform(&flat(4, 4), level(1)), &["level"]);
}

#[test]
#[should_panic(expected = "is missing in")]
fn a_refusal_without_its_numbers_is_noticed() {
    refused(Lattice::uniform(&flat(726, 726), level(64)), &["level 32"]);
}
