//! Truth's bounds, tree and proofs of facing change nothing: piece by piece it is what the slow program finds.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::surface::Surface;
use hachure::truth::{Terrain, TruthLine, TruthPiece};
use hachure::view::Camera;

use super::slow::{Found, Slow};
use crate::scenes::{Random, level, look};
use crate::tolerances::{DOUBTFUL_SHARE, SAME_PIECE_PX};

const PAGE: [u32; 2] = [48, 36];
/// Metres.
const CELL: DVec2 = DVec2::new(20.0, 15.0);
/// Columns and rows of samples.
const SAMPLES: [usize; 2] = [8, 6];
/// Surfaces of each exaggeration. On those of 105, 114 and 121 a sliver faces away beside patches that do not.
const SEEDS: RangeInclusive<u64> = 105..=121;

/// What a small surface is made of.
#[derive(Debug, Clone, Copy)]
struct Ground {
    seed: u64,
    shape: Shape,
    /// Of heights of 20 m; 30 and more folds patches of noise.
    exaggeration: f64,
    /// Whether one sample in eight is void.
    voids: bool,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    Noise,
    /// Noise in steps of 10 m: patches bulge over level corners.
    Terraces,
    /// Long waves: most patches face one way.
    Waves,
}

const SHAPES: [Shape; 3] = [Shape::Noise, Shape::Terraces, Shape::Waves];

fn ground(Ground { seed, shape, exaggeration, voids }: Ground) -> Surface {
    let mut random = Random::new(seed);
    let [length, across, first, second] = [4.0, 4.0, 0.0, 0.0].map(|least| least + random.between(0.0, 6.0));
    let mut height = |i: usize| {
        let (noise, void) = (random.between(0.0, 20.0), random.below(8) == 0);
        let (x, y) = ((i % SAMPLES[0]) as f64, (i / SAMPLES[0]) as f64);
        let height = match shape {
            Shape::Noise => noise,
            Shape::Terraces => (noise / 10.0).round() * 10.0,
            Shape::Waves => 10.0 * ((x / length * TAU + first).sin() + (y / across * TAU + second).sin()),
        };
        if voids && void { f32::NAN } else { (height * exaggeration) as f32 }
    };
    let heights = (0..SAMPLES[0] * SAMPLES[1]).map(&mut height).collect();
    Surface::new(Dem::from_heights(SAMPLES[0], CELL, DVec2::new(300.0, 400.0), heights))
}

/// Eyes close over the ground, high above it, inside it and below it, beside it and far off, looking at it or anywhere.
fn anywhere(surface: &Surface, random: &mut Random) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let [low, high] = surface.dem().range().expect("land").map(f64::from);
    let inside = DVec3::new(random.between(west, east), random.between(south, north), random.between(low, high));
    let away = DVec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.2, 1.0));
    let span = (east - west).max(high - low);
    let over = surface.height_below(inside.truncate(), level(2)).map(|ground| ground + random.between(0.0, 2.0));
    let eye = match random.below(7) {
        0 => over.map_or(inside, |z| inside.with_z(z)),
        1 => inside.with_z(high + random.between(0.0, 2.0) * span),
        2 => inside.with_z(low - random.between(0.0, 1.0) * span),
        3 => inside + away * (20.0 * span),
        4 => inside,
        _ => inside + away * span,
    };
    let target = DVec3::new(random.between(west, east), random.between(south, north), random.between(low, high));
    let camera = look(eye, target, random.between(10.0, 100.0), PAGE);
    let turned = random.below(4) == 0;
    if turned { Camera { azimuth: random.between(0.0, 360.0), ..camera } } else { camera }
}

/// What two programs found.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Compared {
    pieces: usize,
    border: usize,
    doubtful: usize,
    /// Pieces of the slow program that truth lacks.
    missing: usize,
    /// Pieces of truth that the slow program lacks.
    extra: usize,
}

impl Compared {
    fn unlike(&self) -> usize {
        self.missing + self.extra
    }

    fn and(self, other: Self) -> Self {
        Self {
            pieces: self.pieces + other.pieces,
            border: self.border + other.border,
            doubtful: self.doubtful + other.doubtful,
            missing: self.missing + other.missing,
            extra: self.extra + other.extra,
        }
    }
}

/// Each piece has one partner at most, doubtful pieces need none.
fn compare(truth: &[TruthPiece], slow: &Found) -> Compared {
    let same = |a: &TruthPiece, b: &TruthPiece| {
        let [p, q] = b.ends;
        let near = |p: DVec2, q: DVec2| a.ends[0].distance(p).max(a.ends[1].distance(q)) <= SAME_PIECE_PX;
        let depth = (a.distance / b.distance - 1.0).abs() <= SAME_PIECE_PX;
        a.line == b.line && depth && (near(p, q) || near(q, p))
    };
    let mut open: Vec<&TruthPiece> = truth.iter().collect();
    let mut partner = |piece: &&TruthPiece| open.iter().position(|p| same(p, piece)).map(|i| open.remove(i)).is_some();
    let missing = slow.seen.iter().filter(|p| !partner(p)).count();
    slow.doubtful.iter().for_each(|p| _ = partner(&p));
    Compared {
        pieces: truth.len(),
        border: truth.iter().filter(|p| p.line == TruthLine::Border).count(),
        doubtful: slow.doubtful.len(),
        missing,
        extra: open.len(),
    }
}

