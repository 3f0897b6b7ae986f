//! At every spacing the places with room for it keep it, and leave few holes.

use std::sync::Arc;

use glam::DVec2;
use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

use hachure::door::relief::slope::{SlopeBlock, SlopeLine, SlopePoint};

use super::{CELL, Scene, land, lines, plane, real, share};
use crate::scenes::Random;
use crate::tolerances::{HOLES, KEPT_SHARE, ROOM, ROOM_SHARE, SPACED_SHARE, SPACED_TOLERANCE};

/// Spacings, cells: lines of all levels that may be drawn are there.
const SPACINGS: [f64; 4] = [1.5, 4.0, 8.0, 16.0];
/// Least room that is asked for, cells.
const LEAST: f64 = 1.5;

/// So many times as near as beside it a line may begin ahead of another's end.
const AHEAD: f64 = 2.0;

/// Places that are looked at for holes.
const HOLE_PLACES: usize = 4000;

type Piece = GeomWithData<Line<[f64; 2]>, usize>;

/// What is drawn at a spacing.
struct Drawn {
    tree: RTree<Piece>,
    /// Points with room, metres, each with its line.
    places: Vec<(usize, DVec2)>,
    /// The middle of each stretch as long as the spacing.
    middles: Vec<(usize, DVec2)>,
}

impl Drawn {
    fn at(scene: &Scene, lines: &[&[SlopePoint]], spacing: f64) -> Self {
        let cell = scene.surface.dem().cell();
        let (mut pieces, mut places, mut middles) = (Vec::new(), Vec::new(), Vec::new());
        for (number, points) in lines.iter().enumerate() {
            for stretch in points.split(|point| f64::from(point.room) < spacing) {
                let stretch: Vec<DVec2> = stretch.iter().map(|point| point.at * cell).collect();
                // Of points so near each other every second tells as much.
                places.extend(stretch.iter().step_by(2).map(|at| (number, *at)));
                let steps = stretch.windows(2);
                pieces.extend(steps.map(|pair| Piece::new(Line::new(pair[0].into(), pair[1].into()), number)));
                let length: f64 = stretch.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
                middles.extend((length >= spacing).then(|| (number, stretch[stretch.len() / 2])));
            }
        }
        Self { tree: RTree::bulk_load(pieces), places, middles }
    }

    /// Metres to the nearest of some other lines: across, and ahead of its pieces [`AHEAD`] times as far.
    fn nearest(&self, at: DVec2, is_other: impl Fn(usize) -> bool) -> f64 {
        let mut nearest = f64::INFINITY;
        for piece in self.tree.nearest_neighbor_iter(at.to_array()).filter(|piece| is_other(piece.data)) {
            if piece.distance_2(&at.to_array()).sqrt() >= nearest {
                break;
            }
            nearest = nearest.min(distance(at, [piece.geom().from, piece.geom().to].map(DVec2::from)));
        }
        nearest
    }

    /// Metres to the nearest of some other lines as the crow flies.
    fn nearest_place(&self, at: DVec2, is_other: impl Fn(usize) -> bool) -> f64 {
        let nearest = self.tree.nearest_neighbor_iter(at.to_array()).find(|piece| is_other(piece.data));
        nearest.map_or(f64::INFINITY, |piece| piece.distance_2(&at.to_array()).sqrt())
    }
}

/// Of a place from a piece of line: across, and ahead of its ends [`AHEAD`] times as far.
fn distance(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = (b - a).normalize_or_zero();
    let beyond = (-(at - a).dot(along)).max((at - b).dot(along)).max(0.0);
    DVec2::new(AHEAD * beyond, (at - a).perp_dot(along)).length()
}

/// 5 %, half and 95 % of values.
fn percentiles(values: &mut [f64]) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [0.05, 0.5, 0.95].map(|share| values.get((share * values.len() as f64) as usize).copied().unwrap_or(f64::NAN))
}

/// How lines lie at a spacing.
struct Judged {
    /// Least distance of a place from lines of lower rank, in front of whose ends it may be.
    least: f64,
    /// Share of places that keep the spacing from these.
    kept: f64,
    /// Share of middles with another line at most two spacings away.
    even: f64,
}

