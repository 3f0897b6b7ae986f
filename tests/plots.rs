//! What a plotter gets: every line, once, in few strokes, in a short order, the same every time.

mod checks;
mod made;
mod stranger;

use std::time::Instant;

use checks::{faults, length, open, ring, short, travel, twice, uncovered};
use glam::{DVec2, DVec3};
use hachure::ink::plot::{Journey, planned};
use hachure::ink::style::Plot;
use hachure::ink::{Drawing, Sheet, Stroke, StrokeForm, StrokePoint, Style, draw};
use hachure::line::{Id, Kind, Lines, Marks};
use hachure::view::{Camera, Perspective};
use made::{curves, scattered, tangle};

use crate::ink::raster;

/// Places of the strokes, each begun at its lesser end, rings at their least place and towards the lesser neighbour: in an
/// order that has nothing to do with that of plotting. In micrometres.
fn canonical(strokes: &[Stroke]) -> Vec<Vec<[i64; 2]>> {
    let of = |stroke: &Stroke| {
        let place = |point: &StrokePoint| (point.place * 1000.0).to_array().map(|c| c.round() as i64);
        let there: Vec<[i64; 2]> = stroke.points.iter().map(place).collect();
        let back: Vec<[i64; 2]> = there.iter().rev().copied().collect();
        let turns = if stroke.closed { there.len() } else { 1 };
        let turned = |way: &[[i64; 2]], turn| [&way[turn..], &way[..turn]].concat();
        let ways = (0..turns).flat_map(|turn| [turned(&there, turn), turned(&back, turn)]);
        ways.min().expect("a stroke has a point")
    };
    let mut all: Vec<_> = strokes.iter().map(of).collect();
    all.sort();
    all
}

/// Whether the plan of these strokes are those, whichever way round and in whichever order.
#[track_caller]
fn becomes(found: &[Stroke], expected: &[Stroke]) {
    let planned = planned(found.to_vec());
    assert_eq!(canonical(&planned), canonical(expected), "{planned:?}");
    let closed = |strokes: &[Stroke]| strokes.iter().filter(|stroke| stroke.closed).count();
    assert_eq!(closed(&planned), closed(expected), "{planned:?}");
}

#[test]
fn whatever_is_found_is_drawn_once_and_nothing_else() {
    let mut merged = 0;
    for seed in 1..400 {
        let found = tangle(seed);
        let planned = planned(found.clone());
        let faults = faults(&found, &planned);
        assert!(faults.is_empty(), "seed {seed}: {faults:?}");
        assert!(planned.iter().all(|stroke| !stroke.closed || stroke.points.len() > 2), "seed {seed}: a ring of two");
        assert!(!twice(&found).is_empty() && !short(&found).is_empty(), "seed {seed} asks for nothing");
        merged += usize::from(planned.len() < found.len());
    }
    assert!(merged > 100, "{merged} layers with fewer strokes than found");
}

#[test]
fn what_is_wrong_with_a_plan_is_noticed() {
    let found = curves(5, 40, [2.0, 9.0]);
    let good = planned(found.clone());
    let with = |change: fn(&mut Vec<Stroke>)| {
        let mut planned = good.clone();
        change(&mut planned);
        faults(&found, &planned).join("; ")
    };
    assert_eq!(with(|_| ()), "");
    assert!(with(|strokes| drop(strokes.remove(7))).starts_with("lost"));
    assert!(with(|strokes| strokes[7].points.truncate(2)).starts_with("lost"));
    assert!(with(|strokes| strokes.push(open(&[(500.0, 1.0), (501.0, 1.0)]))).starts_with("added"));
    assert!(with(|strokes| strokes[3].points[2].place.x += 0.1).contains("added"));
    assert!(with(|strokes| strokes.push(strokes[4].clone())).starts_with("drawn twice"));
    let reversed = |strokes: &mut Vec<Stroke>| {
        let points = strokes[4].points.iter().rev().copied().collect();
        strokes.push(Stroke { points, ..strokes[4].clone() });
    };
    assert!(with(reversed).starts_with("drawn twice"));
    let split = |strokes: &mut Vec<Stroke>| {
        let place = strokes[4].points[1].place + DVec2::X * 0.019;
        strokes[4].points.insert(1, StrokePoint { place, width: 1.0 });
    };
    assert!(with(split).starts_with("too short"));
    let dot = |strokes: &mut Vec<Stroke>| {
        let at = strokes[0].points[0].place;
        strokes.push(open(&[(at.x, at.y), (at.x + 0.024, at.y), (at.x + 0.024, at.y + 0.024)]));
    };
    assert!(with(dot).starts_with("too short"), "{}", with(dot));
    assert_eq!(
        uncovered(&found, &[]).len(),
        uncovered(&found, &[open(&[(900.0, 0.0)])]).len(),
        "nothing covers nothing"
    );
}

