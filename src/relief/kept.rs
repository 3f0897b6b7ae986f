//! Lines of a DEM that flow tells, and shores, kept in the cache by its heights: a file of its own for each kind.
//!
//! Those of a DEM that stays in its file are found on blocks of samples ([`coarse`](super::coarse)). Shores of a held one are found
//! anew.
//!
//! ```text
//! header | lines | points | of shores a bit a block, water or not | hash of all before
//! ```
//!
//! Cost: a hash of the heights; 20 bytes a line, 40 a point.

use std::io::{self, ErrorKind};

use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use xxhash_rust::xxh3::Xxh3;

use super::coarse::{lowest_and_highest, on_samples, spacing};
use super::whole::{ChannelArea, Relief};
use super::{FlatWater, LineKind, Shores, SurfaceLine, SurfacePoint};
use crate::cache::{Cache, CacheKey, CacheKind, CacheObserver, KeptEntry, NewEntry, not_kept};
use crate::dem::Dem;
use crate::error::Result;

/// Raise it when the lines of the same heights come out otherwise, or when the bytes below mean something else.
const FORMAT: u32 = 2;
const KIND: CacheKind =
    CacheKind { name: "creases", format: FORMAT, words: ["what was found of creases", "what is kept of creases"] };
/// The line that none joins.
const NONE: [u32; 2] = [u32::MAX; 2];

