//! Lines run down the slope, and end where they must.

use glam::DVec2;
use hachure::door::relief::slope::SlopeLine;
use hachure::relief::{LineKind, SurfaceLine, SurfacePoint};
use hachure::surface::Surface;

use super::{CELL, RULES, Scene, land, lines, plane, position, real, share};
use crate::tolerances::{DOWNHILL_DEGREES, DOWNHILL_SHARE, DOWNHILL_WAVES, ON_SURFACE};

/// Room of lines that are asked for, cells.
const ROOM: f64 = 1.9;

/// The gradient of the surface by differences of positions.
fn gradient(surface: &Surface, at: DVec2) -> Option<DVec2> {
    const STEP: f64 = 1.0 / 64.0;
    let of = |step: DVec2| position(surface, at + step);
    let [west, east] = [-STEP, STEP].map(|x| of(DVec2::new(x, 0.0)));
    let [north, south] = [-STEP, STEP].map(|y| of(DVec2::new(0.0, y)));
    let normal = (east? - west?).cross(north? - south?);
    Some(-normal.truncate() / normal.z)
}

/// Share of the length of lines that runs downhill, but for some degrees, by an evaluation of the surface that is not theirs.
fn downhill<'a>(surface: &Surface, lines: impl Iterator<Item = &'a SlopeLine>, degrees: f64) -> f64 {
    let pieces = lines.flat_map(|line| line.points.windows(2));
    let judged = pieces.filter_map(|pair| {
        let [from, to] = [position(surface, pair[0].at)?, position(surface, pair[1].at)?];
        let way = (to - from).truncate();
        let against = -gradient(surface, pair[0].at.midpoint(pair[1].at))?;
        let angle = way.angle_to(against).abs().to_degrees();
        Some((way.length(), angle <= degrees))
    });
    let [good, all] = judged
        .fold([0.0; 2], |[good, all], (length, is_good)| [good + if is_good { length } else { 0.0 }, all + length]);
    share(good, all)
}

#[test]
fn lines_run_down_the_slope() {
    let made = [
        Scene::bare("plane", plane([80, 80])),
        Scene::bare("cone", land([81, 81], |at| 0.5 * (400.0 - at.distance(DVec2::splat(400.0))))),
        Scene::bare("sphere", land([81, 81], |at| (1e6 - at.distance_squared(DVec2::splat(400.0))).sqrt())),
        Scene::bare("saddle", land([81, 81], |at| 1e-3 * ((at.x - 400.0).powi(2) - (at.y - 400.0).powi(2)))),
    ];
    for scene in made.into_iter().chain(real()) {
        let blocks = scene.blocks(ROOM);
        let good = downhill(&scene.surface, lines(&blocks), DOWNHILL_DEGREES);
        println!("{}: {:.4} of {} lines within {DOWNHILL_DEGREES} degrees", scene.name, good, lines(&blocks).count());
        assert!(good >= DOWNHILL_SHARE, "{}: {good}", scene.name);
        for point in lines(&blocks).flat_map(|line| &line.points) {
            let height = position(&scene.surface, point.at).expect("land").z;
            assert!((height - f64::from(point.height)).abs() <= ON_SURFACE * scene.unit(), "{}: {point:?}", scene.name);
        }
        // Negative control: the same lines seven degrees aside.
        let turned = |line: &SlopeLine| {
            let turn = DVec2::from_angle(7_f64.to_radians());
            let from = line.points[0].at;
            let mut line = line.clone();
            line.points.iter_mut().for_each(|point| point.at = from + turn.rotate(point.at - from));
            line
        };
        let turned: Vec<_> = lines(&blocks).map(turned).collect();
        assert!(downhill(&scene.surface, turned.iter(), DOWNHILL_DEGREES) < DOWNHILL_SHARE, "{}", scene.name);
    }
}

#[test]
fn lines_follow_a_surface_that_bends_sideways() {
    let scene = Scene::bare("waves", land([81, 81], |at| 25.0 * (at.x / 15.0).sin() * (at.y / 18.0).cos()));
    let (degrees, least) = DOWNHILL_WAVES;
    let good = downhill(&scene.surface, lines(&scene.blocks(ROOM)), degrees);
    println!("waves: {good:.4} within {degrees} degrees");
    assert!(good >= least, "{good}");
}

#[test]
fn lines_of_a_cone_point_to_its_tip() {
    let tip = DVec2::splat(40.0);
    let scene = Scene::bare("cone", land([81, 81], |at| 0.5 * (400.0 - at.distance(tip * CELL))));
    let blocks = scene.blocks(ROOM);
    let ends = lines(&blocks).map(|line| (line.points[0].at, line.points[line.points.len() - 1].at));
    // Samples hold a cone well a few cells from its tip.
    let far: Vec<_> = ends.filter(|(top, _)| top.distance(tip) > 6.0).collect();
    assert!(far.len() > 50, "only {}", far.len());
    for (top, foot) in far {
        let angle = (foot - top).angle_to(top - tip).abs().to_degrees();
        assert!(angle <= DOWNHILL_DEGREES, "{top} to {foot}: {angle} degrees");
    }
}

