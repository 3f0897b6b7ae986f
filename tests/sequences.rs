//! From frame to frame: what pops is noticed, what moves with the land does not, and what is drawn pops as little as promised.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::cache::Cache;
use hachure::door::line::economised;
use hachure::door::measure::compare::{CompareObserver, LEAST_TRUTH_LEVEL};
use hachure::door::measure::figures::SequenceRun;
use hachure::door::measure::popped::{Looked, Popped};
use hachure::door::measure::{Comparison, Sequence};
use hachure::error::{Error, Result};
use hachure::geo::read;
use hachure::ink::{Sheet, Style, draw};
use hachure::line::{Chain, ChainPoint, Id, Line, Lines, Recession};
use hachure::plan::{Border, Detail, Method};
use hachure::surface::{Level, Surface};
use hachure::truth::{Inked, Mask, Terrain, TruthPiece};
use hachure::view::{Camera, Fixed, Perspective, choose};

use crate::common::gpu;
use crate::judged::truth;
use crate::scenes::{level, look, rough};
use crate::tolerances::{LEAP, MASK_POP, RECESSION_STEP, STROKES_POP};

/// Page of the lines made here, px.
const PAGE: [u32; 2] = [200, 200];

/// Looks north, an eye so many metres on from the origin.
fn camera(metres_on: f64) -> Camera {
    Camera { eye: DVec3::Y * metres_on, azimuth: 0.0, altitude: 0.0, fov: 90.0, width: PAGE[0], height: PAGE[1] }
}

/// A level line of the world 40 m away, seen from the origin at a row of the page, so heavy.
#[derive(Debug, Clone, Copy)]
struct Level40 {
    row: f64,
    jump: f64,
    weight: f32,
}

fn at(row: f64) -> Level40 {
    Level40 { row, jump: 0.5, weight: 1.0 }
}

impl Level40 {
    fn world(self, column: f64) -> DVec3 {
        DVec3::new(column - 100.0, 100.0, 100.0 - self.row) * 0.4
    }

    fn chain(self, camera: &Camera) -> Chain {
        let perspective = Perspective::new(camera, 1.0);
        let point = |i: i32| {
            let world = self.world(40.0 + f64::from(i));
            let (place, depth) = perspective.project(world);
            let (depth, behind) = (depth as f32, (depth / (1.0 + self.jump)) as f32);
            ChainPoint { place, line: Line::Occluding, depth, behind, world, crowd: 0, weight: self.weight, black: 1.0 }
        };
        Chain { id: Some(Id(self.row as u64)), points: (0..=120).map(point).collect(), closed: false }
    }

    fn pieces(self, camera: &Camera) -> Vec<TruthPiece> {
        let perspective = Perspective::new(camera, 1.0);
        let [from, to] = [40.0, 160.0].map(|column| perspective.project(self.world(column)).0);
        let distance = perspective.distance(self.world(0.0));
        let place = |i: u32| from.lerp(to, f64::from(i) / 1000.0);
        let piece =
            |i| TruthPiece { ends: [place(i), place(i + 1)], distance, line: hachure::truth::TruthLine::Contour };
        (0..1000).map(piece).collect()
    }
}

/// A frame of such lines, as an eye so many metres on sees them: their drawing and their truth.
fn frame(metres_on: f64, drawn: &[Level40], true_ones: &[Level40]) -> (Looked, Looked) {
    let camera = camera(metres_on);
    let chains: Vec<Chain> = drawn.iter().map(|line| line.chain(&camera)).collect();
    let pieces: Vec<TruthPiece> = true_ones.iter().flat_map(|line| line.pieces(&camera)).collect();
    (looked(&camera, chains), Looked::of_truth(&camera, &truth(PAGE, pieces)))
}

/// The default drawing of chains as they are.
fn looked(camera: &Camera, chains: Vec<Chain>) -> Looked {
    let recession = Recession::of(std::iter::once((1.0, 1.0)));
    let (eye, hidden, own) = (camera.eye, Vec::new(), Vec::new());
    let lines = Lines { width: PAGE[0], height: PAGE[1], eye, chains, hidden, recession, own };
    let drawing = draw(&lines, &Sheet::for_frame(PAGE), &Style::default(), &[]).expect("a drawing");
    Looked::of_strokes(camera, &lines, &drawing)
}

/// What strokes of a frame lose towards another.
fn popped((strokes, of): &(Looked, Looked), (next, next_of): &(Looked, Looked)) -> Popped {
    strokes.popped(next, of, &of.lost(next_of))
}

fn share(part: f64, popped: Popped) -> f64 {
    part / popped.darkness
}

#[test]
fn what_moves_with_the_land_does_not_pop_however_far() {
    let lines = [20.0, 60.0, 130.0].map(at);
    let frames = [0.0, 4.0].map(|on| frame(on, &lines, &lines));
    let place = |on: f64| lines[0].chain(&camera(on)).points[60].place;
    assert!(place(0.0).distance(place(4.0)) > 8.0, "the lines hardly move");
    for [here, next] in [[0, 1], [1, 0]] {
        let popped = popped(&frames[here], &frames[next]);
        assert!(popped.darkness > 10.0 && share(popped.lost, popped) < STROKES_POP, "{popped:?}");
    }
}

