//! How much of the chains is called the same in the next frame.
//!
//! Method: chains are looked at every quarter pixel. The next frame's looks are projected from where they lie in the world
//! onto the page of the first; of those within 1.5 px there, the one nearest in the world is the same place of the land. It is
//! kept where both chains have the same id. A place without one near, a place whose next one is called otherwise (so after a
//! swap), and every place of a chain whose id another chain of its frame has too, is lost. Cost: some microseconds a look.
//!
//! Does not handle: places that are on one of the two pages only; they do not count.

use std::collections::HashMap;

use glam::DVec2;
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::looks::{LineLook, along, on_page};
use crate::line::{Chain, Id};
use crate::view::{Camera, Perspective};

/// Only chains longer than this on the page count, px.
const LEAST: f64 = 12.0;
/// The same place lies no farther on the first page, px.
const NEAR: f64 = 1.5;

/// Chains as a camera sees them.
#[derive(Clone, Copy)]
pub struct SeenChains<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Its chains.
    pub chains: &'a [Chain],
}

/// A look at a chain, and what that is called; `None` where another one of its frame is called so, too.
type Called = (LineLook, Option<Id>);

/// Share of the length of chains over 12 px whose id the next frame keeps; `None` where no chain has an id, and where
/// none is so long.
pub fn ids_kept(frame: SeenChains<'_>, next: SeenChains<'_>) -> Option<f64> {
    if frame.chains.iter().all(|chain| chain.id.is_none()) {
        return None;
    }
    let [here, there] = [&frame, &next].map(|seen| Perspective::new(seen.camera, 1.0));
    let indexed = |called: Called| Some(GeomWithData::new(on_page(&here, called.0.world)?.to_array(), called));
    let found = RTree::bulk_load(looks(next, &there, 0.0).into_iter().filter_map(indexed).collect());
    let counted: Vec<Called> = looks(frame, &here, LEAST);
    let weigh = |(look, id): &Called| {
        on_page(&there, look.world)?;
        let place = on_page(&here, look.world)?.to_array();
        let near = found.locate_within_distance(place, NEAR * NEAR).map(|near| near.data);
        let away = |other: &Called| other.0.world.distance_squared(look.world);
        let same = near.min_by(|a, b| away(a).total_cmp(&away(b)));
        let kept = id.is_some() && same.is_some_and(|same| same.1 == *id);
        Some(DVec2::new(if kept { look.length } else { 0.0 }, look.length))
    };
    let weights: Vec<DVec2> = counted.par_iter().filter_map(weigh).collect();
    let sum: DVec2 = weights.iter().sum();
    (sum.y > 0.0).then(|| sum.x / sum.y)
}

/// Looks at the chains that are longer than `least` px on the page.
fn looks(seen: SeenChains<'_>, perspective: &Perspective, least: f64) -> Vec<Called> {
    let mut called: HashMap<Id, usize> = HashMap::new();
    seen.chains.iter().filter_map(|chain| chain.id).for_each(|id| *called.entry(id).or_default() += 1);
    let of_chain = |chain: &Chain| {
        let id = chain.id.filter(|id| called[id] == 1);
        let looks: Vec<Called> =
            chain.pairs().flat_map(|pair| along(pair, perspective)).map(|look| (look, id)).collect();
        if looks.iter().map(|(look, _)| look.length).sum::<f64>() > least { looks } else { Vec::new() }
    };
    seen.chains.iter().flat_map(of_chain).collect()
}
