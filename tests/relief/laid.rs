//! How lines lie to each other: joined to the last bit, never crossing, growing as they go.

use std::collections::HashMap;

use glam::DVec2;
use hachure::relief::{ChannelArea, LineKind, Relief, SurfaceLine};

use super::{rough, sample};
use crate::tolerances::{BENT, CREASES_CROSS, LINE_SPACING};

/// Lines of the sample and of rough land, drainage and ridges of each.
fn lines() -> Vec<[Vec<SurfaceLine>; 2]> {
    let lands = [sample(), rough(1, [120, 90]), rough(2, [90, 120])];
    let of = |dem| {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        [relief.drainage(ChannelArea::Auto), relief.ridges().expect("ridges")]
    };
    lands.map(of).into()
}

/// Whether two segments cross within both.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |from: DVec2, to: DVec2, place: DVec2| (to - from).perp_dot(place - from);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Pairs of segments that cross, of lines of one list or of two, each with numbers of their lines.
fn crossings(lines: &[SurfaceLine], others: &[SurfaceLine]) -> Vec<[usize; 2]> {
    let mut cells: HashMap<[i64; 2], Vec<(usize, [DVec2; 2])>> = HashMap::new();
    let segments = |lines: &[SurfaceLine]| -> Vec<(usize, [DVec2; 2])> {
        let of = |(k, line): (usize, &SurfaceLine)| {
            line.points.windows(2).map(|pair| (k, [pair[0].at, pair[1].at])).collect::<Vec<_>>()
        };
        lines.iter().enumerate().flat_map(of).collect()
    };
    let cell = |at: DVec2| [at.x.floor() as i64, at.y.floor() as i64];
    for (k, segment) in segments(others) {
        cells.entry(cell((segment[0] + segment[1]) / 2.0)).or_default().push((k, segment));
    }
    let mut found = Vec::new();
    for (k, segment) in segments(lines) {
        let [c, r] = cell((segment[0] + segment[1]) / 2.0);
        for near in (0..25).map(|i| [c - 2 + i % 5, r - 2 + i / 5]) {
            let there = cells.get(&near).into_iter().flatten();
            found.extend(there.filter(|(_, other)| cross(segment, *other)).map(|(other, _)| [k, *other]));
        }
    }
    found
}

#[test]
fn no_two_lines_cross() {
    for kinds in lines() {
        for lines in &kinds {
            assert!(!lines.is_empty());
            let crossings = crossings(lines, lines);
            assert!(crossings.is_empty(), "{:?}: {crossings:?}", lines[0].kind);
        }
        let [drainage, ridges] = kinds;
        let between = crossings(&ridges, &drainage).len();
        println!("{between} crossings of {} ridges", ridges.len());
        assert!(
            between as f64 <= CREASES_CROSS * ridges.len() as f64,
            "{between} crossings of {} ridges",
            ridges.len()
        );
    }
}

#[test]
fn a_line_that_crosses_is_noticed() {
    let [mut drainage, _] = lines().swap_remove(0);
    let longest = drainage.iter().max_by_key(|line| line.points.len()).expect("a line").clone();
    let turned = |mut line: SurfaceLine| {
        let middle = line.points[line.points.len() / 2].at;
        line.points.iter_mut().for_each(|point| point.at = middle + (point.at - middle).perp());
        line
    };
    drainage.push(turned(longest));
    assert!(!crossings(&drainage, &drainage).is_empty());
}

/// What is wrong with how lines of a DEM of a size join and grow.
fn faults(lines: &[SurfaceLine], size: DVec2) -> Vec<String> {
    let mut faults = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let mut fault = |what: &str| faults.push(format!("line {k}: {what}"));
        if line.points.len() < 2 || line.points.windows(2).any(|pair| pair[0].at == pair[1].at) {
            fault("points");
        }
        if line.points.windows(2).any(|pair| pair[1].length < pair[0].length || pair[1].drop < pair[0].drop) {
            fault("does not grow");
        }
        if line.points.windows(2).any(|pair| pair[0].at.distance(pair[1].at) > LINE_SPACING) {
            fault("a gap");
        }
        if line.points.iter().any(|point| point.at != point.at.clamp(DVec2::ZERO, size - 1.0)) {
            fault("outside");
        }
        if let Some([trunk, point]) = line.joins {
            let trunk = lines.get(trunk as usize).filter(|_| (trunk as usize) < k);
            let joint = trunk.and_then(|trunk| trunk.points.get(point as usize));
            if joint.map(|joint| joint.at) != line.points.last().map(|point| point.at) {
                fault("its joint");
            }
        }
    }
    faults
}

#[test]
fn lines_join_to_the_last_bit_and_grow() {
    for (kinds, size) in lines().into_iter().zip([[500.0, 500.0], [120.0, 90.0], [90.0, 120.0]]) {
        for lines in kinds {
            assert_eq!(faults(&lines, size.into()), Vec::<String>::new());
            assert!(lines.iter().any(|line| line.joins.is_some()));
        }
    }
}

#[test]
fn a_joint_that_is_off_is_noticed() {
    let [mut drainage, _] = lines().swap_remove(0);
    let joined = drainage.iter().position(|line| line.joins.is_some()).expect("a joint");
    let last = drainage[joined].points.last_mut().expect("a point");
    last.at.x = f64::from_bits(last.at.x.to_bits() + 1);
    assert_eq!(faults(&drainage, DVec2::splat(500.0)), [format!("line {joined}: its joint")]);
    drainage[joined].joins = None;
    drainage[joined].points[0].length = f32::INFINITY;
    assert_eq!(faults(&drainage, DVec2::splat(500.0)), [format!("line {joined}: does not grow")]);
    assert!(faults(&drainage, DVec2::splat(400.0)).iter().any(|fault| fault.ends_with("outside")));
}

/// Largest share of turns, from a segment to the next, by more than 30 degrees.
fn bent(lines: &[SurfaceLine]) -> f64 {
    let (mut turns, mut sharp) = (0, 0);
    for line in lines {
        for three in line.points.windows(3) {
            let turn = (three[1].at - three[0].at).angle_to(three[2].at - three[1].at).abs();
            turns += 1;
            sharp += usize::from(turn > std::f64::consts::FRAC_PI_6);
        }
    }
    f64::from(sharp as u32) / f64::from(turns)
}

#[test]
fn lines_have_no_stairs() {
    // Of the sample: rough land has none but bends.
    for lines in lines().swap_remove(0) {
        let share = bent(&lines);
        println!("{:?}: {share}", lines[0].kind);
        assert!(share <= BENT, "{share}");
    }
}

#[test]
fn stairs_are_noticed() {
    let [mut drainage, _] = lines().swap_remove(0);
    for (k, point) in drainage.iter_mut().flat_map(|line| &mut line.points).enumerate() {
        point.at = if k % 2 == 0 { point.at.floor() } else { point.at.round() };
    }
    assert!(bent(&drainage) > BENT);
}

#[test]
fn orders_and_kinds_are_told() {
    let [drainage, ridges] = lines().swap_remove(0);
    assert!(drainage.iter().all(|line| line.kind == LineKind::Drainage && line.order >= 1));
    assert!(drainage.iter().any(|line| line.order >= 4), "the sample has streams of the fourth order");
    assert!(ridges.iter().all(|line| line.kind == LineKind::Ridge && line.order == 1));
}
