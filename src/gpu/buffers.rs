//! Everything that lies on the device, each buffer under the name the shaders give it.
//!
//! A frame uploads the camera, its lattice, and those tiles of samples that are not there yet. Vertices stay from frame to
//! frame where one batch has room for all. No binding exceeds 128 MiB, whatever the level: vertices and the queue are sized
//! by a batch, facing bits lie in up to two parts.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use bytemuck::Zeroable;
use rayon::prelude::*;

use super::candidates::NO_PIXELS;
use super::device::Gpu;
use super::pool::{Placed, Pool};
use super::rasterize_large::EMPTY_QUEUE;
use super::sizes::{self, LARGEST_BINDING, fits};
use super::uniforms::{BatchUniform, CameraUniform, ChunkUniform, SceneUniform};
use crate::error::{Error, Result};
use crate::plan::batches::{BATCH_CHUNKS, PART_CHUNKS};
use crate::plan::{Batch, Visibility, batches};
use crate::surface::rim::RimEdge;
use crate::surface::tile::{TILE_SAMPLES, TileSamples};
use crate::surface::{Chunk, Lattice, Surface, Tile};

/// Tiles sent to the device together, 3 KB each.
const TILES_AT_ONCE: usize = 4096;
/// Bytes between entries of a uniform buffer that are bound one at a time.
const UNIFORM_STRIDE: u64 = 256;

/// All buffers of a scene on a page.
pub struct Buffers {
    named: HashMap<&'static str, wgpu::Buffer>,
    batches: wgpu::Buffer,
    rounds: u32,
    room: Room,
    /// Those with gradients, which have the first places, and the others.
    tiles: [Pool<Tile>; 2],
    blocks: Pool<Chunk>,
    /// Whether a lattice is on its way: after an error nobody knows what lies in which place.
    is_loading: bool,
    /// Slots of the chunks whose vertices were not there when the lattice came.
    fresh: Vec<u32>,
    /// Whether they still are not.
    pending: Cell<bool>,
    /// Whether the last frame made them.
    made: Cell<bool>,
}

/// For what there is room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Room {
    /// Chunks of a frame.
    pub chunks: u32,
    /// Nodes of their quadtree.
    pub nodes: usize,
    /// Tiles of samples.
    pub tiles: usize,
    /// Of them those with gradients.
    pub patched: usize,
}

impl Room {
    /// What a lattice takes.
    pub fn of(lattice: &Lattice) -> Self {
        let tiles: HashSet<Tile> = lattice.chunks().iter().map(Tile::of).collect();
        let patched = tiles.iter().filter(|tile| tile.has_gradients()).count();
        let (chunks, nodes) = (lattice.chunks().len() as u32, lattice.tree().nodes().len());
        Self { chunks, nodes, tiles: tiles.len(), patched }
    }

    /// Whether the vertices of all chunks fit in one batch, and so stay from frame to frame.
    pub fn keeps_vertices(&self) -> bool {
        self.chunks <= BATCH_CHUNKS
    }

    /// Room for another as well, and for a quarter more than what is too small, so that it seldom grows; as far as
    /// bindings go, and no farther than vertices stay.
    fn grown(self, least: Self) -> Self {
        let grow = |has: usize, needs: usize, most: usize| {
            if has >= needs { has } else { (needs + needs / 4).max(2 * has).min(most).max(needs) }
        };
        let binding = |bytes: usize| LARGEST_BINDING as usize / bytes;
        let chunks = if least.keeps_vertices() { BATCH_CHUNKS as usize } else { binding(size_of::<ChunkUniform>()) };
        let tiles = binding(4 * TILE_SAMPLES as usize);
        let patched = grow(self.patched, least.patched, tiles.saturating_sub(least.bare()));
        Self {
            chunks: grow(self.chunks as usize, least.chunks as usize, chunks) as u32,
            nodes: grow(self.nodes, least.nodes, binding(4)),
            tiles: patched + grow(self.bare(), least.bare(), tiles.saturating_sub(patched)),
            patched,
        }
    }

    /// Tiles without gradients.
    fn bare(self) -> usize {
        self.tiles - self.patched
    }

