//! A GIF: of each picture the rectangle that differs from the last one, in 255 colours made of the inks.
//!
//! Colours are the way from the paper to each ink in equal steps; each pixel takes the nearest. A clock of hundredths of a
//! second cannot tell 24 or 30 pictures a second: delays are dithered, so that the whole lasts as long as it should.

use std::io::{self, Write};

use gif::{Encoder, Frame, Repeat};
use rustc_hash::FxHashMap;

use super::Inks;
use super::picture::Picture;

/// Colours; one more is left for what has not changed.
const COLOURS: usize = 255;
/// Ticks of the clock in a second.
const TICKS: f64 = 100.0;

/// Writes pictures, so many a second, to be shown again and again.
///
/// # Errors
/// The writer's, and those of the pictures.
pub(super) fn write(
    out: &mut dyn Write,
    fps: f64,
    inks: &Inks,
    pictures: &mut dyn ExactSizeIterator<Item = io::Result<Picture>>,
) -> io::Result<()> {
    let Some(first) = pictures.next().transpose()? else { return Err(io::ErrorKind::InvalidInput.into()) };
    let side = |px: u32| {
        u16::try_from(px).map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "a GIF is at most 65535 pixels long"))
    };
    let [width, height] = [side(first.size[0])?, side(first.size[1])?];
    let mut palette = Palette::of(inks);
    let mut encoder = Encoder::new(out, width, height, &palette.colours.concat()).map_err(io_error)?;
    encoder.set_repeat(Repeat::Infinite).map_err(io_error)?;
    let mut last: Option<Picture> = None;
    for (number, picture) in (0..).zip(std::iter::once(Ok(first)).chain(pictures)) {
        let picture = picture?;
        let part = last.as_ref().map_or(picture.whole(), |last| picture.changed(last));
        let same = last.as_ref().map(|last| last.part(part));
        let mut frame = Frame {
            left: part.from[0] as u16,
            top: part.from[1] as u16,
            width: part.size[0] as u16,
            height: part.size[1] as u16,
            delay: delay(number, fps),
            transparent: same.is_some().then_some(COLOURS as u8),
            buffer: palette.indices(&picture.part(part), same.as_deref()).into(),
            ..Frame::default()
        };
        frame.make_lzw_pre_encoded();
        encoder.write_lzw_pre_encoded_frame(&frame).map_err(io_error)?;
        last = Some(picture);
    }
    Ok(())
}

/// Ticks that a picture is shown: until the one after it is due, to the nearest tick.
fn delay(number: u32, fps: f64) -> u16 {
    let due = |number: f64| (number * TICKS / fps).round();
    (due(f64::from(number) + 1.0) - due(f64::from(number))) as u16
}

/// Colours, and which of them is nearest to those met so far.
struct Palette {
    colours: Vec<[u8; 3]>,
    known: FxHashMap<[u8; 3], u8>,
}

impl Palette {
    fn of(Inks(inks): &Inks) -> Self {
        let paper = inks.first().map_or([255; 3], |paper| paper.0);
        let pens: Vec<[u8; 3]> = inks.iter().skip(1).take(COLOURS - 1).map(|ink| ink.0).collect();
        let steps = (COLOURS - 1) / pens.len().max(1);
        let mix = |pen: [u8; 3], step: usize| {
            let share = (step + 1) as f64 / steps as f64;
            [0, 1, 2].map(|i| (f64::from(paper[i]) + share * (f64::from(pen[i]) - f64::from(paper[i]))).round() as u8)
        };
        let ramps = pens.iter().flat_map(|pen| (0..steps).map(move |step| mix(*pen, step)));
        let mut colours: Vec<[u8; 3]> = std::iter::once(paper).chain(ramps).collect();
        // The last one is never shown.
        colours.resize(COLOURS + 1, paper);
        Self { colours, known: FxHashMap::default() }
    }

    /// Of each pixel the nearest colour; the last one where it is as it was.
    fn indices(&mut self, rgb: &[u8], same: Option<&[u8]>) -> Vec<u8> {
        let pixels = rgb.as_chunks::<3>().0;
        let mut indices: Vec<u8> = pixels.iter().map(|pixel| self.nearest(*pixel)).collect();
        for (index, (pixel, before)) in
            indices.iter_mut().zip(pixels.iter().zip(same.unwrap_or_default().as_chunks::<3>().0))
        {
            if pixel == before {
                *index = COLOURS as u8;
            }
        }
        indices
    }

    fn nearest(&mut self, pixel: [u8; 3]) -> u8 {
        let Self { colours, known } = self;
        *known.entry(pixel).or_insert_with(|| {
            let away = |colour: &[u8; 3]| {
                let apart = |i: usize| (i32::from(colour[i]) - i32::from(pixel[i])).pow(2);
                apart(0) + apart(1) + apart(2)
            };
            let nearest = (0..COLOURS).min_by_key(|i| away(&colours[*i]));
            nearest.unwrap_or(0) as u8
        })
    }
}

fn io_error(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(inner) => inner,
        other => io::Error::other(other),
    }
}
