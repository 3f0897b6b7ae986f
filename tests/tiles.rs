//! Large pages: drawn in tiles, a page has the same bits as in one piece.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::gpu::Gpu;
use hachure::ink::Pixel;
use hachure::plan::tiles::{HALO, LARGEST_PAGE, LARGEST_PIECE, LONGEST_PIECE, Rectangle};
use hachure::plan::{Border, Method, Plan, Tile, Tiles};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::shared_dems;
use crate::drawn::over;
use crate::scenes::{METHODS, gpu, gpu_without_int64, level, look, rough};

const PAGE: [u32; 2] = [197, 131];

/// The page as packed for readback, put together from tiles of at most `side` pixels, each changed by `cut` before.
fn page_in(gpu: &Gpu, scene: &Scene<'_>, side: [u32; 2], cut: impl Fn(Tile) -> Tile) -> Vec<Pixel> {
    let plan = Plan::new(level(scene.level), scene.method, Border::On);
    let tiles = Tiles::new([scene.camera.width, scene.camera.height], side);
    let renderer = Renderer::new(gpu, scene.surface, plan, tiles).expect("a renderer");
    let width = scene.camera.width as usize;
    let mut page = vec![Pixel::new(hachure::ink::Kind::Sky, DVec2::ZERO, 7.0); width * scene.camera.height as usize];
    for tile in tiles.iter().map(cut) {
        let raster = renderer.draw_tile(&scene.camera, tile).expect("a tile").raster;
        for row in 0..tile.kept.size[1] {
            for column in 0..tile.kept.size[0] {
                let [x, y] = [tile.kept.origin[0] + column, tile.kept.origin[1] + row];
                let inside = [x - tile.drawn.origin[0], y - tile.drawn.origin[1]].map(i64::from);
                page[y as usize * width + x as usize] = raster.at(inside[0], inside[1]).expect("a pixel of the tile");
            }
        }
    }
    page
}

/// What is drawn.
struct Scene<'a> {
    surface: &'a Surface,
    camera: Camera,
    level: u32,
    method: Method,
}

