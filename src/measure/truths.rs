//! Truths kept on disk: a truth depends on the DEM, the camera and the level, and on the code that finds it, of which a number
//! stands for the state.
//!
//! 56 bytes a piece of a quarter pixel, and a hash of all. One that is damaged is noticed and made anew.

use std::io::{self, ErrorKind, Read};
use std::time::Instant;

use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use crate::cache::{Cache, CacheKey, CacheKind, CacheObserver, NewEntry, not_kept};
use crate::error::Message;
use crate::surface::{Level, Surface};
use crate::truth::{Terrain, Truth, TruthLine, TruthPiece};
use crate::view::Camera;

/// Raise it when a truth comes out otherwise for the same samples, camera and level (anything in `truth`, normals, patches,
/// the camera's projection), or when the bytes below mean something else.
const FORMAT: u32 = 1;
const KIND: CacheKind = CacheKind { name: "truth", format: FORMAT, words: ["truth", "a cached truth"] };

/// A truth with what it took to make it, now or when it was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptTruth {
    /// Contours and border lines.
    pub truth: Truth,
    /// Milliseconds.
    pub ms: f64,
}

/// What stands before the pieces.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    level: u32,
    size: [u32; 2],
    pad: u32,
    facets: u64,
    rays: u64,
    ms: f64,
}

/// A piece in 56 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Row {
    ends: [[f64; 2]; 2],
    distance: f64,
    /// 0 contour, 1 border.
    line: u64,
}

impl Cache {
    /// The truth of a view, from the folder or made and kept. `warn` hears of a damaged file and of a folder that cannot
    /// be written; both cost time, nothing else.
    pub fn truth(&self, terrain: &Terrain<'_>, camera: &Camera, level: Level, warn: &dyn Fn(&Message)) -> KeptTruth {
        let make = || {
            let start = Instant::now();
            let truth = terrain.truth(camera, level);
            KeptTruth { truth, ms: start.elapsed().as_secs_f64() * 1e3 }
        };
        let Some(key) = self.folder().and_then(|_| key(terrain.surface, camera, level)) else { return make() };
        let recall = |mut kept: crate::cache::KeptEntry| {
            let mut bytes = Vec::new();
            kept.file.by_ref().take(kept.bytes).read_to_end(&mut bytes)?;
            from_bytes(&bytes).ok_or(io::Error::from(ErrorKind::InvalidData))
        };
        let make_and_keep = |sheet: Option<NewEntry>, _: &dyn Fn(f64)| {
            let made = make();
            if let Some(mut sheet) = sheet {
                sheet.write(&to_bytes(&made));
                let published = sheet.publish();
                published.err().into_iter().for_each(|error| warn(&not_kept(&key, &error)));
            }
            Ok(made)
        };
        // Making it cannot fail.
        self.get(&key, CacheObserver { warn, progress: &|_| () }, recall, make_and_keep).unwrap_or_else(|_| make())
    }
}

/// What a truth depends on; none where the samples are not in memory.
fn key(surface: &Surface, camera: &Camera, level: Level) -> Option<CacheKey> {
    let dem = surface.dem();
    let samples = dem.held().ok()?;
    let mut hash = Xxh3::new();
    hash.update(bytemuck::cast_slice(samples.heights()));
    hash.update(bytemuck::cast_slice(samples.valid()));
    let corner = dem.position(0, 0);
    let numbers = [corner.x, corner.y, dem.cell().x, dem.cell().y, camera.eye.x, camera.eye.y, camera.eye.z];
    hash.update(bytemuck::cast_slice(&numbers));
    hash.update(bytemuck::cast_slice(&[camera.azimuth, camera.altitude, camera.fov]));
    let counts = [dem.columns() as u64, u64::from(camera.width), u64::from(camera.height), level.subdivisions().into()];
    hash.update(bytemuck::cast_slice(&counts));
    surface.limits().identify(&mut hash);
    Some(CacheKey { kind: KIND, hash: hash.digest128(), of: dem.label() })
}

fn to_bytes(kept: &KeptTruth) -> Vec<u8> {
    let KeptTruth { truth, ms } = kept;
    let header = Header {
        level: truth.level.subdivisions(),
        size: truth.size,
        pad: 0,
        facets: truth.facets,
        rays: truth.rays,
        ms: *ms,
    };
    let row = |piece: &TruthPiece| Row {
        ends: piece.ends.map(|end| end.to_array()),
        distance: piece.distance,
        line: u64::from(piece.line == TruthLine::Border),
    };
    let mut bytes = bytemuck::bytes_of(&header).to_vec();
    truth.pieces.iter().for_each(|piece| bytes.extend(bytemuck::bytes_of(&row(piece))));
    bytes.extend(xxh3_64(&bytes).to_le_bytes());
    bytes
}

/// `None` where the bytes are not those that were written.
fn from_bytes(bytes: &[u8]) -> Option<KeptTruth> {
    let (content, sum) = bytes.split_last_chunk::<8>()?;
    if xxh3_64(content) != u64::from_le_bytes(*sum) {
        return None;
    }
    let (header, rows) = content.split_at_checked(size_of::<Header>())?;
    let header: Header = bytemuck::pod_read_unaligned(header);
    let piece = |row: &[u8]| {
        let row: Row = bytemuck::pod_read_unaligned(row);
        let line = if row.line == 0 { TruthLine::Contour } else { TruthLine::Border };
        TruthPiece { ends: row.ends.map(DVec2::from_array), distance: row.distance, line }
    };
    let pieces = rows.chunks_exact(size_of::<Row>()).map(piece).collect();
    let Header { level, size, facets, rays, ms, .. } = header;
    Some(KeptTruth { truth: Truth { level: Level::new(level)?, size, pieces, facets, rays }, ms })
}
