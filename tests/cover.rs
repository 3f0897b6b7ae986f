//! The hidden-surface cover: a polyline of the world vanishes behind a ridge and comes back with the cover off.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::line::{Chain, Cover, Line, project_polyline};
use hachure::plan::{Border, Method, Plan};
use hachure::surface::Surface;
use hachure::view::{Camera, Perspective};

use crate::forms::{Form, about_middle, from_middle};
use crate::frames::Planned;
use crate::scenes::{gpu, level, look};
use crate::tolerances::COVER_PX;

const PAGE: [u32; 2] = [384, 288];

/// A ridge from west to east, 160 m high in the middle and falling off to both sides.
const RIDGE: Form = Form {
    name: "ridge",
    height: |p| 160.0 * (-p.y * p.y / (2.0 * 80.0 * 80.0) - p.x * p.x / (2.0 * 120.0 * 120.0)).exp(),
    gradient: |p| {
        let height = 160.0 * (-p.y * p.y / (2.0 * 80.0 * 80.0) - p.x * p.x / (2.0 * 120.0 * 120.0)).exp();
        DVec2::new(-p.x / (120.0 * 120.0), -p.y / (80.0 * 80.0)) * height
    },
    residual: |_, _| 0.0,
    samples: 129,
    cell: 10.0,
};

/// Where, as shares of a segment, it passes from seen to hidden or back: by fine steps and bisection.
fn turns(eye: DVec3, a: DVec3, b: DVec3) -> Vec<f64> {
    let half = RIDGE.half();
    let sees = |t: f64| RIDGE.sees(eye, a.lerp(b, t), &|p| p.abs().max_element() <= half);
    let steps = 400;
    let mut turns = Vec::new();
    for k in 0..steps {
        let (mut low, mut high) = (f64::from(k) / f64::from(steps), f64::from(k + 1) / f64::from(steps));
        if sees(low) != sees(high) {
            for _ in 0..40 {
                let middle = low.midpoint(high);
                if sees(middle) == sees(low) { low = middle } else { high = middle }
            }
            turns.push(low);
        }
    }
    turns
}

fn ends(chain: &Chain) -> [DVec2; 2] {
    [chain.points[0].place, chain.points[chain.points.len() - 1].place]
}

/// The chains of a segment over the ridge's raster, with the camera that sees it.
fn chains(camera: &Camera, a: DVec3, b: DVec3, cover: Cover) -> Vec<Chain> {
    let surface = Arc::new(Surface::new(RIDGE.dem(|_, _| true)));
    let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(4), Method::Walk, Border::Off));
    let raster = renderer.draw(camera).expect("a frame").raster;
    let seen = Perspective::new(camera, renderer.near());
    project_polyline(&[from_middle(a), from_middle(b)], Line::Own, &seen, &raster, cover)
}

#[test]
fn a_line_behind_a_ridge_vanishes_where_the_ridge_hides_it() {
    let camera = look(from_middle(DVec3::new(0.0, -700.0, 60.0)), from_middle(DVec3::new(0.0, 0.0, 60.0)), 60.0, PAGE);
    // Behind the ridge: level past both its ends, and rising from behind it into the open.
    let lines = [
        (DVec3::new(-500.0, 300.0, 110.0), DVec3::new(500.0, 300.0, 110.0), 2),
        (DVec3::new(-60.0, 260.0, 30.0), DVec3::new(120.0, 320.0, 320.0), 1),
    ];
    for (a, b, count) in lines {
        let turns = turns(about_middle(camera.eye), a, b);
        assert_eq!(turns.len(), count, "the ridge hides one stretch");
        let shown = chains(&camera, a, b, Cover::On);
        let place = |t: f64| camera.project(from_middle(a.lerp(b, t))).0;
        assert_eq!(shown.len(), count, "one chain a visible stretch");
        for &t in &turns {
            let off = shown.iter().flat_map(ends).map(|p| p.distance(place(t))).fold(f64::INFINITY, f64::min);
            println!("cover: hidden from or to {}, chain ends {off:.2} px from there", place(t));
            assert!(off <= COVER_PX, "a chain ends {off:.2} px from where the ridge hides the line");
        }
        // With the cover off all of it comes back.
        let all = chains(&camera, a, b, Cover::Off);
        assert_eq!(all.len(), 1);
        let [start, end] = ends(&all[0]);
        assert!(start.distance(place(0.0)) < 0.01 && end.distance(place(1.0)) < 0.01);
        // Negative control: a line moved by 20 m vanishes elsewhere.
        let lower = chains(&camera, a - DVec3::Z * 20.0, b - DVec3::Z * 20.0, Cover::On);
        let nearest = |t: f64| lower.iter().flat_map(ends).map(|p| p.distance(place(t))).fold(f64::INFINITY, f64::min);
        assert!(turns.iter().any(|t| nearest(*t) > COVER_PX), "a moved line is not noticed");
    }
}

#[test]
fn a_line_before_the_ridge_is_seen_whole() {
    let camera = look(from_middle(DVec3::new(0.0, -700.0, 60.0)), from_middle(DVec3::new(0.0, 0.0, 60.0)), 60.0, PAGE);
    let (a, b) = (DVec3::new(-200.0, -250.0, 50.0), DVec3::new(200.0, -250.0, 50.0));
    assert!(turns(about_middle(camera.eye), a, b).is_empty());
    assert_eq!(chains(&camera, a, b, Cover::On), chains(&camera, a, b, Cover::Off));
}
