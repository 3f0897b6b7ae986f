//! The same lines, whatever was asked before and on as many threads as there are.

use std::sync::Arc;

use glam::DVec3;
use hachure::door::relief::slope::SlopeBlock;
use rayon::ThreadPoolBuilder;

use super::{Scene, blocks, lines, plane, sample};

/// Least room of all lines, cells.
const ROOM: f64 = 1.5;

/// That all of some blocks are among others, to the last bit.
fn are_among(some: &[Arc<SlopeBlock>], others: &[Arc<SlopeBlock>]) -> bool {
    let bits = |block: &SlopeBlock| {
        let points = block.lines.iter().flat_map(|line| {
            line.points.iter().map(|point| {
                let floats = [point.height, point.gradient.x, point.gradient.y, point.room].map(f32::to_bits);
                (line.id, point.at.to_array().map(f64::to_bits), floats)
            })
        });
        (block.level, block.at, points.collect::<Vec<_>>())
    };
    let same = |a: &SlopeBlock, b: &SlopeBlock| bits(a) == bits(b);
    some.iter().all(|block| {
        others.iter().any(|other| other.at == block.at && other.level == block.level && same(block, other))
    })
}

/// Least room in a window of shares of a scene, elsewhere none.
fn window(scene: &Scene, [from, to]: [f64; 2]) -> impl Fn([DVec3; 2]) -> f64 + Sync {
    let [west, south, east, north] = scene.surface.dem().extent();
    let [low, high] =
        [from, to].map(|share| DVec3::new(west + (east - west) * share, south + (north - south) * share, 0.0));
    let room = ROOM * scene.unit();
    move |bounds: [DVec3; 2]| {
        let meets = |axis: usize| bounds[0][axis] <= high[axis] && bounds[1][axis] >= low[axis];
        if meets(0) && meets(1) { room } else { f64::INFINITY }
    }
}

#[test]
fn lines_are_the_same_however_they_are_asked_for() {
    for scene in [sample(), Scene::bare("plane", plane([160, 160]))] {
        let whole = scene.blocks(ROOM);
        assert!(lines(&whole).count() > 100);
        for shares in [[0.5, 0.7], [0.6, 0.8], [0.7, 1.0]] {
            let slopes = scene.slopes();
            let part = blocks(&slopes, &window(&scene, shares));
            assert!(!part.is_empty() && part.len() < whole.len(), "{} of {}", part.len(), whole.len());
            assert!(are_among(&part, &whole), "{}: a window", scene.name);
            // And the rest after it.
            let rest = blocks(&slopes, &|_| ROOM * scene.unit());
            assert!(rest.len() == whole.len() && are_among(&rest, &whole), "{}: the whole after a window", scene.name);
        }
    }
}

#[test]
fn lines_are_the_same_on_any_number_of_threads() {
    let scene = sample();
    let on = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| scene.blocks(ROOM))
    };
    let [one, two, five] = [1, 2, 5].map(on);
    assert!(one.len() == two.len() && are_among(&one, &two) && are_among(&one, &five));
}

#[test]
fn other_lines_are_noticed() {
    let blocks = sample().blocks(8.0);
    assert!(are_among(&blocks, &blocks));
    let with_lines = blocks.iter().position(|block| !block.lines.is_empty()).expect("lines");
    let mut other = SlopeBlock::clone(&blocks[with_lines]);
    let room = &mut other.lines[0].points[0].room;
    *room = f32::from_bits(room.to_bits() + 1);
    assert!(!are_among(&[Arc::new(other)], &blocks));
}

#[test]
fn ids_are_told_apart() {
    let blocks = sample().blocks(ROOM);
    let mut ids: Vec<u64> = lines(&blocks).map(|line| line.id).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
}
