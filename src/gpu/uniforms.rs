//! The structs that shaders and CPU share, laid out as `shaders/scene.wgsl` and `shaders/ink.wgsl` declare them.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use crate::dem::Dem;
use crate::error::{Error, Result, Setting};
use crate::plan::pieces::Rectangle;
use crate::surface::pyramid::SquareBounds;
use crate::surface::{Chunk, Lattice, Pyramid};
use crate::view::Camera;

/// The near plane in cells: a power of two, so that depths scale without rounding.
pub(crate) const NEAR_CELLS: f64 = 1.0 / 1024.0;

/// `Scene` of scene.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SceneUniform {
    /// Metres between columns and rows.
    pub cell: [f32; 2],
    /// Columns, rows.
    pub samples: [u32; 2],
    /// Of the quadtree of chunks, across, down.
    pub roots: [u32; 2],
    /// Lattice units along a root's side, a power of two.
    pub root_size: u32,
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
    /// Chunks of the frame.
    pub chunks: u32,
    /// Pixels across, down, of what is drawn.
    pub size: [u32; 2],
    /// Inward normals of the two sides of its map projection; 0 where it is no frustum.
    pub frustum: [f32; 4],
    /// The page's column and row of its top left pixel.
    pub origin: [i32; 2],
    /// Chunks in the first slots that are drawn.
    pub seen: u32,
    /// Chunks whose vertices are not there yet.
    pub fresh: u32,
}

/// `Chunk` of scene.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ChunkUniform {
    /// Lattice place of the north-west vertex.
    pub origin: [u32; 2],
    /// Lattice units between vertices.
    pub step: u32,
    /// Sides beyond which a chunk of twice the step lies.
    pub coarser: u32,
    /// Metres, below all its surface.
    pub low: f32,
    /// Metres, above all its surface.
    pub high: f32,
    /// Metres that its surface reaches beyond its square on the map.
    pub beyond: f32,
    /// Which tile holds its samples.
    pub tile: u32,
    /// Which block of `places` holds its vertices.
    pub block: u32,
    /// Fills to 8 bytes.
    pub pad: u32,
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
    /// 1: its vertices make way for those of the next batch, 0: they stay.
    pub passing: u32,
}

/// `Segment` of segment.wgsl: a stretch of a curve of at most about a pixel, with the surface that faces the eye on its left, seen
/// from above.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Segment {
    /// Metres from the eye.
    pub start: [f32; 3],
    /// How steeply facing falls along the view: sine of the angle between ray and stretch, below 0 where it is concave.
    pub fall: f32,
    /// Metres from the eye.
    pub end: [f32; 3],
    /// Depth of what lies behind.
    pub behind: f32,
    /// Its middle on the lattice, in 1/256 of the finest step.
    pub at: [i32; 2],
    /// ID of the facet it lies on.
    pub facet: u32,
    /// Which line of the facet, and which part of it.
    pub code: u32,
    /// On the page, the unit vector from the surface to what lies behind.
    pub outward: [f32; 2],
    /// The pixel of its middle in what is drawn: column, and row in the high half.
    pub pixel: u32,
    /// Whether it is seen.
    pub sight: u32,
}

/// Codes of a segment, as segment.wgsl says.
pub mod code {
    /// Which corner of the facet faces the other way, or which edge is of the rim.
    pub const CORNER: u32 = 3;
    /// A point of a line on the land, in the place of a corner; its number stands where that of a part would.
    pub const LAID: u32 = 3;
    /// That corner faces away.
    pub const AWAY_CORNER: u32 = 4;
    /// It is of the rim.
    pub const OF_RIM: u32 = 8;
    /// It starts where the line of the facet does.
    pub const STARTS: u32 = 16;
    /// It ends where the line of the facet does.
    pub const ENDS: u32 = 32;
    /// It starts where the rim turns.
    pub const STARTS_TURNING: u32 = 64;
    /// It ends where the rim turns.
    pub const ENDS_TURNING: u32 = 128;
    /// Behind so many bits stands its number among the parts of the line.
    pub const PART_SHIFT: u32 = 8;
}

/// What sight.wgsl finds.
pub mod seen {
    /// From no pixel centre about it something stands before it.
    pub const FREE: u32 = 0;
    /// From all something does.
    pub const HIDDEN: u32 = 1;
    /// They differ, and from the nearest nothing does.
    pub const NEAREST_FREE: u32 = 2;
    /// They differ, and from the nearest something does.
    pub const NEAREST_HIDDEN: u32 = 3;
    /// Nobody looked.
    pub const NOT_ASKED: u32 = 4;
}

/// `Tally` of tally.wgsl: what is counted of curves, whether there is room for it or not.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Tally {
    /// Chunks whose vertices count.
    pub wanted: u32,
    /// Facets through which contours run.
    pub crossed: u32,
    /// Segments.
    pub segments: u32,
    /// Those that are looked at.
    pub asked: u32,
    /// Walks that a driver ended before they were done: must be 0.
    pub cut_short: u32,
}

/// `Counts` of ink.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Counts {
    /// Nodes the longest walk visited, or facets of the longest cut.
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
            roots: lattice.tree().roots(),
            root_size: lattice.tree().root_size(),
            near: near_plane(dem) as f32,
        }
    }
}

impl ChunkUniform {
    /// A chunk with its samples in a tile and its vertices in a block.
    pub fn new(chunk: Chunk, pyramid: &Pyramid, tile: u32, block: u32) -> Self {
        let Chunk { origin, step, coarser } = chunk;
        let SquareBounds { low, high, beyond } = pyramid.relief(origin, step);
        Self { origin, step, coarser, low, high, beyond, tile, block, pad: 0 }
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
    /// [`Error::Setting`] when the eye is farther from the DEM than f32 can count cells.
    pub fn new(dem: &Dem, camera: &Camera) -> Result<Self> {
        let place = dem.grid_place(camera.eye.truncate());
        let eye_cell = place.floor();
        if !camera.eye.is_finite() || eye_cell.abs().max_element() >= f64::from(1 << 22) {
            let [west, south, east, north] = dem.extent();
            let (middle, file) = (DVec2::new(west + east, south + north) / 2.0, dem.georeference().file());
            let near = dem.georeference().place_in(file, middle).unwrap_or(middle);
            return Err(Error::setting(
                Setting::Eye,
                format!("{:.0},{:.0} is more than 4 million cells from the DEM", camera.eye.x, camera.eye.y),
                format!("give an eye in the CRS of the DEM, near its middle at {},{}", near.x, near.y),
            ));
        }
        let offset = (place - eye_cell) * dem.cell() * DVec2::new(1.0, -1.0);
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
            chunks: 0,
            size: [camera.width, camera.height],
            frustum: frustum_words(camera.frustum()),
            origin: [0; 2],
            seen: 0,
            fresh: 0,
        })
    }

    /// The same camera drawing a rectangle of its page alone.
    pub fn cut_to(self, camera: &Camera, rectangle: Rectangle) -> Self {
        let origin = DVec2::from(rectangle.origin.map(f64::from));
        let frustum = camera.frustum_of(origin, origin + DVec2::from(rectangle.size.map(f64::from)));
        let frustum = frustum_words(frustum);
        Self { origin: rectangle.origin.map(|v| v as i32), size: rectangle.size, frustum, ..self }
    }
}

fn frustum_words(frustum: Option<[DVec2; 2]>) -> [f32; 4] {
    frustum.map_or([0.0; 4], |[a, b]| [a.x as f32, a.y as f32, b.x as f32, b.y as f32])
}
