//! The mask: ink as a raster of one bit a pixel, whatever the style.

use std::io::{self, Write};

use super::Seal;
use super::png::stream;

/// Writes the mask of a page of so many pixels across and down as PNG, grayscale, 1 bit a pixel, exactly the page's size:
/// 0 = ink, 255 = paper. `inked` gives column and row of the pixels of ink, in reading order. One row after the other,
/// none is kept. The file tells what made it where there is a seal.
///
/// Errors are those of the writer, and `InvalidInput` where PNG cannot hold the size (an empty page).
pub fn write_mask(
    [width, height]: [u32; 2],
    inked: impl IntoIterator<Item = [u32; 2]>,
    seal: Option<&Seal>,
    out: impl Write,
) -> io::Result<()> {
    let mut encoder = ::png::Encoder::new(out, width, height);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::One);
    seal.map_or(Ok(()), |seal| seal.write_into(&mut encoder))?;
    let mut paper = vec![0xff; width.div_ceil(8) as usize];
    if let Some(last) = paper.last_mut() {
        // Bits beyond the page are 0.
        *last <<= (8 - width % 8) % 8;
    }
    let mut inked = inked.into_iter().peekable();
    let rows = (0..height).map(|row| {
        let mut bits = paper.clone();
        while let Some([column, _]) = inked.next_if(|pixel| pixel[1] == row) {
            bits[(column / 8) as usize] &= !(0x80 >> (column % 8));
        }
        bits
    });
    stream(encoder, rows)
}