#[test]
fn what_is_too_short_goes_or_grows() {
    becomes(&[], &[]);
    becomes(&[open(&[(1.0, 2.0), (4.0, 2.0)])], &[open(&[(1.0, 2.0), (4.0, 2.0)])]);
    // Dots, one of them twice, and what is no more than one.
    for places in [&[(3.0, 4.0)][..], &[(3.0, 4.0), (3.0, 4.0)], &[(2.995, 4.0), (3.005, 4.0)]] {
        for closed in [false, true] {
            let dot = Stroke { closed, ..open(places) };
            let planned = planned(vec![dot.clone(), dot]);
            assert_eq!(planned.len(), 1, "{planned:?}");
            let middle = planned[0].points[0].place.midpoint(planned[0].points[1].place);
            assert!((0.05..0.053).contains(&length(&planned[0])) && middle.distance(DVec2::new(3.0, 4.0)) < 1e-9);
        }
    }
    // In files, these two are one.
    assert_eq!(planned(vec![open(&[(3.0, 4.0)]), open(&[(3.0004, 4.0)])]).len(), 1);
    // Along a line, at its end, around a ring; of a hook at an end, the point that stands out.
    becomes(
        &[open(&[(0.0, 0.0), (1.0, 0.0), (1.015, 0.0), (2.0, 0.0)])],
        &[open(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])],
    );
    becomes(&[open(&[(0.0, 0.0), (1.0, 0.0), (1.01, 0.0)])], &[open(&[(0.0, 0.0), (1.01, 0.0)])]);
    becomes(
        &[ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.01, 0.0)])],
        &[ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])],
    );
    let hook = open(&[(0.0, 0.0), (1.0, 0.0), (0.99, 0.015), (1.01, -0.018)]);
    becomes(&[hook], &[open(&[(0.0, 0.0), (0.99, 0.015), (1.01, -0.018)])]);
}

#[test]
fn nothing_is_drawn_twice() {
    let line = open(&[(1.0, 1.0), (3.0, 1.0), (5.0, 2.0)]);
    let back = open(&[(5.0, 2.0), (3.0, 1.0004), (1.0, 1.0)]);
    becomes(&[line.clone(), back], std::slice::from_ref(&line));
    // Two rings side by side: what the second has of its own.
    let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let beside = ring(&[(1.0, 1.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0)]);
    becomes(&[square.clone(), beside], &[square.clone(), open(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0)])]);
    // A ring again, from elsewhere; a stroke that turns back on its own way.
    let turned = ring(&[(1.0, 1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0)]);
    becomes(&[square.clone(), turned], &[square]);
    becomes(
        &[open(&[(0.0, 5.0), (2.0, 5.0), (2.0, 7.0), (2.0, 5.0), (4.0, 5.0)])],
        // Straight on from the left, and the spike for itself: its ends met where three do.
        &[open(&[(0.0, 5.0), (2.0, 5.0), (2.0, 7.0)]), open(&[(2.0, 5.0), (4.0, 5.0)])],
    );
    // A part of a longer one is left out where it has both its points.
    becomes(&[line.clone(), open(&[(3.0, 1.0), (5.0, 2.0)])], &[line]);
}

