//! Whether every number of a frame is one: neither NaN nor infinity in what passes leave on the device, in chains, in strokes.
//!
//! Method: after a frame with curves each buffer of f32 is read back whole, of pixels and segments the words that are f32; of the
//! page's lines every place, depth and width. Words that nothing wrote are 0. Cost: a look at each number.

use crate::error::Result;
use crate::gpu::uniforms::{Segment, Tally};
use crate::ink::{Drawing, StrokePoint};
use crate::line::{Chain, ChainPoint};
use crate::render::Renderer;

/// Buffers that hold f32 and nothing else.
const FLOATS: [&str; 6] = ["places", "heights", "gradients_east", "gradients_north", "sides", "turns"];

/// How many numbers were looked at, and what is none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Counted {
    /// Numbers.
    pub numbers: usize,
    /// NaN and infinities.
    pub bad: usize,
    /// Where they are: names with counts.
    pub places: Vec<String>,
}

impl Counted {
    /// Looks at numbers that stand there.
    pub fn look(&mut self, name: &str, numbers: impl Iterator<Item = f64>) {
        let mut bad = 0;
        for number in numbers {
            self.numbers += 1;
            bad += usize::from(!number.is_finite());
        }
        self.bad += bad;
        self.places.extend((bad > 0).then(|| format!("{name} {bad}")));
    }

    /// What was counted, in words.
    pub fn words(&self) -> String {
        let at = if self.places.is_empty() { String::new() } else { format!(" in {}", self.places.join(", ")) };
        format!("{} of {} numbers{at}", self.bad, self.numbers)
    }

    /// Looks at what the passes of a frame with curves left on the device.
    ///
    /// # Errors
    /// As [`Gpu::read`](crate::gpu::Gpu::read).
    pub fn buffers(&mut self, renderer: &Renderer) -> Result<()> {
        let (on_device, gpu) = (renderer.on_device(), renderer.gpu());
        for name in FLOATS {
            let buffer = on_device.buffer(name)?;
            let numbers: Vec<f32> = gpu.read(buffer, (buffer.size() / 4) as usize)?;
            self.look(name, numbers.into_iter().map(f64::from));
        }
        let pixels = on_device.buffer("pixels")?;
        let pixels: Vec<[u32; 2]> = gpu.read(pixels, (pixels.size() / 8) as usize)?;
        self.look("pixels", pixels.into_iter().map(|[_, depth]| f32::from_bits(depth).into()));
        let tally: Vec<Tally> = gpu.read(on_device.buffer("tally")?, 1)?;
        let found = tally.first().map_or(0, |tally| tally.segments);
        let segments: Vec<Segment> = gpu.read(on_device.buffer("segments")?, found as usize)?;
        self.look("segments", segments.iter().flat_map(of_segment).map(f64::from));
        Ok(())
    }

    /// Looks at chains.
    pub fn chains(&mut self, chains: &[Chain]) {
        self.look("chains", chains.iter().flat_map(|chain| &chain.points).flat_map(of_point));
    }

    /// Looks at strokes.
    pub fn strokes(&mut self, drawing: &Drawing) {
        let strokes = drawing.layers.iter().flat_map(|layer| &layer.strokes);
        let of_point = |point: &StrokePoint| [point.place.x, point.place.y, point.width];
        self.look("strokes", strokes.flat_map(|stroke| &stroke.points).flat_map(of_point));
    }
}

fn of_segment(segment: &Segment) -> [f32; 10] {
    let Segment { start: [a, b, c], end: [d, e, f], outward: [x, y], fall, behind, .. } = *segment;
    [a, b, c, d, e, f, x, y, fall, behind]
}

fn of_point(point: &ChainPoint) -> [f64; 9] {
    let ChainPoint { place, depth, behind, world, weight, black, .. } = point;
    let [depth, behind, weight, black] = [depth, behind, weight, black].map(|value| f64::from(*value));
    [place.x, place.y, depth, behind, world.x, world.y, world.z, weight, black]
}
