//! The shader of every pass: the files of `shaders/` that it is composed of, constants of its own, and how many invocations
//! it takes. What each computes stands at the head of its own file there.

use std::borrow::Cow;

use super::pass::Pass;
use super::sizes::BLOCK;
use crate::error::{Error, Result};
use crate::plan::{PassName, Visibility};
use crate::shader;
use crate::surface::lattice::{CHUNK_FACETS, CHUNK_QUADS, CHUNK_SIDE, CHUNK_WORDS};

/// Facets of a column of eight quads, over which one invocation of `rasterize` goes.
pub const STRIP_FACETS: u32 = 16;
/// An empty list of pixels: workgroups of the pass that reads it along x, y and z, and the count.
pub(crate) const NO_PIXELS: [u32; 4] = [0, 1, 1, 0];
/// An empty queue of `rasterize_large`: workgroups along x, one row of them along y for each share of the largest facet, z, and
/// the count.
pub(crate) const EMPTY_QUEUE: [u32; 4] = [0, 1, 1, 0];
/// Constants that a pass alone sets: these three stand on the sources of `walk`, but leave nothing to another pass.
pub const OWN_CONSTANTS: [(PassName, (&str, f64)); 3] =
    [(PassName::WalkRest, ("defers", 0.0)), (PassName::Lay, ("defers", 0.0)), (PassName::Sight, ("defers", 0.0))];

/// The composed shader of a pass over a raster that keeps what `visibility` says, in frames whose vertices are all at hand,
/// or those of one batch at a time.
pub fn source(pass: PassName, visibility: Visibility, keeps_vertices: bool) -> Cow<'static, str> {
    let walk = || {
        let walk = shader!("scene", "lattice", "surface", "wide", "ink", "list", "levels", "walk_between", "walk");
        [walk, if keeps_vertices { shader!("vertex_kept") } else { shader!("vertex_anew") }].concat()
    };
    // What goes over the list of segments stands on `walk`, and on what curves are made of.
    let curves = |own: &str| Cow::from([&walk(), shader!("cull", "curve", "tally", "segment"), own].concat());
    match pass {
        PassName::Tessellate => shader!("scene", "lattice", "surface", "cull", "tessellate").into(),
        PassName::Seam => shader!("scene", "seam").into(),
        PassName::Facing => shader!("scene", "lattice", "surface", "cull", "vertex", "facing").into(),
        PassName::Project => shader!("scene", "lattice", "surface", "cull", "project").into(),
        PassName::Rasterize => {
            [shader!("scene", "lattice"), kept(visibility), shader!("triangle", "cull", "rasterize")].concat().into()
        }
        PassName::RasterizeLarge => {
            let before = shader!("scene", "lattice", "surface", "wide");
            [before, kept(visibility), shader!("triangle", "rasterize_large")].concat().into()
        }
        PassName::Candidates => shader!("scene", "lattice", "list", "candidates").into(),
        PassName::Pairs => shader!("scene", "lattice", "list", "pairs").into(),
        PassName::Walk => walk().into(),
        PassName::WalkRest => [&walk(), shader!("section", "walk_rest")].concat().into(),
        PassName::TowardAway => shader!("scene", "ink", "toward_away").into(),
        PassName::Adjacency => shader!("scene", "lattice", "ink", "adjacency").into(),
        PassName::Border => shader!("scene", "lattice", "surface", "ink", "border", "rim").into(),
        PassName::Turning => shader!("scene", "lattice", "cull", "curve", "turning").into(),
        PassName::Wanted => shader!("scene", "lattice", "surface", "cull", "curve", "tally", "wanted").into(),
        PassName::Turn => shader!("scene", "lattice", "surface", "cull", "curve", "vertex", "turn").into(),
        PassName::Meet => shader!("scene", "lattice", "curve", "meet").into(),
        PassName::Crossed => shader!("scene", "lattice", "curve", "tally", "crossed").into(),
        PassName::Segments => curves(shader!("segments")),
        PassName::RimSegments => curves(shader!("rim_segments", "rim")),
        PassName::Lay => curves(shader!("section", "lay")),
        PassName::Sight => curves(shader!("sight")),
        PassName::Compose => shader!("scene", "ink", "compose").into(),
    }
}

/// What a pixel of the raster keeps of the facets that cover it.
fn kept(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Key64 => shader!("emit_u64"),
        Visibility::Key32 => shader!("emit_u32"),
        Visibility::TwoDepths => shader!("emit_two_depths"),
    }
}

/// Over how much a pass goes in a frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Amounts {
    /// Chunks.
    pub chunks: u32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Patch edges of the rim.
    pub rim_edges: u64,
    /// Points of lines on the land.
    pub laid: u64,
    /// Facets through which contours run, as many as there is room for.
    pub crossed: u64,
    /// Segments of curves, as many as there is room for.
    pub segments: u64,
}

/// Invocations of a pass along x and y; for most along y one row a chunk.
///
/// # Errors
/// [`Error::Mistake`] for a pass that goes over a list, which the device counts.
pub(crate) fn invocations(name: PassName, pass: &Pass, amounts: Amounts) -> Result<[u32; 2]> {
    let Amounts { chunks, size: [width, height], rim_edges, laid, crossed, segments } = amounts;
    Ok(match name {
        // At most 16 blocks of vertices.
        PassName::Tessellate => [16, chunks],
        // A vertex that may move, half of those on four sides.
        PassName::Seam => [2 * CHUNK_QUADS, chunks],
        // A word of 32 facets.
        PassName::Facing => [CHUNK_WORDS, chunks],
        PassName::Project => [32, chunks],
        // A column of eight quads.
        PassName::Rasterize => [CHUNK_FACETS / STRIP_FACETS, chunks],
        // A vertex of a side.
        PassName::Meet => [4 * CHUNK_QUADS, chunks],
        // A row of quads.
        PassName::Crossed => [CHUNK_QUADS, chunks],
        // A column of vertices.
        PassName::Turn => [CHUNK_SIDE, chunks],
        PassName::Turning | PassName::Wanted => pass.folded(chunks.into()),
        PassName::Candidates | PassName::TowardAway => [width.div_ceil(BLOCK[0]), height.div_ceil(BLOCK[1])],
        PassName::Adjacency | PassName::Compose => [width, height],
        PassName::Border | PassName::RimSegments => pass.folded(rim_edges),
        PassName::Lay => pass.folded(laid),
        PassName::Segments => pass.folded(crossed),
        PassName::Sight => pass.folded(segments),
        PassName::RasterizeLarge | PassName::Pairs | PassName::Walk | PassName::WalkRest => {
            return Err(Error::mistake(format!("pass {} goes over a list", name.name())));
        }
    })
}
