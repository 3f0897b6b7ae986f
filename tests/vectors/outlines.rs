//! The area of a stroke against its definition, place by place: trapezoids, discs at ends and sharp bends, wedges at others.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};
use hachure::door::ink::outline::outline;
use hachure::ink::{Stroke, StrokePoint};

use super::samples::{closed, dot, even, ring, shares, spiral, tapered, widths, zigzag};
use crate::tolerances::OUTLINE_MM;

/// Numbers from 0 to 1, the same every time.
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    fn place(&mut self) -> DVec2 {
        dvec2(self.share(), self.share())
    }
}

/// Whether a place lies in the area of a stroke, by definition.
fn covers(stroke: &Stroke, pen: f64, place: DVec2) -> bool {
    let mut points: Vec<StrokePoint> = stroke.points.clone();
    points.extend(points.first().copied().filter(|_| stroke.closed));
    points.dedup_by(|a, b| a.place == b.place);
    let half = |point: &StrokePoint| point.width * pen / 2.0;
    let in_disc = |point: &StrokePoint| place.distance(point.place) <= half(point);
    let segments: Vec<[StrokePoint; 2]> = points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let in_trapezoid = |[a, b]: &[StrokePoint; 2]| {
        let (along, length) = ((b.place - a.place).normalize(), a.place.distance(b.place));
        let (ahead, aside) = (along.dot(place - a.place), along.perp_dot(place - a.place).abs());
        (0.0..=length).contains(&ahead) && aside <= half(a) + (half(b) - half(a)) * ahead / length
    };
    let in_joint = |[before, after]: [&[StrokePoint; 2]; 2]| {
        let [d, e] = [before, after].map(|[a, b]| (b.place - a.place).normalize());
        let from = place - after[0].place;
        // A disc, or the part of it between the two trapezoids.
        in_disc(&after[0]) && (d.dot(e) <= 0.866 || (d.dot(from) >= 0.0 && e.dot(from) <= 0.0))
    };
    let closing = segments.last().zip(segments.first()).filter(|_| stroke.closed).map(|(last, first)| [last, first]);
    let joints = segments.windows(2).map(|pair| [&pair[0], &pair[1]]).chain(closing);
    let ends = [points.first(), points.last()].into_iter().flatten().filter(|_| !stroke.closed || points.len() == 1);
    segments.iter().any(in_trapezoid) || joints.into_iter().any(in_joint) || ends.into_iter().any(in_disc)
}

/// How often polygons go around a place, counted by a ray to the right.
fn windings(polygons: &[Vec<DVec2>], place: DVec2) -> i32 {
    let edges = polygons.iter().flat_map(|polygon| polygon.iter().zip(polygon.iter().cycle().skip(1)));
    let crossed = edges.filter(|(a, b)| (a.y <= place.y) != (b.y <= place.y)).filter_map(|(a, b)| {
        let x = a.x + (b.x - a.x) * (place.y - a.y) / (b.y - a.y);
        (x > place.x).then_some(if b.y > a.y { 1 } else { -1 })
    });
    crossed.sum()
}

/// A place where the polygons are wrong by more than the tolerance, out of so many; with what goes around it.
fn wrong(stroke: &Stroke, pen: f64, polygons: &[Vec<DVec2>], tries: u32) -> Option<(DVec2, i32)> {
    let mut random = Random(7);
    let corners = || polygons.iter().flatten();
    let low = corners().copied().reduce(DVec2::min)? - 0.1;
    let high = corners().copied().reduce(DVec2::max)? + 0.1;
    let count = corners().count();
    // Every other place is near a corner, where mistakes are.
    let places = (0..tries).map(|i| match i % 2 {
        0 => low + (high - low) * random.place(),
        _ => *corners().nth((random.share() * count as f64) as usize).expect("a corner") + (random.place() - 0.5) * 0.1,
    });
    let places: Vec<DVec2> = places.collect();
    places.into_iter().find_map(|place| {
        let (said, windings) = (covers(stroke, pen, place), windings(polygons, place));
        // Right is also what holds within the tolerance.
        let about = || (0..16).map(|i| place + DVec2::from_angle(f64::from(i) * TAU / 16.0) * OUTLINE_MM);
        let is_wrong = said != (windings != 0) && about().all(|near| covers(stroke, pen, near) == said);
        (is_wrong || windings * sign(polygons) < 0).then_some((place, windings))
    })
}

