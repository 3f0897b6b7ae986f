//! The mask: ink as a raster of one bit a pixel, whatever the style.

use std::io::{self, Write};

use super::png::stream;
use super::{Mark, Marks};

/// Writes the mask as PNG, grayscale, 1 bit a pixel, exactly the page's size: 0 = ink, 255 = paper. One row after the
/// other, none is kept.
///
/// Errors are those of the writer, and `InvalidInput` where PNG cannot hold the size (an empty page).
pub fn write_mask(marks: &Marks, out: impl Write) -> io::Result<()> {
    let mut encoder = ::png::Encoder::new(out, marks.width, marks.height);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::One);
    let mut paper = vec![0xff; marks.width.div_ceil(8) as usize];
    if let Some(last) = paper.last_mut() {
        // Bits beyond the page are 0.
        *last <<= (8 - marks.width % 8) % 8;
    }
    let rows = (0..i64::from(marks.height)).map(|row| {
        let mut bits = paper.clone();
        for Mark { column, .. } in marks.row(row).iter().filter(|mark| mark.pixel.is_ink()) {
            bits[(column / 8) as usize] &= !(0x80 >> (column % 8));
        }
        bits
    });
    stream(encoder, rows)
}
