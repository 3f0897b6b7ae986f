//! Everything that lies on the device, each buffer under the name the shaders give it.
//!
//! The scene is uploaded once. A frame uploads the camera. No binding exceeds 128 MiB, whatever the level: vertices
//! and the queue are sized by a batch, facing bits lie in up to four parts.

use std::collections::HashMap;

use bytemuck::Zeroable;

use super::candidates::NO_PIXELS;
use super::device::Gpu;
use super::rasterize_large::EMPTY_QUEUE;

use super::sizes::{self, fits};
use super::uniforms::{BatchUniform, CameraUniform, SceneUniform};
use crate::dem::Dem;
use crate::error::{Error, Result};
use crate::plan::batches::PART_CHUNKS;
use crate::plan::{Batch, Visibility};
use crate::surface::bounds::spheres;
use crate::surface::rim::RimEdge;
use crate::surface::{Lattice, Surface};

/// Bytes between entries of a uniform buffer that are bound one at a time.
const UNIFORM_STRIDE: u64 = 256;

/// All buffers of a scene on a page.
pub struct Buffers {
    named: HashMap<&'static str, wgpu::Buffer>,
    batches: wgpu::Buffer,
    rounds: u32,
}

impl Buffers {
    /// Uploads a scene and makes room for frames of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`Error::Limit`] when a buffer would exceed what every device binds.
    pub fn new(
        gpu: &Gpu,
        surface: &Surface,
        lattice: &Lattice,
        rim: &[RimEdge],
        batches: &[Batch],
        visibility: Visibility,
        [width, height]: [u32; 2],
    ) -> Result<Self> {
        let mut buffers = Self {
            named: HashMap::new(),
            batches: upload_uniforms(gpu, &batch_uniforms(batches, visibility.rounds())),
            rounds: visibility.rounds(),
        };
        let dem = surface.dem();
        buffers.uniform(gpu, "scene", bytemuck::bytes_of(&SceneUniform::new(dem, lattice)));
        buffers.uniform(gpu, "camera", bytemuck::bytes_of(&CameraUniform::zeroed()));
        buffers.upload(gpu, "chunks", bytemuck::cast_slice(lattice.chunks()))?;
        buffers.upload(gpu, "spheres", bytemuck::cast_slice(&spheres(surface, lattice)))?;
        buffers.upload(gpu, "slots", bytemuck::cast_slice(lattice.slots()))?;
        buffers.upload(gpu, "heights", bytemuck::cast_slice(dem.heights()))?;
        for (name, gradients) in ["gradients_east", "gradients_north"].into_iter().zip(surface.gradients()) {
            buffers.upload(gpu, name, bytemuck::cast_slice(gradients))?;
        }
        let voids = dem.voids() > 0;
        buffers.upload(gpu, "valid", bytemuck::cast_slice(&if voids { valid_bits(dem) } else { vec![0] }))?;
        buffers.upload(gpu, "rim", bytemuck::cast_slice(rim))?;

        buffers.upload(gpu, "empty_queue", bytemuck::bytes_of(&EMPTY_QUEUE))?;
        buffers.upload(gpu, "no_pixels", bytemuck::bytes_of(&NO_PIXELS))?;
        for (name, size) in sizes::written(lattice.chunks().len() as u64, [width, height])? {
            buffers.create(gpu, name, size)?;
        }
        gpu.check()?;
        Ok(buffers)
    }

    /// A buffer by the name the shaders give it.
    ///
    /// # Errors
    /// [`Error::Gpu`] when there is none.
    pub fn get(&self, name: &str) -> Result<&wgpu::Buffer> {
        self.named.get(name).ok_or_else(|| Error::Gpu { what: format!("no buffer is named {name}") })
    }

    /// Bytes of all of them on the device.
    pub fn bytes(&self) -> u64 {
        self.named.values().chain([&self.batches]).map(wgpu::Buffer::size).sum()
    }

    /// What a pass over batch `index` in round `round` binds under `name`.
    pub fn resource(&self, name: &str, index: usize, round: u32, batch: Batch) -> Option<wgpu::BindingResource<'_>> {
        match name {
            "batch" => Some(wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &self.batches,
                offset: (index as u64 * u64::from(self.rounds) + u64::from(round)) * UNIFORM_STRIDE,
                size: wgpu::BufferSize::new(size_of::<BatchUniform>() as u64),
            })),
            "facing" => {
                let part = ["facing_0", "facing_1", "facing_2", "facing_3"][batch.part() as usize];
                Some(self.named.get(part)?.as_entire_binding())
            }
            _ => Some(self.named.get(name)?.as_entire_binding()),
        }
    }

    /// Writes the camera: all a further frame uploads.
    ///
    /// # Errors
    /// [`Error::Gpu`] when the driver refuses.
    pub fn write_camera(&self, gpu: &Gpu, camera: &CameraUniform) -> Result<()> {
        gpu.queue.write_buffer(self.get("camera")?, 0, bytemuck::bytes_of(camera));
        Ok(())
    }

    fn uniform(&mut self, gpu: &Gpu, name: &'static str, bytes: &[u8]) {
        self.named.insert(name, upload(gpu, name, bytes, wgpu::BufferUsages::UNIFORM));
    }

    fn upload(&mut self, gpu: &Gpu, name: &'static str, bytes: &[u8]) -> Result<()> {
        fits(name, bytes.len() as u64)?;
        self.named.insert(name, upload(gpu, name, bytes, wgpu::BufferUsages::STORAGE));
        // Sent at once: until then the driver holds a second copy.
        gpu.queue.submit([]);
        gpu.wait()
    }

    fn create(&mut self, gpu: &Gpu, name: &'static str, size: u64) -> Result<()> {
        fits(name, size)?;
        let copied = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | copied;
        let size = size.max(16).next_multiple_of(4);
        let descriptor = wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        self.named.insert(name, gpu.device.create_buffer(&descriptor));
        Ok(())
    }
}

fn upload(gpu: &Gpu, name: &'static str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(name),
        size: (bytes.len() as u64).max(16).next_multiple_of(4),
        usage: usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

fn batch_uniforms(batches: &[Batch], rounds: u32) -> Vec<BatchUniform> {
    let of = |b: &Batch, round| BatchUniform {
        first_slot: b.first_slot,
        part_slot: b.first_slot % PART_CHUNKS,
        round,
        pad: 0,
    };
    batches.iter().flat_map(|b| (0..rounds).map(move |round| of(b, round))).collect()
}

fn upload_uniforms(gpu: &Gpu, entries: &[BatchUniform]) -> wgpu::Buffer {
    let mut bytes = vec![0; entries.len() * UNIFORM_STRIDE as usize];
    for (slot, entry) in bytes.chunks_exact_mut(UNIFORM_STRIDE as usize).zip(entries) {
        slot[..size_of::<BatchUniform>()].copy_from_slice(bytemuck::bytes_of(entry));
    }
    upload(gpu, "batches", &bytes, wgpu::BufferUsages::UNIFORM)
}

fn valid_bits(dem: &Dem) -> Vec<u32> {
    let word = |bits: &[bool]| bits.iter().rev().fold(0, |word, bit| word << 1 | u32::from(*bit));
    dem.valid().chunks(32).map(word).collect()
}
