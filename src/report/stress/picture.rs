//! The picture of a view: land, the ink of the walk beside truth, and rings about the places where promises are measured worst.

use std::io;

use crate::error::{Error, Result};
use crate::report::pictures::{PALETTE, Picture};
use crate::stress::Promise;
use crate::stress::figures::{ViewFigures, Worst};

/// Sky, then land, the three inks of differences, and rings of accuracy and of what moves.
const COLOURS: [[u8; 3]; 7] =
    [[255; 3], [238, 231, 217], PALETTE[1], PALETTE[2], PALETTE[3], [200, 0, 140], [0, 128, 72]];
const LAND: u8 = 1;
const AGREED: u8 = 2;
const MISSED: u8 = 3;
const ASTRAY: u8 = 4;
const OF_ACCURACY: u8 = 5;
const OF_MOVES: u8 = 6;
/// Radius of rings, px.
const RING: f64 = 10.0;
/// Pixels across below which a picture is enlarged.
const LEAST: u32 = 64;

/// Draws it, pages of a few pixels enlarged.
///
/// # Errors
/// [`Error::Output`] where PNG cannot hold it.
pub(crate) fn picture(view: &ViewFigures) -> Result<Picture> {
    let [width, height] = [view.width, view.height];
    let times = LEAST.div_ceil(width.max(1)).max(1);
    let page = painted(view);
    let mut png = Vec::new();
    let large = |row: u32| (0..width * times).map(move |column| (row / times * width + column / times) as usize);
    let indices: Vec<u8> = (0..height * times).flat_map(large).map(|at| page[at]).collect();
    match write(&mut png, [width * times, height * times], &indices) {
        Ok(()) => Ok(Picture { name: view.picture.clone(), png }),
        Err(why) => Err(Error::output(view.picture.as_ref(), &why)),
    }
}

/// The page in indices of the colours.
fn painted(view: &ViewFigures) -> Vec<u8> {
    let (seen, width) = (&view.seen, view.width);
    let mut page = vec![0; width as usize * view.height as usize];
    page.iter_mut().zip(&seen.land).for_each(|(index, land)| *index = if *land { LAND } else { 0 });
    let mut paint = |places: &[[u32; 2]], ink: u8| {
        places.iter().for_each(|[column, row]| page[(row * width + column) as usize] = ink);
    };
    let inked: Vec<[u32; 2]> = seen.ink.iter().flat_map(|mask| &mask.inked).map(|p| [p.column, p.row]).collect();
    paint(&inked, AGREED);
    paint(&seen.missed, MISSED);
    paint(&seen.astray, ASTRAY);
    for worst in &view.worst {
        let of_accuracy = matches!(worst.promise, Promise::Accurate | Promise::NoFlood | Promise::Watertight);
        paint(&ring(worst, [width, view.height]), if of_accuracy { OF_ACCURACY } else { OF_MOVES });
    }
    page
}

/// The pixels of a ring about a place.
fn ring(worst: &Worst, size: [u32; 2]) -> Vec<[u32; 2]> {
    let span = |at: f64, size: u32| {
        let to = |place: f64| place.clamp(0.0, f64::from(size)) as u32;
        to((at - RING - 1.0).floor())..to((at + RING + 2.0).ceil())
    };
    let [x, y] = worst.at_px;
    let off = |column: u32, row: u32| (f64::from(column) + 0.5 - x).hypot(f64::from(row) + 0.5 - y);
    let on = |[column, row]: &[u32; 2]| (off(*column, *row) - RING).abs() <= 0.7;
    span(y, size[1]).flat_map(|row| span(x, size[0]).map(move |column| [column, row])).filter(on).collect()
}

fn write(out: &mut Vec<u8>, [width, height]: [u32; 2], indices: &[u8]) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(COLOURS.concat());
    let mut writer = encoder.write_header()?;
    writer.write_image_data(indices)?;
    Ok(writer.finish()?)
}
