//! What a frame leaves behind for ink: two words a pixel.

use bytemuck::{Pod, Zeroable};
use glam::DVec2;

/// Sub-pixel places are counted in this many steps a pixel.
const PLACE_STEPS: f64 = 64.0;

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Sky, or an underside: bare paper that hides nothing.
    Sky,
    /// Visible surface without ink; it hides what lies behind it.
    Cover,
    /// Ink: an occluding line or the skyline.
    Silhouette,
    /// Ink: the visible border of the DEM or of a void.
    Border,
}

/// One pixel as the GPU packs it, two 32-bit words.
///
/// Word 0: bits 0..2 the [`Kind`] (0 sky, 1 cover, 2 silhouette, 3 border), bits 8..16 and 16..24 the place of the line
/// relative to the pixel's centre, x right and y down, signed, in 1/64 px (0, 0 where the method knows no better).
/// Word 1: the bits of the f32 depth, near / distance along the view axis, larger is nearer, 0 is sky.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Pixel {
    word: u32,
    depth: f32,
}

impl Pixel {
    /// A pixel of this kind at this depth whose line lies `place` px off its centre (rounded to 1/64 px, at most 127/64).
    pub fn new(kind: Kind, place: DVec2, depth: f32) -> Self {
        let byte = |v: f64| u32::from((v * PLACE_STEPS).round().clamp(-128.0, 127.0) as i8 as u8);
        let kind = match kind {
            Kind::Sky => 0,
            Kind::Cover => 1,
            Kind::Silhouette => 2,
            Kind::Border => 3,
        };
        Self { word: kind | byte(place.x) << 8 | byte(place.y) << 16, depth }
    }

    /// What the pixel shows.
    pub fn kind(self) -> Kind {
        match self.word & 3 {
            0 => Kind::Sky,
            1 => Kind::Cover,
            2 => Kind::Silhouette,
            _ => Kind::Border,
        }
    }

    /// Whether the pixel is ink, of either kind.
    pub fn is_ink(self) -> bool {
        self.word & 2 != 0
    }

    /// Where the line runs relative to the pixel's centre, in px, x right, y down.
    pub fn place(self) -> DVec2 {
        let signed = |shift: u32| f64::from((self.word >> shift) as u8 as i8);
        DVec2::new(signed(8), signed(16)) / PLACE_STEPS
    }

    /// Near / distance along the view axis; larger is nearer, 0 is sky.
    pub fn depth(self) -> f32 {
        self.depth
    }

    /// Metres along the view axis, for the near plane's distance in metres; infinite for sky.
    pub fn distance(self, near: f64) -> f64 {
        near / f64::from(self.depth)
    }
}

/// The picture as compose leaves it, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct InkRaster {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height` pixels; `bytemuck::cast_slice` makes them from the words read back.
    pub pixels: Vec<Pixel>,
}

impl InkRaster {
    /// The pixel in this column and row; `None` outside the picture.
    pub fn at(&self, column: i64, row: i64) -> Option<Pixel> {
        let inside = (0..i64::from(self.width)).contains(&column) && (0..i64::from(self.height)).contains(&row);
        inside.then(|| self.pixels[row as usize * self.width as usize + column as usize])
    }
}