/// A scene's lines, by rank, at a spacing.
fn judged(scene: &Scene, lines: &[&[SlopePoint]], cells: f64) -> Option<Judged> {
    let spacing = cells * scene.unit();
    let drawn = Drawn::at(scene, lines, spacing);
    let far = |(number, at): &(usize, DVec2)| drawn.nearest_place(*at, |other| other < *number) / spacing;
    let least = drawn.places.iter().map(far).fold(f64::INFINITY, f64::min);
    let keeps = |(number, at): &&(usize, DVec2)| {
        drawn.nearest(*at, |other| other < *number) >= (1.0 - SPACED_TOLERANCE) * spacing
    };
    let kept = share(drawn.places.iter().filter(keeps).count() as f64, drawn.places.len() as f64);
    let nearest = |(number, at): &(usize, DVec2)| drawn.nearest(*at, |other| other != *number) / spacing;
    let mut nearest: Vec<f64> = drawn.middles.iter().map(nearest).collect();
    let even = share(nearest.iter().filter(|nearest| **nearest <= 2.0).count() as f64, nearest.len() as f64);
    let [low, half, high] = percentiles(&mut nearest);
    println!(
        "{} at {cells} cells: {} stretches, least {least:.3}, {kept:.4} kept, of middles 5 % {low:.2}, half {half:.2}, 95 % {high:.2}, {even:.3} up to 2",
        scene.name,
        nearest.len()
    );
    (nearest.len() >= 20).then_some(Judged { least, kept, even })
}

#[test]
fn lines_keep_every_spacing_and_leave_few_holes() {
    let scenes = std::iter::once(Scene::bare("plane", plane([160, 160]))).chain(real());
    for scene in scenes {
        let blocks = scene.blocks(LEAST);
        let lines = by_rank(&blocks);
        let judged: Vec<_> = SPACINGS.iter().filter_map(|cells| judged(&scene, &lines, *cells)).collect();
        assert!(judged.len() >= 3, "{}: too few lines", scene.name);
        for Judged { least, kept, even } in judged {
            assert!(least >= 1.0 / AHEAD - SPACED_TOLERANCE, "{}: {least}", scene.name);
            assert!(kept >= KEPT_SHARE, "{}: {kept}", scene.name);
            assert!(even >= SPACED_SHARE, "{}: {even}", scene.name);
        }
    }
}

/// Share of places of a scene farther than a spacing and a quarter from all that is drawn at it; not of those near its rim.
fn holes(scene: &Scene, lines: &[&[SlopePoint]], cells: f64) -> f64 {
    let (dem, spacing) = (scene.surface.dem(), cells * scene.unit());
    let drawn = Drawn::at(scene, lines, spacing);
    let far = DVec2::new(dem.columns() as f64, dem.rows() as f64) * dem.cell() - 2.0 * spacing;
    let mut random = Random::new(5);
    let mut place = || DVec2::new(random.between(spacing, far.x), random.between(spacing, far.y));
    let is_far = |at: DVec2| drawn.nearest_place(at, |_| true) > 1.25 * spacing;
    share((0..HOLE_PLACES).map(|_| place()).filter(|at| is_far(*at)).count() as f64, HOLE_PLACES as f64)
}

#[test]
fn all_room_is_taken() {
    let tip = DVec2::splat(80.0 * CELL);
    let cone = Scene::bare("cone", land([161, 161], |at| -0.5 * at.distance(tip)));
    for scene in [cone, Scene::bare("plane", plane([160, 160]))] {
        let blocks = scene.blocks(LEAST);
        let lines = by_rank(&blocks);
        for cells in SPACINGS {
            let holes = holes(&scene, &lines, cells);
            println!("{} at {cells} cells: {holes:.4} of places are holes", scene.name);
            assert!(holes <= HOLES, "{} at {cells} cells: {holes}", scene.name);
        }
        // Negative control: every fifth line is gone.
        let fewer: Vec<_> = lines.iter().enumerate().filter(|(k, _)| k % 5 > 0).map(|(_, line)| *line).collect();
        assert!(holes(&scene, &fewer, 2.2) > HOLES);
    }
}

