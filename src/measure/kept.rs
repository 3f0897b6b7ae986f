//! How much of the chains is called the same in the next frame.
//!
//! Method: chains are looked at every quarter pixel. The next frame's looks are projected from where they lie in the world
//! onto the page of the first; of those within 1.5 px there, the one nearest in the world is the same place of the land. It is
//! kept where both chains have the same id. A place without one near, a place whose next one is called otherwise (so after a
//! swap), and every place of a chain whose id another chain of its frame has too, is lost. Cost: some microseconds a look.
//!
//! Does not handle: places that are on one of the two pages only; they do not count.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::line::{Chain, ChainPoint, Id};
use crate::view::cut::steps;
use crate::view::{Camera, Perspective};

/// Only chains longer than this on the page count, px.
const LEAST: f64 = 12.0;
/// The same place lies no farther on the first page, px.
const NEAR: f64 = 1.5;

/// Chains as a camera sees them.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Its chains.
    pub chains: &'a [Chain],
}

/// A look at a chain.
#[derive(Clone, Copy)]
struct Look {
    world: DVec3,
    /// Of the page that it stands for, px.
    length: f64,
    /// What its chain is called; `None` where another one is called so, too.
    id: Option<Id>,
}

/// Share of the length of chains over 12 px whose id the next frame keeps; `None` where no chain has an id, and where
/// none is so long.
pub fn ids_kept(frame: Seen<'_>, next: Seen<'_>) -> Option<f64> {
    if frame.chains.iter().all(|chain| chain.id.is_none()) {
        return None;
    }
    let [here, there] = [&frame, &next].map(|seen| Perspective::new(seen.camera, 1.0));
    let page = |look: &Look| on_page(&here, look.world);
    let indexed = |look: Look| page(&look).map(|place| GeomWithData::new(place.to_array(), look));
    let found = RTree::bulk_load(looks(next, &there, 0.0).into_iter().filter_map(indexed).collect());
    let counted: Vec<Look> = looks(frame, &here, LEAST);
    let weigh = |look: &Look| {
        on_page(&there, look.world)?;
        let place = on_page(&here, look.world)?.to_array();
        let near = found.locate_within_distance(place, NEAR * NEAR).map(|near| near.data);
        let away = |other: &Look| other.world.distance_squared(look.world);
        let same = near.min_by(|a, b| away(a).total_cmp(&away(b)));
        let kept = look.id.is_some() && same.is_some_and(|same| same.id == look.id);
        Some(DVec2::new(if kept { look.length } else { 0.0 }, look.length))
    };
    let weights: Vec<DVec2> = counted.par_iter().filter_map(weigh).collect();
    let sum: DVec2 = weights.iter().sum();
    (sum.y > 0.0).then(|| sum.x / sum.y)
}

/// Looks at the chains that are longer than `least` px on the page.
fn looks(seen: Seen<'_>, perspective: &Perspective, least: f64) -> Vec<Look> {
    let mut called: HashMap<Id, usize> = HashMap::new();
    seen.chains.iter().filter_map(|chain| chain.id).for_each(|id| *called.entry(id).or_default() += 1);
    let size = [seen.camera.width, seen.camera.height];
    let of_chain = |chain: &Chain| {
        let id = chain.id.filter(|id| called[id] == 1);
        let looks: Vec<Look> = chain.pairs().flat_map(|pair| along(pair, size, perspective, id)).collect();
        if looks.iter().map(|look| look.length).sum::<f64>() > least { looks } else { Vec::new() }
    };
    seen.chains.iter().flat_map(of_chain).collect()
}

/// Looks between two points of a chain, which is a straight line in the world.
fn along(
    [a, b]: [&ChainPoint; 2],
    size: [u32; 2],
    perspective: &Perspective,
    id: Option<Id>,
) -> impl Iterator<Item = Look> {
    let (a, b) = (*a, *b);
    let [near, far] = [a, b].map(|point| perspective.distance(point.world));
    steps(size, a.place, b.place).map(move |step| {
        // Depth turns steps on the page into steps in the world.
        let share = step.middle * near / (far * (1.0 - step.middle) + step.middle * near);
        Look { world: a.world.lerp(b.world, share), length: step.length, id }
    })
}

/// Where a place of the world is seen on the page; `None` beside it and behind the eye.
fn on_page(perspective: &Perspective, world: DVec3) -> Option<DVec2> {
    let (place, depth) = perspective.project(world);
    let inside = place.cmpge(DVec2::ZERO).all() && place.cmplt(perspective.size()).all();
    (depth > 0.0 && inside).then_some(place)
}