#[test]
fn strokes_whose_ends_meet_become_one() {
    let named = |stroke: Stroke, id: u64| Stroke { chain: Some(Id(id)), ..stroke };
    let (a, b, c) = (open(&[(0.0, 0.0), (2.0, 0.0)]), open(&[(4.0, 1.0), (2.0, 0.0)]), open(&[(4.0, 1.0), (6.0, 1.0)]));
    let whole = open(&[(0.0, 0.0), (2.0, 0.0), (4.0, 1.0), (6.0, 1.0)]);
    becomes(&[a.clone(), b.clone(), c.clone()], std::slice::from_ref(&whole));
    becomes(&[c.clone(), a.clone(), b.clone()], &[whole]);
    let one = planned(vec![named(a.clone(), 9), b.clone(), named(c.clone(), 4)]);
    assert_eq!((one.len(), one[0].chain), (1, Some(Id(4))));
    assert_eq!(planned(vec![a.clone(), b])[0].chain, None);
    // A gap of .05 mm and of more.
    becomes(
        &[a.clone(), open(&[(2.04, 0.0), (4.0, 1.0)])],
        &[open(&[(0.0, 0.0), (2.0, 0.0), (2.04, 0.0), (4.0, 1.0)])],
    );
    let apart = [a.clone(), open(&[(2.06, 0.0), (4.0, 1.0)])];
    becomes(&apart, &apart);
    // Three meet: those two that go on the straightest, whichever comes first.
    let branch = open(&[(2.0, 0.0), (2.5, -3.0)]);
    let on = open(&[(2.0, 0.0), (5.0, 0.3)]);
    let joined = [open(&[(0.0, 0.0), (2.0, 0.0), (5.0, 0.3)]), branch.clone()];
    for found in [[&a, &branch, &on], [&branch, &a, &on], [&on, &branch, &a]] {
        becomes(&found.map(Clone::clone), &joined);
    }
    // Where a stroke heads does not hang on its last .03 mm.
    let hooked = open(&[(0.0, 0.0), (2.0, 0.03), (2.0, 0.0)]);
    becomes(
        &[hooked.clone(), branch.clone(), on.clone()],
        &[open(&[(0.0, 0.0), (2.0, 0.03), (2.0, 0.0), (5.0, 0.3)]), branch],
    );
    // Four: both pairs. Five alike: two pairs, always the same ones.
    let cross = [(0.0, 0.0), (4.0, 0.0), (2.0, -2.0), (2.0, 2.0)].map(|end| open(&[end, (2.0, 0.0)]));
    becomes(&cross, &[open(&[(0.0, 0.0), (2.0, 0.0), (4.0, 0.0)]), open(&[(2.0, -2.0), (2.0, 0.0), (2.0, 2.0)])]);
    let star = (0..5).map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 5.0) + 3.0);
    let star: Vec<Stroke> = star.map(|tip| open(&[tip.into(), (3.0, 3.0)])).collect();
    assert_eq!(planned(star).len(), 3);
    // Dots on an end stay dots.
    assert_eq!(planned(vec![a, open(&[(2.0, 0.0)])]).len(), 2);
}

#[test]
fn pieces_of_a_ring_are_closed() {
    let corners = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)];
    let whole = [ring(&corners)];
    becomes(&[open(&[corners[0], corners[1], corners[2], corners[3], corners[0]])], &whole);
    becomes(&[open(&corners[..3]), open(&[corners[0], corners[3], corners[2]])], &whole);
    let sides = [[0, 1], [3, 2], [1, 2], [0, 3]].map(|[a, b]| open(&[corners[a], corners[b]]));
    becomes(&sides, &whole);
    // A gap of .04 mm is closed, one of .06 mm and a short hook are not.
    becomes(
        &[open(&[(0.0, 0.04), (3.0, 0.0), (3.0, 3.0), (0.0, 0.0)])],
        &[ring(&[(0.0, 0.04), (3.0, 0.0), (3.0, 3.0), (0.0, 0.0)])],
    );
    for left in [&[(0.0, 0.06), (3.0, 0.0), (3.0, 3.0), (0.0, 0.0)][..], &[(0.0, 0.0), (0.05, 0.03), (0.045, 0.0)]] {
        becomes(&[open(left)], &[open(left)]);
    }
}

/// The shortest way through the strokes, by trying all orders and directions.
fn best(from: DVec2, left: &[&Stroke]) -> f64 {
    let first = |i: usize| {
        let rest: Vec<&Stroke> = left.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, stroke)| *stroke).collect();
        let [a, b] = [left[i].points[0].place, left[i].points[left[i].points.len() - 1].place];
        (from.distance(a) + best(b, &rest)).min(from.distance(b) + best(a, &rest))
    };
    (0..left.len()).map(first).reduce(f64::min).unwrap_or(0.0)
}

