//! What chains are called: made of geometry alone, so that a chain is called the same in the next frame, and on another
//! machine.
//!
//! Method: a chain holds the cells of level 1 that it passes, whatever the level drawn, each by its length there on the
//! page; where a line leads up and where down on the page are cells apart. Each chain is called by one cell that it holds:
//! the one of the largest length / u, u a number between 0 and 1 made of the cell alone (priority sampling: Duffield,
//! Lund, Thorup 2007). So a long cell is likelier than a short one, and the choice is stable: it changes only as far as
//! the lengths do, since the largest of such numbers stands far above the second. Where two chains would be called by one
//! cell the one with the larger number is, and the other by its next.
//!
//! Cost: sorts the cells of all chains. Does not handle: chains of which nothing was seen in the last frame.

use std::collections::HashSet;

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_64;

use super::Id;
use super::curve::LatticePlace;

/// Steps of a [`LatticePlace`] across a cell of level 1: 64 of the finest lattice, in 256 parts.
pub(super) const CELL: i32 = 64 * 256;
/// Bits for a row or column of cells.
const BITS: u32 = 18;

/// How much of a chain lies in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Cell and side.
    pub key: u64,
    /// Px on the page.
    pub length: f64,
}

/// The key of a place on the lattice where the surface lies on this side of a line.
pub fn key(at: LatticePlace, outward: DVec2) -> u64 {
    let [column, row] = at.map(|v| u64::from(v.div_euclid(CELL).cast_unsigned()) & ((1 << BITS) - 1));
    (row << BITS | column) << 1 | u64::from(outward.x > 0.0)
}

/// An id for each chain, given how much it holds of which cell, in any order; `None` where it holds none. No two are equal.
pub fn names(held: &[Vec<Held>]) -> Vec<Option<Id>> {
    let mut bids: Vec<(f64, u64, usize)> = Vec::new();
    for (chain, held) in held.iter().enumerate() {
        let mut held = held.clone();
        held.sort_by_key(|held| held.key);
        bids.extend(held.chunk_by(|a, b| a.key == b.key).map(|cell| (bid(cell), cell[0].key, chain)));
    }
    bids.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut ids, mut taken, mut round) = (vec![None; held.len()], HashSet::new(), 0);
    while !bids.is_empty() {
        for &(_, key, chain) in &bids {
            let id = Id(round << (2 * BITS + 1) | key);
            if ids[chain].is_none() && taken.insert(id) {
                ids[chain] = Some(id);
            }
        }
        // Chains of which others have taken every cell share the cells again.
        bids.retain(|&(.., chain)| ids[chain].is_none());
        round += 1;
    }
    ids
}

/// What a chain bids for a cell with all that it holds of it.
fn bid(held: &[Held]) -> f64 {
    let length: f64 = held.iter().map(|held| held.length).sum();
    let u = ((xxh3_64(&held[0].key.to_le_bytes()) >> 11) + 1) as f64 / (1_u64 << 53) as f64;
    length / u
}
