//! What all frames of a surface share on the device: samples, vertices, chunks and what is found of their facets.
//!
//! A frame uploads the camera, its lattice unless that is the last one's, and those tiles of samples that are not there yet,
//! whatever the plan of the frames before. Vertices stay from frame to frame where one batch has room for all. No binding
//! exceeds 128 MiB, whatever the level: vertices and the queue are sized by a batch, facing bits lie in up to two parts.

use std::collections::HashSet;
use std::sync::Arc;

use bytemuck::Zeroable;

use super::buffers::{Buffers, Creation};
use super::capacity::{Capacity, Moves};
use super::device::Gpu;
use super::pace::Work;
use super::shaders::{EMPTY_QUEUE, NO_PIXELS};
use super::sizes::{self, TILE_BYTES, rim_fits, valid_fits};
use super::slot_cache::{Placed, SlotCache};
use super::uniforms::{CameraUniform, ChunkUniform, SceneUniform};
use crate::error::{Error, Result};
use crate::plan::batches::BATCH_CHUNKS;
use crate::plan::{Border, Detail, Frame, PagePiece};
use crate::surface::rim::{RimEdge, rim, rim_length};
use crate::surface::tile::{TILE_SAMPLES, TileSamples};
use crate::surface::{Chunk, Lattice, Surface, Tile};

/// Tiles sent to the device together, 3 KB each.
const TILES_AT_ONCE: usize = 4096;
/// Which slot cache holds tiles with gradients: they have the first places.
const PATCHED: usize = 0;
/// Which slot cache holds the others.
const BARE: usize = 1;

/// A surface on a device, and the lattice of the last frame.
pub struct Scene {
    buffers: Buffers,
    /// How often some of them were made anew: what binds them must then bind them again.
    generation: u64,
    capacity: Capacity,
    /// Those with gradients, and the others.
    tiles: [SlotCache<Tile>; 2],
    /// How many tiles were uploaded.
    uploaded: u64,
    blocks: SlotCache<Chunk>,
    /// `None` while one is on its way, and after an error there: nobody knows then what lies in which place.
    lattice: Option<Arc<Lattice>>,
    /// `None` until a frame draws it.
    rim_edges: Option<usize>,
    /// Slots of the chunks whose vertices were not there when the lattice came.
    fresh: Vec<u32>,
    /// Whether they still are not.
    pending: bool,
    /// Whether the last piece made them.
    made: bool,
}