/// The way in which polygons go around what they cover, by the first place that is far inside.
fn sign(polygons: &[Vec<DVec2>]) -> i32 {
    let area = |polygon: &Vec<DVec2>| {
        polygon.iter().zip(polygon.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
    };
    polygons.iter().map(area).sum::<f64>().signum() as i32
}

/// Strokes that are hard to outline, each with a pen.
fn strokes() -> Vec<(&'static str, f64, Stroke)> {
    let mut random = Random(3);
    let o = dvec2(20.0, 20.0);
    let mut walk = |steps: usize, step: f64, least: f64| {
        let mut at = o;
        widths((0..steps).map(|_| {
            at += (random.place() - 0.5) * step;
            (at, least + (1.0 - least) * random.share())
        }))
    };
    let mut cases = vec![
        ("a walk of steep widths", 1.0, walk(40, 4.0, 0.0)),
        ("a walk of short steps", 3.0, walk(60, 0.4, 0.5)),
        ("a walk of tiny steps", 0.3, walk(60, 1e-4, 0.9)),
        ("a walk of even width", 2.0, walk(40, 4.0, 1.0)),
        ("a closed walk", 1.0, closed(walk(20, 6.0, 0.2))),
    ];
    let tight = |radius: f64| even(shares(200).map(|t| o + DVec2::from_angle(t * 5.0) * radius));
    let horn = |i: u32| (0..i).map(|k| DVec2::from_angle(0.19 * f64::from(k)) * 0.25).sum::<DVec2>();
    let coarse = |radius: f64| even(shares(9).map(|t| o + DVec2::from_angle(t * 5.0) * radius));
    cases.extend([
        ("a dot", 0.3, dot(o)),
        ("a repeated dot", 10.0, even([o, o, o])),
        ("a closed dot", 1.0, closed(dot(o))),
        ("a line", 0.3, even([o, o + 9.0])),
        ("a frustum", 2.0, widths([(o, 0.0), (o + 9.0, 1.0)])),
        ("a drop", 4.0, widths([(o, 0.0), (o + 2.0, 1.0)])),
        ("a bent horn", 4.0, widths((0..6).map(|i| (o + horn(i), 0.1 * f64::from(i))))),
        ("a waist", 2.0, widths([(o, 1.0), (o + 5.0, 0.0), (o + dvec2(10.0, 3.0), 1.0)])),
        ("no width between", 2.0, widths([(o, 1.0), (o + 2.0, 0.0), (o + 4.0, 0.0), (o + dvec2(5.0, 3.0), 1.0)])),
        ("repeated points", 1.0, even([o, o, o + 3.0, o + 3.0, o + dvec2(4.0, 0.0), o + dvec2(4.0, 0.0)])),
        ("there and back", 1.0, even([o, o + 5.0, o + 1.0, o + 6.0])),
        ("there and back, steep", 3.0, widths([(o, 0.1), (o + dvec2(2.0, 0.0), 1.0), (o, 0.3)])),
        ("a circle tighter than the pen", 3.0, tight(0.7)),
        ("a circle of half the pen", 3.0, tight(1.5)),
        ("a circle wider than the pen", 3.0, tight(2.6)),
        ("a coarse circle tighter than the pen", 3.0, coarse(0.7)),
        ("a broad pen", 10.0, tight(8.0)),
        ("a ring", 0.5, ring(o, 6.0)),
        ("a ring tighter than the pen", 3.0, ring(o, 0.6)),
        ("a closed line", 1.0, closed(even([o, o + 6.0]))),
        ("a triangle", 1.0, closed(even([o, o + dvec2(6.0, 1.0), o + dvec2(2.0, 5.0)]))),
        ("a triangle the other way", 1.0, closed(even([o, o + dvec2(2.0, 5.0), o + dvec2(6.0, 1.0)]))),
        ("a closed waist", 1.0, closed(widths([(o, 1.0), (o + 3.0, 0.0), (o + dvec2(6.0, 0.0), 1.0)]))),
        (
            "an eight",
            0.8,
            closed(even(
                (0..80).map(|i| f64::from(i) * TAU / 80.0).map(|t| o + dvec2(t.sin() * 6.0, (2.0 * t).sin() * 3.0)),
            )),
        ),
        ("a tapered wave", 0.3, tapered(o, 15.0)),
        ("a spiral", 1.0, spiral(o, 6.0, 9.0)),
        ("a zigzag", 1.5, zigzag(o, 9.0)),
    ]);
    cases
}

#[test]
fn outlines_cover_what_the_stroke_covers() {
    for (name, pen, stroke) in strokes() {
        let polygons = outline(&stroke, pen);
        assert_eq!(polygons.len(), if stroke.closed && name != "a closed dot" { 2 } else { 1 }, "{name}");
        assert!(polygons.iter().flatten().all(|corner| corner.is_finite()), "{name}");
        assert_eq!(wrong(&stroke, pen, &polygons, 40_000), None, "{name}, with a pen of {pen} mm");
    }
}

#[test]
fn an_outline_that_is_wrong_somewhere_is_noticed() {
    for (name, pen, stroke) in strokes() {
        if pen < 0.4 {
            continue;
        }
        let grown = outline(&stroke, pen + 10.0 * OUTLINE_MM);
        assert!(wrong(&stroke, pen, &grown, 40_000).is_some(), "{name}: too wide a pen is not noticed");
        let mut polygons = outline(&stroke, pen);
        let corners = polygons.iter_mut().flatten();
        *corners.max_by(|a, b| a.x.total_cmp(&b.x)).expect("a corner") += DVec2::X * 0.3;
        assert!(wrong(&stroke, pen, &polygons, 40_000).is_some(), "{name}: a moved corner is not noticed");
    }
}

#[test]
fn smooth_strokes_have_few_corners() {
    let corners = |stroke: &Stroke, pen: f64| outline(stroke, pen).iter().map(Vec::len).sum::<usize>() as f64;
    let per_point = |stroke: Stroke, pen: f64| corners(&stroke, pen) / stroke.points.len() as f64;
    let [wave, ring] = [per_point(tapered(DVec2::ZERO, 40.0), 0.3), per_point(ring(DVec2::ZERO, 8.0), 0.3)];
    println!("corners a point: {wave:.2} of a wave, {ring:.2} of a ring");
    assert!(wave < 2.5 && ring == 2.0);
    assert!(corners(&dot(DVec2::ZERO), 0.3) < 20.0);
    assert_eq!(corners(&widths([(DVec2::ZERO, 0.0), (DVec2::X, 0.5), (DVec2::X * 2.0, 0.0)]), 0.3) as u32 & 1, 0);
}

#[test]
fn strokes_without_points_cover_nothing() {
    assert_eq!(outline(&even([]), 1.0), Vec::<Vec<DVec2>>::new());
    assert_eq!(outline(&closed(even([])), 1.0), Vec::<Vec<DVec2>>::new());
}
