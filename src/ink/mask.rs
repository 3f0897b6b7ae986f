//! The mask: ink as a raster of one bit a pixel, whatever the style.

use std::io::{self, Write};

use super::InkRaster;

/// Writes the mask as PNG, grayscale, 1 bit a pixel, exactly the raster's size: 0 = ink, 255 = paper.
///
/// Errors are those of the writer, and `InvalidInput` where PNG cannot hold the size (an empty picture).
pub fn write_mask(raster: &InkRaster, out: impl Write) -> io::Result<()> {
    let mut encoder = ::png::Encoder::new(out, raster.width, raster.height);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::One);
    let bits: Vec<u8> = raster
        .pixels
        .chunks(raster.width.max(1) as usize)
        .flat_map(|row| row.chunks(8))
        .map(|eight| eight.iter().enumerate().fold(0, |byte, (i, p)| byte | u8::from(!p.is_ink()) << (7 - i)))
        .collect();
    let mut writer = encoder.write_header().map_err(io_error)?;
    writer.write_image_data(&bits).map_err(io_error)?;
    writer.finish().map_err(io_error)
}

/// The writer's own error where there is one, so that "disk full" stays "disk full".
fn io_error(error: ::png::EncodingError) -> io::Error {
    match error {
        ::png::EncodingError::IoError(inner) => inner,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}
