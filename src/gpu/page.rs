//! What frames leave of each pixel: buffers as large as the piece of a page that is drawn.

use super::buffers::Buffers;
use super::device::Gpu;
use super::sizes;
use crate::error::Result;

/// Buffers of a page's size.
#[derive(Default)]
pub struct PageBuffers {
    buffers: Buffers,
    size: [u32; 2],
    /// How often they were made: what binds them must then bind them again.
    generation: u64,
}

impl PageBuffers {
    /// Makes room for pieces of so many pixels across and down, unless it is there.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) when they are too large for one piece; whatever the driver reports.
    pub fn fit(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<()> {
        if self.size == size {
            return Ok(());
        }
        // Both together may be more than the device holds.
        *self = Self { generation: self.generation + 1, ..Self::default() };
        let mut buffers = Buffers::default();
        for (name, bytes) in sizes::of_page(size)? {
            buffers.create(gpu, name, bytes)?;
        }
        gpu.check()?;
        (self.buffers, self.size) = (buffers, size);
        Ok(())
    }

    /// The buffers.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }

    /// How often they were made: other numbers, other buffers.
    pub fn generation(&self) -> u64 {
        self.generation
    }
}
