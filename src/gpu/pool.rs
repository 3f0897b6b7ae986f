//! The tiles of samples on the device: which place each has, and which may be overwritten.

use std::collections::HashMap;

use crate::surface::Tile;

/// Places for so many tiles. What a frame does not ask for stays until its place is needed.
#[derive(Debug, Default)]
pub struct Pool {
    places: HashMap<Tile, u32>,
    /// Of each place, the tile that it holds and the frame that asked for it last.
    held: Vec<(Tile, u64)>,
    capacity: usize,
    frame: u64,
}

/// Tiles in their places.
#[derive(Debug, PartialEq, Eq)]
pub struct Placed {
    /// Of each tile asked for.
    pub places: Vec<u32>,
    /// Those that are not there yet, with their places.
    pub missing: Vec<(u32, Tile)>,
}

impl Pool {
    /// An empty pool.
    pub fn new(capacity: usize) -> Self {
        Self { capacity, ..Self::default() }
    }

    /// Where each tile is to be. `None` when there are more different ones than places.
    pub fn place(&mut self, wanted: &[Tile]) -> Option<Placed> {
        self.frame += 1;
        let mut missing = Vec::new();
        for tile in wanted {
            match self.places.get(tile) {
                Some(place) => self.held[*place as usize].1 = self.frame,
                None => missing.push(*tile),
            }
        }
        let mut oldest = self.replaceable();
        let mut written = Vec::new();
        for tile in missing {
            if self.places.contains_key(&tile) {
                continue;
            }
            let place = if self.held.len() < self.capacity {
                self.held.push((tile, self.frame));
                self.held.len() as u32 - 1
            } else {
                let place = oldest.pop()?;
                let (old, _) = std::mem::replace(&mut self.held[place as usize], (tile, self.frame));
                self.places.remove(&old);
                place
            };
            self.places.insert(tile, place);
            written.push((place, tile));
        }
        Some(Placed { places: wanted.iter().map(|tile| self.places[tile]).collect(), missing: written })
    }

    /// Places that this frame has not asked for, the one asked for longest ago last.
    fn replaceable(&self) -> Vec<u32> {
        let mut places: Vec<u32> =
            (0..self.held.len() as u32).filter(|p| self.held[*p as usize].1 < self.frame).collect();
        places.sort_by_key(|place| std::cmp::Reverse(self.held[*place as usize].1));
        places
    }
}
