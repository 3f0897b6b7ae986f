//! Truths kept on disk: a truth depends on the DEM, the camera, the level and the code that finds it, nothing else.
//!
//! A file is named by a hash of all four and ends with a hash of its bytes. One that is damaged is noticed and made
//! anew. Nothing is ever deleted: the folder may be emptied at any time. 56 bytes a piece of a quarter pixel.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use crate::error::Result;
use crate::ink::Output;
use crate::surface::{Level, Surface};
use crate::truth::{Line, Piece, Terrain, Truth};
use crate::view::Camera;

/// The code that a truth depends on: when it changes, older truths are no longer found.
const CODE: &str = concat!(
    include_str!("cache.rs"),
    include_str!("../surface/lattice.rs"),
    include_str!("../surface/normals.rs"),
    include_str!("../surface/patch.rs"),
    include_str!("../truth/cell.rs"),
    include_str!("../truth/contour.rs"),
    include_str!("../truth/facing.rs"),
    include_str!("../truth/page.rs"),
    include_str!("../truth/sight.rs"),
    include_str!("../truth/terrain.rs"),
    include_str!("../view/camera.rs"),
);

/// A folder of truths, or none.
#[derive(Debug, Clone)]
pub struct Cache {
    folder: Option<PathBuf>,
}

/// A truth with what it took to make it, now or when it was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Kept {
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
    /// The user's own, where the system has a place for it.
    pub fn of_user() -> Self {
        Self { folder: dirs::cache_dir().map(|folder| folder.join("hachure")) }
    }

    /// In a folder, which is made when something is kept.
    pub fn in_folder(folder: PathBuf) -> Self {
        Self { folder: Some(folder) }
    }

    /// Keeps nothing and finds nothing.
    pub fn none() -> Self {
        Self { folder: None }
    }

    /// A file of the folder.
    pub(super) fn path(&self, name: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(name))
    }

    /// The truth of a view, from the folder or made and kept. `warn` hears of a damaged file and of a folder that cannot
    /// be written; both cost time, nothing else.
    pub fn truth(&self, terrain: &Terrain<'_>, camera: &Camera, level: Level, warn: &dyn Fn(&str)) -> Kept {
        let name = || name(terrain.surface, camera, level);
        let path = self.folder.as_ref().and_then(|_| self.path(&name()?));
        if let Some(bytes) = path.as_ref().and_then(|path| fs::read(path).ok()) {
            match from_bytes(&bytes) {
                Some(kept) => return kept,
                None => warn("a cached truth is damaged: it is made anew"),
            }
        }
        let start = Instant::now();
        let truth = terrain.truth(camera, level);
        let kept = Kept { truth, ms: start.elapsed().as_secs_f64() * 1e3 };
        if let Some(Err(error)) = path.map(|path| write_file(&path, &to_bytes(&kept))) {
            warn(&format!("truth is not cached: {error}"));
        }
        kept
    }
}

/// Begins a file of the cache.
pub(super) fn create(path: &Path) -> Result<Output> {
    // A folder that cannot be made shows when the file is opened in it.
    let _ = path.parent().map(fs::create_dir_all);
    Output::create(path)
}

/// Writes a file of the cache, whole or not at all.
fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut output = create(path)?;
    output.write(|file| file.write_all(bytes))?;
    output.publish()
}

/// The file of a truth; none where the samples it depends on are not in memory.
fn name(surface: &Surface, camera: &Camera, level: Level) -> Option<String> {
    let dem = surface.dem();
    let samples = dem.held().ok()?;
    let mut hash = Xxh3::new();
    hash.update(env!("CARGO_PKG_VERSION").as_bytes());
    hash.update(CODE.as_bytes());
    hash.update(bytemuck::cast_slice(samples.heights()));
    hash.update(bytemuck::cast_slice(samples.valid()));
    let corner = dem.position(0, 0);
    let numbers = [corner.x, corner.y, dem.cell().x, dem.cell().y, camera.eye.x, camera.eye.y, camera.eye.z];
    hash.update(bytemuck::cast_slice(&numbers));
    hash.update(bytemuck::cast_slice(&[camera.azimuth, camera.altitude, camera.fov]));
    let counts = [dem.columns() as u64, u64::from(camera.width), u64::from(camera.height), level.subdivisions().into()];
    hash.update(bytemuck::cast_slice(&counts));
    Some(format!("truth-{:032x}", hash.digest128()))
}

fn to_bytes(kept: &Kept) -> Vec<u8> {
    let Kept { truth, ms } = kept;
    let header = Header {
        level: truth.level.subdivisions(),
        size: truth.size,
        pad: 0,
        facets: truth.facets,
        rays: truth.rays,
        ms: *ms,
    };
    let row = |piece: &Piece| Row {
        ends: piece.ends.map(|end| end.to_array()),
        distance: piece.distance,
        line: u64::from(piece.line == Line::Border),
    };
    let mut bytes = bytemuck::bytes_of(&header).to_vec();
    truth.pieces.iter().for_each(|piece| bytes.extend(bytemuck::bytes_of(&row(piece))));
    bytes.extend(xxh3_64(&bytes).to_le_bytes());
    bytes
}

/// `None` where the bytes are not those that were written.
fn from_bytes(bytes: &[u8]) -> Option<Kept> {
    let (content, sum) = bytes.split_last_chunk::<8>()?;
    if xxh3_64(content) != u64::from_le_bytes(*sum) {
        return None;
    }
    let (header, rows) = content.split_at_checked(size_of::<Header>())?;
    let header: Header = bytemuck::pod_read_unaligned(header);
    let piece = |row: &[u8]| {
        let row: Row = bytemuck::pod_read_unaligned(row);
        let line = if row.line == 0 { Line::Contour } else { Line::Border };
        Piece { ends: row.ends.map(DVec2::from_array), distance: row.distance, line }
    };
    let pieces = rows.chunks_exact(size_of::<Row>()).map(piece).collect();
    let Header { level, size, facets, rays, ms, .. } = header;
    Some(Kept { truth: Truth { level: Level::new(level)?, size, pieces, facets, rays }, ms })
}