#[test]
fn a_line_that_goes_or_comes_pops_unless_truth_does() {
    let [all, two] = [vec![at(20.0), at(60.0), at(130.0)], vec![at(20.0), at(130.0)]];
    let whole = frame(0.0, &all, &all);
    let lacking = frame(1.0, &two, &all);
    let goes = popped(&whole, &lacking);
    assert!((share(goes.popped, goes) - 1.0 / 3.0).abs() < 0.01, "one of three goes: {goes:?}");
    let back = popped(&frame(0.0, &two, &all), &frame(1.0, &all, &all));
    assert_eq!(back.popped, 0.0, "what comes is looked for from the other frame");
    let comes = popped(&frame(1.0, &all, &all), &frame(0.0, &two, &all));
    assert!((share(comes.popped, comes) - 1.0 / 3.0).abs() < 0.01, "{comes:?}");
    // Hidden by nearer land, it goes with its truth.
    let hidden = popped(&whole, &frame(1.0, &two, &two));
    assert!((share(hidden.lost, hidden) - 1.0 / 3.0).abs() < 0.01 && hidden.popped == 0.0, "{hidden:?}");
    // What truth never had has no excuse.
    let stray = popped(&frame(0.0, &all, &two), &frame(1.0, &two, &two));
    assert!((share(stray.popped, stray) - 1.0 / 3.0).abs() < 0.01, "{stray:?}");
}

#[test]
fn a_line_that_thins_loses_what_it_thins_by_and_one_that_strays_all() {
    let lines = |line: Level40| [line, at(130.0)];
    let whole = frame(0.0, &lines(at(60.0)), &lines(at(60.0)));
    let lost = |next: Level40| {
        let popped = popped(&whole, &frame(1.0, &lines(next), &lines(at(60.0))));
        share(popped.popped, popped)
    };
    let thinner = lost(Level40 { weight: 0.75, ..at(60.0) });
    assert!((thinner - 0.125).abs() < 0.01, "{thinner}");
    assert!(lost(at(60.7)) < 0.001 && lost(at(61.4)) > 0.4, "{} {}", lost(at(60.7)), lost(at(61.4)));
}

/// The largest share of darkness that pops from one of these frames to the next, where `weigh` weighs the line of each.
fn worst_leap(mut weigh: impl FnMut(&Chain) -> Chain) -> f64 {
    // What lies behind draws near, from twice the least jump and more to less than it.
    let lines = |k: i32| [Level40 { jump: 0.025 - 0.0008 * f64::from(k), ..at(60.0) }, at(130.0)];
    let mut frames = (0..=20).map(|k| {
        let (camera, lines) = (camera(0.05 * f64::from(k)), lines(k));
        let chains = lines.iter().map(|line| weigh(&line.chain(&camera))).collect();
        let pieces: Vec<TruthPiece> = lines.iter().flat_map(|line| line.pieces(&camera)).collect();
        (looked(&camera, chains), Looked::of_truth(&camera, &truth(PAGE, pieces)))
    });
    let mut last = frames.next().expect("a frame");
    let mut worst = 0.0_f64;
    for frame in frames {
        let popped = popped(&last, &frame);
        worst = worst.max(share(popped.popped, popped));
        last = frame;
    }
    worst
}

#[test]
fn a_line_fades_out_and_a_threshold_that_leaps_is_noticed() {
    let economy = Style::default().economy(Sheet::for_frame(PAGE).placement(PAGE).px_per_mm);
    let ours = worst_leap(|chain| economised(std::slice::from_ref(chain), &economy).remove(0));
    let leaping = worst_leap(|chain| {
        let weight = |point: &ChainPoint| if point.jump() > 1.5 * economy.min_jump { 1.0 } else { 0.0 };
        let points = chain.points.iter().map(|point| ChainPoint { weight: weight(point), ..*point }).collect();
        Chain { points, ..chain.clone() }
    });
    assert!(ours > 0.0 && ours <= LEAP, "{ours}");
    assert!(leaping > 3.0 * LEAP, "{leaping}");
}

#[test]
fn one_line_more_hardly_changes_how_others_recede() {
    // Two crowds of ridges with nothing between, as a valley has them.
    let ridges = || (0..100).map(|i| (if i < 95 { 1e-3 + 1e-6 * f64::from(i) } else { 1e-2 } as f32, 1.0));
    let point = |depth: f32| ChainPoint { depth, ..at(0.0).chain(&camera(0.0)).points[0] };
    let change = |ink: f64, depth: f32| {
        let [without, with] = [0.0, ink].map(|ink| Recession::of(ridges().chain([(depth, ink)])));
        let shares = [1e-3_f32, 2e-3, 5e-3, 1e-2].map(|d| (with.share(&point(d)) - without.share(&point(d))).abs());
        shares.into_iter().fold(0.0, f64::max)
    };
    for depth in [5e-4, 1e-3, 1e-2, 2e-2] {
        let changed = change(0.5, depth);
        assert!(changed <= RECESSION_STEP, "half a line of a hundred, at depth {depth}: {changed}");
    }
    assert!(change(50.0, 2e-2) > RECESSION_STEP, "half the ink is not noticed");
}

