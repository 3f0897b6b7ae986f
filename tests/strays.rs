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
use crate::scenes::{look, rough};
use crate::tolerances::{FAR_STRAYS, STRAYS};

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
        black: 1.0,
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
fn strays_of(surface: Arc<Surface>, camera: &Camera) -> [usize; 3] {
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
    let sample = Arc::new(Surface::new(read(dem, &ReadOptions::default()).expect("a DEM")));
    // From so far that no ridge is nearer than another by a share worth speaking of: what is hidden the walk alone tells.
    let hills = Arc::new(Surface::new(rough(120, 100, 1.0, 0.5, false)));
    let [west, south, east, north] = hills.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let away = look(middle + DVec3::new(30_000.0, -200_000.0, 9_000.0), middle, 0.6, [640, 240]);
    for (surface, camera, share) in [(&sample, far, STRAYS), (&sample, low, STRAYS), (&hills, away, FAR_STRAYS)] {
        let [chains, ink, all] = strays_of(surface.clone(), &camera);
        println!("{chains} px of chains without ink, {ink} px of ink without a chain, {all} px of ink");
        assert!(all > 2500 && chains.max(ink) as f64 <= share * all as f64, "{chains} and {ink} of {all} px");
    }
}
