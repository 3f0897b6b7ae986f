//! What frames leave on the device for later ones, tiles of samples and blocks of vertices: which place each has, and which
//! may be overwritten.

use std::collections::{HashMap, HashSet};
use std::hash::Hash;

/// Places for so many items. What a frame does not ask for stays until its place is needed.
#[derive(Debug)]
pub struct SlotCache<T> {
    places: HashMap<T, u32>,
    /// Of each place, the item that it holds and the frame that asked for it last.
    held: Vec<(T, u64)>,
    capacity: usize,
    frame: u64,
}

/// Items in their places.
#[derive(Debug, PartialEq, Eq)]
pub struct Placed<T> {
    /// Of each item asked for.
    pub places: Vec<u32>,
    /// Those that are not there yet, with their places.
    pub missing: Vec<(u32, T)>,
}

impl<T: Copy + Eq + Hash> SlotCache<T> {
    /// An empty one.
    pub fn new(capacity: usize) -> Self {
        Self { places: HashMap::new(), held: Vec::new(), capacity, frame: 0 }
    }

    /// Where each item is to be. `None` when there are more different ones than places: then nothing has changed.
    pub fn place(&mut self, wanted: &[T]) -> Option<Placed<T>> {
        self.frame += 1;
        let mut missing = Vec::new();
        let mut asked = HashSet::new();
        for item in wanted {
            match self.places.get(item) {
                Some(place) => self.held[*place as usize].1 = self.frame,
                None if asked.insert(*item) => missing.push(*item),
                None => (),
            }
        }
        let mut oldest = if missing.is_empty() { Vec::new() } else { self.replaceable() };
        if missing.len() > self.capacity - self.held.len() + oldest.len() {
            return None;
        }
        let mut written = Vec::new();
        for item in missing {
            let place = if self.held.len() < self.capacity {
                self.held.push((item, self.frame));
                self.held.len() as u32 - 1
            } else {
                let place = oldest.pop()?;
                let (old, _) = std::mem::replace(&mut self.held[place as usize], (item, self.frame));
                self.places.remove(&old);
                place
            };
            self.places.insert(item, place);
            written.push((place, item));
        }
        Some(Placed { places: wanted.iter().map(|item| self.places[item]).collect(), missing: written })
    }

    /// Makes room for more; what is there stays in its place.
    pub fn grow(&mut self, capacity: usize) {
        self.capacity = self.capacity.max(capacity);
    }

    /// Places that this frame has not asked for, the one asked for longest ago last.
    fn replaceable(&self) -> Vec<u32> {
        let mut places: Vec<u32> =
            (0..self.held.len() as u32).filter(|p| self.held[*p as usize].1 < self.frame).collect();
        places.sort_by_key(|place| std::cmp::Reverse(self.held[*place as usize].1));
        places
    }
}
