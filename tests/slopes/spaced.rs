//! At every spacing the places with room for it keep it, and leave few holes.

use glam::DVec2;
use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

use hachure::relief::slope::SlopePoint;

use super::{Scene, lines, plane, real, share};
use crate::tolerances::{SPACED_SHARE, SPACED_TOLERANCE};

/// Spacings, cells: lines of all levels that may be drawn are there.
const SPACINGS: [f64; 5] = [1.5, 2.2, 4.0, 8.0, 16.0];
/// Least room that is asked for, cells.
const LEAST: f64 = 1.5;

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
                places.extend(stretch.iter().map(|at| (number, *at)));
                let steps = stretch.windows(2);
                pieces.extend(steps.map(|pair| Piece::new(Line::new(pair[0].into(), pair[1].into()), number)));
                let length: f64 = stretch.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
                middles.extend((length >= spacing).then(|| (number, stretch[stretch.len() / 2])));
            }
        }
        Self { tree: RTree::bulk_load(pieces), places, middles }
    }

    /// Metres to the nearest place of another line.
    fn nearest(&self, (number, at): (usize, DVec2)) -> f64 {
        let others = self.tree.nearest_neighbor_iter(at.to_array()).find(|piece| piece.data != number);
        others.map_or(f64::INFINITY, |piece| piece.distance_2(&at.to_array()).sqrt())
    }
}

/// 5 %, half and 95 % of values.
fn percentiles(values: &mut [f64]) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [0.05, 0.5, 0.95].map(|share| values.get((share * values.len() as f64) as usize).copied().unwrap_or(f64::NAN))
}

/// Of a scene at a spacing: the least distance, and the share of middles with one from one to two spacings.
fn judged(scene: &Scene, lines: &[&[SlopePoint]], cells: f64) -> Option<[f64; 2]> {
    let spacing = cells * scene.unit();
    let drawn = Drawn::at(scene, lines, spacing);
    let least = drawn.places.iter().map(|place| drawn.nearest(*place) / spacing).fold(f64::INFINITY, f64::min);
    let mut nearest: Vec<f64> = drawn.middles.iter().map(|middle| drawn.nearest(*middle) / spacing).collect();
    let even = share(nearest.iter().filter(|nearest| **nearest <= 2.0).count() as f64, nearest.len() as f64);
    let [low, half, high] = percentiles(&mut nearest);
    println!(
        "{} at {cells} cells: {} stretches, least {least:.3}, of middles 5 % {low:.2}, half {half:.2}, 95 % {high:.2}, {even:.3} up to 2",
        scene.name,
        nearest.len()
    );
    (nearest.len() >= 20).then_some([least, even])
}

#[test]
fn lines_keep_every_spacing_and_leave_few_holes() {
    let scenes = std::iter::once(Scene::bare("plane", plane([160, 160]))).chain(real());
    for scene in scenes {
        let blocks = scene.blocks(LEAST);
        let lines: Vec<&[SlopePoint]> = lines(&blocks).map(|line| &line.points[..]).collect();
        let judged: Vec<_> = SPACINGS.iter().filter_map(|cells| judged(&scene, &lines, *cells)).collect();
        assert!(judged.len() >= 3, "{}: too few lines", scene.name);
        for [least, even] in judged {
            assert!(least >= 1.0 - SPACED_TOLERANCE, "{}: {least}", scene.name);
            assert!(even >= SPACED_SHARE, "{}: {even}", scene.name);
        }
    }
}

#[test]
fn uneven_lines_are_noticed() {
    let scene = Scene::bare("plane", plane([160, 160]));
    let blocks = scene.blocks(LEAST);
    let all: Vec<Vec<SlopePoint>> = lines(&blocks).map(|line| line.points.clone()).collect();
    let judge = |lines: &[Vec<SlopePoint>]| {
        let lines: Vec<&[SlopePoint]> = lines.iter().map(Vec::as_slice).collect();
        judged(&scene, &lines, 2.2).expect("lines")
    };
    // Room that is not there.
    let mut boasting = all.clone();
    boasting.iter_mut().flatten().for_each(|point| point.room *= 1.2);
    assert!(judge(&boasting)[0] < 1.0 - SPACED_TOLERANCE);
    // Two lines of three are gone.
    let thinned: Vec<_> = all.iter().step_by(3).cloned().collect();
    assert!(judge(&thinned)[1] < SPACED_SHARE);
}
