//! A picture of a frame, read back; and where two of them differ.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::error::{Error, Result};

/// Red, green and blue of each pixel, row by row.
pub(super) struct Picture {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Part {
    /// Left and top.
    pub from: [u32; 2],
    /// Pixels across and down.
    pub size: [u32; 2],
}

impl Picture {
    /// Reads a PNG of 8-bit RGB.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub(super) fn read(path: &Path) -> Result<Self> {
        let wrong = |what: String| Error::input(path, what, "remove it and draw it anew");
        let file = File::open(path).map_err(|error| wrong(format!("it cannot be read ({error})")))?;
        let broken = |error: ::png::DecodingError| wrong(format!("it is no whole picture ({error})"));
        let mut reader = ::png::Decoder::new(BufReader::new(file)).read_info().map_err(broken)?;
        let mut rgb = vec![0; reader.output_buffer_size().unwrap_or(0)];
        let info = reader.next_frame(&mut rgb).map_err(broken)?;
        if (info.color_type, info.bit_depth) != (::png::ColorType::Rgb, ::png::BitDepth::Eight) {
            return Err(wrong("it is no drawing".to_owned()));
        }
        rgb.truncate(info.buffer_size());
        Ok(Self { size: [info.width, info.height], rgb })
    }

    /// All of it.
    pub(super) fn whole(&self) -> Part {
        Part { from: [0; 2], size: self.size }
    }

    /// The least rectangle that holds all pixels that differ from those of a picture of the same size; one pixel where none
    /// do.
    pub(super) fn changed(&self, other: &Self) -> Part {
        let row = 3 * self.size[0] as usize;
        let rows = self.rgb.chunks_exact(row).zip(other.rgb.chunks_exact(row)).enumerate();
        let (mut low, mut high) = (self.size, [0, 0]);
        for (y, (a, b)) in rows.filter(|(_, (a, b))| a != b) {
            let differs = |x: &usize| a[3 * x..3 * x + 3] != b[3 * x..3 * x + 3];
            let columns = || 0..self.size[0] as usize;
            let (first, last) = (columns().find(differs), columns().rev().find(differs));
            let (first, last) = (first.unwrap_or(0) as u32, last.unwrap_or(0) as u32);
            low = [low[0].min(first), low[1].min(y as u32)];
            high = [high[0].max(last), high[1].max(y as u32)];
        }
        if low[0] > high[0] {
            return Part { from: [0; 2], size: [1; 2] };
        }
        Part { from: low, size: [high[0] - low[0] + 1, high[1] - low[1] + 1] }
    }

    /// The bytes of a rectangle.
    pub(super) fn part(&self, part: Part) -> Vec<u8> {
        let Part { from: [left, top], size: [width, height] } = part;
        let row = |y: u32| {
            let start = 3 * (y as usize * self.size[0] as usize + left as usize);
            &self.rgb[start..start + 3 * width as usize]
        };
        (top..top + height).flat_map(|y| row(y).iter().copied()).collect()
    }
}
