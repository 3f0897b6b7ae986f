//! A flight as seen from above: its way and its views over a hillshade, to be looked at before frames are drawn.
//!
//! The hillshade is that of the drawn world, lit from the north-west 45 degrees high (Lambert), of as many samples as the
//! picture shows. Cones tell where the camera stands in some frames, which way it looks and how wide; a dot is the start.
//! Cost: a look at each pixel. Does not handle: names and numbers.

use std::fmt::Write as _;
use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec2, DVec3};
use tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, PixmapPaint, Stroke, Transform};

use super::Colour;
use crate::dem::Dem;
use crate::error::Result;
use crate::view::Flight;

/// Pixels of the longer side.
const SIDE: f64 = 1200.0;
/// Blank beside land and way, as a share of both.
const MARGIN: f64 = 0.03;
/// Most cones.
const CONES: u32 = 24;
/// Most points of the way.
const POINTS: u32 = 4000;
/// Length of a cone, px.
const CONE: f64 = 60.0;
/// Width of the way, px.
const WIDTH: f64 = 2.5;
/// Where the light comes from: north-west, 45 degrees high.
const LIGHT: DVec3 = DVec3::new(-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2);
/// Colour of way and cones.
const INK: Colour = Colour([192, 57, 43]);
/// How much of the cones covers the land.
const COVER: f64 = 0.25;

/// A flight as seen from above.
pub(crate) struct Preview {
    size: [u32; 2],
    /// Brightness of each pixel, row by row.
    shade: Vec<u8>,
    /// Pixels of the way, from the start.
    way: Vec<DVec2>,
    /// Pixels of the corners of cones, first where the camera stands.
    cones: Vec<[DVec2; 3]>,
}

impl Preview {
    /// Of a flight over a DEM.
    ///
    /// # Errors
    /// As [`Dem::survey`].
    pub(crate) fn of(dem: &Dem, flight: &Flight) -> Result<Self> {
        let count = flight.count();
        let some = |most: u32| {
            let shown = count.min(most);
            (0..shown).map(move |i| (u64::from(i) * u64::from(count - 1) / u64::from((shown - 1).max(1))) as u32)
        };
        let eyes: Vec<DVec2> = some(POINTS).map(|n| flight.camera(n).eye.truncate()).collect();
        let [west, south, east, north] = dem.extent();
        let low = eyes.iter().fold(DVec2::new(west, south), |low, eye| low.min(*eye));
        let high = eyes.iter().fold(DVec2::new(east, north), |high, eye| high.max(*eye));
        let (low, high) = (low - (high - low) * MARGIN, high + (high - low) * MARGIN);
        let px_per_metre = SIDE / (high - low).max_element();
        let size = ((high - low) * px_per_metre).to_array().map(|px| px.round().max(1.0) as u32);
        let place = |world: DVec2| (DVec2::new(world.x, low.y + high.y - world.y) - low) * px_per_metre;
        let cone = |n: u32| {
            let camera = flight.camera(n);
            let eye = place(camera.eye.truncate());
            let end = |side: f64| {
                let azimuth = (camera.azimuth + side * camera.fov / 2.0).to_radians();
                eye + DVec2::new(azimuth.sin(), -azimuth.cos()) * CONE
            };
            [eye, end(-1.0), end(1.0)]
        };
        let mut way: Vec<DVec2> = eyes.iter().map(|eye| place(*eye)).collect();
        if flight.is_closed() {
            way.extend(way.first().copied());
        }
        Ok(Self {
            size,
            shade: shade(dem, size, low, high, px_per_metre)?,
            way,
            cones: some(CONES).map(cone).collect(),
        })
    }

    /// Writes it as a picture.
    ///
    /// # Errors
    /// The writer's.
    pub(crate) fn write_png(&self, out: impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let mut picture = Pixmap::new(width, height).ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        for (pixel, shade) in picture.data_mut().as_chunks_mut::<4>().0.iter_mut().zip(&self.shade) {
            *pixel = [*shade, *shade, *shade, 255];
        }
        let [red, green, blue] = INK.0;
        let mut paint = Paint { anti_alias: true, ..Paint::default() };
        let mut layer = Pixmap::new(width, height).ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        paint.set_color(Color::from_rgba8(red, green, blue, 255));
        for cone in self.cones.iter().filter_map(|cone| path(cone, true)) {
            layer.fill_path(&cone, &paint, FillRule::Winding, Transform::identity(), None);
        }
        let covers = PixmapPaint { opacity: COVER as f32, ..PixmapPaint::default() };
        picture.draw_pixmap(0, 0, layer.as_ref(), &covers, Transform::identity(), None);
        if let Some(way) = path(&self.way, false) {
            let stroke = Stroke { width: WIDTH as f32, ..Stroke::default() };
            picture.stroke_path(&way, &paint, &stroke, Transform::identity(), None);
        }
        let start =
            self.way.first().and_then(|at| PathBuilder::from_circle(at.x as f32, at.y as f32, 2.0 * WIDTH as f32));
        if let Some(start) = start {
            picture.fill_path(&start, &paint, FillRule::Winding, Transform::identity(), None);
        }
        let rgb: Vec<u8> =
            picture.data().as_chunks::<4>().0.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        encode(self.size, ::png::ColorType::Rgb, &rgb, out)
    }

