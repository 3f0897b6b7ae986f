//! Large pages: drawn in pieces, a page has the same bits as in one piece.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::cli::words::line;
use hachure::door::plan::pieces::{HALO, LARGEST_PAGE, LARGEST_PIECE, LONGEST_PIECE, Rectangle};
use hachure::door::plan::{Frame, PagePiece, Pieces};
use hachure::gpu::Gpu;
use hachure::line::{Marks, Pixel};
use hachure::plan::{Border, Detail, Method, Plan, SharedVertices};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::shared_dems;
use crate::frames::{METHODS, Planned};
use crate::scenes::{self, gpu, gpu_without_int64, level, look, over, rough};

const PAGE: [u32; 2] = [197, 131];

/// The page as packed for readback, put together from pieces of at most `side` pixels, each changed by `cut` before.
fn page_in(gpu: &Arc<Gpu>, scene: &Scene<'_>, side: [u32; 2], cut: impl Fn(PagePiece) -> PagePiece) -> Vec<Pixel> {
    let plan = Plan::new(level(scene.level), scene.method, Border::On);
    let pieces = Pieces::new([scene.camera.width, scene.camera.height], side);
    let mut renderer = Planned::new(gpu, scene.surface, plan);
    let frame = renderer.plan_in(&scene.camera, pieces);
    let width = scene.camera.width as usize;
    let mut page = vec![Pixel::new(hachure::line::Kind::Sky, DVec2::ZERO, 7.0); width * scene.camera.height as usize];
    for piece in pieces.iter().map(cut) {
        let raster = renderer.draw_piece(&frame, piece).expect("a piece").raster;
        for row in 0..piece.kept.size[1] {
            for column in 0..piece.kept.size[0] {
                let [x, y] = [piece.kept.origin[0] + column, piece.kept.origin[1] + row];
                let inside = [x - piece.drawn.origin[0], y - piece.drawn.origin[1]].map(i64::from);
                page[y as usize * width + x as usize] = raster.at(inside[0], inside[1]).expect("a pixel of the piece");
            }
        }
    }
    page
}

/// What is drawn.
struct Scene<'a> {
    surface: &'a Arc<Surface>,
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
fn a_page_in_pieces_has_the_bits_of_one_piece() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    for (name, method) in METHODS {
        let mut inked = 0;
        for (camera, level) in views(&surface).into_iter().zip([4, 1, 2, 2]) {
            let scene = Scene { surface: &surface, camera, level, method };
            let whole = page_in(gpu(), &scene, PAGE, |piece| piece);
            inked += whole.iter().filter(|p| p.is_ink()).count();
            for side in [[61, 47], [7, 131], [32, 32]] {
                let cut = page_in(gpu(), &scene, side, |piece| piece);
                assert_eq!(different(&whole, &cut), 0, "{name}, pieces of {side:?}, {camera:?}");
            }
        }
        assert!(inked > 1000, "{name}: {inked} px of ink, too little to compare");
    }
}

#[test]
fn chains_of_a_page_in_pieces_are_those_of_one_piece() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    let mut length = 0;
    for (camera, level) in views(&surface).into_iter().zip([4, 1, 2, 2]) {
        for detail in [Detail::Uniform(scenes::level(level)), Detail::default()] {
            let plan = Plan { detail, ..Plan::new(scenes::level(level), Method::Contour, Border::On) };
            let mut renderer = Planned::new(gpu(), &surface, plan);
            let mut chains = |side| {
                let frame = renderer.plan_in(&camera, Pieces::new(PAGE, side));
                renderer.page_of(frame, |_| ()).expect("a page").chains
            };
            let whole = chains(PAGE);
            length += whole.iter().map(|chain| chain.points.len()).sum::<usize>();
            for side in [[61, 47], [7, 131], [32, 32]] {
                assert!(whole == chains(side), "{detail:?}, pieces of {side:?}, {camera:?}");
            }
        }
    }
    assert!(length > 500, "{length} points of chains");
}