impl Scene {
    /// Nothing of a surface yet.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let mut buffers = Buffers::default();
        buffers.uniform(gpu, "scene", bytemuck::bytes_of(&SceneUniform::zeroed()));
        buffers.uniform(gpu, "camera", bytemuck::bytes_of(&CameraUniform::zeroed()));
        buffers.upload(gpu, "rim", bytemuck::cast_slice::<RimEdge, u8>(&[]))?;
        buffers.upload(gpu, "empty_queue", bytemuck::bytes_of(&EMPTY_QUEUE))?;
        buffers.upload(gpu, "no_pixels", bytemuck::bytes_of(&NO_PIXELS))?;
        Ok(Self {
            buffers,
            generation: 0,
            capacity: Capacity::default(),
            tiles: [SlotCache::new(0), SlotCache::new(0)],
            uploaded: 0,
            blocks: SlotCache::new(0),
            lattice: None,
            rim_edges: None,
            fresh: Vec::new(),
            pending: false,
            made: false,
        })
    }

    /// Brings what a frame draws to the device; what is already there stays.
    ///
    /// # Errors
    /// [`Error::Limit`] when a buffer would exceed what every device binds; whatever the driver reports, and what keeps
    /// samples from being read.
    pub fn load(&mut self, gpu: &Gpu, surface: &Surface, frame: &Frame) -> Result<()> {
        if frame.plan.border == Border::On && self.rim_edges.is_none() {
            self.load_rim(gpu, surface)?;
        }
        if self.buffers.find("valid").is_none() {
            self.load_validity(gpu, surface)?;
        }
        let lattice = &frame.lattice;
        if self.lattice.as_ref().is_some_and(|there| Arc::ptr_eq(there, lattice)) {
            return Ok(());
        }
        if self.lattice.take().is_none() {
            self.tiles = [self.capacity.patched, self.capacity.bare()].map(SlotCache::new);
            self.blocks = SlotCache::new(self.most_blocks());
        }
        let (chunks, nodes) = (lattice.chunks(), lattice.tree().nodes());
        if self.capacity == Capacity::default()
            || chunks.len() > self.capacity.chunks as usize
            || nodes.len() > self.capacity.nodes
        {
            self.make_room(gpu, frame)?;
        }
        let places = self.load_tiles(gpu, surface, frame)?;
        let (blocks, fresh) = self.place_vertices(chunks)?;
        let pyramid = surface.pyramid()?;
        let of_chunk = |((chunk, tile), block): ((&Chunk, u32), u32)| ChunkUniform::new(*chunk, pyramid, tile, block);
        let uniforms: Vec<_> = chunks.iter().zip(places).zip(blocks).map(of_chunk).collect();
        let scene = SceneUniform::new(surface.dem(), lattice);
        gpu.queue.write_buffer(self.buffers.get("scene")?, 0, bytemuck::bytes_of(&scene));
        gpu.queue.write_buffer(self.buffers.get("chunks")?, 0, bytemuck::cast_slice(&uniforms));
        gpu.queue.write_buffer(self.buffers.get("fresh")?, 0, bytemuck::cast_slice(&fresh));
        gpu.queue.write_buffer(self.buffers.get("nodes")?, 0, bytemuck::cast_slice(nodes));
        self.pending = !fresh.is_empty();
        self.fresh = fresh;
        gpu.check()?;
        self.lattice = Some(lattice.clone());
        Ok(())
    }

    /// Uploads the rim, where a device can bind it: told before it is made.
    fn load_rim(&mut self, gpu: &Gpu, surface: &Surface) -> Result<()> {
        rim_fits(rim_length(surface.dem())?)?;
        let edges = rim(surface.dem())?;
        self.buffers.upload(gpu, "rim", bytemuck::cast_slice(&edges))?;
        self.rim_edges = Some(edges.len());
        self.generation += 1;
        Ok(())
    }

    /// Uploads what tells voids from samples.
    fn load_validity(&mut self, gpu: &Gpu, surface: &Surface) -> Result<()> {
        let dem = surface.dem();
        let valid = if dem.voids() > 0 { dem.validity()?.words() } else { &[0] };
        valid_fits(valid.len() as u64)?;
        self.buffers.upload(gpu, "valid", bytemuck::cast_slice(valid))
    }

    /// Makes buffers that have room for the lattice of a frame as well. Tiles move there on the device.
    fn make_room(&mut self, gpu: &Gpu, frame: &Frame) -> Result<()> {
        let least = Capacity::of(&frame.lattice);
        let before = self.capacity;
        let after = match frame.plan.detail {
            _ if before != Capacity::default() => before.grown(least),
            Detail::Uniform(_) => least,
            Detail::Adaptive { .. } => Capacity::FIRST.grown(least),
        };
        let sizes = sizes::of_scene(after);
        sizes.iter().try_for_each(|(name, size)| sizes::fits(name, *size))?;
        let moves = Moves { before, after };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut heights_move = false;
        for (name, size) in &sizes {
            if let Creation::Anew(old) = self.buffers.create(gpu, name, *size)? {
                heights_move |= *name == "heights";
                let new = self.buffers.get(name)?;
                old.iter().for_each(|old| moves.record(&mut encoder, name, old, new));
            }
        }
        gpu.queue.submit([encoder.finish()]);
        self.generation += 1;
        self.capacity = after;
        if let Err(error) = gpu.check() {
            sizes.iter().for_each(|(name, _)| self.buffers.remove(name));
            self.capacity = Capacity::default();
            return Err(error);
        }
        let stays = moves.stays(heights_move);
        for ((pool, stays), capacity) in self.tiles.iter_mut().zip(stays).zip([after.patched, after.bare()]) {
            if stays { pool.grow(capacity) } else { *pool = SlotCache::new(capacity) }
        }
        self.blocks = SlotCache::new(self.most_blocks());
        Ok(())
    }

    /// Brings the tiles of all chunks to the device; says in which place that of each chunk is.
    fn load_tiles(&mut self, gpu: &Gpu, surface: &Surface, frame: &Frame) -> Result<Vec<u32>> {
        let tiles: Vec<Tile> = frame.lattice.chunks().iter().map(Tile::of).collect();
        let kinds: (Vec<Tile>, Vec<Tile>) = tiles.iter().partition(|tile| tile.has_gradients());
        let mut patched = self.bring(gpu, surface, frame, PATCHED, &kinds.0)?;
        let generation = self.generation;
        let bare = self.bring(gpu, surface, frame, BARE, &kinds.1)?;
        if self.generation != generation {
            // Room for these may have been made at the cost of those.
            patched = self.bring(gpu, surface, frame, PATCHED, &kinds.0)?;
        }
        let first_bare = self.capacity.patched as u32;
        let (mut patched, mut bare) = (patched.into_iter(), bare.into_iter());
        let place = |tile: &Tile| match tile.has_gradients() {
            true => patched.next(),
            false => bare.next().map(|place| first_bare + place),
        };
        Ok(tiles.iter().filter_map(place).collect())
    }

    /// Uploads the tiles of a kind that are not there yet, into larger buffers where there is no place; says in which place
    /// among its kind each is.
    fn bring(&mut self, gpu: &Gpu, surface: &Surface, frame: &Frame, kind: usize, tiles: &[Tile]) -> Result<Vec<u32>> {
        let mut placed = self.tiles[kind].place(tiles);
        if placed.is_none() {
            self.make_room(gpu, frame)?;
            placed = self.tiles[kind].place(tiles);
        }
        let none = || Error::mistake(format!("no room for the samples of {} chunks", tiles.len()));
        let Placed { places, missing } = placed.ok_or_else(none)?;
        let first = if kind == PATCHED { 0 } else { self.capacity.patched as u32 };
        for some in missing.chunks(TILES_AT_ONCE) {
            self.upload_tiles(gpu, surface, first, some)?;
            // Sent at once: until then the driver holds a second copy.
            gpu.queue.submit([]);
            if missing.len() > TILES_AT_ONCE {
                gpu.wait_for(Work::bytes(TILES_AT_ONCE as u64 * TILE_BYTES))?;
            }
        }
        Ok(places)
    }

    /// Reads tiles of one kind and writes them into their places behind the first: those of a run of places at once.
    fn upload_tiles(&mut self, gpu: &Gpu, surface: &Surface, first: u32, placed: &[(u32, Tile)]) -> Result<()> {
        let tiles: Vec<Tile> = placed.iter().map(|(_, tile)| *tile).collect();
        let TileSamples { heights, gradients: [east, north] } = TileSamples::read(surface, &tiles)?;
        let samples = [("heights", heights), ("gradients_east", east), ("gradients_north", north)];
        for (name, samples) in samples.iter().filter(|(_, samples)| !samples.is_empty()) {
            let buffer = self.buffers.get(name)?;
            let mut rest = samples.as_slice();
            for run in placed.chunk_by(|(place, _), (next, _)| place + 1 == *next) {
                let (of_run, others) = rest.split_at(run.len() * TILE_SAMPLES as usize);
                let offset = u64::from(first + run[0].0) * TILE_BYTES;
                gpu.queue.write_buffer(buffer, offset, bytemuck::cast_slice(of_run));
                rest = others;
            }
        }
        self.uploaded += placed.len() as u64;
        Ok(())
    }

    /// Of each chunk the block of its vertices; and the slots of those whose vertices are not there yet.
    fn place_vertices(&mut self, chunks: &[Chunk]) -> Result<(Vec<u32>, Vec<u32>)> {
        let slots = 0..chunks.len() as u32;
        let passing = chunks.len() > BATCH_CHUNKS as usize;
        if self.pending || passing {
            // The last ones were never made, or the next ones make way for each other.
            self.blocks = SlotCache::new(self.most_blocks());
        }
        if passing {
            return Ok((slots.clone().map(|slot| slot % BATCH_CHUNKS).collect(), slots.collect()));
        }
        let none = || Error::mistake(format!("no room for the vertices of {} chunks", chunks.len()));
        let Placed { places, missing } = self.blocks.place(chunks).ok_or_else(none)?;
        let missing: HashSet<u32> = missing.into_iter().map(|(block, _)| block).collect();
        let fresh = slots.filter(|slot| missing.contains(&places[*slot as usize])).collect();
        Ok((places, fresh))
    }

    /// Blocks of vertices for which there is room.
    fn most_blocks(&self) -> usize {
        self.capacity.chunks.min(BATCH_CHUNKS) as usize
    }

    /// Writes the camera of a piece of a frame: all that a further frame of the same lattice uploads.
    ///
    /// # Errors
    /// As [`CameraUniform::new`].
    pub fn write_camera(&self, gpu: &Gpu, surface: &Surface, frame: &Frame, piece: PagePiece) -> Result<()> {
        let uniform = CameraUniform::new(surface.dem(), &frame.camera)?.cut_to(&frame.camera, piece.drawn);
        let (chunks, fresh) = (frame.lattice.chunks().len() as u32, self.fresh());
        let uniform = CameraUniform { chunks, seen: frame.seen, fresh, ..uniform };
        gpu.queue.write_buffer(self.buffers.get("camera")?, 0, bytemuck::bytes_of(&uniform));
        Ok(())
    }

    /// Notes that a frame has made the vertices that were not there.
    pub fn made_vertices(&mut self, frame: &Frame) {
        self.made = self.pending;
        self.pending &= !frame.keeps_vertices();
    }

    /// How many chunks have no vertices yet.
    pub fn fresh(&self) -> u32 {
        if self.pending { self.fresh.len() as u32 } else { 0 }
    }

    /// Slots of the chunks whose vertices the last piece made.
    pub fn made(&self) -> &[u32] {
        if self.made { &self.fresh } else { &[] }
    }

    /// How many edges its rim has; none until a frame draws it.
    pub fn rim_edges(&self) -> usize {
        self.rim_edges.unwrap_or(0)
    }

    /// How many tiles of samples were uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// How often buffers were made anew: other numbers, other buffers.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The buffers.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }
}
