//! Lines that chains or the mask have alone are counted; of real land there are hardly any.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::geo::{ReadOptions, read};
use hachure::line::{Chain, ChainPoint, Kind, Line, Mark, Marks, Pixel, Strays};
use hachure::plan::{Curves, Plan};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::tolerances::STRAYS;

const PAGE: [u32; 2] = [64, 32];

fn row_of_ink(row: u32, columns: std::ops::Range<u32>) -> impl Iterator<Item = Mark> {
    columns.map(move |column| {
        let pixel = Pixel::new(Kind::Silhouette, DVec2::ZERO, 0.1);
        Mark { column, row, pixel, beside_sky: false }
    })
}

fn level_chain(y: f64, from: f64, to: f64) -> Chain {
    let point = |x: f64| ChainPoint {
        place: DVec2::new(x, y),
        line: Line::Occluding,
        depth: 0.1,
        behind: 0.0,
        world: DVec3::ZERO,
        crowd: 0,
        weight: 1.0,
    };
    Chain { id: None, points: [from, to].map(point).to_vec(), closed: false }
}

fn strays(chains: &[Chain], ink: Vec<Mark>) -> [usize; 2] {
    let Strays { chains, ink } = Strays::of(chains, &Marks::new(PAGE, ink));
    [chains, ink]
}

#[test]
fn what_one_of_them_has_alone_is_counted() {
    let chain = level_chain(10.5, 4.0, 24.0);
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(10, 4..24).collect()), [0, 0]);
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(11, 4..24).collect()), [0, 0], "a pixel beside it");
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(12, 4..24).collect()), [20, 20], "two pixels");
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(10, 4..14).collect()), [9, 0], "half the ink");
    let specks = row_of_ink(10, 4..24).chain(row_of_ink(20, 4..9)).chain(row_of_ink(25, 4..10));
    assert_eq!(strays(&[chain], specks.collect()), [0, 6], "five pixels are no line");
    assert_eq!(strays(&[], Vec::new()), [0, 0]);
}

/// Pixels of chains and of ink that one of them has alone, and of all ink.
fn strays_of(dem: &Path, camera: &Camera) -> [usize; 3] {
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default()).expect("a DEM")));
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    let plan = Plan { curves: Curves::On, ..Plan::default() };
    let page = renderer.page(&plan, camera, |_| ()).expect("a page");
    let Strays { chains, ink } = Strays::of(&page.chains, &page.marks);
    [chains, ink, page.marks.inked()]
}

#[test]
fn contours_and_the_walk_tell_of_the_same_lines() {
    let dem = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let far = Camera {
        eye: DVec3::new(539_172.0, 4_193_028.0, 242.0),
        azimuth: 135.0,
        altitude: -7.3,
        fov: 60.0,
        width: 1600,
        height: 900,
    };
    let low = Camera { eye: DVec3::new(547_500.0, 4_183_300.0, 330.0), azimuth: 318.0, altitude: -6.0, ..far };
    for camera in [far, low] {
        let [chains, ink, all] = strays_of(&dem, &camera);
        println!("{chains} px of chains without ink, {ink} px of ink without a chain, {all} px of ink");
        assert!(all > 5000 && chains.max(ink) as f64 <= STRAYS * all as f64, "{chains} and {ink} of {all} px");
    }
}
