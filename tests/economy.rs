//! Economy: which lines are drawn, how strongly, and that nothing pops, on lines made here.

use std::time::{Duration, Instant};

use glam::{DVec2, DVec3};
use hachure::door::line::economised;
use hachure::door::line::ends::free;
use hachure::door::measure::chains::drawn_recall;
use hachure::line::{Chain, ChainPoint, Economy, Id, Line};
use hachure::truth::metrics::Judge;

use crate::judged::truth;
use crate::scenes::Random;
use crate::tolerances::{VISIBLE_WEIGHT, WEIGHT_STEP};
use crate::truth::metrics::straight;

const ECONOMY: Economy = Economy { min_jump: 0.01, min_gap: 3.0 };
/// Depth of lines unless said otherwise.
const DEPTH: f32 = 0.01;

/// A line through these places, a point a pixel, that draws `line` with so much of a jump behind it.
fn line(line: Line, jump: f64, places: &[(f64, f64)]) -> Chain {
    let place = |(x, y): (f64, f64)| DVec2::new(x, y);
    let behind = if line == Line::Skyline { 0.0 } else { (f64::from(DEPTH) / (1.0 + jump)) as f32 };
    let point = |place: DVec2| ChainPoint {
        place,
        line,
        depth: DEPTH,
        behind,
        world: DVec3::ZERO,
        crowd: 0,
        weight: 1.0,
        black: 1.0,
    };
    let mut points = vec![point(place(places[0]))];
    for pair in places.windows(2) {
        let [a, b] = [place(pair[0]), place(pair[1])];
        let steps = a.distance(b).ceil();
        points.extend((1..=steps as u32).map(|i| point(a.lerp(b, f64::from(i) / steps))));
    }
    Chain { id: Some(Id(0)), points, closed: false }
}

/// A level line from right to left, as crests have it: the surface below it, what is behind above.
fn level(kind: Line, jump: f64, y: f64, [left, right]: [f64; 2]) -> Chain {
    line(kind, jump, &[(right, y), (left, y)])
}

/// The same line at another depth, with the same jump.
fn at_depth(chain: &Chain, depth: f32) -> Chain {
    let moved = |point: &ChainPoint| ChainPoint { depth, behind: point.behind / point.depth * depth, ..*point };
    Chain { points: chain.points.iter().map(moved).collect(), ..*chain }
}

/// The weight of a chain at a share of its points.
fn weight(chain: &Chain, share: f64) -> f32 {
    chain.points[((chain.points.len() - 1) as f64 * share) as usize].weight
}

/// Weights in the middle of lines.
fn middles(chains: &[Chain]) -> Vec<f32> {
    economised(chains, &ECONOMY).iter().map(|chain| weight(chain, 0.5)).collect()
}

fn is_rising(weights: &[f32]) -> bool {
    weights.windows(2).all(|pair| pair[0] <= pair[1] + 1e-6)
}

#[test]
fn a_line_fades_in_with_its_jump() {
    let alone = |jump: f64| middles(&[level(Line::Occluding, jump, 50.0, [0.0, 200.0])])[0];
    let weights: Vec<f32> = (0..=30).map(|i| alone(0.001 * f64::from(i))).collect();
    assert!(is_rising(&weights), "{weights:?}");
    assert_eq!(
        (weights[10], weights[20], alone(5.0)),
        (0.0, 1.0, 1.0),
        "out up to the least jump, whole from twice that"
    );
    assert!((0.4..0.6).contains(&weights[15]), "{}", weights[15]);
    assert_eq!(middles(&[level(Line::Border, 0.009, 50.0, [0.0, 200.0])]), [0.0], "so do borders");
    assert_eq!(alone(-0.1), 0.0, "what is behind and yet nearer is nothing");
    let all = Economy { min_jump: 0.0, ..ECONOMY };
    let flat = economised(&[level(Line::Occluding, 0.0, 50.0, [0.0, 200.0])], &all);
    assert!(flat[0].points.iter().all(|point| point.weight == 1.0));
}

#[test]
fn a_line_fades_in_with_its_length() {
    let alone = |length: f64| middles(&[level(Line::Occluding, 1.0, 50.0, [0.0, length])])[0];
    let weights: Vec<f32> = (1..=30).map(|length| alone(f64::from(length) / 2.0)).collect();
    assert!(is_rising(&weights), "{weights:?}");
    assert_eq!((weights[5], weights[23]), (0.0, 1.0), "3 px are out, 12 px whole");
    assert_eq!(middles(&[level(Line::Skyline, 0.0, 50.0, [0.0, 2.0])]), [1.0], "but for the skyline");
}

