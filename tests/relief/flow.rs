//! Where water goes, against slow and independent ways to tell.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::relief::Relief;
use hachure::relief::flow::Flow;

use super::{dem, rough, sample};
use crate::tolerances::OVER_THE_LOWEST_PASS;

/// All kinds of land.
fn lands() -> Vec<(&'static str, Dem)> {
    let flat = dem([30, 20], |_| 5.0);
    let steps = dem([40, 50], |at| (at.x / 8.0).floor() * 3.0 + (at.y / 9.0).floor());
    let bowl = dem([41, 41], |at| (at - 20.0).length_squared());
    let sea = dem([20, 20], |_| 0.0);
    let mut lone = vec![f32::NAN; 49];
    lone[24] = 3.0;
    let lone = Dem::from_heights(7, DVec2::ONE, DVec2::ZERO, lone);
    let smallest = dem([2, 2], |at| at.x + at.y);
    let mut lands =
        vec![("flat", flat), ("steps", steps), ("bowl", bowl), ("sea", sea), ("lone", lone), ("2 x 2", smallest)];
    lands.extend((1..9).map(|seed| ("rough", rough(seed, [90, 70]))));
    lands.push(("the sample", sample()));
    lands
}

/// Samples of the way down from one, itself first; `None` where it does not end.
fn way(flow: &Flow, first: usize) -> Option<Vec<usize>> {
    let mut way = vec![first];
    while let Some(next) = flow.down(*way.last()?) {
        way.push(next);
        if way.len() > flow.frame().samples() {
            return None;
        }
    }
    Some(way)
}

/// Areas as told by walking down from every sample.
fn areas(flow: &Flow) -> Vec<u32> {
    let mut areas = vec![0; flow.frame().samples()];
    for i in flow.frame().indices().filter(|i| flow.is_land(*i)) {
        way(flow, i).expect("an end").into_iter().for_each(|i| areas[i] += 1);
    }
    areas
}

#[test]
fn all_water_ends_and_none_is_lost() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let (flow, area) = (relief.flow(), relief.area());
        let land: Vec<usize> = flow.frame().indices().filter(|i| flow.is_land(*i)).collect();
        let ends = land.iter().filter(|i| flow.down(**i).is_none());
        let arrived: u32 = ends.map(|i| area.cells[*i]).sum();
        assert_eq!(arrived as usize, land.len(), "{name}");
        assert_eq!(land.len(), dem.columns() * dem.rows() - dem.held().expect("samples").voids(), "{name}");
        assert_eq!(area.cells, areas(flow), "{name}");
    }
}

#[test]
fn what_is_lost_is_noticed() {
    let relief = Relief::of(&rough(3, [90, 70]), 1.0).expect("a relief");
    let mut cells = relief.area().cells.clone();
    let most = (0..cells.len()).max_by_key(|i| cells[*i]).expect("a sample");
    cells[most] -= 1;
    assert_ne!(cells, areas(relief.flow()));
}

#[test]
fn water_ends_at_rims_and_in_the_sea_alone() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let flow = relief.flow();
        for i in flow.frame().indices().filter(|i| flow.is_land(*i) && flow.down(*i).is_none()) {
            assert!(flow.is_rim(i) || relief.sea().has(i), "{name}: {:?}", flow.frame().place(i));
        }
    }
}

/// Pairs of directions that cross between four samples.
fn crossings(flow: &Flow) -> usize {
    let frame = flow.frame();
    let is = |from: usize, to: usize| flow.down(from) == Some(to) || flow.down(to) == Some(from);
    let crossing = |i: &usize| {
        let [nw, ne, sw, se] = [*i, i + 1, i + frame.stride(), i + frame.stride() + 1];
        is(nw, se) && is(ne, sw)
    };
    (0..frame.samples() - frame.stride() - 1).filter(crossing).count()
}

#[test]
fn no_two_directions_cross() {
    for (name, dem) in lands() {
        assert_eq!(crossings(Relief::of(&dem, 1.0).expect("a relief").flow()), 0, "{name}");
    }
}

#[test]
fn water_leaves_over_the_lowest_pass() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let (flow, heights) = (relief.flow(), &relief.grid().smoothed);
        let frame = flow.frame();
        // The least that the highest sample can be on a way from each to an end, by Dijkstra's shortest paths.
        let mut levels = vec![f32::INFINITY; frame.samples()];
        let mut front = BinaryHeap::new();
        let order = |height: f32| Reverse((height * 1e4) as i64);
        for i in frame.indices().filter(|i| flow.is_land(*i) && flow.down(*i).is_none()) {
            levels[i] = heights[i];
            front.push((order(heights[i]), i));
        }
        while let Some((_, i)) = front.pop() {
            for step in frame.steps() {
                let next = i.wrapping_add(step);
                let level = heights[next].max(levels[i]);
                if flow.is_land(next) && level < levels[next] {
                    levels[next] = level;
                    front.push((order(level), next));
                }
            }
        }
        let land: Vec<usize> = frame.indices().filter(|i| flow.is_land(*i)).collect();
        let is_higher = |i: &&usize| {
            let highest = way(flow, **i).expect("an end").into_iter().map(|i| heights[i]).fold(f32::MIN, f32::max);
            highest > levels[**i]
        };
        let higher = land.iter().filter(is_higher).count();
        assert!(higher as f64 <= OVER_THE_LOWEST_PASS * land.len() as f64, "{name}: {higher} of {}", land.len());
    }
}

#[test]
fn areas_that_an_edge_may_cut_are_marked() {
    // All water comes from the west edge.
    let relief = Relief::of(&dem([20, 9], |at| -at.x), 1.0).expect("a relief");
    let frame = relief.flow().frame();
    assert!(frame.indices().all(|i| relief.area().cut.has(i)), "water may come from beyond the edge");
    // Water comes from a summit within.
    let relief = Relief::of(&dem([21, 21], |at| -(at - 10.0).length()), 1.0).expect("a relief");
    let cut = frame_count(&relief);
    assert_eq!(cut, 80, "only the edge itself");
}

fn frame_count(relief: &Relief) -> usize {
    relief.flow().frame().indices().filter(|i| relief.area().cut.has(*i)).count()
}
