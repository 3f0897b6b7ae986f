//! Pictures of drawings by us and by others, and how they are compared.

use hachure::ink::{Drawing, write_pdf, write_png, write_svg};
use image::RgbImage;
use resvg::{tiny_skia, usvg};

use super::strangers::Poppler;
use crate::tolerances::{DARK, NEARLY_DARK, POPPLER_DARKNESS, RESVG_DARKNESS, STRANGER_BLOCK_PX};

pub fn png(drawing: &Drawing, px_per_mm: f64) -> RgbImage {
    let mut file = Vec::new();
    write_png(drawing, px_per_mm, &mut file).expect("a PNG");
    image::load_from_memory(&file).expect("a picture").to_rgb8()
}

pub fn svg(drawing: &Drawing) -> Vec<u8> {
    let mut file = Vec::new();
    write_svg(drawing, &mut file).expect("an SVG");
    file
}

pub fn pdf(drawing: &Drawing) -> Vec<u8> {
    let mut file = Vec::new();
    write_pdf(drawing, &mut file).expect("a PDF");
    file
}

/// What resvg sees, on white.
pub fn seen_in_svg(file: &[u8], [width, height]: [u32; 2]) -> RgbImage {
    let tree = usvg::Tree::from_data(file, &usvg::Options::default()).expect("an SVG");
    let mut pixels = tiny_skia::Pixmap::new(width, height).expect("a size");
    pixels.fill(tiny_skia::Color::WHITE);
    let size = tree.size();
    let scale = tiny_skia::Transform::from_scale(width as f32 / size.width(), height as f32 / size.height());
    resvg::render(&tree, scale, &mut pixels.as_mut());
    let rgb = pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
    RgbImage::from_vec(width, height, rgb.collect()).expect("all pixels")
}

/// Darkest of the channels, 255 is black.
fn darkness(picture: &RgbImage, [x, y]: [u32; 2]) -> u8 {
    255 - picture.get_pixel(x, y).0.into_iter().min().unwrap_or(255)
}

/// Where and how two pictures differ by more than two rasterisers do, of which one makes blocks so much darker or lighter.
pub fn difference(a: &RgbImage, b: &RgbImage, darkness: f64) -> Option<String> {
    if a.dimensions() != b.dimensions() {
        return Some(format!("{:?} and {:?} px", a.dimensions(), b.dimensions()));
    }
    let (block, by) = farthest_block(a, b);
    let lone = lone_dark(a, b).or_else(|| lone_dark(b, a));
    let block = (by > darkness).then(|| format!("block at {block:?}: {by:.1} darker or lighter"));
    block.or_else(|| lone.map(|place| format!("dark at {place:?} in one, light around it in the other")))
}

/// The block, by its corner, whose mean differs most in a channel, and by how much of 255.
pub fn farthest_block(a: &RgbImage, b: &RgbImage) -> ([u32; 2], f64) {
    let (width, height) = a.dimensions();
    let corners =
        (0..height).step_by(STRANGER_BLOCK_PX).flat_map(|y| (0..width).step_by(STRANGER_BLOCK_PX).map(move |x| [x, y]));
    let difference = |[left, top]: [u32; 2]| {
        let rows = top..height.min(top + STRANGER_BLOCK_PX as u32);
        let pixels = rows.flat_map(|y| (left..width.min(left + STRANGER_BLOCK_PX as u32)).map(move |x| (x, y)));
        let sum = |channel: usize| {
            let value = |picture: &RgbImage, (x, y)| f64::from(picture.get_pixel(x, y).0[channel]);
            pixels.clone().map(|at| value(a, at) - value(b, at)).sum::<f64>()
        };
        let most = [0, 1, 2].map(sum).into_iter().map(f64::abs).fold(0.0, f64::max);
        most / pixels.clone().count() as f64
    };
    let differences = corners.map(|corner| (corner, difference(corner)));
    differences.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a picture of at least one pixel")
}

/// A dark pixel of one picture that has not even a nearly dark one about it in the other.
fn lone_dark(a: &RgbImage, b: &RgbImage) -> Option<[u32; 2]> {
    let (width, height) = a.dimensions();
    let answered = |[x, y]: [u32; 2]| {
        let rows = y.saturating_sub(1)..height.min(y + 2);
        let mut around = rows.flat_map(|y| (x.saturating_sub(1)..width.min(x + 2)).map(move |x| [x, y]));
        around.any(|near| darkness(b, near) >= NEARLY_DARK)
    };
    let mut pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels.find(|&at| darkness(a, at) >= DARK && !answered(at))
}

/// A drawing in the eyes of a stranger.
pub struct Seen {
    pub who: &'static str,
    pub picture: RgbImage,
    /// How far blocks may be off in them, of 255.
    pub darkness: f64,
}

/// What resvg and, if it is here, poppler see of a drawing.
pub fn seen(drawing: &Drawing, px_per_mm: f64, poppler: Option<&Poppler>) -> Vec<Seen> {
    let size = hachure::door::ink::png::size(&drawing.sheet, px_per_mm);
    let picture = seen_in_svg(&svg(drawing), size);
    let by_resvg = Seen { who: "resvg", picture, darkness: RESVG_DARKNESS };
    let picture = poppler.map(|poppler| poppler.picture(&pdf(drawing), px_per_mm, size));
    let by_poppler = picture.map(|picture| Seen { who: "poppler", picture, darkness: POPPLER_DARKNESS });
    [by_resvg].into_iter().chain(by_poppler).collect()
}
