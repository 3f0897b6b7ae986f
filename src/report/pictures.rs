//! The pictures of a report as PNG: masks, truth, and how the two differ.

use std::io;

use crate::error::{Error, Result};
use crate::ink;
use crate::measure::compare::ShownPicture;
use crate::truth::Mask;
use crate::truth::metrics::Measured;

/// Paper, then the inks of agreement, of a missed line, of a spurious one.
pub(crate) const PALETTE: [[u8; 3]; 4] = [[255, 255, 255], [26, 26, 26], [0, 90, 200], [213, 70, 0]];
const AGREED: u8 = 1;
const MISSED: u8 = 2;
const SPURIOUS: u8 = 3;

/// A picture of the report.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// File name.
    pub name: String,
    /// The file.
    pub png: Vec<u8>,
}

/// What a comparison shows, as a file of this name.
///
/// # Errors
/// [`Error::Output`] where PNG cannot hold it.
pub fn of_shown(name: String, shown: ShownPicture<'_>) -> Result<Picture> {
    match shown {
        ShownPicture::Truth(truth) => truth_picture(name, truth),
        ShownPicture::Mask(mask) => mask_picture(name, mask),
        ShownPicture::Difference(mask, measured) => difference_picture(name, mask, measured),
    }
}

/// A mask: 1 bit a pixel.
fn mask_picture(name: String, mask: &Mask) -> Result<Picture> {
    picture(name, |png| ink::write_mask(mask.size, mask.inked.iter().map(|pixel| [pixel.column, pixel.row]), None, png))
}

/// Truth drawn one pixel wide.
fn truth_picture(name: String, truth: &Mask) -> Result<Picture> {
    picture(name, |png| write_palette(truth.size, &painted(truth, |_| AGREED), png))
}

/// Ink within a pixel of truth, truth without ink within a pixel, ink farther from truth, in three inks.
fn difference_picture(name: String, mask: &Mask, measured: &Measured<'_>) -> Result<Picture> {
    let agrees: Vec<bool> = measured.agrees().collect();
    let mut indices = painted(mask, |i| if agrees[i] { AGREED } else { SPURIOUS });
    for (index, missed) in indices.iter_mut().zip(measured.missed().pixels()) {
        *index = if missed { MISSED } else { *index };
    }
    picture(name, |png| write_palette(mask.size, &indices, png))
}

/// The page in indices of the palette; `ink` gives that of the i-th inked pixel.
fn painted(mask: &Mask, ink: impl Fn(usize) -> u8) -> Vec<u8> {
    let mut inks = (0..mask.inked.len()).map(ink);
    let mut index = |inked: bool| if inked { inks.next().unwrap_or(0) } else { 0 };
    mask.pixels().into_iter().map(&mut index).collect()
}

/// 2 bits a pixel.
fn write_palette([width, height]: [u32; 2], indices: &[u8], out: &mut Vec<u8>) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Two);
    encoder.set_palette(PALETTE.concat());
    let four = |four: &[u8]| four.iter().enumerate().fold(0, |byte, (i, index)| byte | index << (6 - 2 * i));
    let rows = indices.chunks(width.max(1) as usize);
    let bytes: Vec<u8> = rows.flat_map(|row| row.chunks(4)).map(four).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

fn picture(name: String, write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> Result<Picture> {
    let mut png = Vec::new();
    match write(&mut png) {
        Ok(()) => Ok(Picture { name, png }),
        Err(why) => Err(Error::output(name.as_ref(), &why)),
    }
}