#[test]
fn of_two_lines_too_near_the_weaker_yields() {
    // Strong, weak and how they differ.
    let span = [0.0, 200.0];
    let pairs = [
        ("jump", level(Line::Occluding, 0.5, 50.0, span), level(Line::Occluding, 0.1, 50.0, span)),
        ("length", level(Line::Occluding, 0.3, 50.0, span), level(Line::Occluding, 0.3, 50.0, [95.0, 105.5])),
        ("nearness", at_depth(&level(Line::Occluding, 0.3, 50.0, span), 0.04), level(Line::Occluding, 0.3, 50.0, span)),
        ("sky", level(Line::Skyline, 0.0, 50.0, span), level(Line::Border, 9.0, 50.0, span)),
        ("sky", level(Line::Skyline, 0.0, 50.0, span), at_depth(&level(Line::Occluding, 9.0, 50.0, span), 0.9)),
    ];
    for (what, strong, weak) in pairs {
        let beside = |gap: f64| {
            let mut weak = weak.clone();
            weak.points.iter_mut().for_each(|point| point.place.y += gap);
            let both = middles(&[weak, strong.clone()]);
            assert_eq!(both[1], 1.0, "{what}: the stronger yields at {gap} px");
            both[0]
        };
        let weights: Vec<f32> = (0..=20).map(|i| beside(0.2 * f64::from(i))).collect();
        let alone = middles(std::slice::from_ref(&weak))[0];
        assert!(is_rising(&weights), "{what}: {weights:?}");
        assert!(weights[0] < 0.5 * alone && weights[20] == alone, "{what}: {weights:?}, {alone} alone");
    }
    // Kind decides between equals.
    let border = middles(&[
        level(Line::Border, 0.3, 50.0, span),
        level(Line::Occluding, 0.3, 51.0, span),
        level(Line::Occluding, 0.3, 80.0, span),
        level(Line::Occluding, 0.3, 81.0, span),
    ]);
    assert!(border[0] == 1.0 && border[1] < 1.0, "a border is stronger: {border:?}");
    assert_eq!(border[2..], [1.0, 1.0], "equals stay both");
    let none = Economy { min_gap: 0.0, ..ECONOMY };
    let crowd: Vec<Chain> = (0..9).map(|i| level(Line::Occluding, 0.1 + 0.3 * f64::from(i), 50.0, span)).collect();
    let weights = |economy: &Economy| economised(&crowd, economy).iter().map(|c| weight(c, 0.5)).sum::<f32>();
    assert!(weights(&none) == 9.0 && weights(&ECONOMY) < 3.5, "{} {}", weights(&none), weights(&ECONOMY));
}

#[test]
fn the_skyline_never_yields() {
    let mut chains = vec![level(Line::Skyline, 0.0, 50.0, [0.0, 60.0]), level(Line::Skyline, 0.0, 50.0, [70.0, 72.0])];
    for (i, jump) in [20.0, 3.0, 0.5].into_iter().enumerate() {
        for y in [49.0, 50.0, 51.0] {
            chains.push(at_depth(&level(Line::Occluding, jump, y + 0.1 * i as f64, [-100.0, 300.0]), 0.5));
            chains.push(level(Line::Border, jump, y, [-100.0, 300.0]));
        }
    }
    let drawn = economised(&chains, &ECONOMY);
    for chain in &drawn[..2] {
        assert!(chain.points.iter().all(|point| point.weight == 1.0), "{:?}", chain.points);
    }
    assert!(drawn[2..].iter().all(|chain| weight(chain, 0.675) < 0.01), "all others do, beside it");
    // A narrow notch between two walls: each with sky behind it, each the outline of land.
    let notch = |depth| at_depth(&line(Line::Skyline, 0.0, &[(52.0, 100.0), (52.0, 20.0)]), depth);
    let wall = line(Line::Skyline, 0.0, &[(50.5, 20.0), (50.5, 100.0)]);
    for depth in [0.002, 0.05] {
        assert_eq!(middles(&[wall.clone(), notch(depth)]), [1.0, 1.0]);
    }
}