#[test]
fn pieces_change_no_bit_without_int64_and_of_real_terrain() {
    let rough = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    let narrow = Scene { surface: &rough, camera: views(&rough)[1], level: 4, method: Method::Walk };
    let whole = page_in(gpu(), &narrow, PAGE, |piece| piece);
    assert_eq!(different(&whole, &page_in(gpu_without_int64(), &narrow, [50, 50], |piece| piece)), 0);
    let Some(dems) = shared_dems() else { return };
    let dem: Dem = hachure::geo::read(dems.join("west_temple_50m.tif"), &Default::default()).expect("west-temple");
    let surface = Arc::new(Surface::new(dem));
    let eye = DVec3::new(325_249.0, 4_117_889.0, 2000.0);
    let camera = Camera { eye, azimuth: 310.0, altitude: 0.0, fov: 60.0, width: 1280, height: 720 };
    for method in [Method::Walk, Method::TowardAway { wide: true }] {
        let scene = Scene { surface: &surface, camera, level: 4, method };
        let whole = page_in(gpu(), &scene, [1280, 720], |piece| piece);
        assert!(whole.iter().filter(|p| p.is_ink()).count() > 4000);
        assert_eq!(different(&whole, &page_in(gpu(), &scene, [299, 257], |piece| piece)), 0, "{method:?}");
    }
}

/// A rectangle of a page as packed for readback.
fn rectangle(frame: &Frame, renderer: &mut Planned, origin: [u32; 2], size: [u32; 2]) -> Vec<Pixel> {
    let drawn = Rectangle { origin, size };
    renderer.draw_piece(frame, PagePiece { kept: drawn, drawn }).expect("a piece").raster.pixels
}

#[test]
fn far_out_on_a_large_page_no_bit_depends_on_the_piece() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    for (name, method) in METHODS {
        let (mut inked, mut covered) = (0, 0);
        for (view, level) in views(&surface).into_iter().zip([4, 1, 2, 2]) {
            let camera = Camera { width: LARGEST_PAGE, height: 40_000, ..view };
            let mut renderer = Planned::new(gpu(), &surface, Plan::new(scenes::level(level), method, Border::On));
            let frame = renderer.plan_in(&camera, Pieces::new([camera.width, camera.height], [400, 300]));
            for origin in [[0, 39_700], [33_000, 20_000], [40_001, 24_003], [65_136, 30_007], [51_003, 39_700]] {
                let whole = rectangle(&frame, &mut renderer, origin, [400, 300]);
                let part = rectangle(&frame, &mut renderer, [origin[0] + 97, origin[1] + 41], [283, 251]);
                covered += whole.iter().filter(|p| p.depth() != 0.0).count();
                // Without the halo of the part.
                for (row, column) in (1..250).flat_map(|r| (1..282).map(move |c| (r, c))) {
                    let [a, b] = [whole[(row + 41) * 400 + column + 97], part[row * 283 + column]];
                    inked += usize::from(a.is_ink());
                    assert_eq!(
                        different(&[a], &[b]),
                        0,
                        "{name}, {origin:?} + {column}, {row}: {a:?}, {b:?}, {camera:?}"
                    );
                }
            }
        }
        println!("{name}: {inked} px of ink, {covered} covered");
        assert!(inked > 100 && covered > 100_000, "{name}: {inked} px of ink, {covered} covered");
    }
}

#[test]
fn a_large_page_shows_what_a_small_one_shows() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    let scale = 32.0;
    let small = Camera { width: LARGEST_PAGE / 32, height: 1250, ..views(&surface)[0] };
    let large = Camera { width: LARGEST_PAGE, height: 40_000, ..small };
    let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(1), Method::Walk, Border::Off));
    let marks = renderer.page(&small).unwrap().marks;
    let frame = renderer.plan_in(&large, Pieces::new([large.width, large.height], [200, 200]));
    let place = |column: u32, row: u32, pixel: &Pixel| DVec2::new(column.into(), row.into()) + 0.5 + pixel.place();
    let mut far = 0;
    for mark in marks.ink().step_by(marks.inked() / 40) {
        let expected = place(mark.column, mark.row, &mark.pixel) * scale;
        let origin = [expected.x, expected.y].map(|v| (v - 100.0).max(0.0) as u32);
        let pixels = rectangle(&frame, &mut renderer, origin, [200, 200]);
        let inked = (0..).zip(&pixels).filter(|(_, pixel)| pixel.is_ink());
        let places = inked.map(|(i, pixel): (u32, _)| place(origin[0] + i % 200, origin[1] + i / 200, pixel));
        let off = places.map(|p| p.distance(expected)).fold(f64::INFINITY, f64::min);
        assert!(off < scale, "{mark:?} lies {off} px of the large page from its line");
        far += usize::from(expected.x.max(expected.y) > 32_768.0);
    }
    assert!(far > 10, "{far} places far out");
}

