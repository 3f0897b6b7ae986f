//! Voids of a DEM in its file are drawn as those of a held one, bit by bit, and a second view reads what it needs of the
//! samples alone.

use std::sync::Arc;

use glam::DVec3;
use hachure::cache::Cache;
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::frames::{METHODS, Planned};
use crate::scenes::{level, look};
use crate::validity::{SHAPES, dem, written};

const PAGE: [u32; 2] = [96, 72];
/// A budget that holds no tile.
const SMALL: u64 = 1 << 18;

/// Over the DEM's north-west, to its middle; a far corner of it is beside the page.
fn camera(surface: &Surface) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let eye = DVec3::new(west + 0.2 * (east - west), north + 300.0, 900.0);
    look(eye, DVec3::new((west + east) / 2.0, (south + north) / 2.0, 150.0), 60.0, PAGE)
}

fn page(surface: &Arc<Surface>, detail: Detail, method: Method) -> Vec<u8> {
    Planned::new(gpu(), surface, Plan::new(detail, method, Border::On)).bytes(&camera(surface))
}

fn inked(page: &[u8]) -> usize {
    page.chunks_exact(8).filter(|pixel| pixel[0] & 2 != 0).count()
}

#[test]
fn filed_voids_are_drawn_as_held_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let details = [Detail::Adaptive { error_px: 1.0 }, level(1).into(), level(2).into(), level(4).into()];
    let mut all_inked = 0;
    for (i, (name, shape)) in SHAPES.into_iter().enumerate() {
        let path = written(&folder, shape, [300, 200]);
        let [held, filed] = [1 << 30, SMALL].map(|memory| Arc::new(Surface::new(dem(&path, memory))));
        assert!(filed.dem().is_filed());
        for (k, (of, method)) in METHODS.into_iter().enumerate() {
            // Each shape with each method; each method with each detail.
            let detail = details[(i + k) % details.len()];
            let expected = page(&held, detail, method);
            all_inked += inked(&expected);
            assert!(page(&filed, detail, method) == expected, "{name}, {of}, {detail:?}");
        }
    }
    assert!(all_inked > 10_000, "{all_inked} px, too little ink to compare");
}

#[test]
fn a_second_view_reads_what_it_draws() {
    let folder = tempfile::tempdir().expect("a folder");
    let size = [1500, 1500];
    // Blocks of voids all over, most of them beside the page.
    let path = written(&folder, |c, r, _| c % 300 < 40 && r % 250 < 50, size);
    let all = (size[0] * size[1]) as u64;
    let cache = Cache::in_folder(folder.path().join("cache"));
    let view = |expected: Option<&[u8]>| {
        let surface = Arc::new(Surface::new(dem(&path, 16 << 20)));
        cache.prepare(&surface, &|words| panic!("{words}"), &|_| ()).expect("samples");
        let looked = surface.dem().samples_read();
        let [_, _, east, north] = surface.dem().extent();
        let eye = DVec3::new(east - 3000.0, north - 2000.0, 700.0);
        let camera = look(eye, eye + DVec3::new(900.0, 500.0, -90.0), 40.0, PAGE);
        let plan = Plan::new(Detail::Adaptive { error_px: 2.0 }, Method::Walk, Border::On);
        let mut renderer = Planned::new(gpu(), &surface, plan);
        let drawn = renderer.bytes(&camera);
        let frame = renderer.last().expect("a frame");
        assert!(inked(&drawn) > 50 && frame.facets(&surface) > 0);
        assert!(!frame.left_out(&surface).expect("words").is_empty());
        assert!(expected.is_none_or(|expected| drawn == expected), "another picture at second sight");
        (looked, surface.dem().samples_read() - looked, drawn)
    };
    let (looked, drawn, first) = view(None);
    assert!(looked >= all && drawn < all / 2, "{looked} samples looked at, {drawn} drawn, of {all}");
    let (looked, drawn, _) = view(Some(&first));
    assert!(looked == 0 && drawn < all / 2, "second sight: {looked} samples looked at, {drawn} drawn, of {all}");
}
