//! Where water goes, against slow and independent ways to tell.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::relief::channels::Channels;
use hachure::door::relief::flow::Flow;
use hachure::door::relief::frame::FramedGrid;
use hachure::error::Error;
use hachure::geo::{ReadOptions, read};
use hachure::relief::{ChannelArea, Relief};

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
fn crossings(frame: FramedGrid, down: impl Fn(usize) -> Option<usize>) -> usize {
    let is = |from: usize, to: usize| down(from) == Some(to) || down(to) == Some(from);
    let crossing = |i: &usize| {
        let [nw, ne, sw, se] = [*i, i + 1, i + frame.stride(), i + frame.stride() + 1];
        is(nw, se) && is(ne, sw)
    };
    (0..frame.samples() - frame.stride() - 1).filter(crossing).count()
}

#[test]
fn no_two_directions_cross() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        assert_eq!(crossings(relief.flow().frame(), |i| relief.flow().down(i)), 0, "{name}");
    }
}

#[test]
fn directions_that_cross_are_noticed() {
    let relief = Relief::of(&rough(1, [90, 70]), 1.0).expect("a relief");
    let (frame, flow) = (relief.flow().frame(), relief.flow());
    let is_diagonal = |i: &usize| flow.down(*i) == Some(i + frame.stride() + 1) && flow.is_land(i + 1);
    let nw = frame.indices().find(is_diagonal).expect("a diagonal");
    let crossed = |i: usize| if i == nw + 1 { Some(nw + frame.stride()) } else { flow.down(i) };
    assert_eq!(crossings(frame, crossed), 1);
}

/// The least that the highest sample can be on a way from each to an end, by Dijkstra's shortest paths.
fn levels(flow: &Flow, heights: &[f32]) -> Vec<f32> {
    let frame = flow.frame();
    let mut levels = vec![f32::INFINITY; frame.samples()];
    let mut front = BinaryHeap::new();
    let order = |height: f32| Reverse((height * 1e4) as i64);
    for i in frame.indices().filter(|i| flow.is_land(*i) && flow.down(*i).is_none()) {
        levels[i] = heights[i];
        front.push((order(heights[i]), i));
    }
    while let Some((_, i)) = front.pop() {
        for next in frame.steps().map(|step| i.wrapping_add(step)) {
            let level = heights[next].max(levels[i]);
            if flow.is_land(next) && level < levels[next] {
                levels[next] = level;
                front.push((order(level), next));
            }
        }
    }
    levels
}

/// Share of the samples whose water goes higher than a level of each.
fn higher(flow: &Flow, heights: &[f32], levels: &[f32]) -> f64 {
    let land: Vec<usize> = flow.frame().indices().filter(|i| flow.is_land(*i)).collect();
    let is_higher = |i: &&usize| {
        let highest = way(flow, **i).expect("an end").into_iter().map(|i| heights[i]).fold(f32::MIN, f32::max);
        highest > levels[**i]
    };
    land.iter().filter(is_higher).count() as f64 / land.len() as f64
}

#[test]
fn water_leaves_over_the_lowest_pass() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let (flow, heights) = (relief.flow(), &relief.grid().smoothed);
        let share = higher(flow, heights, &levels(flow, heights));
        assert!(share <= OVER_THE_LOWEST_PASS, "{name}: {share}");
    }
}

#[test]
fn water_over_a_higher_pass_is_noticed() {
    let relief = Relief::of(&rough(1, [90, 70]), 1.0).expect("a relief");
    let (flow, heights) = (relief.flow(), &relief.grid().smoothed);
    // As if one lower pass were there for all.
    let lower: Vec<f32> = levels(flow, heights).iter().map(|level| level - 1.0).collect();
    assert!(higher(flow, heights, &lower) > OVER_THE_LOWEST_PASS);
}

#[test]
fn orders_are_those_that_a_slow_count_gives() {
    for (name, dem) in lands() {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let channels = Channels::of(relief.flow(), relief.area(), 10);
        let orders = channels.orders(relief.area(), 10);
        // All on small land, some on the sample.
        for node in (0..channels.samples.len()).step_by(1 + channels.samples.len() / 300) {
            let from: Vec<usize> =
                (0..channels.down.len()).filter(|from| channels.below(*from) == Some(node)).collect();
            let highest = from.iter().map(|from| orders.strahler[*from]).max().unwrap_or(0);
            let equal = from.iter().filter(|from| orders.strahler[**from] == highest).count();
            let strahler = if from.is_empty() { 1 } else { highest + u8::from(equal > 1) };
            let shreve: u32 = from.iter().map(|from| orders.shreve[*from]).sum();
            assert_eq!(
                [u32::from(orders.strahler[node]), orders.shreve[node]],
                [strahler.into(), shreve.max(1)],
                "{name}"
            );
        }
    }
}

#[test]
fn channels_begin_where_they_are_told_to() {
    let relief = Relief::of(&sample(), 1.0).expect("a relief");
    let cells = |area: f64| relief.channel_cells(ChannelArea::SquareMetres(area));
    let cell = relief.flow().frame().area();
    assert_eq!([25.0, 25.5, 1.0, 0.0, -3.0, f64::NAN].map(|of| cells(of * cell)), [25, 26, 1, 1, 1, 1]);
    assert!(relief.drainage(ChannelArea::SquareMetres(f64::INFINITY)).is_empty());
    // As the falls of streams tell: |t| passes 2 there, and is less for the next.
    let found = relief.channel_cells(ChannelArea::Auto);
    let trials = relief.trials();
    let k = trials.iter().position(|trial| trial.cells == found).expect("one that was tried");
    println!("{trials:#?}");
    assert!(trials[..k].iter().all(|trial| trial.t < -2.0) && trials[k..k + 2].iter().all(|trial| trial.t.abs() < 2.0));
}

#[test]
fn a_filed_dem_is_refused() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let filed = read(&path, &ReadOptions { memory: 1 << 16, ..ReadOptions::default() }).expect("the sample");
    assert!(filed.is_filed());
    assert!(matches!(Relief::of(&filed, 1.0), Err(Error::Limit { .. })));
}

#[test]
fn areas_that_an_edge_may_cut_are_marked() {
    // All water comes from the west edge.
    let relief = Relief::of(&dem([20, 9], |at| -at.x), 1.0).expect("a relief");
    let frame = relief.flow().frame();
    assert!(frame.indices().all(|i| relief.area().cut.has(i)), "water may come from beyond the edge");
    // Water comes from a summit within.
    let relief = Relief::of(&dem([21, 21], |at| -(at - 10.0).length()), 1.0).expect("a relief");
    let cut = relief.flow().frame().indices().filter(|i| relief.area().cut.has(*i)).count();
    assert_eq!(cut, 80, "only the edge itself");
}
