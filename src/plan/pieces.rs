//! Pieces of a page that is too large for one piece.
//!
//! A piece is drawn with a halo, cut at the page's edge: silhouettes, border lines and what compose packs look at the 8
//! neighbours of a pixel, so 1 px makes the piece itself right. A second px makes its neighbours right too, by which
//! [`Marks`](crate::line::Marks) tell whether ink encloses a pixel. Places and rays are those of the whole page, so that
//! no bit depends on the pieces. Does not handle: overlapping work; a facet in two pieces is drawn twice.

use crate::error::{Error, Result, Setting};
use crate::message;

/// Pixels around a piece that are drawn with it.
pub const HALO: u32 = 2;
/// Pixels along the longest page side. Up to there f32 tells 1/256 px everywhere on the page.
pub const LARGEST_PAGE: u32 = 65_536;
/// Pixels of the largest piece: 8 bytes each fill a storage binding of 128 MiB, and lists give 24 bits to a pixel.
pub const LARGEST_PIECE: u64 = 1 << 24;
/// Pixels along the longest side of a piece: passes take a row of workgroups for each of its rows, at most 65 535.
pub const LONGEST_PIECE: u32 = 16_384;
/// Pixels along the pieces of a page that is cut: buffers and readback take 56 bytes for each pixel.
const SIDE: u32 = 2048;

/// A rectangle of a page, pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    /// Column and row of its top left pixel.
    pub origin: [u32; 2],
    /// Pixels across, down.
    pub size: [u32; 2],
}

/// A part of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PagePiece {
    /// What it contributes; the pieces of a page share no pixel.
    pub kept: Rectangle,
    /// What is drawn for that: with the halo, as far as the page goes.
    pub drawn: Rectangle,
}

/// How a page is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pieces {
    page: [u32; 2],
    side: [u32; 2],
}

impl Pieces {
    /// A page of `page` pixels in pieces of at most `side` pixels, halo not counted, both across and down.
    pub fn new(page: [u32; 2], side: [u32; 2]) -> Self {
        Self { page, side: [0, 1].map(|axis| side[axis].clamp(1, page[axis].max(1))) }
    }

    /// Pixels of the page, across and down.
    pub fn page(&self) -> [u32; 2] {
        self.page
    }

    /// Pixels of the largest rectangle that is drawn, across and down.
    pub fn largest(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.page[axis].min(self.side[axis] + 2 * HALO))
    }

    /// The pieces in reading order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = PagePiece> + use<> {
        let Self { page, side } = *self;
        let columns = page[0].div_ceil(side[0]);
        (0..columns * page[1].div_ceil(side[1])).map(move |i| {
            let first = [i % columns * side[0], i / columns * side[1]];
            let end = [0, 1].map(|axis| page[axis].min(first[axis] + side[axis]));
            let low = first.map(|v| v.saturating_sub(HALO));
            let high = [0, 1].map(|axis| page[axis].min(end[axis] + HALO));
            PagePiece { kept: between(first, end), drawn: between(low, high) }
        })
    }

    /// Whether the page can be drawn at all.
    ///
    /// # Errors
    /// [`Error::Limit`] when a side is longer than [`LARGEST_PAGE`].
    pub fn check(&self) -> Result<()> {
        let [width, height] = self.page;
        if width.max(height) <= LARGEST_PAGE {
            return Ok(());
        }
        let holds = format!(" is longer than the {LARGEST_PAGE} pixels a page side holds");
        let what = message![Setting::Size.at(format!("{width}x{height}")), holds];
        Err(Error::limit(what, message!["use a smaller ", Setting::Size]))
    }
}

/// In one piece if the page is small enough.
impl From<[u32; 2]> for Pieces {
    fn from(page: [u32; 2]) -> Self {
        let pixels = u64::from(page[0]) * u64::from(page[1]);
        let is_piece = pixels <= LARGEST_PIECE && page[0].max(page[1]) <= LONGEST_PIECE;
        Self::new(page, if is_piece { page } else { [SIDE; 2] })
    }
}

fn between(low: [u32; 2], high: [u32; 2]) -> Rectangle {
    Rectangle { origin: low, size: [high[0] - low[0], high[1] - low[1]] }
}
