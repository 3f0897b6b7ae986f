//! A bare copy on the device: as fast as bytes can move there, beside which the time of a frame stands.
//!
//! One command reads half the bytes and writes the other half; where half of them are more than a buffer may hold, one
//! pair of buffers is copied several times. Few bytes may stay in a cache, as those of a frame may.

use crate::error::Result;
use crate::gpu::Gpu;

/// Two buffers, one copied to the other.
pub struct BareCopy {
    from: wgpu::Buffer,
    to: wgpu::Buffer,
    /// Bytes of each command.
    parts: Vec<u64>,
}

impl BareCopy {
    /// Makes room to move so many bytes, read and written ones together.
    ///
    /// # Errors
    /// [`Error::Gpu`](crate::error::Error::Gpu) when the driver refuses.
    pub fn new(gpu: &Gpu, bytes: u64) -> Result<Self> {
        let parts = parts(bytes, gpu.device.limits().max_buffer_size);
        let buffer = |label| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: parts[0],
                usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let copy = Self { from: buffer("copy from"), to: buffer("copy to"), parts };
        gpu.check()?;
        Ok(copy)
    }

    /// The buffer that is read.
    pub fn from(&self) -> &wgpu::Buffer {
        &self.from
    }

    /// The buffer that is written.
    pub fn to(&self) -> &wgpu::Buffer {
        &self.to
    }

    /// Records the copy.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        for size in &self.parts {
            encoder.copy_buffer_to_buffer(&self.from, 0, &self.to, 0, *size);
        }
    }
}

/// Bytes of each command that together move so many, the largest first; a buffer holds at most `largest`.
fn parts(bytes: u64, largest: u64) -> Vec<u64> {
    let size = (bytes / 2).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT).max(wgpu::COPY_BUFFER_ALIGNMENT);
    let largest = largest - largest % wgpu::COPY_BUFFER_ALIGNMENT;
    let whole = (size / largest) as usize;
    let rest = size % largest;
    std::iter::repeat_n(largest, whole).chain((rest > 0).then_some(rest)).collect()
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn parts_move_what_is_asked_and_fit() {
        assert_eq!(parts(64, 1000), [32], "half is read, half is written");
        assert_eq!(parts(3000, 1000), [1000, 500]);
        assert_eq!(parts(4000, 1000), [1000, 1000]);
        assert_eq!(parts(4000, 1002), [1000, 1000], "words alone are copied");
        assert_eq!(parts(2, 1000), [4]);
        assert_eq!(parts(0, 1000), [4]);
    }
}
