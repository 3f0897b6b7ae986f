//! An animated PNG: of each picture the rectangle that differs from the last one.

use std::io::{self, Write};

use super::picture::Picture;

/// Most parts of a second in which a delay is told.
const PARTS: f64 = 65_535.0;

/// Writes pictures, so many a second, to be shown again and again.
///
/// # Errors
/// The writer's, and those of the pictures.
pub(super) fn write(
    out: &mut dyn Write,
    fps: f64,
    pictures: &mut dyn ExactSizeIterator<Item = io::Result<Picture>>,
) -> io::Result<()> {
    let count = pictures.len() as u32;
    let Some(first) = pictures.next().transpose()? else { return Err(io::ErrorKind::InvalidInput.into()) };
    let mut encoder = ::png::Encoder::new(out, first.size[0], first.size[1]);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_compression(::png::Compression::Fast);
    encoder.set_filter(::png::Filter::Adaptive);
    encoder.set_animated(count, 0).map_err(io_error)?;
    let [numerator, denominator] = delay(fps);
    encoder.set_frame_delay(numerator, denominator).map_err(io_error)?;
    let mut writer = encoder.write_header().map_err(io_error)?;
    writer.write_image_data(&first.rgb).map_err(io_error)?;
    let mut last = first;
    for picture in pictures {
        let picture = picture?;
        let part = picture.changed(&last);
        // A rectangle must lie within the picture at every step between the last one and this one.
        writer.reset_frame_position().map_err(io_error)?;
        writer.set_frame_dimension(part.size[0], part.size[1]).map_err(io_error)?;
        writer.set_frame_position(part.from[0], part.from[1]).map_err(io_error)?;
        writer.write_image_data(&picture.part(part)).map_err(io_error)?;
        last = picture;
    }
    writer.finish().map_err(io_error)
}

/// A picture's time in seconds, as a fraction of what two bytes each hold.
fn delay(fps: f64) -> [u16; 2] {
    let scale = [1000.0, 100.0, 10.0, 1.0].into_iter().find(|scale| fps * scale <= PARTS).unwrap_or(1.0);
    let exact = [1.0, scale].into_iter().find(|scale| (fps * scale).fract() == 0.0).unwrap_or(scale);
    [exact as u16, (fps * exact).round().clamp(1.0, PARTS) as u16]
}

/// The writer's own error where there is one, so that "disk full" stays "disk full".
fn io_error(error: ::png::EncodingError) -> io::Error {
    match error {
        ::png::EncodingError::IoError(inner) => inner,
        other => io::Error::other(other),
    }
}
