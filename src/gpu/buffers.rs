//! Buffers on the device, each under the name the shaders give it.

use std::collections::HashMap;

use super::device::Gpu;
use super::pace::Work;
use super::sizes::fits;
use crate::error::{Error, Result};

/// Buffers by name.
#[derive(Default)]
pub struct Buffers(HashMap<&'static str, wgpu::Buffer>);

impl Buffers {
    /// The buffer of this name.
    ///
    /// # Errors
    /// [`Error::Mistake`] when there is none.
    pub fn get(&self, name: &str) -> Result<&wgpu::Buffer> {
        self.find(name).ok_or_else(|| Error::mistake(format!("no buffer is named {name}")))
    }

    /// The buffer of this name, if there is one.
    pub fn find(&self, name: &str) -> Option<&wgpu::Buffer> {
        self.0.get(name)
    }

    /// Bytes of all of them on the device.
    pub fn bytes(&self) -> u64 {
        self.0.values().map(wgpu::Buffer::size).sum()
    }

    /// Makes a uniform buffer of these bytes.
    pub fn uniform(&mut self, gpu: &Gpu, name: &'static str, bytes: &[u8]) {
        self.0.insert(name, upload(gpu, name, bytes, wgpu::BufferUsages::UNIFORM));
    }

    /// Makes a storage buffer of these bytes.
    ///
    /// # Errors
    /// [`Error::Limit`] when it would exceed what every device binds; whatever the driver reports.
    pub fn upload(&mut self, gpu: &Gpu, name: &'static str, bytes: &[u8]) -> Result<()> {
        fits(name, bytes.len() as u64)?;
        self.0.insert(name, upload(gpu, name, bytes, wgpu::BufferUsages::STORAGE));
        // Sent at once: until then the driver holds a second copy.
        gpu.queue.submit([]);
        gpu.wait_for(Work::bytes(bytes.len() as u64))
    }

    /// Makes a storage buffer of zeros, unless there is one of this size; gives back the one in whose place it is.
    ///
    /// # Errors
    /// [`Error::Limit`] when it would exceed what every device binds.
    pub fn create(&mut self, gpu: &Gpu, name: &'static str, size: u64) -> Result<Creation> {
        fits(name, size)?;
        let size = rounded(size);
        if self.find(name).is_some_and(|there| there.size() == size) {
            return Ok(Creation::WasThere);
        }
        let copied = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | copied;
        let descriptor = wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        Ok(Creation::Anew(self.0.insert(name, gpu.device.create_buffer(&descriptor))))
    }

    /// Forgets a buffer.
    pub fn remove(&mut self, name: &str) {
        self.0.remove(name);
    }
}

/// What became of a buffer that was asked for.
pub enum Creation {
    /// It is the one that was there.
    WasThere,
    /// It is new, in the place of this one.
    Anew(Option<wgpu::Buffer>),
}

/// A buffer of these bytes.
pub(crate) fn upload(gpu: &Gpu, name: &'static str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(name),
        size: rounded(bytes.len() as u64),
        usage: usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// Bytes that a buffer takes so that shaders can bind it.
fn rounded(size: u64) -> u64 {
    size.max(16).next_multiple_of(4)
}