    /// Nothing in any place of tiles.
    fn no_tiles(self) -> [Pool<Tile>; 2] {
        [self.patched, self.bare()].map(Pool::new)
    }
}

impl Buffers {
    /// Uploads what all frames of a scene share, and makes room for a frame of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`Error::Limit`] when a buffer would exceed what every device binds.
    pub fn new(
        gpu: &Gpu,
        surface: &Surface,
        lattice: &Lattice,
        room: Room,
        rim: &[RimEdge],
        visibility: Visibility,
        [width, height]: [u32; 2],
    ) -> Result<Self> {
        let mut buffers = Self {
            named: HashMap::new(),
            batches: upload_uniforms(gpu, &batch_uniforms(&batches(room.chunks), visibility.rounds())),
            rounds: visibility.rounds(),
            room,
            tiles: room.no_tiles(),
            blocks: Pool::new(room.chunks as usize),
            is_loading: false,
            fresh: Vec::new(),
            pending: Cell::new(false),
            made: Cell::new(false),
        };
        let dem = surface.dem();
        buffers.uniform(gpu, "scene", bytemuck::bytes_of(&SceneUniform::new(dem, lattice)));
        buffers.uniform(gpu, "camera", bytemuck::bytes_of(&CameraUniform::zeroed()));
        let valid = if dem.voids() > 0 { dem.validity()?.words() } else { &[0] };
        sizes::valid_fits(valid.len() as u64)?;
        buffers.upload(gpu, "valid", bytemuck::cast_slice(valid))?;
        buffers.upload(gpu, "rim", bytemuck::cast_slice(rim))?;
        buffers.upload(gpu, "empty_queue", bytemuck::bytes_of(&EMPTY_QUEUE))?;
        buffers.upload(gpu, "no_pixels", bytemuck::bytes_of(&NO_PIXELS))?;
        for (name, size) in sizes::written(room, [width, height])? {
            buffers.create(gpu, name, size)?;
        }
        gpu.check()?;
        Ok(buffers)
    }