/// Compares from some eyes at some levels.
fn from_eyes(of: Ground) -> Compared {
    let surface = ground(of);
    let terrain = Terrain::new(&surface);
    let mut random = Random::new(of.seed + 1000);
    let mut all = Compared::default();
    for (n, eyes) in [(1, 2), (2, 5), (4, 4), (8, 1)] {
        let slow = Slow::new(&surface, level(n));
        for _ in 0..eyes {
            let camera = anywhere(&surface, &mut random);
            let compared = compare(&terrain.truth(&camera, level(n)).pieces, &slow.lines(&camera));
            assert_eq!(compared.unlike(), 0, "{of:?}, level {n}, {camera:?}: {compared:?}");
            all = all.and(compared);
        }
    }
    all
}

#[test]
fn truth_is_what_all_facets_say() {
    for exaggeration in [0.3, 1.0, 5.0, 30.0, 100.0] {
        let ground = |seed| Ground { seed, shape: SHAPES[seed as usize % 3], exaggeration, voids: seed % 4 == 0 };
        let all = SEEDS.map(|seed| from_eyes(ground(seed))).fold(Compared::default(), Compared::and);
        let Compared { pieces, border, doubtful, .. } = all;
        println!("exaggeration {exaggeration}: {pieces} pieces, {border} of border lines, {doubtful} doubtful");
        assert!(border > 1000 && pieces - border > 1000, "{pieces} pieces, {border} of border lines: too few");
        let most = DOUBTFUL_SHARE * pieces as f64;
        assert!(doubtful as f64 <= most, "{doubtful} doubtful pieces of {pieces}: nothing is compared");
    }
}

/// A wall with a flat top before a rim that rises from below its top to above it: between the two rows of its samples
/// the wall bulges over them. Along the rows, or along the columns.
fn wall(along_rows: bool) -> Surface {
    const SIDE: usize = 12;
    let height = |across: usize, along: usize| match across {
        0 => 9.5 + 0.25 * along as f64,
        5 | 6 => 10.0,
        _ => 0.0,
    };
    let at = |c, r| if along_rows { height(r, c) } else { height(SIDE - 1 - c, r) } as f32;
    let heights = (0..SIDE * SIDE).map(|i| at(i % SIDE, i / SIDE)).collect();
    Surface::new(Dem::from_heights(SIDE, DVec2::splat(10.0), DVec2::new(0.0, 110.0), heights))
}

#[test]
fn what_bulges_over_level_corners_hides() {
    for along_rows in [true, false] {
        let surface = wall(along_rows);
        let terrain = Terrain::new(&surface);
        let slow = [2, 4].map(|n| (n, Slow::new(&surface, level(n))));
        let mut random = Random::new(11);
        for _ in 0..12 {
            let (off, along, z) = (random.between(50.0, 90.0), random.between(30.0, 80.0), random.between(10.4, 11.6));
            let eye = if along_rows { DVec3::new(along, -off, z) } else { DVec3::new(-off, along, z) };
            let target = if along_rows { DVec3::new(55.0, 110.0, 11.0) } else { DVec3::new(110.0, 55.0, 11.0) };
            let camera = look(eye, target, 40.0, [96, 24]);
            for (n, slow) in &slow {
                let compared = compare(&terrain.truth(&camera, level(*n)).pieces, &slow.lines(&camera));
                assert_eq!(compared.unlike(), 0, "along rows {along_rows}, level {n}, {camera:?}: {compared:?}");
                assert!(compared.pieces > 200, "{compared:?}");
            }
        }
    }
}

#[test]
fn a_plane_seen_edge_on_is_away() {
    let [columns, rows] = SAMPLES;
    let flat = Surface::new(Dem::from_heights(columns, CELL, DVec2::new(300.0, 400.0), vec![5.0; columns * rows]));
    let seen = |z| {
        let camera = look(DVec3::new(320.0, 100.0, z), DVec3::new(350.0, 370.0, 5.0), 60.0, PAGE);
        Terrain::new(&flat).truth(&camera, level(2)).pieces.len()
    };
    assert_eq!(seen(5.0), 0, "pieces of a plane that runs through the eye");
    assert_eq!(seen(4.0), 0, "pieces of a plane seen from below");
    assert!(seen(6.0) > 100, "{} pieces of a plane seen from above", seen(6.0));
}

#[test]
fn another_eye_or_another_facet_is_noticed() {
    let surface = ground(Ground { seed: 5, shape: Shape::Noise, exaggeration: 5.0, voids: false });
    let camera = look(DVec3::new(330.0, 200.0, 150.0), DVec3::new(350.0, 370.0, 30.0), 60.0, PAGE);
    let truth = Terrain::new(&surface).truth(&camera, level(2)).pieces;
    let slow = |n| Slow::new(&surface, level(n));
    let same = compare(&truth, &slow(2).lines(&camera));
    assert!(same.unlike() == 0 && same.pieces > 200, "{same:?}");
    let moved = Camera { eye: camera.eye + DVec3::new(0.001, 0.0, 0.0), ..camera };
    assert!(compare(&truth, &slow(2).lines(&moved)).unlike() > 0, "an eye moved by 1 mm is not noticed");
    assert!(compare(&truth, &slow(4).lines(&camera)).unlike() > 0, "another level is not noticed");
    let noticed = |i: &usize| compare(&truth, &slow(2).without(*i).lines(&camera)).unlike() > 0;
    let facets = slow(2).facets();
    let seen = (0..facets).filter(noticed).count();
    println!("{seen} of {facets} facets are missed when they are gone");
    assert!(seen * 4 > facets, "of {facets} facets only {seen} are missed when they are gone");
    assert!(compare(&truth[1..], &slow(2).lines(&camera)).missing == 1, "a piece that is gone is not noticed");
    let twice = [&truth[..], &truth[..1]].concat();
    assert!(compare(&twice, &slow(2).lines(&camera)).extra == 1, "a piece found twice is not noticed");
}
