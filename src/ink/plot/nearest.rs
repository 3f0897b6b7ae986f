//! The nearest of many places, some of which are no longer there.
//!
//! A k-d tree (Bentley 1975) over places that do not change; a node knows the box of its places and how many of them are
//! left, so that empty parts are passed over. Cost: n log n to build; log n to take a place away or to find one, while those
//! left are spread about as all were.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec2;

/// Places of a leaf.
const LEAF: usize = 8;

/// Places by number.
#[derive(Debug)]
pub(super) struct Nearest {
    /// By their place in the tree.
    places: Vec<(DVec2, u32)>,
    /// Where a place of a number stands in the tree; `None` once it has been taken away.
    slots: Vec<Option<u32>>,
    /// The root, then the halves of each node `n` at `2 n + 1` and `2 n + 2`.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec2,
    high: DVec2,
    left: u32,
}

/// How far, squared, and which.
pub(super) type Found = (f64, u32);

/// Nearer first, then by number.
fn by_distance(a: &Found, b: &Found) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

impl Node {
    fn distance_squared(&self, from: DVec2) -> f64 {
        from.distance_squared(from.clamp(self.low, self.high))
    }
}

/// The halves of a node and of its range; `None` of a leaf.
fn halves(node: usize, range: &Range<usize>) -> Option<[(usize, Range<usize>); 2]> {
    let middle = range.start + range.len() / 2;
    (range.len() > LEAF).then(|| [(2 * node + 1, range.start..middle), (2 * node + 2, middle..range.end)])
}

impl Nearest {
    /// Of places that are numbered from 0 on.
    pub(super) fn new(places: impl Iterator<Item = DVec2>) -> Self {
        let places: Vec<(DVec2, u32)> = places.zip(0..).collect();
        let leaves = places.len().div_ceil(LEAF).next_power_of_two();
        let nothing = Node { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY, left: 0 };
        let mut tree = Self { slots: vec![None; places.len()], nodes: vec![nothing; 2 * leaves], places };
        tree.split(0, 0..tree.places.len());
        for (slot, &(_, number)) in (0..).zip(&tree.places) {
            tree.slots[number as usize] = Some(slot);
        }
        tree
    }

    fn split(&mut self, node: usize, range: Range<usize>) {
        let places = &mut self.places[range.clone()];
        let low = places.iter().fold(DVec2::INFINITY, |low, (place, _)| low.min(*place));
        let high = places.iter().fold(DVec2::NEG_INFINITY, |high, (place, _)| high.max(*place));
        self.nodes[node] = Node { low, high, left: range.len() as u32 };
        if let Some(halves) = halves(node, &range) {
            let size = high - low;
            let along = |(place, _): &(DVec2, u32)| if size.x > size.y { place.x } else { place.y };
            places.select_nth_unstable_by(range.len() / 2, |a, b| along(a).total_cmp(&along(b)).then(a.1.cmp(&b.1)));
            halves.into_iter().for_each(|(half, range)| self.split(half, range));
        }
    }

    /// Takes a place away, if it is still there.
    pub(super) fn remove(&mut self, number: u32) {
        let Some(slot) = self.slots[number as usize].take() else { return };
        let mut at = Some((0, 0..self.places.len()));
        while let Some((node, range)) = at {
            self.nodes[node].left -= 1;
            at = halves(node, &range)
                .and_then(|halves| halves.into_iter().find(|(_, half)| half.contains(&(slot as usize))));
        }
    }

    /// The `most` nearest that are left and wanted, not farther than `reach`: the nearest first, of equally near ones that
    /// with the lower number.
    pub(super) fn find(&self, from: DVec2, most: usize, reach: f64, is_wanted: impl Fn(u32) -> bool) -> Vec<Found> {
        let mut found: Vec<Found> = Vec::with_capacity(most + 1);
        let worst = |found: &Vec<Found>| if found.len() < most { reach * reach } else { found[most - 1].0 };
        let mut open = vec![(self.nodes[0].distance_squared(from), 0, 0..self.places.len())];
        while let Some((distance, node, range)) = open.pop() {
            // An equally near one may have a lower number.
            if self.nodes[node].left == 0 || distance > worst(&found) {
                continue;
            }
            if let Some(halves) = halves(node, &range) {
                let mut halves = halves.map(|(half, range)| (self.nodes[half].distance_squared(from), half, range));
                halves.sort_by(|a, b| b.0.total_cmp(&a.0));
                open.extend(halves);
                continue;
            }
            for &(place, number) in &self.places[range] {
                let one = (from.distance_squared(place), number);
                if one.0 <= worst(&found) && self.slots[number as usize].is_some() && is_wanted(number) {
                    found.insert(found.partition_point(|other| by_distance(other, &one).is_lt()), one);
                    found.truncate(most);
                }
            }
        }
        found
    }
}
