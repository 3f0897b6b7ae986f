//! Slope lines that a view needed, kept in the cache: who draws it again need not wait for them.
//!
//! What a first request makes of a scale is one file, named by the heights, the rules, what lines end at, and the blocks that were made, which
//! are others for another tone or spacing; what flights add from frame to frame is not kept.
//!
//! ```text
//! header | blocks | lines | points | hash of all before
//! ```
//!
//! Cost: a hash of the heights; 12 bytes a line, 32 a point. Trouble with the folder is told where creases of the same DEM are
//! kept, and not again.

use std::io::{self, ErrorKind};
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, Vec2};
use xxhash_rust::xxh3::Xxh3;

use super::block::bounds;
use super::land::Land;
use super::level::BlockAt;
use super::{SlopeBlock, SlopeLine, SlopePoint};
use crate::cache::{Cache, CacheKey, CacheKind, CacheObserver, KeptEntry, NewEntry};
use crate::dem::Dem;
use crate::error::Result;
use crate::relief::kept::digest;

/// Raise it when the lines of the same heights come out otherwise, or when the bytes below mean something else.
const FORMAT: u32 = 1;
const KIND: CacheKind = CacheKind {
    name: "slopes",
    format: FORMAT,
    words: ["what was made of slope lines", "what is kept of slope lines"],
};
/// Fewer blocks are made as fast as they are read.
const LEAST: usize = 200;

/// Where the lines of a DEM are kept.
#[derive(Debug, Clone)]
pub(super) struct Store {
    cache: Cache,
    /// Of the DEM.
    hash: u128,
    /// The DEM, for people.
    of: String,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    blocks: u64,
    lines: u64,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Block {
    level: u32,
    at: [u32; 2],
    lines: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct KeptLine {
    id: [u32; 2],
    points: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Point {
    at: [f64; 2],
    height: f32,
    gradient: [f32; 2],
    room: f32,
}

impl Store {
    /// In a cache, of a DEM whose heights are exaggerated by a factor; none for files that may be others next time.
    ///
    /// # Errors
    /// Those of reading the samples.
    pub(super) fn new(cache: &Cache, dem: &Dem, exaggeration: f64) -> Result<Option<Self>> {
        if cache.folder().is_none() {
            return Ok(None);
        }
        let Some(heights) = digest(dem, exaggeration)? else { return Ok(None) };
        let mut hash = Xxh3::new();
        hash.update(&heights.to_le_bytes());
        hash.update(bytemuck::bytes_of(&dem.position(0, 0).truncate().to_array()));
        Ok(Some(Self { cache: cache.clone(), hash: hash.digest128(), of: dem.label() }))
    }

    /// Blocks of lines on some land as they are kept, or as they are made and kept from now on.
    ///
    /// # Errors
    /// None of its own.
    pub(super) fn blocks(
        &self,
        land: &Land,
        wanted: &[BlockAt],
        make: impl FnOnce() -> Vec<Arc<SlopeBlock>>,
    ) -> Result<Vec<Arc<SlopeBlock>>> {
        if wanted.len() < LEAST {
            return Ok(make());
        }
        let mut hash = Xxh3::new();
        hash.update(&self.hash.to_le_bytes());
        land.identify(&mut hash);
        wanted.iter().for_each(|at| hash.update(bytemuck::bytes_of(&[at.level, at.row, at.column])));
        let key = CacheKey { kind: KIND, hash: hash.digest128(), of: self.of.clone() };
        let hearing = CacheObserver { warn: &|_| (), progress: &|_| () };
        let are_wanted = |blocks: &Vec<Arc<SlopeBlock>>| {
            let at = |block: &Arc<SlopeBlock>| BlockAt { level: block.level, row: block.at[1], column: block.at[0] };
            blocks.iter().map(at).eq(wanted.iter().copied())
        };
        if let Some(blocks) = self.cache.hold(&key).and_then(|kept| recall(kept).ok()).filter(are_wanted) {
            return Ok(blocks);
        }
        // No lock is held meanwhile: threads at work may be given work that waits for it.
        let blocks = make();
        self.cache.get(
            &key,
            hearing,
            |kept| recall(kept).map(drop),
            |sheet, _| {
                // What cannot be kept is made again.
                let _ = sheet.map(|sheet| write(sheet, &blocks));
                Ok(())
            },
        )?;
        Ok(blocks)
    }
}

/// Writes and publishes blocks.
fn write(sheet: NewEntry, blocks: &[Arc<SlopeBlock>]) -> Result<KeptEntry> {
    let lines = || blocks.iter().flat_map(|block| &block.lines);
    let header = Header { blocks: blocks.len() as u64, lines: lines().count() as u64 };
    let block = |block: &Arc<SlopeBlock>| Block { level: block.level, at: block.at, lines: block.lines.len() as u32 };
    let line =
        |line: &SlopeLine| KeptLine { id: [line.id as u32, (line.id >> 32) as u32], points: line.points.len() as u32 };
    let point = |point: &SlopePoint| {
        let SlopePoint { at, height, gradient, room } = *point;
        Point { at: at.to_array(), height, gradient: gradient.to_array(), room }
    };
    let mut bytes = bytemuck::bytes_of(&header).to_vec();
    bytes.extend_from_slice(bytemuck::cast_slice(&blocks.iter().map(block).collect::<Vec<_>>()));
    bytes.extend_from_slice(bytemuck::cast_slice(&lines().map(line).collect::<Vec<_>>()));
    lines().for_each(|line| line.points.iter().for_each(|at| bytes.extend_from_slice(bytemuck::bytes_of(&point(at)))));
    sheet.publish_whole(&bytes)
}

/// Reads blocks. Fails where the bytes are not those that were written.
fn recall(kept: KeptEntry) -> io::Result<Vec<Arc<SlopeBlock>>> {
    let damaged = || io::Error::from(ErrorKind::InvalidData);
    let bytes = kept.whole()?;
    let (header, rest) = bytes.split_at_checked(size_of::<Header>()).ok_or_else(damaged)?;
    let header: Header = bytemuck::pod_read_unaligned(header);
    let parted = |bytes, count: u64, size: usize| -> Option<(&[u8], &[u8])> {
        <[u8]>::split_at_checked(bytes, usize::try_from(count).ok()?.checked_mul(size)?)
    };
    let (blocks, rest) = parted(rest, header.blocks, size_of::<Block>()).ok_or_else(damaged)?;
    let (lines, points) = parted(rest, header.lines, size_of::<KeptLine>()).ok_or_else(damaged)?;
    let mut lines = lines.chunks_exact(size_of::<KeptLine>()).map(bytemuck::pod_read_unaligned::<KeptLine>);
    let mut points = points.chunks_exact(size_of::<Point>()).map(bytemuck::pod_read_unaligned::<Point>);
    let point = |point: Point| {
        let Point { at, height, gradient, room } = point;
        SlopePoint { at: DVec2::from_array(at), height, gradient: Vec2::from_array(gradient), room }
    };
    let mut line = |line: KeptLine| SlopeLine {
        id: u64::from(line.id[0]) | u64::from(line.id[1]) << 32,
        points: points.by_ref().take(line.points as usize).map(point).collect(),
    };
    let block = |block: &[u8]| {
        let Block { level, at, lines: count } = bytemuck::pod_read_unaligned(block);
        let lines: Vec<SlopeLine> = lines.by_ref().take(count as usize).map(&mut line).collect();
        let boxes = lines.iter().map(bounds).collect();
        Arc::new(SlopeBlock { level, at, lines, boxes })
    };
    Ok(blocks.chunks_exact(size_of::<Block>()).map(block).collect())
}