#[test]
fn the_ink_of_pieces_is_that_of_one_piece() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    let camera = views(&surface)[0];
    // Adjacency floods: there ink encloses pixels of the cover, also across pieces.
    for (n, method) in [(4, Method::Walk), (4, Method::Adjacency { share: SharedVertices::Edge })] {
        let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(n), method, Border::On));
        let whole = renderer.draw(&camera).unwrap();
        let marks = Marks::from(&whole.raster);
        assert_eq!(marks.inked(), whole.inked());
        let enclosed = marks.iter().count() - marks.inked();
        assert!(method == Method::Walk || enclosed > 10, "{enclosed} pixels enclosed by ink");
        let frame = renderer.plan_in(&camera, Pieces::new(PAGE, [13, 11]));
        let page = renderer.page_of(frame, |_| ()).unwrap();
        assert!(page.marks == marks && page.longest_walk == whole.longest_walk, "{method:?}");
        assert!(page.marks != Marks::new(PAGE, marks.iter().copied().skip(1).collect()), "the comparison is blind");
    }
}

#[test]
fn a_piece_without_its_halo_is_noticed() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    for (name, method) in METHODS {
        let scene = Scene { surface: &surface, camera: views(&surface)[0], level: 4, method };
        let whole = page_in(gpu(), &scene, PAGE, |piece| piece);
        let bare = page_in(gpu(), &scene, [61, 47], |piece| PagePiece { drawn: piece.kept, ..piece });
        assert!(different(&whole, &bare) > 0, "{name}: pieces without a halo");
    }
    let scene = Scene { surface: &surface, camera: views(&surface)[1], level: 1, method: Method::Walk };
    let whole = page_in(gpu(), &scene, PAGE, |piece| piece);
    // One pixel of halo is what the pixels of a piece themselves need.
    let narrow = |piece: PagePiece| {
        let grown = |axis: usize| {
            let low = piece.kept.origin[axis].saturating_sub(1);
            (low, PAGE[axis].min(piece.kept.origin[axis] + piece.kept.size[axis] + 1) - low)
        };
        let [(x, width), (y, height)] = [grown(0), grown(1)];
        PagePiece { drawn: Rectangle { origin: [x, y], size: [width, height] }, ..piece }
    };
    assert_eq!(different(&whole, &page_in(gpu(), &scene, [61, 47], narrow)), 0);
}

#[test]
fn pieces_cover_the_page_once() {
    for (page, side) in [([197, 131], [61, 47]), ([1, 1], [5, 5]), ([40_000, 8], [2048, 2048]), ([5, 9], [1, 1])] {
        let pieces = Pieces::new(page, side);
        let mut area = 0;
        for PagePiece { kept, drawn } in pieces.iter() {
            area += kept.size[0] * kept.size[1];
            for axis in 0..2 {
                let end = kept.origin[axis] + kept.size[axis];
                assert!(kept.size[axis] > 0 && kept.size[axis] <= side[axis] && end <= page[axis]);
                assert_eq!(drawn.origin[axis], kept.origin[axis].saturating_sub(HALO));
                assert_eq!(drawn.origin[axis] + drawn.size[axis], (end + HALO).min(page[axis]));
                assert!(drawn.size[axis] <= pieces.largest()[axis]);
            }
        }
        assert_eq!(area, page[0] * page[1], "{page:?} in pieces of {side:?}");
    }
}

#[test]
fn only_pages_beyond_a_limit_are_cut() {
    let count = |page: [u32; 2]| Pieces::from(page).iter().len();
    assert_eq!(LARGEST_PIECE * 8, hachure::door::gpu::sizes::LARGEST_BINDING);
    assert_eq!([[1920, 1080], [4096, 4096], [LONGEST_PIECE, 1024]].map(count), [1; 3]);
    assert!(count([4096, 4097]) > 1 && count([LONGEST_PIECE + 1, 1]) > 1);
    assert!(Pieces::from([LARGEST_PAGE; 2]).check().is_ok());
    let line = line(&Pieces::from([LARGEST_PAGE + 1, 1]).check().expect_err("too long"));
    assert!(line.contains("65537x1") && line.contains("--size"), "{line}");
    for page in [[LARGEST_PAGE; 2], [32_768, 32_768], [40_000, 8]] {
        assert!(hachure::door::gpu::sizes::page_fits(Pieces::from(page).largest()).is_ok());
    }
}
