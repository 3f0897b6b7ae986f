//! What passes leave of the curves of a frame: buffers that grow with its chunks and with the length of its lines.

use super::buffers::Buffers;
use super::device::Gpu;
use super::sizes::{self, LIST_HEADER, SEGMENT_BYTES, WORD_BYTES};
use super::uniforms::Segment;
use crate::error::Result;
use crate::plan::Frame;
use crate::plan::batches::BATCH_CHUNKS;
use crate::surface::lattice::CHUNK_VERTICES;

/// Segments for which there is room at first: 1 MB.
const FIRST_ROOM: u32 = 1 << 14;

/// Buffers of curves.
#[derive(Default)]
pub struct CurveBuffers {
    buffers: Buffers,
    chunks: u32,
    room: u32,
    /// How often some were made anew: what binds them must then bind them again.
    generation: u64,
}

impl CurveBuffers {
    /// Makes room for the chunks of a frame, if it has curves and unless there is.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) when a buffer would exceed what every device binds; whatever the driver
    /// reports.
    pub fn fit(&mut self, gpu: &Gpu, frame: &Frame) -> Result<()> {
        let chunks = frame.lattice.chunks().len() as u32;
        if !frame.plan.has_curves() || (chunks <= self.chunks && self.room > 0) {
            return Ok(());
        }
        let chunks = chunks + chunks / 4;
        let of_batch = u64::from(chunks.min(BATCH_CHUNKS));
        self.generation += 1;
        self.buffers.create(gpu, "turning", u64::from(chunks) * WORD_BYTES)?;
        self.buffers.create(gpu, "turns", of_batch * u64::from(CHUNK_VERTICES) * WORD_BYTES)?;
        self.chunks = chunks;
        if self.room == 0 {
            self.make_room(gpu, FIRST_ROOM)?;
        }
        gpu.check()
    }

    /// Makes room for so many segments.
    ///
    /// # Errors
    /// As [`Self::fit`].
    pub fn make_room(&mut self, gpu: &Gpu, segments: u32) -> Result<()> {
        sizes::segments_fit(u64::from(segments))?;
        self.generation += 1;
        self.buffers.create(gpu, "segments", LIST_HEADER + u64::from(segments) * SEGMENT_BYTES)?;
        self.room = segments;
        gpu.check()
    }

    /// The segments that were found; where there was no room for all, how many there are.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn read(&self, gpu: &Gpu) -> Result<Found> {
        let list = self.buffers.get("segments")?;
        let header: Vec<u32> = gpu.read(list, 1)?;
        let count = header[0];
        if count > self.room {
            return Ok(Found::TooMany(count));
        }
        gpu.read_from(list, LIST_HEADER, count as usize).map(Found::All)
    }

    /// Segments for which there is room.
    pub fn room(&self) -> u32 {
        self.room
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

/// What was found of curves.
pub enum Found {
    /// All their segments, in no particular order.
    All(Vec<Segment>),
    /// More than there is room for: so many.
    TooMany(u32),
}
