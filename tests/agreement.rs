//! Adaptive frames show the lines that frames of one fine level show: as small errors as those among fine levels, border
//! lines connected and in the same places.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::line::{InkRaster, Kind};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::Planned;
use crate::judged::centres;
use crate::mixed::variety;
use crate::quadtrees::moor;
use crate::scenes::{gpu, level, look, rough};
use crate::tolerances::{COARSE_STRAYS, LEVEL_STRAYS, REACH_PX};

const PAGE: [u32; 2] = [384, 288];

/// A frame; and how many levels and seams it has.
fn draw(surface: &Arc<Surface>, detail: impl Into<Detail>, camera: &Camera, border: Border) -> (InkRaster, [usize; 2]) {
    let mut renderer = Planned::new(gpu(), surface, Plan::new(detail, Method::Walk, border));
    let raster = renderer.draw(camera).expect("a frame").raster;
    let variety = variety(&renderer.lattice());
    (raster, variety)
}

/// Share of places of `a` farther than a pixel from all of `b`, or the other way round, whichever is more.
fn strays(a: &[DVec2], b: &[DVec2]) -> f64 {
    let one_way = |a: &[DVec2], b: &[DVec2]| {
        a.iter().filter(|p| b.iter().all(|q| q.distance(**p) > REACH_PX)).count() as f64 / a.len() as f64
    };
    one_way(a, b).max(one_way(b, a))
}

/// Sets of places that touch, corners too.
fn pieces(places: &[DVec2]) -> usize {
    let mut left = places.to_vec();
    let mut count = 0;
    while let Some(first) = left.pop() {
        let mut open = vec![first];
        while let Some(at) = open.pop() {
            let near: Vec<usize> = (0..left.len()).rev().filter(|i| left[*i].distance(at) < 1.5).collect();
            open.extend(near.into_iter().map(|i| left.swap_remove(i)));
        }
        count += 1;
    }
    count
}

fn from_aside(surface: &Surface, eye: DVec3) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    look(middle + eye, middle, 60.0, PAGE)
}

#[test]
fn small_errors_draw_what_fine_levels_draw() {
    let surface = Arc::new(Surface::new(rough(18, 18, 1.0, 4.0, false)));
    let camera = from_aside(&surface, DVec3::new(-120.0, -330.0, 130.0));
    let fine = [32, 64].map(|n| centres(&draw(&surface, level(n), &camera, Border::Off).0, Kind::Silhouette));
    let adaptive = |error_px| draw(&surface, Detail::Adaptive { error_px }, &camera, Border::Off);
    let (raster, variety) = adaptive(0.05);
    let adaptive_ink = centres(&raster, Kind::Silhouette);
    let found = [strays(&fine[0], &fine[1]), strays(&adaptive_ink, &fine[0]), strays(&adaptive_ink, &fine[1])];
    println!(
        "{variety:?} levels and seams, {} px; strays of 32 and 64, adaptive and each: {found:?}",
        adaptive_ink.len()
    );
    assert!(found.iter().all(|share| *share <= LEVEL_STRAYS) && variety[0] > 1);
    // Negative control: a large error is noticed.
    assert!(strays(&centres(&adaptive(40.0).0, Kind::Silhouette), &fine[1]) > LEVEL_STRAYS, "the comparison is blind");
}

/// Rolling hills, smooth at the scale of cells.
fn hills() -> Dem {
    let height = |c: f64, r: f64| 90.0 * (c / 50.0).sin() * (r / 41.0).cos() + 30.0 * ((c + 2.0 * r) / 60.0).sin();
    let heights = (0..700 * 600).map(|i| height((i % 700) as f64, (i / 700) as f64) as f32).collect();
    Dem::from_heights(700, DVec2::splat(10.0), DVec2::new(3e5, 4e6), heights)
}

#[test]
fn coarse_chunks_draw_what_the_grid_draws() {
    for (i, (dem, nearer)) in [(hills(), 1.0), (moor(), 0.45)].into_iter().enumerate() {
        let surface = &Arc::new(Surface::new(dem));
        for eye in [DVec3::new(-2600.0, -4300.0, 900.0), DVec3::new(300.0, -5000.0, 1500.0)].map(|eye| eye * nearer) {
            let camera = from_aside(surface, eye);
            let (raster, [levels, seams]) = draw(surface, Detail::Adaptive { error_px: 0.15 }, &camera, Border::On);
            let uniform = draw(surface, level(4), &camera, Border::On).0;
            let of = |kind| [&raster, &uniform].map(|raster| centres(raster, kind));
            let (lines, borders) = (of(Kind::Silhouette), of(Kind::Border));
            let off = strays(&borders[0], &borders[1]);
            let counts = [&borders[0], &borders[1]].map(|b| pieces(b));
            println!(
                "scene {i}: {levels} levels, {seams} seams; border {} px, {off:.4} stray, {counts:?} pieces; lines {:?} px",
                borders[0].len(),
                lines.each_ref().map(Vec::len)
            );
            assert!(levels > 1 && seams > 5, "scene {i}: {levels} levels, {seams} seams");
            assert!(off <= LEVEL_STRAYS && borders[0].len() > 300, "scene {i}: border lines {off} stray, {camera:?}");
            assert!(counts[0] <= counts[1] + 2, "scene {i}: border lines in {counts:?} pieces");
            if lines[1].len() > 100 {
                let off = strays(&lines[0], &lines[1]);
                println!("    lines {off:.4} stray");
                assert!(off <= COARSE_STRAYS, "scene {i}: lines {off} stray, {camera:?}");
            }
        }
    }
}