/// Lines from the lowest rank on.
fn by_rank(blocks: &[Arc<SlopeBlock>]) -> Vec<&[SlopePoint]> {
    let mut lines: Vec<&SlopeLine> = lines(blocks).collect();
    lines.sort_by_key(|line| rank(line.id));
    lines.into_iter().map(|line| &line.points[..]).collect()
}

/// The rank of a line as its id tells it: level, phase of its block, number; blocks of a phase do not know each other.
fn rank(id: u64) -> [u64; 3] {
    [id >> 56, (id >> 36 & 1) * 2 + (id >> 16 & 1), id & 0xffff]
}

/// How far a place is from the nearest of pieces that have more room than that; pieces with their room.
fn room(at: DVec2, pieces: &[([DVec2; 2], f64)]) -> f64 {
    let distances = pieces.iter().map(|(piece, room)| (distance(at, *piece), *room));
    distances.filter(|(distance, room)| room > distance).map(|(distance, _)| distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn room_is_what_its_definition_says() {
    let tip = DVec2::splat(60.0 * CELL);
    let scene = Scene::bare("cone", land([121, 121], |at| -0.5 * at.distance(tip)));
    let blocks = scene.blocks(LEAST);
    let cell = scene.surface.dem().cell();
    let mut lines: Vec<_> = lines(&blocks).collect();
    lines.sort_by_key(|line| rank(line.id));
    let of_line = |points: &[SlopePoint]| -> Vec<_> {
        let room = |pair: &[SlopePoint]| f64::from(pair[0].room.max(pair[1].room));
        points.windows(2).map(|pair| ([pair[0].at * cell, pair[1].at * cell], room(pair))).collect()
    };
    let (mut lower, mut good, mut good_of_all, mut all) = (Vec::new(), 0.0, 0.0, 0.0);
    let mut pressed = Vec::new();
    for line in lines {
        let most = match rank(line.id)[0] {
            0 => 128.0 * scene.unit(),
            level => 32.0 * scene.unit() * f64::exp2((1.0 - level as f64) / 2.0),
        };
        for point in line.points.iter().step_by(5) {
            let told = f64::from(point.room);
            let is_near = |room: f64| (room.min(most) - told).abs() <= ROOM * told;
            good += f64::from(u8::from(is_near(room(point.at * cell, &lower))));
            good_of_all += f64::from(u8::from(is_near(room(point.at * cell, &pressed))));
            all += 1.0;
        }
        let pieces = of_line(&line.points);
        // Negative control: as if every line were drawn at every spacing.
        pressed.extend(pieces.iter().map(|(piece, _)| (*piece, f64::INFINITY)));
        lower.extend(pieces);
    }
    let [good, good_of_all] = [good, good_of_all].map(|good| share(good, all));
    println!("{good:.4} of {all} rooms as defined, {good_of_all:.4} if all lines were drawn");
    assert!(good >= ROOM_SHARE && good_of_all < ROOM_SHARE, "{good}, {good_of_all}");
}

#[test]
fn uneven_lines_are_noticed() {
    let scene = Scene::bare("plane", plane([160, 160]));
    let blocks = scene.blocks(LEAST);
    let all: Vec<Vec<SlopePoint>> = by_rank(&blocks).into_iter().map(<[_]>::to_vec).collect();
    let judge = |lines: &[Vec<SlopePoint>]| {
        let lines: Vec<&[SlopePoint]> = lines.iter().map(Vec::as_slice).collect();
        judged(&scene, &lines, 2.2).expect("lines")
    };
    // Room that is not there.
    let mut boasting = all.clone();
    boasting.iter_mut().flatten().for_each(|point| point.room *= 1.2);
    assert!(judge(&boasting).kept < KEPT_SHARE);
    // Two lines of three are gone.
    let thinned: Vec<_> = all.iter().step_by(3).cloned().collect();
    assert!(judge(&thinned).even < SPACED_SHARE);
}
