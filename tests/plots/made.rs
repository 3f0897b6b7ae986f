//! Layers that no landscape has: at random, each with all that is awkward for a plotter.

use glam::DVec2;
use hachure::ink::{Stroke, StrokePoint};
use hachure::line::Id;

use crate::scenes::Random;

/// A smooth line of some length that begins anywhere on an A3 sheet, with a point every half millimetre.
pub fn curve(random: &mut Random, length: f64) -> Stroke {
    let steps = (length / 0.5).ceil();
    let mut place = DVec2::new(random.between(10.0, 410.0), random.between(10.0, 287.0));
    let (mut angle, mut bend) = (random.between(0.0, std::f64::consts::TAU), random.between(-0.05, 0.05));
    let mut points = vec![StrokePoint { place, width: 1.0 }];
    for _ in 0..steps as usize {
        bend += random.between(-0.01, 0.01);
        angle += bend;
        place += DVec2::from_angle(angle) * length / steps;
        points.push(StrokePoint { place, width: 1.0 });
    }
    Stroke { chain: None, piece: 0, points, closed: false }
}

/// So many of them, from so long to so long.
pub fn curves(seed: u64, count: usize, [shortest, longest]: [f64; 2]) -> Vec<Stroke> {
    let mut random = Random::new(seed);
    let one = |_| {
        let length = random.between(shortest, longest);
        curve(&mut random, length)
    };
    (0..count).map(one).collect()
}

/// Strokes on few square millimetres: walks over a lattice that meet, cross and repeat each other, wiggles of micrometres,
/// dots, rings, copies.
pub fn tangle(seed: u64) -> Vec<Stroke> {
    let mut random = Random::new(seed);
    let mut strokes: Vec<Stroke> = Vec::new();
    for i in 0..20 + random.below(60) {
        let copied = (random.below(6) == 0).then(|| random.below(i.max(1)) as usize);
        if let Some(mut copy) = copied.and_then(|copied| strokes.get(copied)).cloned() {
            copy.points.reverse();
            copy.points.truncate(2 + random.below(8) as usize);
            strokes.push(Stroke { closed: false, ..copy });
            continue;
        }
        let pitch = [1.0, 0.3, 0.04, 0.013][random.below(4) as usize];
        let noise = [0.0, 0.0, 0.004, 0.02][random.below(4) as usize];
        let mut at = [0, 1].map(|_| random.between(0.0, 6.0).round() / pitch);
        let count = 1 + random.below(14);
        let mut point = |_| {
            let axis = random.below(2) as usize;
            at[axis] += f64::from(random.below(3)) - 1.0;
            let stray = DVec2::new(random.between(-noise, noise), random.between(-noise, noise));
            StrokePoint { place: DVec2::from(at.map(|steps| steps.round() * pitch)) + stray, width: 1.0 }
        };
        let points = (0..count).map(&mut point).collect();
        let chain = (random.below(5) > 0).then(|| Id(u64::from(random.bits())));
        strokes.push(Stroke { chain, piece: 0, points, closed: random.below(4) == 0 });
    }
    strokes
}

/// Strokes of two or three points, or rings of three, each alone in its own square millimetre.
pub fn scattered(seed: u64, columns: u32, rows: u32) -> Vec<Stroke> {
    let mut random = Random::new(seed);
    let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| DVec2::new(column.into(), row.into())));
    let stroke = |square: DVec2| {
        let corners = [(0.1, 0.1), (0.9, 0.1), (0.5, 0.9)];
        let near =
            |(x, y)| square + DVec2::new(x, y) + DVec2::new(random.between(-0.07, 0.07), random.between(-0.07, 0.07));
        let points = corners.map(near).map(|place| StrokePoint { place, width: 1.0 });
        let count = 2 + random.below(2) as usize;
        Stroke { chain: None, piece: 0, points: points[..count].to_vec(), closed: count == 3 && random.below(2) == 0 }
    };
    let mut strokes: Vec<Stroke> = squares.map(stroke).collect();
    // As they are found: in no order on the sheet.
    for i in (1..strokes.len()).rev() {
        strokes.swap(i, random.below(i as u32 + 1) as usize);
    }
    strokes
}