fn different(a: &[Pixel], b: &[Pixel]) -> usize {
    let (a, b) = (bytemuck::cast_slice::<_, u64>(a), bytemuck::cast_slice::<_, u64>(b));
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// Rough land with voids: seen from outside, from just above the ground (facets of thousands of pixels, cut by the near
/// plane and the guard band), and straight down.
fn views(surface: &Surface) -> [Camera; 4] {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let low = over(surface, 30.2, 25.3, 0.4);
    [
        look(middle + DVec3::new(-700.0, -900.0, 250.0), middle, 60.0, PAGE),
        look(low, low + DVec3::new(30.0, 41.0, -9.0), 100.0, PAGE),
        look(middle + DVec3::new(3.0, 2.0, 900.0), middle, 60.0, PAGE),
        // Its top row looks behind the zenith.
        look(middle + DVec3::new(0.0, 0.0, -300.0), middle + DVec3::new(9.0, 20.0, -200.0), 110.0, PAGE),
    ]
}

#[test]
fn a_page_in_tiles_has_the_bits_of_one_piece() {
    let surface = Surface::new(rough(60, 50, 2.0, 4.0, true));
    for (name, method) in METHODS {
        let mut inked = 0;
        for (camera, level) in views(&surface).into_iter().zip([4, 1, 2, 2]) {
            let scene = Scene { surface: &surface, camera, level, method };
            let whole = page_in(gpu(), &scene, PAGE, |tile| tile);
            inked += whole.iter().filter(|p| p.is_ink()).count();
            for side in [[61, 47], [197, 13], [7, 131], [32, 32]] {
                let tiled = page_in(gpu(), &scene, side, |tile| tile);
                assert_eq!(different(&whole, &tiled), 0, "{name}, tiles of {side:?}, {camera:?}");
            }
        }
        assert!(inked > 1000, "{name}: {inked} px of ink, too little to compare");
    }
}

#[test]
fn tiles_change_no_bit_without_int64_and_of_real_terrain() {
    let rough = Surface::new(rough(60, 50, 2.0, 4.0, true));
    let narrow = Scene { surface: &rough, camera: views(&rough)[1], level: 4, method: Method::Walk };
    let whole = page_in(gpu(), &narrow, PAGE, |tile| tile);
    assert_eq!(different(&whole, &page_in(gpu_without_int64(), &narrow, [50, 50], |tile| tile)), 0);
    let Some(dems) = shared_dems() else { return };
    let dem: Dem = hachure::dem::read(dems.join("west_temple_50m.tif"), &Default::default()).expect("west-temple");
    let surface = Surface::new(dem);
    let eye = DVec3::new(325_249.0, 4_117_889.0, 2000.0);
    let camera = Camera { eye, azimuth: 310.0, altitude: 0.0, fov: 60.0, width: 1280, height: 720 };
    for method in [Method::Walk, Method::TowardAway { wide: true }] {
        let scene = Scene { surface: &surface, camera, level: 4, method };
        let whole = page_in(gpu(), &scene, [1280, 720], |tile| tile);
        assert!(whole.iter().filter(|p| p.is_ink()).count() > 4000);
        assert_eq!(different(&whole, &page_in(gpu(), &scene, [299, 257], |tile| tile)), 0, "{method:?}");
    }
}

#[test]
fn a_tile_without_its_halo_is_noticed() {
    let surface = Surface::new(rough(60, 50, 2.0, 4.0, true));
    for (name, method) in METHODS {
        let scene = Scene { surface: &surface, camera: views(&surface)[0], level: 4, method };
        let whole = page_in(gpu(), &scene, PAGE, |tile| tile);
        let bare = page_in(gpu(), &scene, [61, 47], |tile| Tile { drawn: tile.kept, ..tile });
        assert!(different(&whole, &bare) > 0, "{name}: tiles without a halo");
    }
    let scene = Scene { surface: &surface, camera: views(&surface)[1], level: 1, method: Method::Walk };
    let whole = page_in(gpu(), &scene, PAGE, |tile| tile);
    // One pixel of halo is what the pixels of a tile themselves need.
    let narrow = |tile: Tile| {
        let grown = |axis: usize| {
            let low = tile.kept.origin[axis].saturating_sub(1);
            (low, PAGE[axis].min(tile.kept.origin[axis] + tile.kept.size[axis] + 1) - low)
        };
        let [(x, width), (y, height)] = [grown(0), grown(1)];
        Tile { drawn: Rectangle { origin: [x, y], size: [width, height] }, ..tile }
    };
    assert_eq!(different(&whole, &page_in(gpu(), &scene, [61, 47], narrow)), 0);
}

#[test]
fn tiles_cover_the_page_once() {
    for (page, side) in [([197, 131], [61, 47]), ([1, 1], [5, 5]), ([40_000, 8], [2048, 2048]), ([5, 9], [1, 1])] {
        let tiles = Tiles::new(page, side);
        let mut area = 0;
        for Tile { kept, drawn } in tiles.iter() {
            area += kept.size[0] * kept.size[1];
            for axis in 0..2 {
                let end = kept.origin[axis] + kept.size[axis];
                assert!(kept.size[axis] > 0 && kept.size[axis] <= side[axis] && end <= page[axis]);
                assert_eq!(drawn.origin[axis], kept.origin[axis].saturating_sub(HALO));
                assert_eq!(drawn.origin[axis] + drawn.size[axis], (end + HALO).min(page[axis]));
                assert!(drawn.size[axis] <= tiles.largest()[axis]);
            }
        }
        assert_eq!(area, page[0] * page[1], "{page:?} in tiles of {side:?}");
    }
}

#[test]
fn only_pages_beyond_a_limit_are_cut() {
    let count = |page: [u32; 2]| Tiles::from(page).iter().len();
    assert_eq!(LARGEST_PIECE * 8, hachure::gpu::sizes::LARGEST_BINDING);
    assert_eq!([[1920, 1080], [4096, 4096], [LONGEST_PIECE, 1024]].map(count), [1; 3]);
    assert!(count([4096, 4097]) > 1 && count([LONGEST_PIECE + 1, 1]) > 1);
    assert!(Tiles::from([LARGEST_PAGE; 2]).check().is_ok());
    let line = Tiles::from([LARGEST_PAGE + 1, 1]).check().expect_err("too long").to_string();
    assert!(line.contains("65537x1") && line.contains("--size"), "{line}");
    for page in [[LARGEST_PAGE; 2], [32_768, 32_768], [40_000, 8]] {
        assert!(hachure::gpu::sizes::page_fits(Tiles::from(page).largest()).is_ok());
    }
}
