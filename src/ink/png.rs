//! A drawing as PNG.
//!
//! Method: a stroke is outlined as one tapered quad a segment with wedges or discs at its joints, all wound the same way,
//! and a layer's outlines are filled at once by the non-zero rule: neither joints nor junctions are painted twice. The
//! page is filled in tiles, at four times its resolution and then averaged, since an anti-aliased fill knows four
//! steps across a pixel only, too few for far lines of half a pixel. Each tile has coordinates of its own, so that pages
//! may be of any size: beyond 32 767 px fills lose their anti-aliasing or are dropped. A row of tiles is a band; some
//! bands at a time are filled and sent on to the file. The opacity of a layer counts once, where strokes cross too.
//!
//! Cost: tiles with ink, about 1 ms each and core; memory for a band a core.

use std::f64::consts::TAU;
use std::io::{self, Write};

use ::png::{PixelDimensions, Unit};
use glam::DVec2;
use rayon::prelude::*;
use tiny_skia::{FillRule, Mask, PathBuilder, Transform};

use super::{Area, Drawing, Layer, Pen, Sheet, Stroke, StrokePoint};

/// Side of a tile, px.
const TILE: u32 = 128;
/// Bytes of a piece of the file: most pages take one.
const CHUNK: usize = 1 << 20;
/// Pixels of the fill across one pixel of the page.
const SCALE: u32 = 4;
/// Turning at a joint up to which a flat wedge is as good as a disc: cos 30 degrees.
const WEDGE_COS: f64 = 0.866;

/// Farthest from a tile that corners of areas are filled from, px: what reaches beyond is a rule, which stays what it is within.
const FAR: f64 = 4096.0;

/// What is filled.
enum Shape {
    Segment(Segment),
    /// In pixels.
    Area(Area),
}

impl Shape {
    /// Its corners towards the top left and the bottom right, px.
    fn bounds(&self) -> [DVec2; 2] {
        match self {
            Self::Segment(Segment { ends: [a, b], half, .. }) => {
                let pad = DVec2::splat(half[0].max(half[1]));
                [a.min(*b) - pad, a.max(*b) + pad]
            }
            Self::Area(Area(rings)) => {
                let places = || rings.iter().flatten().copied();
                [places().reduce(DVec2::min), places().reduce(DVec2::max)].map(Option::unwrap_or_default)
            }
        }
    }
}

/// A segment of a stroke as it is filled.
struct Segment {
    /// Places of both ends, px.
    ends: [DVec2; 2],
    /// Half the pen's width at both ends, px.
    half: [f64; 2],
    /// Unit direction of the next segment; `None` where the stroke ends.
    next: Option<DVec2>,
    /// Whether the stroke begins here.
    first: bool,
}

/// Pixels across and down of a picture with so many for each millimetre of the sheet.
pub fn size(sheet: &Sheet, px_per_mm: f64) -> [u32; 2] {
    (sheet.size * px_per_mm).to_array().map(|px| px.round() as u32)
}

