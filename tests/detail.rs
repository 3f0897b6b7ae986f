//! What a page shows of lines on the land: whole branches, by their relief on the page, and nothing that pops.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::line::detail::From;
use hachure::line::Land;
use hachure::relief::{LineKind, SurfaceLine, SurfacePoint};

use crate::tolerances::FADE_STEP;

const SIDE: usize = 200;
const CELL: f64 = 20.0;

/// A plain at 0 m, its middle at 0, 0.
fn plain() -> Dem {
    let half = (SIDE - 1) as f64 / 2.0 * CELL;
    Dem::from_heights(SIDE, DVec2::splat(CELL), DVec2::new(-half, half), vec![0.0; SIDE * SIDE])
}

/// A stream from one place of the grid to another, in beds so many metres deep at its head and at its end.
fn stream(from: DVec2, to: DVec2, depth: [f32; 2], joins: Option<[u32; 2]>) -> SurfaceLine {
    let steps = from.distance(to).ceil().max(2.0) as u32;
    let point = |k: u32| {
        let share = k as f32 / steps as f32;
        let across = depth[0] + (depth[1] - depth[0]) * share;
        let at = from.lerp(to, f64::from(share));
        let length = (from.distance(at) * CELL) as f32;
        SurfacePoint { at, across: [across; 3], length, drop: length * 0.2 }
    };
    SurfaceLine { kind: LineKind::Drainage, order: 1, points: (0..=steps).map(point).collect(), closed: false, joins }
}

fn shown(lines: &[SurfaceLine], eye: DVec3) -> Vec<Vec<f32>> {
    Land::new(&plain(), 1.0, lines.to_vec()).expect("lines").shown(From::Eye(eye, 693.0))
}

#[test]
fn a_branch_that_is_drawn_reaches_its_junction() {
    // Deep at their heads, shallow where they join; the trunk is shallow but for its end.
    let trunk = stream(DVec2::new(100.0, 60.0), DVec2::new(100.0, 160.0), [0.0, 3.0], None);
    let branch = stream(DVec2::new(40.0, 60.0), DVec2::new(100.0, 100.0), [30.0, 0.0], Some([0, 40]));
    let twig = stream(DVec2::new(45.0, 80.0), DVec2::new(47.0, 72.0), [0.3, 0.0], Some([1, 10]));
    let shown = shown(&[trunk, branch, twig], DVec3::new(0.0, -3000.0, 1200.0));
    let [trunk, branch, twig] = [0, 1, 2].map(|i| &shown[i]);
    assert!(branch[0] > 0.5 && branch.is_sorted() && trunk.is_sorted(), "{branch:?}");
    assert!(trunk[39] < 0.1 && trunk[40] >= branch[branch.len() - 1], "{:?}", &trunk[38..42]);
    assert!(twig.iter().all(|weight| *weight == 0.0), "no relief, no line");
    // A trunk that falls too little to be drawn by itself carries its branches on all the same.
    let mut flat = stream(DVec2::new(100.0, 60.0), DVec2::new(100.0, 160.0), [0.0; 2], None);
    flat.points.iter_mut().for_each(|point| point.drop = 0.0);
    let branch = stream(DVec2::new(40.0, 60.0), DVec2::new(100.0, 100.0), [30.0, 0.0], Some([0, 40]));
    let shown = self::shown(&[flat, branch], EYE);
    assert!(shown[0].len() == 101 && shown[0][39] == 0.0 && shown[0][40..].iter().all(|weight| *weight > 0.3));
    // Without the branch nothing of that trunk is drawn.
    let alone = self::shown(&[stream(DVec2::new(100.0, 60.0), DVec2::new(100.0, 160.0), [0.0, 3.0], None)], EYE);
    assert!(alone[0].is_empty());
}

const EYE: DVec3 = DVec3::new(0.0, -3000.0, 1200.0);

#[test]
fn lines_fade_with_distance_and_never_pop() {
    let branch = stream(DVec2::new(60.0, 80.0), DVec2::new(100.0, 100.0), [12.0, 20.0], None);
    let weights = |share: f64| shown(std::slice::from_ref(&branch), EYE * share * 0.5).pop().unwrap_or_default();
    let (mut last, mut ratio, mut largest) = (weights(1.0), 1.0_f64, 0.0_f32);
    assert!(last.iter().all(|weight| *weight > 0.59), "whole from near, as wide as the first order is");
    while !last.is_empty() && ratio < 1e4 {
        ratio *= 1.001;
        let next = weights(ratio);
        let step = |(k, weight): (usize, &f32)| (weight - next.get(k).unwrap_or(&0.0)).abs();
        largest = last.iter().enumerate().map(step).fold(largest, f32::max);
        last = next;
    }
    println!("detail: gone from {ratio:.0} times as far; largest step {largest}");
    assert!(last.is_empty() && ratio > 2.0, "far away nothing is left of it, and not at once");
    assert!(largest <= FADE_STEP, "{largest}");
}

#[test]
fn own_lines_are_drawn_whatever_the_relief_and_rivers_through_plains() {
    let flat = |x: f64, length: f64| stream(DVec2::new(x, 20.0), DVec2::new(x, 20.0 + length), [0.0; 2], None);
    let own = SurfaceLine { kind: LineKind::Own(0), order: 1, ..flat(90.0, 60.0) };
    let of_own = |point: &SurfacePoint| SurfacePoint { across: [f32::INFINITY; 3], drop: f32::INFINITY, ..*point };
    let own = SurfaceLine { points: own.points.iter().map(of_own).collect(), ..own };
    // 1.2 km and 160 m of 20 m cells; a river of 20 km that is 3 km long here.
    let (brook, mut river) = (flat(80.0, 60.0), flat(110.0, 150.0));
    river.points.iter_mut().for_each(|point| (point.length, point.drop) = (point.length + 17_000.0, 0.5));
    let shown = shown(&[own, brook, river], EYE);
    let widest = |i: usize| shown[i].iter().copied().fold(0.0, f32::max);
    assert!(widest(0) > 0.4 && shown[0].iter().all(|weight| *weight == widest(0)), "order 1 is fine, and whole");
    assert!(widest(1) == 0.0, "a brook without a bed: {}", widest(1));
    assert!(widest(2) > 0.59, "a river without one: {}", widest(2));
}
