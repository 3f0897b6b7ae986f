//! What passes leave of the curves of a frame: buffers that grow with its chunks and with the length of its lines.

use super::buffers::Buffers;
use super::device::Gpu;
use super::sizes::{SEGMENT_BYTES, WORD_BYTES};
use super::uniforms::{Segment, Tally};
use crate::error::{Error, Result};
use crate::plan::batches::BATCH_CHUNKS;
use crate::plan::{Frame, LandLines};
use crate::surface::lattice::{CHUNK_QUADS, CHUNK_VERTICES};

/// Words that tell what lies around a chunk.
pub const AROUND: u32 = 16;
/// Points of lines on the land for which there is room at first.
const LEAST_LAID: u32 = 1 << 12;
/// Vertices of the side of a chunk.
pub const SIDE_VERTICES: u32 = 4 * CHUNK_QUADS;

/// For how much there is room; what is found of it may be more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CurveCapacity {
    /// Chunks whose vertices count.
    pub wanted: u32,
    /// Facets through which contours run.
    pub crossed: u32,
    /// Segments.
    pub segments: u32,
}

/// At first: 1.5 MB.
impl Default for CurveCapacity {
    fn default() -> Self {
        Self { wanted: 1 << 9, crossed: 1 << 14, segments: 1 << 14 }
    }
}

/// Buffers of curves.
#[derive(Default)]
pub struct CurveBuffers {
    buffers: Buffers,
    chunks: u32,
    capacity: CurveCapacity,
    /// Points of lines on the land, and for how many there is room.
    laid: [u32; 2],
    /// How often some were made anew: what binds them must then bind them again.
    generation: u64,
}

impl CurveBuffers {
    /// Makes room for the chunks of a frame, if it has curves, and for lines on the land, if it has those, unless there is.
    ///
    /// # Errors
    /// [`Error::Limit`] when a buffer would exceed what every device binds; whatever the driver reports.
    pub fn fit(&mut self, gpu: &Gpu, frame: &Frame) -> Result<()> {
        let chunks = frame.lattice.chunks().len() as u32;
        if frame.plan.land == LandLines::On && self.buffers.find("laid").is_none() {
            self.lay(gpu, &[])?;
        }
        if !frame.plan.has_curves() || (chunks <= self.chunks && self.buffers.find("segments").is_some()) {
            return Ok(());
        }
        let chunks = chunks + chunks / 4;
        let of_batch = u64::from(chunks.min(BATCH_CHUNKS));
        self.buffers.create(gpu, "turning", u64::from(chunks) * WORD_BYTES)?;
        self.buffers.create(gpu, "around", u64::from(chunks) * u64::from(AROUND) * WORD_BYTES)?;
        self.buffers.create(gpu, "turns", of_batch * u64::from(CHUNK_VERTICES) * WORD_BYTES)?;
        self.buffers.create(gpu, "tally", size_of::<Tally>() as u64)?;
        self.chunks = chunks;
        self.make_room(gpu, self.capacity)
    }

    fn make_room(&mut self, gpu: &Gpu, capacity: CurveCapacity) -> Result<()> {
        let [wanted, crossed, segments] = [capacity.wanted, capacity.crossed, capacity.segments].map(u64::from);
        self.generation += 1;
        self.buffers.create(gpu, "sides", wanted * u64::from(SIDE_VERTICES) * WORD_BYTES)?;
        self.buffers.create(gpu, "crossed", crossed * WORD_BYTES)?;
        self.buffers.create(gpu, "segments", segments * SEGMENT_BYTES)?;
        self.buffers.create(gpu, "asked", segments * WORD_BYTES)?;
        self.capacity = capacity;
        gpu.check()
    }

    /// The segments that were found, in no particular order; `None` where there was no room for all that was found: then
    /// there is now, and they must be found again.
    ///
    /// # Errors
    /// As [`Self::fit`]; [`Error::Gpu`] when a walk was cut short.
    pub fn read(&mut self, gpu: &Gpu) -> Result<Option<Vec<Segment>>> {
        let tally: Vec<Tally> = gpu.read(self.buffers.get("tally")?, 1)?;
        let Tally { wanted, crossed, segments, cut_short, .. } = tally[0];
        if cut_short > 0 {
            return Err(Error::Gpu { what: format!("the driver cut {cut_short} walks short") });
        }
        let grown = |has: u32, needs: u32| if needs > has { needs + needs / 4 } else { has };
        let capacity = CurveCapacity {
            wanted: grown(self.capacity.wanted, wanted),
            crossed: grown(self.capacity.crossed, crossed),
            segments: grown(self.capacity.segments, segments),
        };
        if capacity != self.capacity {
            self.make_room(gpu, capacity)?;
            return Ok(None);
        }
        gpu.read(self.buffers.get("segments")?, segments as usize).map(Some)
    }

    /// Takes points of lines on the land by their places on the lattice, in 1/256 of its finest step, none of them the north-west
    /// sample.
    ///
    /// # Errors
    /// [`Error::Limit`] when they would exceed what every device binds; whatever the driver reports.
    pub fn lay(&mut self, gpu: &Gpu, places: &[[i32; 2]]) -> Result<()> {
        let count = places.len() as u32;
        if self.buffers.find("laid").is_none() || count > self.laid[1] {
            let room = (count + count / 4).max(LEAST_LAID);
            self.buffers.create(gpu, "laid", u64::from(room) * size_of::<[i32; 2]>() as u64)?;
            self.laid[1] = room;
            self.generation += 1;
        }
        let before = std::mem::replace(&mut self.laid[0], count);
        let buffer = self.buffers.get("laid")?;
        // What is left of those before is no point.
        let nothing = vec![[0; 2]; before.saturating_sub(count) as usize];
        gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(places));
        gpu.queue.write_buffer(buffer, size_of_val(places) as u64, bytemuck::cast_slice(&nothing));
        gpu.check()
    }

    /// How many points of lines on the land there are.
    pub fn laid(&self) -> u32 {
        self.laid[0]
    }

    /// For how much there is room.
    pub fn capacity(&self) -> CurveCapacity {
        self.capacity
    }

    /// The buffers.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }

    /// How often some were made anew: other numbers, other buffers.
    pub fn generation(&self) -> u64 {
        self.generation
    }
}