/// Renders the drawing anti-aliased, with so many pixels for each millimetre, and writes it as 8-bit RGB that tells its size in
/// metres.
///
/// Errors are those of the writer, and `InvalidInput` where PNG cannot hold the size (an empty page).
pub fn write_png(drawing: &Drawing, px_per_mm: f64, out: impl Write) -> io::Result<()> {
    let [width, height] = size(&drawing.sheet, px_per_mm);
    let mut encoder = ::png::Encoder::new(out, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_compression(::png::Compression::Fast);
    encoder.set_filter(::png::Filter::Adaptive);
    let per_metre = (px_per_mm * 1000.0).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    drawing.seal.as_ref().map_or(Ok(()), |seal| seal.write_into(&mut encoder))?;
    let layers: Vec<Vec<Shape>> = drawing.layers.iter().map(|layer| shapes(layer, px_per_mm)).collect();
    let columns = width.div_ceil(TILE) as usize;
    let tiles = sort_into_tiles(&layers, columns, height.div_ceil(TILE) as usize);
    let bands: Vec<_> = tiles.chunks(columns.max(1)).enumerate().collect();
    let at_a_time = bands.chunks(rayon::current_num_threads());
    let filled = at_a_time.flat_map(|bands| {
        let fill = |&(row, tiles): &(usize, &[_])| band(drawing, [width, height], &layers, row, tiles);
        bands.par_iter().map(fill).collect::<Vec<_>>()
    });
    stream(encoder, filled)
}

/// Writes an image in pieces of whole rows, from top to bottom.
pub(super) fn stream<W: Write>(
    encoder: ::png::Encoder<'_, W>,
    mut pieces: impl Iterator<Item = Vec<u8>>,
) -> io::Result<()> {
    let mut writer = encoder.write_header().map_err(io_error)?;
    let mut image = writer.stream_writer_with_size(CHUNK).map_err(io_error)?;
    pieces.try_for_each(|piece| image.write_all(&piece))?;
    image.finish().map_err(io_error)?;
    writer.finish().map_err(io_error)
}

/// The writer's own error where there is one, so that "disk full" stays "disk full".
fn io_error(error: ::png::EncodingError) -> io::Error {
    match error {
        ::png::EncodingError::IoError(inner) => inner,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}

/// A row of tiles, three bytes a pixel: each with its shapes as (layer, index), layers in order.
fn band(
    drawing: &Drawing,
    [width, height]: [u32; 2],
    layers: &[Vec<Shape>],
    row: usize,
    tiles: &[Vec<(usize, usize)>],
) -> Vec<u8> {
    let width = width as usize;
    let rows = (height as usize - row * TILE as usize).min(TILE as usize);
    let mut pixels = drawing.paper.0.repeat(width * rows);
    for (column, tile) in tiles.iter().enumerate() {
        let corner = DVec2::new(column as f64, row as f64) * f64::from(TILE);
        for group in tile.chunk_by(|a, b| a.0 == b.0) {
            let layer = group[0].0;
            let coverage = fill(group.iter().map(|&(_, i)| &layers[layer][i]), corner);
            let pen = drawing.layers[layer].pen;
            for (row, coverage) in pixels.chunks_mut(3 * width).zip(coverage.chunks(TILE as usize)) {
                let pixels = row[3 * column * TILE as usize..].chunks_exact_mut(3);
                for (pixel, &coverage) in pixels.zip(coverage).filter(|(_, coverage)| **coverage > 0) {
                    pixel.copy_from_slice(&blend([pixel[0], pixel[1], pixel[2]], pen, coverage));
                }
            }
        }
    }
    pixels
}

/// Which shapes, as (layer, index), touch each tile, layers in order.
fn sort_into_tiles(layers: &[Vec<Shape>], columns: usize, rows: usize) -> Vec<Vec<(usize, usize)>> {
    let mut tiles = vec![Vec::new(); columns * rows];
    let tile = |v: f64| (v / f64::from(TILE)).floor().max(0.0) as usize;
    for (layer, shapes) in layers.iter().enumerate() {
        for (i, shape) in shapes.iter().enumerate() {
            let [low, high] = shape.bounds();
            let (low, high) = (low - 1.0, high + 1.0);
            if high.min_element() < 0.0 {
                continue;
            }
            for row in tile(low.y)..rows.min(tile(high.y) + 1) {
                for column in tile(low.x)..columns.min(tile(high.x) + 1) {
                    tiles[row * columns + column].push((layer, i));
                }
            }
        }
    }
    tiles
}

/// A layer's strokes in pixels, cut into segments; a dot is a segment without length. And its areas.
fn shapes(layer: &Layer, px_per_mm: f64) -> Vec<Shape> {
    let half = layer.pen.width / 2.0;
    let segments = layer.strokes.iter().flat_map(|stroke| stroke_segments(stroke, half, px_per_mm));
    let in_px = |area: &Area| Area(area.0.iter().map(|ring| ring.iter().map(|at| *at * px_per_mm).collect()).collect());
    segments.map(Shape::Segment).chain(layer.areas.iter().map(in_px).map(Shape::Area)).collect()
}

/// The segments of one stroke; those without length are left out, unless the stroke is a dot.
fn stroke_segments(stroke: &Stroke, half: f64, px_per_mm: f64) -> Vec<Segment> {
    let half = half * px_per_mm;
    let in_px = |point: &StrokePoint| StrokePoint { place: point.place * px_per_mm, ..*point };
    let mut points: Vec<StrokePoint> = stroke.points.iter().map(in_px).collect();
    if stroke.closed {
        points.extend(stroke.points.first().map(in_px));
    }
    points.dedup_by(|a, b| a.place == b.place);
    if let [dot] = points[..] {
        points.push(dot);
    }
    let direction = |i: usize| points.get(i + 1).and_then(|b| (b.place - points[i].place).try_normalize());
    let last = points.len().saturating_sub(2);
    (0..points.len().saturating_sub(1))
        .map(|i| Segment {
            ends: [points[i].place, points[i + 1].place],
            half: [points[i].width * half, points[i + 1].width * half],
            next: if i == last && stroke.closed { direction(0) } else { direction(i + 1) },
            first: i == 0 && !stroke.closed,
        })
        .collect()
}

/// How much of each pixel of the tile at `corner` the shapes cover, 0 to 255.
fn fill<'a>(shapes: impl Iterator<Item = &'a Shape>, corner: DVec2) -> Vec<u8> {
    let mut path = PathBuilder::new();
    for shape in shapes {
        match shape {
            Shape::Segment(segment) => outline(segment, corner, &mut path),
            Shape::Area(Area(rings)) => rings.iter().for_each(|ring| border(ring, corner, &mut path)),
        }
    }
    let (Some(path), Some(mut mask)) = (path.finish(), Mask::new(TILE * SCALE, TILE * SCALE)) else {
        return Vec::new();
    };
    let scale = Transform::from_scale(SCALE as f32, SCALE as f32);
    mask.fill_path(&path, FillRule::Winding, true, scale);
    let (side, scale) = (TILE as usize, SCALE as usize);
    let mut coverage = Vec::with_capacity(side * side);
    for rows in mask.data().chunks_exact(side * scale * scale) {
        for column in 0..side {
            let square = (0..scale).flat_map(|r| &rows[r * side * scale + column * scale..][..scale]);
            coverage.push((square.map(|&c| u32::from(c)).sum::<u32>() / (SCALE * SCALE)) as u8);
        }
    }
    coverage
}

/// Adds a segment, its joint to the next one and its caps.
fn outline(segment: &Segment, corner: DVec2, path: &mut PathBuilder) {
    let [a, b] = segment.ends.map(|p| p - corner);
    let [ha, hb] = segment.half;
    let along = (b - a).try_normalize();
    if let Some(n) = along.map(DVec2::perp) {
        polygon(&[a + n * ha, b + n * hb, b - n * hb, a - n * ha], path);
    }
    if segment.first {
        disc(a, ha, path);
    }
    match (along, segment.next) {
        (Some(d), Some(next)) if d.dot(next) > WEDGE_COS => {
            let outer = -d.perp_dot(next).signum() * hb;
            polygon(&[b, b + d.perp() * outer, b + next.perp() * outer], path);
        }
        _ => disc(b, hb, path),
    }
}

/// Adds a disc as a polygon that is nowhere 0.02 px off.
fn disc(centre: DVec2, radius: f64, path: &mut PathBuilder) {
    let sides = ((std::f64::consts::PI / (2.0 * 0.02 / radius.max(0.1)).sqrt()).ceil()).max(8.0);
    let corners: Vec<DVec2> =
        (0..sides as u32).map(|i| centre + DVec2::from_angle(TAU * f64::from(i) / sides) * radius).collect();
    polygon(&corners, path);
}

/// Adds a ring of an area, wound as it is: a hole runs the other way.
fn border(ring: &[DVec2], corner: DVec2, path: &mut PathBuilder) {
    let near = |at: &DVec2| (*at - corner).clamp(DVec2::splat(-FAR), DVec2::splat(FAR));
    ring.iter().map(near).enumerate().for_each(|(i, at)| put(i, at, path));
    path.close();
}

/// Adds a polygon, wound the same way as all others whatever the order of its corners.
fn polygon(corners: &[DVec2], path: &mut PathBuilder) {
    let area: f64 = corners.windows(2).map(|w| (w[0] - corners[0]).perp_dot(w[1] - corners[0])).sum();
    if area < 0.0 {
        corners.iter().rev().enumerate().for_each(|(i, at)| put(i, *at, path));
    } else {
        corners.iter().enumerate().for_each(|(i, at)| put(i, *at, path));
    }
    path.close();
}

/// Adds a corner; the first of a polygon begins it.
fn put(i: usize, at: DVec2, path: &mut PathBuilder) {
    match i {
        0 => path.move_to(at.x as f32, at.y as f32),
        _ => path.line_to(at.x as f32, at.y as f32),
    }
}

/// A colour laid over another with this coverage, 0 to 255.
fn blend(below: [u8; 3], pen: Pen, coverage: u8) -> [u8; 3] {
    let alpha = pen.opacity as f32 * f32::from(coverage) / 255.0;
    let mix = |i: usize| f32::from(below[i]) + (f32::from(pen.colour.0[i]) - f32::from(below[i])) * alpha;
    [0, 1, 2].map(|i| mix(i).round() as u8)
}