/// Figures of a flight of straight steps along the view.
fn follow(surface: &Arc<Surface>, methods: &[Method], cameras: &[Camera], truth: Level) -> Result<Vec<SequenceRun>> {
    let comparison = Comparison {
        methods: methods.to_vec(),
        levels: vec![Detail::default()],
        repeat: std::num::NonZeroU32::MIN,
        floor: false,
        border: Border::On,
        truth_level: Some(truth),
        cache: Cache::none(),
    };
    let hearing = CompareObserver { stage: &|_, _| (), warn: &|_| (), found: &|_| Ok(()) };
    let sequence = Sequence { name: "flight", step_m: 1.0, cameras };
    comparison.sequence(gpu(), surface, &Terrain::new(surface), sequence, &hearing)
}

fn steps(camera: &Camera, count: u32, metres: f64) -> Vec<Camera> {
    let forward = camera.axes()[2];
    (0..count).map(|k| Camera { eye: camera.eye + forward * f64::from(k) * metres, ..*camera }).collect()
}

#[test]
fn every_method_is_followed_and_frames_know_nothing_of_each_other() {
    let surface = Arc::new(Surface::new(rough(40, 36, 1.0, 4.0, false)));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec2::new((west + east) / 2.0, (south + north) / 2.0).extend(0.0);
    let camera = look(middle + DVec3::new(0.0, -700.0, 160.0), middle, 60.0, [160, 96]);
    let cameras = steps(&camera, 4, 1.0);
    let runs = follow(&surface, &Method::ALL, &cameras, level(8)).expect("runs");
    assert_eq!(runs.iter().map(|run| run.method).collect::<Vec<_>>(), Method::ALL.map(|method| method.entry().name));
    for run in &runs {
        assert_eq!((run.frames, run.truth_level, run.width, run.height), (4, 8, 160, 96));
        assert!(run.inked > 100 && run.recall > 0.5 && run.least_recall <= run.recall, "{run:?}");
        assert!((run.pop - run.truth_pop - run.excess_pop).abs() < 1e-12);
        assert!(run.strokes_excess_pop <= run.strokes_lost && run.strokes_lost < 0.5, "{run:?}");
        assert_eq!(run.ids_kept.is_some(), ["walk", "contour"].contains(&run.method), "{}", run.method);
    }
    // The other way round they are the same frames, and strokes that go are strokes that come.
    let back: Vec<Camera> = cameras.iter().rev().copied().collect();
    let there = &runs[0];
    let back = &follow(&surface, &[Method::Walk], &back, level(8)).expect("runs")[0];
    assert_eq!((back.inked, back.least_recall), (there.inked, there.least_recall));
    for (back, there) in [(back.strokes_lost, there.strokes_lost), (back.strokes_excess_pop, there.strokes_excess_pop)]
    {
        assert!((back - there).abs() < 1e-9, "{back}, {there}");
    }
    let sky = Camera { altitude: 80.0, ..camera };
    assert!(matches!(follow(&surface, &[Method::Walk], &steps(&sky, 2, 1.0), level(8)), Err(Error::Scene { .. })));
}

#[test]
fn the_sample_pops_as_little_as_promised() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let surface = Arc::new(Surface::new(read(sample, &Default::default()).expect("the sample")));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 640, 360).expect("a view");
    let runs = follow(&surface, &[Method::Walk], &steps(&camera, 4, 1.0), LEAST_TRUTH_LEVEL).expect("runs");
    let SequenceRun { excess_pop, strokes_excess_pop, recall, inked, .. } = runs[0];
    println!("excess pop {excess_pop}, of strokes {strokes_excess_pop}, recall {recall}, {inked} px");
    assert!(inked > 4000 && recall > 0.99);
    assert!(excess_pop.abs() <= MASK_POP && strokes_excess_pop <= STROKES_POP, "{excess_pop}, {strokes_excess_pop}");
}

#[test]
fn ink_dropped_in_one_frame_is_noticed() {
    let page = |rows: &[u32]| {
        let row = |&row: &u32| (10..90).map(move |column| Inked { column, row, distance: 1.0 });
        Mask { size: [100, 100], inked: rows.iter().flat_map(row).collect() }
    };
    assert_eq!(page(&[20, 40, 60]).pop(&page(&[21, 39, 60])), 0.0);
    assert_eq!(page(&[20, 40]).pop(&page(&[20])), 0.5);
    assert!(page(&[20, 40]).pop(&page(&[20, 42])) > MASK_POP);
}