/// Lines that are found by the relief alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowLines {
    /// Where water runs; beds begin with so much land.
    Drainage(ChannelArea),
    /// Where it parts.
    Ridges,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    lines: u64,
    points: u64,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct KeptLine {
    points: u32,
    joins: [u32; 2],
    order: u32,
    closed: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Point {
    at: [f64; 2],
    across: [f32; 3],
    length: f32,
    drop: f32,
    /// So that no byte is unknown.
    zero: f32,
}

impl FlowLines {
    fn kind(self) -> LineKind {
        match self {
            Self::Drainage(_) => LineKind::Drainage,
            Self::Ridges => LineKind::Ridge,
        }
    }

    /// What tells it from others.
    fn code(self) -> [u64; 2] {
        match self {
            Self::Drainage(ChannelArea::Auto) => [0, 0],
            Self::Drainage(ChannelArea::SquareMetres(area)) => [1, area.to_bits()],
            Self::Ridges => [2, 0],
        }
    }

    fn lines(self, relief: &Relief) -> Result<Vec<SurfaceLine>> {
        match self {
            Self::Drainage(area) => Ok(relief.drainage(area)),
            Self::Ridges => relief.ridges(),
        }
    }
}

impl Cache {
    /// The lines of a DEM whose heights are exaggerated by a factor, of each kind that is asked for: known or found.
    ///
    /// # Errors
    /// Those of [`Relief`] and of reading the samples.
    pub fn creases(
        &self,
        dem: &Dem,
        exaggeration: f64,
        creases: &[FlowLines],
        hearing: CacheObserver<'_>,
    ) -> Result<Vec<Vec<SurfaceLine>>> {
        let heights = digest(dem, exaggeration)?;
        // Of what is not known, found once.
        let mut reliefs = None;
        let mut of_kind = |crease: &FlowLines| {
            let mut find = |sheet: Option<(NewEntry, &CacheKey)>, progress: &dyn Fn(f64)| {
                let (lowest, highest) = match &mut reliefs {
                    Some(reliefs) => reliefs,
                    none => none.insert(both(dem, exaggeration, progress)?),
                };
                let relief = match crease {
                    FlowLines::Drainage(_) => lowest,
                    FlowLines::Ridges => highest.as_mut().unwrap_or(lowest),
                };
                let mut lines = crease.lines(relief)?;
                if dem.is_filed() {
                    on_samples(&mut lines, dem, spacing(dem));
                }
                if let Some((sheet, key)) = sheet {
                    keep(sheet, &lines, &[], key, hearing);
                }
                Ok(lines)
            };
            // Files that are not on the disk may be others next time.
            let Some(heights) = heights else { return find(None, hearing.progress) };
            let key = key(heights, crease.code(), dem);
            let make =
                |sheet: Option<NewEntry>, progress: &dyn Fn(f64)| find(sheet.map(|sheet| (sheet, &key)), progress);
            let known = |kept| match recall(kept, crease.kind())? {
                (lines, words) if words.is_empty() => Ok(lines),
                _ => Err(io::Error::from(ErrorKind::InvalidData)),
            };
            self.get(&key, hearing, known, make)
        };
        creases.iter().map(&mut of_kind).collect()
    }

    /// The shores of a DEM whose heights are exaggerated by a factor: found or, of one that stays in its file, known or found.
    ///
    /// # Errors
    /// Those of reading the samples.
    pub fn shores(&self, dem: &Dem, exaggeration: f64, hearing: CacheObserver<'_>) -> Result<Shores> {
        if !dem.is_filed() {
            return Shores::of(dem, exaggeration);
        }
        let side = spacing(dem);
        let find = |progress: &dyn Fn(f64)| Shores::on_blocks(dem, exaggeration, side, progress);
        let Some(heights) = digest(dem, exaggeration)? else { return find(hearing.progress) };
        let key = key(heights, SHORES, dem);
        let make = |sheet: Option<NewEntry>, progress: &dyn Fn(f64)| {
            let shores = find(progress)?;
            if let Some(sheet) = sheet {
                keep(sheet, &shores.lines, shores.water.words(), &key, hearing);
            }
            Ok(shores)
        };
        let known = |kept| {
            let (lines, words) = recall(kept, LineKind::Shore)?;
            let water =
                FlatWater::from_words(dem, side, words).ok_or_else(|| io::Error::from(ErrorKind::InvalidData))?;
            Ok(Shores { water, lines })
        };
        self.get(&key, hearing, known, make)
    }
}

/// What tells shores from other lines of the same heights.
const SHORES: [u64; 2] = [3, 0];

/// Of lines of a DEM whose heights hash to this.
fn key(heights: u128, code: [u64; 2], dem: &Dem) -> CacheKey {
    let mut hash = Xxh3::new();
    hash.update(&heights.to_le_bytes());
    code.iter().for_each(|code| hash.update(&code.to_le_bytes()));
    CacheKey { kind: KIND, hash: hash.digest128(), of: dem.label() }
}

/// Keeps lines and words; says so where it cannot.
fn keep(sheet: NewEntry, lines: &[SurfaceLine], words: &[u64], key: &CacheKey, hearing: CacheObserver<'_>) {
    if let Err(error) = write(sheet, lines, words) {
        (hearing.warn)(&not_kept(key, &error));
    }
}

/// Where water runs on a DEM and, of a filed one, where it would on the highest samples of its blocks.
fn both(dem: &Dem, exaggeration: f64, progress: &dyn Fn(f64)) -> Result<(Relief, Option<Relief>)> {
    if !dem.is_filed() {
        return Ok((Relief::of(dem, exaggeration)?, None));
    }
    let [lowest, highest] = lowest_and_highest(dem, exaggeration, spacing(dem), progress)?;
    Ok((Relief::on(lowest)?, Some(Relief::on(highest)?)))
}

/// Of all that the lines of a DEM depend on.
pub(super) fn digest(dem: &Dem, exaggeration: f64) -> Result<Option<u128>> {
    let mut hash = Xxh3::new();
    match dem.held() {
        Ok(samples) => {
            hash.update(bytemuck::cast_slice(samples.heights()));
            hash.update(bytemuck::cast_slice(samples.valid()));
        }
        Err(_) => match dem.stamp() {
            Some(stamp) => hash.update(&stamp.to_le_bytes()),
            None => return Ok(None),
        },
    }
    let numbers = [dem.columns() as f64, dem.rows() as f64, dem.cell().x, dem.cell().y, exaggeration];
    hash.update(bytemuck::bytes_of(&numbers));
    Ok(Some(hash.digest128()))
}

/// Writes and publishes lines and words.
fn write(sheet: NewEntry, lines: &[SurfaceLine], words: &[u64]) -> Result<KeptEntry> {
    let points: usize = lines.iter().map(|line| line.points.len()).sum();
    let header = Header { lines: lines.len() as u64, points: points as u64 };
    let line = |line: &SurfaceLine| KeptLine {
        points: line.points.len() as u32,
        joins: line.joins.unwrap_or(NONE),
        order: u32::from(line.order),
        closed: u32::from(line.closed),
    };
    let point = |point: &SurfacePoint| {
        let SurfacePoint { at, across, length, drop } = *point;
        Point { at: at.to_array(), across, length, drop, zero: 0.0 }
    };
    let mut bytes = bytemuck::bytes_of(&header).to_vec();
    bytes.extend_from_slice(bytemuck::cast_slice(&lines.iter().map(line).collect::<Vec<_>>()));
    let points: Vec<Point> = lines.iter().flat_map(|line| &line.points).map(point).collect();
    bytes.extend_from_slice(bytemuck::cast_slice(&points));
    bytes.extend_from_slice(bytemuck::cast_slice(words));
    sheet.publish_whole(&bytes)
}

/// Reads lines of a kind, and the words behind them. Fails where the bytes are not those that were written.
fn recall(kept: KeptEntry, kind: LineKind) -> io::Result<(Vec<SurfaceLine>, Vec<u64>)> {
    let damaged = || io::Error::from(ErrorKind::InvalidData);
    let bytes = kept.whole()?;
    let (header, rest) = bytes.split_at_checked(size_of::<Header>()).ok_or_else(damaged)?;
    let header: Header = bytemuck::pod_read_unaligned(header);
    let size = (header.lines as usize).checked_mul(size_of::<KeptLine>()).ok_or_else(damaged)?;
    let (lines, rest) = rest.split_at_checked(size).ok_or_else(damaged)?;
    let size = (header.points as usize).checked_mul(size_of::<Point>()).ok_or_else(damaged)?;
    let (points, words) = rest.split_at_checked(size).ok_or_else(damaged)?;
    let mut points = points.chunks_exact(size_of::<Point>()).map(bytemuck::pod_read_unaligned::<Point>);
    let point = |point: Point| {
        let Point { at, across, length, drop, .. } = point;
        SurfacePoint { at: DVec2::from_array(at), across, length, drop }
    };
    let line = |line: &[u8]| {
        let KeptLine { points: count, joins, order, closed } = bytemuck::pod_read_unaligned(line);
        let points: Vec<SurfacePoint> = points.by_ref().take(count as usize).map(point).collect();
        let joins = Some(joins).filter(|joins| *joins != NONE);
        SurfaceLine { kind, order: order as u8, points, closed: closed != 0, joins }
    };
    let lines = lines.chunks_exact(size_of::<KeptLine>()).map(line).collect();
    if words.len() % size_of::<u64>() != 0 {
        return Err(damaged());
    }
    Ok((lines, words.chunks_exact(size_of::<u64>()).map(bytemuck::pod_read_unaligned).collect()))
}
