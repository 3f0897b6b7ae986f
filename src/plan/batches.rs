//! Chunks in batches that share one vertex buffer, so that memory does not grow with the level.

/// Chunks of a batch: their vertices take 16384 x 289 x 16 bytes = 76 MB in each of two buffers.
pub const BATCH_CHUNKS: u32 = 16384;
/// Chunks whose facing bits fill one storage binding of 128 MiB.
pub const PART_CHUNKS: u32 = 1 << 21;

/// A run of slots rasterized together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batch {
    /// Slot of its first chunk.
    pub first_slot: u32,
    /// How many chunks.
    pub chunks: u32,
}

impl Batch {
    /// Which of the two buffers of facing bits holds the batch.
    pub fn part(&self) -> u32 {
        self.first_slot / PART_CHUNKS
    }

    /// How many of its chunks are among those in the first `seen` slots.
    pub fn seen(&self, seen: u32) -> u32 {
        seen.saturating_sub(self.first_slot).min(self.chunks)
    }
}

/// The batches of so many chunks, in the order of their slots.
pub fn batches(chunks: u32) -> Vec<Batch> {
    (0..chunks)
        .step_by(BATCH_CHUNKS as usize)
        .map(|first_slot| Batch { first_slot, chunks: BATCH_CHUNKS.min(chunks - first_slot) })
        .collect()
}