#[test]
fn the_way_is_nearly_the_shortest_there_is() {
    let mut ratios = [Vec::new(), Vec::new()];
    for seed in 1..100 {
        let found = curves(seed, 5, [20.0, 120.0]);
        let shortest = best(DVec2::ZERO, &found.iter().collect::<Vec<_>>());
        let planned = planned(found.clone());
        assert_eq!(planned.len(), found.len());
        [&planned, &found]
            .into_iter()
            .zip(&mut ratios)
            .for_each(|(strokes, ratios)| ratios.push(travel(strokes) / shortest));
    }
    let [planned, found] = ratios.map(|ratios| {
        let most = ratios.iter().fold(0.0, |most: f64, ratio| most.max(*ratio));
        (ratios.iter().sum::<f64>() / ratios.len() as f64, most)
    });
    println!("way in the air over the shortest, mean and most: {planned:?}; as found {found:?}");
    assert!(planned.0 < 1.02 && planned.1 < 1.2, "{planned:?}");
    assert!(found.0 > 1.5, "{found:?}: the measure sees no order");
}

#[test]
fn rings_begin_where_the_pen_comes_from() {
    let circle = |x: f64, y: f64| {
        let corners = (0..90).map(|i| DVec2::from_angle(f64::from(4 * i).to_radians()) * 20.0 + DVec2::new(x, y));
        ring(&corners.map(Into::into).collect::<Vec<_>>())
    };
    let rings = [circle(60.0, 60.0), circle(160.0, 100.0)];
    let planned = planned(rings.to_vec());
    assert_eq!(canonical(&planned), canonical(&rings));
    // One after the other, each from its best point.
    let places = |i: usize| rings[i].points.iter().map(|point| point.place);
    let ways = places(0).flat_map(|a| places(1).map(move |b| a.length() + a.distance(b)));
    let shortest = ways.fold(f64::INFINITY, f64::min);
    assert!(travel(&planned) < 1.01 * shortest, "{} instead of {shortest} mm", travel(&planned));
    // The point nearest to the corner is not the best.
    let nearest = places(0).map(DVec2::length).fold(f64::INFINITY, f64::min);
    assert!(planned[0].points[0].place.length() > nearest + 1.0);
}

#[test]
fn a_plan_is_the_same_every_time_and_needs_no_plan() {
    let found = [curves(11, 800, [1.0, 30.0]), tangle(3), scattered(4, 20, 20)].concat();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| planned(found.clone()))
    };
    let once = planned(found.clone());
    assert!((1..4).all(|threads| with(threads) == once), "threads change the plan");
    assert_ne!(once, found);
    let again = planned(once.clone());
    assert!(travel(&again) <= travel(&once) * 1.02, "{} mm after {}", travel(&again), travel(&once));
    // Equally good ones by their order.
    let alike: Vec<Stroke> = (0..4).map(|i| open(&[(3.0, f64::from(i)), (3.0, f64::from(i) + 0.5)])).collect();
    assert_eq!(planned(alike.clone()), alike);
    let mirrored = [open(&[(3.0, 4.0), (50.0, 50.2)]), open(&[(4.0, 3.0), (50.2, 50.0)])];
    for alike in [[0, 1], [1, 0]].map(|order| order.map(|i| mirrored[i].clone())) {
        assert_eq!(canonical(&planned(alike.to_vec())[..1]), canonical(&alike[..1]));
    }
}

#[test]
fn many_strokes_are_planned_in_little_time() {
    let mut seconds = Vec::new();
    // As many as nearest ones are looked for among; more, along a curve, which is longer.
    for (columns, rows, shares) in [(500, 400, 0.002..0.0025), (500, 420, 0.003..0.0037)] {
        let found = scattered(9, columns, rows);
        let start = Instant::now();
        let planned = planned(found.clone());
        seconds.push(start.elapsed().as_secs_f64());
        assert!(canonical(&planned) == canonical(&found), "{} strokes are others", found.len());
        let [before, after] = [&found, &planned].map(|strokes| travel(strokes));
        println!(
            "{} strokes in {:.2} s: {before:.0} mm in the air become {after:.0}",
            found.len(),
            seconds[seconds.len() - 1]
        );
        assert!(shares.contains(&(after / before)), "{after} of {before} mm");
    }
    assert!(seconds.iter().all(|seconds| *seconds < 30.0), "{seconds:?}");
}