#[test]
fn a_plain_has_no_lines() {
    let slopes = [0.0, 0.9, 1.1].map(|share| share * RULES.min_slope.to_radians().tan());
    let counts = slopes.map(|slope| {
        let scene = Scene::bare("plain", land([60, 60], |at| slope * at.x));
        lines(&scene.blocks(ROOM)).count()
    });
    assert_eq!(counts[..2], [0, 0]);
    assert!(counts[2] > 10, "{counts:?}");
}

#[test]
fn lines_are_those_of_the_land_as_it_is() {
    // Twice as high, and said to be: the slope is the same.
    let scene =
        |times: f64| Scene::bare("plain", land([60, 60], |at| times * 0.9 * RULES.min_slope.to_radians().tan() * at.x));
    let count = |scene: &Scene, exaggeration: f64| {
        let slopes = hachure::door::relief::slope::Slopes::new(scene.surface.clone(), exaggeration, RULES, &[], None);
        let blocks = super::blocks(&slopes.expect("slopes"), &|_| ROOM * CELL);
        lines(&blocks).count()
    };
    assert_eq!(count(&scene(2.0), 2.0), 0);
    assert!(count(&scene(2.0), 1.0) > 10);
}

/// A line through places.
fn stop(places: &[[f64; 2]]) -> SurfaceLine {
    let point =
        |at: &[f64; 2]| SurfacePoint { at: DVec2::from_array(*at), across: [f32::INFINITY; 3], length: 0.0, drop: 0.0 };
    let points = places.iter().map(point).collect();
    SurfaceLine { kind: LineKind::Ridge, order: 1, points, closed: false, joins: None }
}

/// How many pieces of lines cross a piece of a stop.
fn crossings<'a>(lines: impl Iterator<Item = &'a SlopeLine>, stops: &[SurfaceLine]) -> usize {
    let side = |[a, b]: [DVec2; 2], p: DVec2| (b - a).perp_dot(p - a) > 0.0;
    let cross = |a: [DVec2; 2], b: [DVec2; 2]| side(a, b[0]) != side(a, b[1]) && side(b, a[0]) != side(b, a[1]);
    let bounds = |[a, b]: [DVec2; 2]| [a.min(b), a.max(b)];
    let meet = |a: [DVec2; 2], b: [DVec2; 2]| a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all();
    let pieces: Vec<_> =
        stops.iter().flat_map(|line| line.points.windows(2)).map(|pair| [pair[0].at, pair[1].at]).collect();
    let boxed: Vec<_> = pieces.into_iter().map(|piece| (piece, bounds(piece))).collect();
    let of_line = |line: &SlopeLine| {
        let all = line
            .points
            .iter()
            .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], point| [low.min(point.at), high.max(point.at)]);
        let near: Vec<_> = boxed.iter().filter(|(_, bounds)| meet(all, *bounds)).collect();
        let pieces = line.points.windows(2).map(|pair| [pair[0].at, pair[1].at]);
        pieces.map(|piece| near.iter().filter(|(stop, _)| cross(piece, *stop)).count()).sum::<usize>()
    };
    lines.map(of_line).sum()
}

#[test]
fn no_line_crosses_a_crest_or_a_channel() {
    let mut scenes = real();
    let wall = stop(&[[10.0, 30.3], [30.2, 29.0], [50.7, 33.3]]);
    scenes.push(Scene { stops: vec![wall], ..Scene::bare("plane", plane([64, 64])) });
    for scene in scenes {
        let blocks = scene.blocks(ROOM);
        assert_eq!(crossings(lines(&blocks), &scene.stops), 0, "{}", scene.name);
        // Negative control: without them lines do.
        let free =
            Scene { stops: Vec::new(), surface: scene.surface.clone(), water: scene.water.clone(), name: scene.name };
        let free = crossings(lines(&free.blocks(ROOM)), &scene.stops);
        println!("{}: {free} crossings without stops", scene.name);
        assert!(free >= 8, "{}: {free}", scene.name);
    }
}

#[test]
fn no_line_enters_water_or_a_void() {
    // A lake in the sample's bay, a void in a plane.
    let scenes = [
        super::sample(),
        Scene::bare(
            "void",
            land([64, 64], |at| {
                let is_void = at.distance(DVec2::splat(300.0)) < 80.0;
                if is_void { f64::NAN } else { 0.2 * at.x }
            }),
        ),
    ];
    for scene in scenes {
        let (dem, blocks) = (scene.surface.dem(), scene.blocks(ROOM));
        assert!(lines(&blocks).count() > 20, "{}", scene.name);
        for at in lines(&blocks).flat_map(|line| &line.points).map(|point| point.at) {
            let [c, r] = at.round().to_array().map(|at| at as usize);
            assert!(!scene.water.is_water(c, r), "{}: {at} is water", scene.name);
            assert!(dem.height(c, r).is_some(), "{}: {at} is void", scene.name);
        }
    }
}
