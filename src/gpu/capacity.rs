//! For how much of a frame there is room on the device.

use std::collections::HashSet;

use super::sizes::{LARGEST_BINDING, TILE_BYTES};
use super::uniforms::ChunkUniform;
use crate::plan::batches::BATCH_CHUNKS;
use crate::surface::{Lattice, Tile};

/// For what there is room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Capacity {
    /// Chunks of a frame.
    pub chunks: u32,
    /// Nodes of their quadtree.
    pub nodes: usize,
    /// Tiles of samples.
    pub tiles: usize,
    /// Of them those with gradients, which have the first places.
    pub patched: usize,
}

impl Capacity {
    /// Before the first frame of an adaptive lattice.
    pub const FIRST: Self = Self { chunks: 512, nodes: 2048, tiles: 512, patched: 256 };

    /// What a lattice takes.
    pub fn of(lattice: &Lattice) -> Self {
        let tiles: HashSet<Tile> = lattice.chunks().iter().map(Tile::of).collect();
        let patched = tiles.iter().filter(|tile| tile.has_gradients()).count();
        let (chunks, nodes) = (lattice.chunks().len() as u32, lattice.tree().nodes().len());
        Self { chunks, nodes, tiles: tiles.len(), patched }
    }

    /// Room for another as well, and for a quarter more than what is too small, so that it seldom grows; as far as
    /// bindings go, and no farther than vertices stay. Where both kinds of tiles do not fit together, the other's room
    /// shrinks.
    #[must_use]
    pub fn grown(self, least: Self) -> Self {
        let grow = |has: usize, needs: usize, most: usize| {
            let enough = if has >= needs { has } else { (needs + needs / 4).max(2 * has) };
            enough.min(most).max(needs)
        };
        let binding = |bytes: usize| LARGEST_BINDING as usize / bytes;
        let in_one_batch = least.chunks.max(self.chunks) <= BATCH_CHUNKS;
        let chunks = if in_one_batch { BATCH_CHUNKS as usize } else { binding(size_of::<ChunkUniform>()) };
        let tiles = binding(TILE_BYTES as usize);
        let patched = grow(self.patched, least.patched, tiles.saturating_sub(least.bare()));
        Self {
            chunks: grow(self.chunks as usize, least.chunks as usize, chunks) as u32,
            nodes: grow(self.nodes, least.nodes, binding(4)),
            tiles: patched + grow(self.bare(), least.bare(), tiles.saturating_sub(patched)),
            patched,
        }
    }

    /// Tiles without gradients.
    pub fn bare(self) -> usize {
        self.tiles - self.patched
    }
}

/// Tiles on their way into buffers of another capacity.
pub(crate) struct Moves {
    /// What the old buffers have room for.
    pub before: Capacity,
    /// What the new ones have.
    pub after: Capacity,
}

impl Moves {
    /// Of each kind of tiles, those with gradients and the others, whether all are still there, each in its place; whether
    /// heights are copied.
    pub(crate) fn stays(&self, heights_move: bool) -> [bool; 2] {
        let Self { before, after } = self;
        let behind_the_same = before.patched == after.patched;
        [after.patched >= before.patched, after.bare() >= before.bare() && (heights_move || behind_the_same)]
    }

    /// Records the copies of tiles that stay from one buffer to another of this name.
    pub(crate) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        name: &str,
        old: &wgpu::Buffer,
        new: &wgpu::Buffer,
    ) {
        let Self { before, after } = self;
        let [patched, bare] = self.stays(true);
        let (copies_patched, copies_bare) = match name {
            "heights" => (patched, bare),
            "gradients_east" | "gradients_north" => (patched, false),
            _ => return,
        };
        let bytes = |tiles: usize| tiles as u64 * TILE_BYTES;
        if copies_patched && before.patched > 0 {
            encoder.copy_buffer_to_buffer(old, 0, new, 0, bytes(before.patched));
        }
        if copies_bare && before.bare() > 0 {
            encoder.copy_buffer_to_buffer(old, bytes(before.patched), new, bytes(after.patched), bytes(before.bare()));
        }
    }
}