#[test]
fn a_skyline_before_a_farther_one_is_none() {
    let crest = |y: f64| level(Line::Skyline, 0.0, y, [0.0, 200.0]);
    let middles = |gap: f64| middles(&[crest(50.0 + gap), at_depth(&crest(50.0), 0.5 * DEPTH)]);
    assert_eq!(middles(1.2), [0.0, 1.0], "the raster saw no land between the two, yet there is");
    assert_eq!(middles(-1.2), [1.0, 1.0], "behind the land of the nearer there is nothing to see");
    assert_eq!(middles(4.0), [1.0, 1.0]);
}

#[test]
fn a_line_that_has_faded_pushes_no_one() {
    let span = [0.0, 200.0];
    let lines = |jump: f64| {
        [
            level(Line::Occluding, 1.0, 50.0, span),
            level(Line::Occluding, jump, 51.8, span),
            level(Line::Occluding, 0.05, 53.2, span),
        ]
    };
    let middles = middles(&lines(0.3));
    assert_eq!(middles[0], 1.0);
    assert!(middles[1] < 0.2 && middles[2] > 0.85, "the second makes room for the third: {middles:?}");
    let alone = crate::economy::middles(&lines(0.3)[1..]);
    assert!(alone[0] == 1.0 && alone[1] < 0.05, "which it would push out by itself: {alone:?}");
}

#[test]
fn lines_that_cross_or_go_on_do_not_compete() {
    // A weak line runs on while a strong one ends on it, crosses it, or begins where it ends.
    let weak = || level(Line::Occluding, 0.1, 50.0, [0.0, 200.0]);
    let meetings = [
        ("ends", line(Line::Occluding, 3.0, &[(100.0, 0.0), (100.0, 50.0)])),
        ("crosses", line(Line::Occluding, 3.0, &[(90.0, 0.0), (110.0, 100.0)])),
        ("goes on", level(Line::Skyline, 3.0, 50.0, [-200.0, 0.0])),
    ];
    for (how, strong) in meetings {
        let drawn = economised(&[weak(), strong], &ECONOMY);
        let least = drawn.iter().flat_map(|c| &c.points).map(|point| point.weight).fold(1.0, f32::min);
        assert!(least > 0.95, "{how}: {least}");
    }
    // One line whose wiggles come near it, as a line of the land does; and a hairpin far back along it.
    let wiggles: Vec<(f64, f64)> =
        (0..40).map(|i| (100.0 - 2.0 * f64::from(i), if i % 2 == 0 { 50.0 } else { 51.5 })).collect();
    let wiggly = economised(&[line(Line::Occluding, 0.3, &wiggles)], &ECONOMY);
    assert!(wiggly[0].points.iter().all(|point| point.weight == 1.0));
    let mut hairpin = line(Line::Occluding, 0.3, &[(200.0, 50.0), (0.0, 50.0), (0.0, 51.0), (200.0, 51.0)]);
    let half = hairpin.points.len() / 2;
    hairpin.points[half..].iter_mut().for_each(|point| point.behind = 0.92 * point.depth);
    let hairpin = &economised(&[hairpin], &ECONOMY)[0];
    let [there, back] = [weight(hairpin, 0.2), weight(hairpin, 0.8)];
    assert!(there == 1.0 && back < 0.1, "{there}, {back}");
}

#[test]
fn a_line_runs_on_where_its_jump_ends() {
    let mut chain = level(Line::Occluding, 0.5, 50.0, [0.0, 200.0]);
    chain.points[100..].iter_mut().for_each(|point| point.behind = point.depth);
    let chain = &economised(&[chain], &ECONOMY)[0];
    let weights: Vec<f32> = chain.points.iter().rev().map(|point| point.weight).collect();
    assert!(is_rising(&weights), "{weights:?}");
    let of = |from: f64, to: f64| {
        let inside = chain.points.iter().filter(move |point| (from..to).contains(&(200.0 - point.place.x)));
        inside.map(|point| point.weight)
    };
    assert!(of(0.0, 96.0).all(|weight| weight > 0.99), "up to where it ends");
    assert!(of(120.0, 300.0).all(|weight| weight == 0.0), "not far beyond");
}

/// A page of lines that wander side by side: of all kinds, jumps and depths, some closed.
fn wild(seed: u64, count: u32) -> Vec<Chain> {
    let mut random = Random::new(seed);
    let chain = |id: u32| {
        let kind = [Line::Occluding, Line::Occluding, Line::Border, Line::Skyline][random.below(4) as usize];
        let (mut x, mut y) = (random.between(0.0, 300.0), random.between(0.0, 120.0));
        let mut heading = random.between(-0.4, 0.4);
        let mut places = vec![(x, y)];
        for _ in 0..2 + random.below(30) {
            heading += random.between(-0.3, 0.3);
            (x, y) = (x - 4.0 * f64::cos(heading), y - 4.0 * f64::sin(heading));
            places.push((x, y));
        }
        let drawn = line(kind, 10_f64.powf(random.between(-2.3, 0.5)), &places);
        let mut drawn = at_depth(&drawn, 10_f32.powf(random.between(-3.0, -1.0) as f32));
        drawn.closed = random.below(8) == 0;
        Chain { id: Some(Id(id.into())), ..drawn }
    };
    (0..count).map(chain).collect()
}