#[test]
fn an_order_is_shorter_than_none() {
    let layers =
        [("contours", curves(7, 3000, [5.0, 60.0]), 0.0195), ("hachures", curves(8, 20_000, [2.0, 2.0]), 0.0073)];
    for (what, found, share) in layers {
        let planned = planned(found.clone());
        let [before, after] = [&found, &planned].map(|strokes| Journey::through(strokes));
        assert!((after.drawn - before.drawn).abs() < 1e-3 * before.drawn, "{what}: {after:?} of {before:?}");
        let plot = Plot::default();
        println!(
            "{what}: {before:?}, {:.0} s; planned {after:?}, {:.0} s",
            before.seconds(&plot),
            after.seconds(&plot)
        );
        assert!(after.travel < share * before.travel, "{what}: {after:?} of {before:?}");
    }
}

#[test]
fn a_journey_is_what_a_pen_does() {
    let strokes =
        [open(&[(3.0, 4.0), (3.0, 10.0)]), ring(&[(11.0, 10.0), (11.0, 13.0), (15.0, 13.0)]), open(&[(11.0, 11.0)])];
    let journey = Journey::through(&strokes);
    assert_eq!(journey, Journey { drawn: 6.0 + 12.0, travel: 5.0 + 8.0 + 1.0, strokes: 3 });
    let two: Journey = [journey, journey].into_iter().sum();
    assert_eq!(two, Journey { drawn: 36.0, travel: 28.0, strokes: 6 });
    let plot = Plot { speed: 9.0, travel_speed: 7.0, lift: 0.5, ..Plot::default() };
    assert!((journey.seconds(&plot) - (2.0 + 2.0 + 1.5)).abs() < 1e-12);
    assert_eq!(Journey::through(&[]), Journey::default());
    // What the checks here measure, on another way.
    let random: Vec<Stroke> = (1..20).flat_map(tangle).collect();
    let (through, drawn) = (Journey::through(&random), random.iter().map(length).sum::<f64>());
    assert!((through.travel - travel(&random)).abs() < 1e-6 && (through.drawn - drawn).abs() < 1e-6);
}

/// A drawing of short lines in rows, in two kinds of ink, found row by row.
fn rows(style: &Style) -> Drawing {
    let kind = |row: i64| if row % 8 < 4 { Kind::Silhouette } else { Kind::Border };
    let raster = raster(120, 80, |x, y| (y % 4 == 2 && x % 30 > 4).then_some((kind(y), 1.0)));
    let camera = Camera { eye: DVec3::ZERO, azimuth: 0.0, altitude: 0.0, fov: 60.0, width: 120, height: 80 };
    let lines = Lines::of(&Marks::from(&raster), &Perspective::new(&camera, 1.0), 0.5);
    draw(&lines, &Sheet::for_frame([120, 80]), style, &[]).expect("a drawing")
}

#[test]
fn layers_know_the_way_of_the_pen_before_and_after() {
    let plot = Plot { centre_lines: true, ..Plot::default() };
    let drawing = rows(&Style { plot, ..Style::default() });
    assert_eq!(drawing.layers.len(), 2);
    for layer in &drawing.layers {
        let planned = Journey::through(&layer.strokes);
        assert_eq!(layer.form, StrokeForm::CentreLines);
        assert_eq!((layer.found.strokes, planned.strokes), (40, 40));
        assert!((layer.found.drawn - planned.drawn).abs() < 0.05 * planned.drawn, "{:?}, {planned:?}", layer.found);
        assert!(planned.travel < 0.8 * layer.found.travel, "{:?}, {planned:?}", layer.found);
    }
    // What no pen follows stays as it is found.
    for layer in &rows(&Style::default()).layers {
        assert_eq!((layer.form, Journey::through(&layer.strokes)), (StrokeForm::Outlines, layer.found));
    }
}
