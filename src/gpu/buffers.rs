//! Everything that lies on the device, each buffer under the name the shaders give it.
//!
//! The scene is uploaded once. A frame uploads the camera. No binding exceeds 128 MiB, whatever the level: vertices
//! and the queue are sized by a batch, facing bits lie in up to four parts.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use super::device::Gpu;
use super::rasterize_large::empty_queue;
use super::silhouette::NO_PIXELS;
use super::sizes::{self, fits};
use crate::dem::Dem;
use crate::error::{Error, Result};
use crate::plan::batches::PART_CHUNKS;
use crate::plan::{Batch, Visibility};
use crate::surface::bounds::spheres;
use crate::surface::rim::RimEdge;
use crate::surface::{Lattice, Surface};
use crate::view::Camera;

/// Bytes between entries of a uniform buffer that are bound one at a time.
const UNIFORM_STRIDE: u64 = 256;
/// The near plane in cells: a power of two, so that depths scale without rounding.
pub const NEAR_CELLS: f64 = 1.0 / 1024.0;

/// `Scene` of scene.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SceneUniform {
    /// Metres between columns and rows.
    pub cell: [f32; 2],
    /// Columns, rows.
    pub samples: [u32; 2],
    /// Chunks across, down.
    pub chunk_grid: [u32; 2],
    /// Lattice units between vertices.
    pub step: u32,
    /// Metres along the view axis.
    pub near: f32,
}

/// `Camera` of scene.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct CameraUniform {
    /// Unit vector to the right.
    pub right: [f32; 4],
    /// Unit vector upwards on the page.
    pub up: [f32; 4],
    /// Unit vector along the view axis.
    pub forward: [f32; 4],
    /// The sample north-west of the eye.
    pub eye_cell: [i32; 2],
    /// Metres east and north from that sample to the eye.
    pub eye_offset: [f32; 2],
    /// Metres, high part and remainder.
    pub eye_height: [f32; 2],
    /// Half the page in pixels.
    pub centre: [f32; 2],
    /// Pixels per unit of tangent.
    pub focal: f32,
    /// Fills to 8 bytes.
    pub pad: u32,
    /// Pixels across, down.
    pub size: [u32; 2],
    /// Inward normals of the two sides of the page's map projection; 0 where it is no wedge.
    pub wedge: [f32; 4],
}

/// `Batch` of scene.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct BatchUniform {
    /// Of the batch.
    pub first_slot: u32,
    /// The same, within its part of the facing bits.
    pub part_slot: u32,
    /// Which round over the facets this is.
    pub round: u32,
    /// Fills to 16 bytes.
    pub pad: u32,
}

/// `Counts` of ink.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Counts {
    /// Nodes the longest walk visited.
    pub longest_walk: u32,
    /// Pixels with a depth and no ID: must be 0.
    pub orphans: u32,
    /// Walks that a driver ended before they were done: must be 0.
    pub cut_short: u32,
}

impl SceneUniform {
    /// What the shaders need to know of a DEM and its lattice.
    pub fn new(dem: &Dem, lattice: &Lattice) -> Self {
        Self {
            cell: dem.cell().as_vec2().to_array(),
            samples: [dem.columns() as u32, dem.rows() as u32],
            chunk_grid: lattice.grid(),
            step: lattice.level().step(),
            near: near_plane(dem) as f32,
        }
    }
}

/// Metres along the view axis to the near plane.
pub fn near_plane(dem: &Dem) -> f64 {
    dem.cell().min_element() * NEAR_CELLS
}

impl CameraUniform {
    /// The camera relative to the grid, so that the GPU never sees a northing.
    ///
    /// # Errors
    /// [`Error::Flag`] when the eye is farther from the DEM than f32 can count cells.
    pub fn new(dem: &Dem, camera: &Camera) -> Result<Self> {
        let place = dem.grid_place(camera.eye.truncate());
        let eye_cell = place.floor();
        if !camera.eye.is_finite() || eye_cell.abs().max_element() >= f64::from(1 << 22) {
            return Err(Error::flag(
                "--eye",
                format!("{:.0},{:.0} is more than 4 million cells from the DEM", camera.eye.x, camera.eye.y),
                "give an eye in the CRS of the DEM, near it",
            ));
        }
        let offset = (place - eye_cell) * dem.cell() * glam::DVec2::new(1.0, -1.0);
        let high = camera.eye.z as f32;
        let axis = |v: DVec3| v.as_vec3().extend(0.0).to_array();
        let [right, up, forward] = camera.axes();
        Ok(Self {
            right: axis(right),
            up: axis(up),
            forward: axis(forward),
            eye_cell: eye_cell.as_ivec2().to_array(),
            eye_offset: offset.as_vec2().to_array(),
            eye_height: [high, (camera.eye.z - f64::from(high)) as f32],
            centre: [camera.width as f32 / 2.0, camera.height as f32 / 2.0],
            focal: camera.focal() as f32,
            pad: 0,
            size: [camera.width, camera.height],
            wedge: camera.wedge().map_or([0.0; 4], |[a, b]| [a.x as f32, a.y as f32, b.x as f32, b.y as f32]),
        })
    }

    /// The view axis, for tests of the uniform itself.
    pub fn forward(&self) -> Vec3 {
        Vec3::from_slice(&self.forward)
    }
}

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
        buffers.upload(gpu, "gradients", bytemuck::cast_slice(surface.gradients()))?;
        let voids = dem.voids() > 0;
        buffers.upload(gpu, "valid", bytemuck::cast_slice(&if voids { valid_bits(dem) } else { vec![0] }))?;
        buffers.upload(gpu, "rim", bytemuck::cast_slice(rim))?;

        buffers.upload(gpu, "empty_queue", bytemuck::bytes_of(&empty_queue([width, height])))?;
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
        Ok(())
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