/// The largest change of a weight from one page to another with the same points.
fn change(from: &[Chain], to: &[Chain]) -> f32 {
    let weights = |chains: &[Chain]| {
        let drawn = economised(chains, &ECONOMY);
        drawn.iter().map(|chain| chain.points.iter().map(|point| point.weight).collect()).collect::<Vec<Vec<f32>>>()
    };
    let (from, to) = (weights(from), weights(to));
    let pairs = from.iter().zip(&to).filter(|(a, b)| a.len() == b.len());
    assert!(pairs.clone().count() > from.len() * 9 / 10, "lines are cut otherwise");
    pairs.flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn nothing_pops() {
    let mut worst = [0.0_f32; 3];
    for seed in 1..=12 {
        let page = wild(seed, 90);
        let mut random = Random::new(1000 + seed);
        let mut moved = |px: f64, share: f64| {
            let mut page = page.clone();
            for chain in &mut page {
                // Neighbours along a line move alike: it stays a line.
                let [a, b, c] = [0.0, 0.0, 0.0].map(|_| random.between(0.0, std::f64::consts::TAU));
                let behind = 1.0 + random.between(-share, share);
                for (i, point) in chain.points.iter_mut().enumerate() {
                    let angle = a + (0.05 * i as f64 + b).sin();
                    point.place += DVec2::from_angle(angle) * px * (0.03 * i as f64 + c).sin();
                    let jump = point.jump() * behind;
                    point.behind =
                        if point.behind == 0.0 { 0.0 } else { (f64::from(point.depth) / (1.0 + jump)) as f32 };
                }
            }
            page
        };
        let changes = [moved(0.05, 0.0), moved(0.0, 0.01), moved(1.5, 0.0)].map(|to| change(&page, &to));
        worst = std::array::from_fn(|i| worst[i].max(changes[i]));
    }
    println!(
        "weights change by {:.3} where points move by .05 px, {:.3} where jumps change by 1 %",
        worst[0], worst[1]
    );
    assert!(worst[0] > 0.0 && worst[0] <= WEIGHT_STEP, "{worst:?}");
    assert!(worst[1] > 0.0 && worst[1] <= WEIGHT_STEP, "{worst:?}");
    assert!(worst[2] > WEIGHT_STEP, "moves of 1.5 px are not noticed: {worst:?}");
}

#[test]
fn weights_are_the_same_in_any_order_of_chains() {
    let page = wild(77, 200);
    let drawn = economised(&page, &ECONOMY);
    assert!(drawn == economised(&page, &ECONOMY));
    let reversed: Vec<Chain> = page.iter().rev().cloned().collect();
    let mut back = economised(&reversed, &ECONOMY);
    back.reverse();
    assert!(drawn == back, "weights depend on the order");
    let shares = [0.0, VISIBLE_WEIGHT, 1.0]
        .map(|share| drawn.iter().flat_map(|chain| &chain.points).filter(|point| point.weight <= share).count());
    assert!(shares.windows(2).all(|pair| pair[0] + 100 < pair[1]), "a page of all weights: {shares:?}");
}

#[test]
fn points_in_between_lie_on_the_line() {
    let mut sparse = level(Line::Occluding, 0.5, 50.0, [0.0, 40.0]);
    sparse.points = [sparse.points[0], sparse.points[40]].to_vec();
    sparse.points[0].world = DVec3::new(10.0, 100.0, 0.0);
    sparse.points[1] = ChainPoint { world: DVec3::new(-30.0, 300.0, 20.0), depth: DEPTH / 3.0, ..sparse.points[1] };
    let points = &economised(&[sparse], &ECONOMY)[0].points;
    assert!(points.windows(2).all(|pair| pair[0].place.distance(pair[1].place) <= 2.25 + 1e-9));
    let middle = points.iter().find(|point| (point.place.x - 20.0).abs() < 1.2).expect("a point in the middle");
    // Half way on the page is a quarter of the way to a point thrice as far.
    let quarter = DVec3::new(0.0, 150.0, 5.0);
    assert!(middle.world.distance(quarter) < 12.0 && (middle.depth / DEPTH - 2.0 / 3.0).abs() < 0.03, "{middle:?}");
    assert!(economised(&[], &ECONOMY).is_empty());
}

#[test]
fn time_grows_with_the_line() {
    let time = |count: u32| {
        // The same crowd on a page that grows.
        let page = (0..count).flat_map(|part| {
            let mut chains = wild(u64::from(part % 7) + 1, 90);
            let shift = DVec2::new(f64::from(part % 8) * 400.0, f64::from(part / 8) * 200.0);
            chains.iter_mut().flat_map(|chain| &mut chain.points).for_each(|point| point.place += shift);
            chains
        });
        let page: Vec<Chain> = page.collect();
        let points: usize = page.iter().map(|chain| chain.points.len()).sum();
        let once = |_| {
            let start = Instant::now();
            assert_eq!(economised(&page, &ECONOMY).len(), page.len());
            start.elapsed()
        };
        (points, (0..5).map(once).min().unwrap_or(Duration::MAX))
    };
    let ((few, short), (many, long)) = (time(2), time(16));
    println!("{few} points in {short:?}, {many} in {long:?}");
    assert!(many > 7 * few && long < short * 24, "{few} points in {short:?}, {many} in {long:?}");
}

#[test]
fn what_economy_removes_of_truth_is_what_no_line_tells_any_more() {
    let ends = |y: f64| ([10.0, y], [110.0, y]);
    let lines = [20.0, 60.0].map(ends).map(|(from, to)| straight(from, to, 1.0)).concat();
    let truth = truth([128, 96], lines);
    let judge = Judge::new(&truth).expect("lines on the page");
    let chain = |jump: f64, y: f64| level(Line::Occluding, jump, y, [10.0, 110.0]);
    let recall = |chains: &[Chain]| drawn_recall(&judge, chains, &ECONOMY);
    assert_eq!(recall(&[chain(0.5, 20.0), chain(0.5, 60.0)]), 1.0);
    assert_eq!(recall(&[chain(0.5, 20.0), chain(0.005, 60.0)]), 0.5, "one of two has too small a jump");
    // Half a pixel beside a strong line a weak one is left out, and truth is told of all the same.
    assert_eq!(recall(&[chain(0.5, 20.0), chain(0.5, 60.5), chain(0.02, 60.0)]), 1.0);
}

#[test]
fn ridges_keep_farther_from_silhouettes_than_streams_do() {
    let crest = level(Line::Occluding, 1.0, 50.0, [0.0, 200.0]);
    // So many gaps below a silhouette, full weight where it is alone.
    let beside = |kind: Line, gaps: f64| {
        let line = level(kind, 0.0, 50.0 + gaps * ECONOMY.min_gap, [0.0, 200.0]);
        let [silhouette, line] = middles(&[crest.clone(), line])[..] else { panic!("two lines") };
        assert_eq!(silhouette, 1.0, "it yields to nothing that lies on the land");
        line
    };
    for (gaps, [stream, ridge]) in [(0.4, [0.0, 0.0]), (1.2, [1.0, 0.0]), (3.0, [1.0, 1.0])] {
        assert_eq!([Line::Drainage, Line::Ridge].map(|kind| beside(kind, gaps)), [stream, ridge], "{gaps} gaps");
    }
    // Across, neither gives way.
    let across = line(Line::Ridge, 0.0, &[(100.0, 10.0), (100.0, 90.0)]);
    assert_eq!(middles(&[crest, across])[1], 1.0);
}

#[test]
fn silhouettes_end_on_nothing_that_lies_on_the_land() {
    // One ends in the middle of another, from above.
    let ending = |ends: Line, on: Line| {
        let [ends, on] = [line(ends, 1.0, &[(100.0, 10.0), (100.0, 50.0)]), level(on, 1.0, 50.0, [20.0, 180.0])];
        free(&[ends, on], [200, 200])[0]
    };
    assert_eq!(ending(Line::Occluding, Line::Occluding), [true, false]);
    assert_eq!(ending(Line::Drainage, Line::Occluding), [true, false], "a stream ends on a silhouette");
    assert_eq!(ending(Line::Drainage, Line::Drainage), [true, false]);
    assert_eq!(
        ending(Line::Occluding, Line::Drainage),
        [true, true],
        "and a silhouette is drawn as without the stream"
    );
}
