//! Hills that were rounded, without their steps, draw the ink of the hills before.

use glam::DVec2;
use hachure::dem::Window;
use hachure::door::dem::smoothest::smoothest;
use hachure::line::{InkRaster, Kind};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::Planned;
use crate::judged::centres;
use crate::scenes::{Random, aimed, gpu, over, surface};
use crate::tolerances::{REACH_PX, STEPLESS_F, STEPLESS_INK};

const SIDE: usize = 220;
const PAGE: [u32; 2] = [640, 360];

/// Round hills of up to 230 m, 350 to 900 m wide, cells of 30 m.
fn hills() -> Vec<f32> {
    let mut random = Random::new(5);
    let hills: Vec<[f64; 4]> = (0..9)
        .map(|_| {
            let [x, y] = [0; 2].map(|_| random.between(0.0, SIDE as f64));
            [x, y, random.between(60.0, 230.0), random.between(12.0, 30.0)]
        })
        .collect();
    let height = |c: f64, r: f64| {
        let hill =
            |[x, y, high, wide]: &[f64; 4]| high * (-((c - x).powi(2) + (r - y).powi(2)) / (2.0 * wide * wide)).exp();
        100.0 + hills.iter().map(hill).sum::<f64>()
    };
    (0..SIDE * SIDE).map(|i| height((i % SIDE) as f64, (i / SIDE) as f64) as f32).collect()
}

fn draw(heights: &[f32], cameras: &[Camera]) -> Vec<InkRaster> {
    let surface = surface(SIDE, 30.0, heights.to_vec());
    let mut renderer = Planned::new(gpu(), &surface, Plan::new(Detail::default(), Method::Walk, Border::Off));
    cameras.iter().map(|camera| renderer.draw(camera).expect("a frame").raster).collect()
}

/// Ink of `drawn` as a share of that of `before`, and F of the one against the other within a pixel.
fn compared(drawn: &InkRaster, before: &InkRaster) -> [f64; 2] {
    let [drawn, before] = [drawn, before].map(|raster| centres(raster, Kind::Silhouette));
    assert!(before.len() > 300, "{} px are too few to judge", before.len());
    let near = |a: &[DVec2], b: &[DVec2]| {
        a.iter().filter(|p| b.iter().any(|q| q.distance(**p) <= REACH_PX)).count() as f64 / a.len() as f64
    };
    let (precision, recall) = (near(&drawn, &before), near(&before, &drawn));
    [drawn.len() as f64 / before.len() as f64, 2.0 * precision * recall / (precision + recall)]
}

fn views(surface: &Surface, relief: f64) -> Vec<Camera> {
    let at = |c: f64, r: f64, above: f64| over(surface, c * SIDE as f64, r * SIDE as f64, above * relief);
    vec![
        aimed(at(0.5, 0.95, 0.25), 0.0, -6.0, PAGE),
        aimed(at(0.04, 0.5, 0.4), 90.0, -8.0, PAGE),
        aimed(at(0.9, 0.9, 1.2), 315.0, -18.0, PAGE),
    ]
}

#[test]
fn hills_without_their_steps_draw_what_they_drew_before() {
    let hills = hills();
    let relief = hills.iter().copied().fold(f32::MIN, f32::max) - hills.iter().copied().fold(f32::MAX, f32::min);
    let cameras = views(&surface(SIDE, 30.0, hills.clone()), f64::from(relief));
    let before = draw(&hills, &cameras);
    let mut stairs = 0;
    for step in [1.0, (relief / 10.0).round()] {
        let rough: Vec<f32> = hills.iter().map(|height| (height / step).round() * step).collect();
        let mut smooth = rough.clone();
        let half = vec![step / 2.0; rough.len()];
        smoothest(&mut smooth, &half, Window { first: [0, 0], size: [SIDE; 2] }, true);
        for ((smooth, rough), before) in draw(&smooth, &cameras).iter().zip(&draw(&rough, &cameras)).zip(&before) {
            let ([share, f], [share_of_stairs, f_of_stairs]) = (compared(smooth, before), compared(rough, before));
            println!(
                "steps of {step} m: {share:.3} of the ink, F {f:.3}; stairs {share_of_stairs:.2}, {f_of_stairs:.2}"
            );
            assert!((STEPLESS_INK[0]..=STEPLESS_INK[1]).contains(&share) && f >= STEPLESS_F, "{step} m: {share}, {f}");
            stairs += usize::from(share_of_stairs > STEPLESS_INK[1]);
        }
    }
    assert!(stairs >= 3, "the stairs must be seen: {stairs} of 6 views");
}