    /// Brings a lattice and its samples to the device; what is already there stays. Where there is no room, says for
    /// what room must be made.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn load(&mut self, gpu: &Gpu, surface: &Surface, lattice: &Lattice) -> Result<Option<Room>> {
        let tiles: Vec<Tile> = lattice.chunks().iter().map(Tile::of).collect();
        let fits = tiles.len() <= self.room.chunks as usize && lattice.tree().nodes().len() <= self.room.nodes;
        if std::mem::replace(&mut self.is_loading, true) {
            self.tiles = self.room.no_tiles();
            self.blocks = Pool::new(self.room.chunks as usize);
        }
        let Some(Placed { places, missing }) = self.place_tiles(&tiles).filter(|_| fits) else {
            return Ok(Some(self.room.grown(Room::of(lattice))));
        };
        for batch in missing.chunks(TILES_AT_ONCE) {
            let read = |(_, tile): &(u32, Tile)| tile.read(surface);
            let tiles: Vec<TileSamples> = match surface.dem().is_parallel() {
                true => batch.par_iter().map(read).collect::<Result<_>>()?,
                false => batch.iter().map(read).collect::<Result<_>>()?,
            };
            self.write_tiles(gpu, batch, &tiles)?;
            // Sent at once: until then the driver holds a second copy.
            gpu.queue.submit([]);
            if missing.len() > TILES_AT_ONCE {
                gpu.wait()?;
            }
        }
        let pyramid = surface.pyramid()?;
        let (blocks, fresh) = self.place_vertices(lattice.chunks())?;
        let chunks = lattice.chunks().iter().zip(places).zip(blocks);
        let chunks: Vec<_> =
            chunks.map(|((chunk, tile), block)| ChunkUniform::new(*chunk, pyramid, tile, block)).collect();
        gpu.queue.write_buffer(self.get("chunks")?, 0, bytemuck::cast_slice(&chunks));
        gpu.queue.write_buffer(self.get("fresh")?, 0, bytemuck::cast_slice(&fresh));
        self.pending.set(!fresh.is_empty());
        self.fresh = fresh;
        gpu.queue.write_buffer(self.get("nodes")?, 0, bytemuck::cast_slice(lattice.tree().nodes()));
        gpu.check()?;
        self.is_loading = false;
        Ok(None)
    }

    /// Where each tile is to be, and those that are not there yet; `None` where there is no room.
    fn place_tiles(&mut self, tiles: &[Tile]) -> Option<Placed<Tile>> {
        let (patched, bare): (Vec<Tile>, Vec<Tile>) = tiles.iter().partition(|tile| tile.has_gradients());
        let first_bare = self.room.patched as u32;
        let of_patched = self.tiles[0].place(&patched)?;
        let of_bare = self.tiles[1].place(&bare)?;
        let behind = of_bare.missing.into_iter().map(|(place, tile)| (first_bare + place, tile));
        let missing = of_patched.missing.into_iter().chain(behind).collect();
        let mut places = [of_patched.places.into_iter(), of_bare.places.into_iter()];
        let place = |tile: &Tile| match tile.has_gradients() {
            true => places[0].next(),
            false => places[1].next().map(|place| first_bare + place),
        };
        Some(Placed { places: tiles.iter().filter_map(place).collect(), missing })
    }

    /// Of each chunk the block of its vertices; and the slots of those whose vertices are not there yet.
    fn place_vertices(&mut self, chunks: &[Chunk]) -> Result<(Vec<u32>, Vec<u32>)> {
        let slots = 0..chunks.len() as u32;
        if !self.room.keeps_vertices() {
            return Ok((slots.clone().map(|slot| slot % BATCH_CHUNKS).collect(), slots.collect()));
        }
        if self.pending.get() {
            // The last ones were never made.
            self.blocks = Pool::new(self.room.chunks as usize);
        }
        let Some(Placed { places, missing }) = self.blocks.place(chunks) else {
            return Err(Error::Gpu { what: format!("no room for the vertices of {} chunks", chunks.len()) });
        };
        let missing: HashSet<u32> = missing.into_iter().map(|(block, _)| block).collect();
        let fresh = slots.filter(|slot| missing.contains(&places[*slot as usize])).collect();
        Ok((places, fresh))
    }

    /// How many chunks have no vertices yet.
    pub fn fresh(&self) -> u32 {
        if self.pending.get() { self.fresh.len() as u32 } else { 0 }
    }

    /// Notes that a frame has made the vertices that were not there.
    pub fn made_vertices(&self) {
        self.made.set(self.pending.get());
        self.pending.set(self.pending.get() && !self.room.keeps_vertices());
    }

    /// Slots of the chunks whose vertices the last frame made.
    pub fn made(&self) -> &[u32] {
        if self.made.get() { &self.fresh } else { &[] }
    }

    /// Writes the samples of tiles into their places: those of a run of places at once.
    fn write_tiles(&self, gpu: &Gpu, placed: &[(u32, Tile)], mut tiles: &[TileSamples]) -> Result<()> {
        let follows = |(place, tile): &(u32, Tile), (next, other): &(u32, Tile)| {
            place + 1 == *next && tile.has_gradients() == other.has_gradients()
        };
        for run in placed.chunk_by(follows) {
            let (of_run, rest) = tiles.split_at(run.len());
            let offset = u64::from(run[0].0) * u64::from(TILE_SAMPLES) * 4;
            let names = ["heights", "gradients_east", "gradients_north"];
            let written = if run[0].1.has_gradients() { names.len() } else { 1 };
            for (k, name) in names.into_iter().enumerate().take(written) {
                let mut samples = Vec::with_capacity(run.len() * TILE_SAMPLES as usize);
                for TileSamples { heights, gradients: [east, north] } in of_run {
                    samples.extend_from_slice([heights, east, north][k]);
                }
                gpu.queue.write_buffer(self.get(name)?, offset, bytemuck::cast_slice(&samples));
            }
            tiles = rest;
        }
        Ok(())
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
                let part = ["facing_0", "facing_1"][batch.part() as usize];
                Some(self.named.get(part)?.as_entire_binding())
            }
            _ => Some(self.named.get(name)?.as_entire_binding()),
        }
    }

    /// Writes the camera: all that a further frame of a uniform level uploads.
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
        passing: u32::from(batches.len() > 1),
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