    /// Writes it as vectors over a picture of the land.
    ///
    /// # Errors
    /// The writer's.
    pub(crate) fn write_svg(&self, mut out: impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let mut land = Vec::new();
        encode(self.size, ::png::ColorType::Grayscale, &self.shade, &mut land)?;
        let points = |corners: &[DVec2]| {
            corners.iter().fold(String::new(), |mut text, at| {
                // A string takes all that is written.
                let _ = write!(text, "{:.1},{:.1} ", at.x, at.y);
                text
            })
        };
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">"
        )?;
        let land = STANDARD.encode(land);
        writeln!(out, "<image width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{land}\"/>")?;
        writeln!(out, "<g fill=\"{INK}\" opacity=\"{COVER}\">")?;
        self.cones.iter().try_for_each(|cone| writeln!(out, "<polygon points=\"{}\"/>", points(cone).trim_end()))?;
        let way = points(&self.way);
        writeln!(
            out,
            "</g>\n<polyline points=\"{}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"{WIDTH}\"/>",
            way.trim_end()
        )?;
        if let Some(start) = self.way.first() {
            writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{}\" fill=\"{INK}\"/>",
                start.x,
                start.y,
                2.0 * WIDTH
            )?;
        }
        writeln!(out, "</svg>")?;
        out.flush()
    }
}

/// Brightness of the land at each pixel, white where there is none.
fn shade(dem: &Dem, size: [u32; 2], low: DVec2, high: DVec2, px_per_metre: f64) -> Result<Vec<u8>> {
    let thinned = dem.thinned()?;
    // Between samples as far apart as pixels are, or as samples are.
    let step = (1.0 / px_per_metre / thinned.cell().min_element()).max(1.0);
    let last = DVec2::new((thinned.columns() - 1) as f64, (thinned.rows() - 1) as f64);
    let height = |at: DVec2| {
        let at = at.round();
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmple(last).all();
        inside.then(|| thinned.height(at.x as usize, at.y as usize)).flatten().map(f64::from)
    };
    let bright = |column: u32, row: u32| {
        let world =
            DVec2::new(low.x, high.y) + DVec2::new(f64::from(column) + 0.5, -f64::from(row) - 0.5) / px_per_metre;
        let at = thinned.grid_place(world);
        let middle = height(at)?;
        let beside = |by: DVec2| height(at + by).unwrap_or(middle);
        let run = 2.0 * step * thinned.cell();
        let east = (beside(DVec2::new(step, 0.0)) - beside(DVec2::new(-step, 0.0))) / run.x;
        let north = (beside(DVec2::new(0.0, -step)) - beside(DVec2::new(0.0, step))) / run.y;
        let lit = DVec3::new(-east, -north, 1.0).normalize().dot(LIGHT).max(0.0);
        Some((90.0 + 160.0 * lit).min(250.0) as u8)
    };
    let [width, rows] = size;
    Ok((0..rows)
        .flat_map(|row| (0..width).map(move |column| (column, row)))
        .map(|(c, r)| bright(c, r).unwrap_or(255))
        .collect())
}

fn path(corners: &[DVec2], closed: bool) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let (first, rest) = corners.split_first()?;
    builder.move_to(first.x as f32, first.y as f32);
    rest.iter().for_each(|at| builder.line_to(at.x as f32, at.y as f32));
    if closed {
        builder.close();
    }
    builder.finish()
}

fn encode([width, height]: [u32; 2], colour: ::png::ColorType, pixels: &[u8], out: impl Write) -> io::Result<()> {
    let mut encoder = ::png::Encoder::new(out, width, height);
    encoder.set_color(colour);
    let mut writer = encoder.write_header().map_err(io::Error::other)?;
    writer.write_image_data(pixels).map_err(io::Error::other)?;
    writer.finish().map_err(io::Error::other)
}
