//! How large each buffer is: numbers alone, so that limits are known before anything is allocated.

use super::capacity::Capacity;
use super::uniforms::{ChunkUniform, Counts, Segment};
use crate::error::{Error, Message, Result, Setting};
use crate::message;
use crate::plan::batches::{BATCH_CHUNKS, PART_CHUNKS};
use crate::plan::pieces::{LARGEST_PIECE, LONGEST_PIECE};
use crate::surface::lattice::{CHUNK_FACETS, CHUNK_VERTICES, CHUNK_WORDS};
use crate::surface::rim::RimEdge;
use crate::surface::tile::TILE_SAMPLES;

/// The largest storage binding every WebGPU device grants, in bytes.
pub const LARGEST_BINDING: u64 = 128 << 20;
/// Bytes of a vertex on the surface, and of one on the page.
pub(crate) const VERTEX_BYTES: u64 = 16;
/// Bytes of a chunk as shaders read it.
pub(crate) const CHUNK_BYTES: u64 = size_of::<ChunkUniform>() as u64;
/// Bytes of a pixel: depth and ID, or two depths.
pub(crate) const PIXEL_BYTES: u64 = 8;
/// Bytes of a word: the ink of a pixel, an item of a list, 32 facing bits, the summary of a chunk, a height.
pub(crate) const WORD_BYTES: u64 = 4;
/// Bytes of a segment of a curve.
pub(crate) const SEGMENT_BYTES: u64 = size_of::<Segment>() as u64;
/// Bytes of an edge of the rim.
pub const RIM_EDGE_BYTES: u64 = size_of::<RimEdge>() as u64;
/// Pixels across and down that one invocation of `candidates` or `toward_away` works off.
pub const BLOCK: [u32; 2] = [4, 8];
/// Bytes of a list before its items: workgroups along x, y and z, and the count.
pub const LIST_HEADER: u64 = 16;
/// Bytes of a tile's samples, of one kind.
pub(crate) const TILE_BYTES: u64 = TILE_SAMPLES as u64 * WORD_BYTES;
/// The parts of the facing bits.
pub(crate) const FACING: [&str; 2] = ["facing_0", "facing_1"];

/// Whether a page can be drawn in one piece.
///
/// # Errors
/// [`Error::Limit`] when it is larger than a binding or a dispatch.
pub fn page_fits([width, height]: [u32; 2]) -> Result<()> {
    let pixels = u64::from(width) * u64::from(height);
    let refused = |what: String| Err(Error::limit(what, message!["use a smaller ", Setting::Size]));
    if width.max(height) > LONGEST_PIECE {
        return refused(format!(
            "{width}x{height} is longer than the {LONGEST_PIECE} pixels that are drawn in one piece"
        ));
    }
    if pixels > LARGEST_PIECE {
        return refused(format!("{width}x{height} are {pixels} pixels, {LARGEST_PIECE} are drawn in one piece"));
    }
    Ok(())
}

/// Name and bytes of every buffer of a scene that frames write or fill, with room for so much.
pub fn of_scene(capacity: Capacity) -> Vec<(&'static str, u64)> {
    let chunks = u64::from(capacity.chunks);
    let batch = chunks.min(u64::from(BATCH_CHUNKS));
    let [tiles, patched] = [capacity.tiles, capacity.patched].map(|tiles| tiles as u64 * TILE_BYTES);
    let part = u64::from(PART_CHUNKS);
    let facing = (0..).map(|i| chunks.saturating_sub(i * part).min(part) * u64::from(CHUNK_WORDS) * 4);
    let mut sizes: Vec<_> = FACING.into_iter().zip(facing).collect();
    sizes.extend([
        ("chunks", chunks * CHUNK_BYTES),
        ("nodes", capacity.nodes as u64 * 4),
        ("heights", tiles),
        ("gradients_east", patched),
        ("gradients_north", patched),
        ("summaries", chunks * 4),
        ("fresh", chunks * WORD_BYTES),
        ("places", batch * u64::from(CHUNK_VERTICES) * VERTEX_BYTES),
        ("screens", batch * u64::from(CHUNK_VERTICES) * VERTEX_BYTES),
        ("queue", LIST_HEADER + batch * u64::from(CHUNK_FACETS) * 4),
    ]);
    sizes
}

/// Name and bytes of every buffer that frames write for a piece of a page.
///
/// # Errors
/// As [`page_fits`].
pub fn of_page([width, height]: [u32; 2]) -> Result<Vec<(&'static str, u64)>> {
    page_fits([width, height])?;
    let pixels = u64::from(width) * u64::from(height);
    Ok(vec![
        ("pixels", pixels * PIXEL_BYTES),
        ("touched", pixels * WORD_BYTES),
        ("ink", pixels * WORD_BYTES),
        ("candidates", LIST_HEADER + pixels * 4),
        ("pairs", LIST_HEADER + pixels * 4),
        ("rest", LIST_HEADER + pixels * 4),
        ("page", pixels * 8),
        ("counts", size_of::<Counts>() as u64),
    ])
}

/// Whether a rim of so many edges can be bound whole.
///
/// # Errors
/// [`Error::Limit`] when it cannot.
pub fn rim_fits(edges: u64) -> Result<()> {
    binds(edges * RIM_EDGE_BYTES, "border lines", message!["use ", Setting::Border.at("off"), ", or a ", Setting::Crop])
}

/// Whether so many words that tell voids from samples can be bound whole.
///
/// # Errors
/// [`Error::Limit`] when they cannot.
pub fn valid_fits(words: u64) -> Result<()> {
    binds(words * WORD_BYTES, "void marks", message!["use a ", Setting::Crop])
}

/// Whether a storage buffer can be bound whole.
///
/// # Errors
/// [`Error::Limit`] when it cannot.
pub fn fits(name: &str, size: u64) -> Result<()> {
    let remedy = message![
        "use ",
        Setting::Level.at("auto"),
        " or a ",
        Setting::Crop,
        "; with ",
        Setting::Level.at("auto"),
        " a larger ",
        Setting::ErrorPx,
        " too"
    ];
    binds(size, name, remedy)
}

fn binds(size: u64, of: &str, remedy: Message) -> Result<()> {
    if size <= LARGEST_BINDING {
        return Ok(());
    }
    let [needed, most] = [size.div_ceil(1 << 20), LARGEST_BINDING >> 20];
    Err(Error::limit(format!("this DEM needs {needed} MiB of {of}, a device binds {most}"), remedy))
}
