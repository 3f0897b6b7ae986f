//! Heights that lines of the land are found on: metres without exaggeration, as they are and smoothed.

use glam::DVec2;

use super::frame::FramedGrid;
use super::smooth::smoothed;
use crate::dem::Dem;
use crate::error::Result;

/// Heights in a frame of voids. Memory: 8 bytes a sample.
#[derive(Debug, Clone)]
pub struct Grid {
    /// Where they lie.
    pub frame: FramedGrid,
    /// Metres, NaN at voids.
    pub heights: Vec<f32>,
    /// The same without the noise of single samples.
    pub smoothed: Vec<f32>,
}

impl Grid {
    /// Of a held DEM whose heights are exaggerated by a factor.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) for a filed one.
    pub fn of(dem: &Dem, exaggeration: f64) -> Result<Self> {
        let samples = dem.held()?;
        let frame = FramedGrid { size: [dem.columns(), dem.rows()], cell: dem.cell() };
        let mut heights = vec![f32::NAN; frame.samples()];
        for r in 0..dem.rows() {
            let row = heights[frame.row(r)].iter_mut().zip(samples.row_from(0, r));
            for (onto, height) in row {
                *onto = height.map_or(f32::NAN, |height| (f64::from(height) / exaggeration) as f32);
            }
        }
        Ok(Self::new(frame, heights))
    }

    /// Of framed heights, NaN at voids.
    pub fn new(frame: FramedGrid, heights: Vec<f32>) -> Self {
        Self { smoothed: smoothed(frame, &heights), frame, heights }
    }

    /// Metres at a place between samples, linear between them; NaN beside a void.
    pub fn height(&self, at: DVec2) -> f32 {
        let Some((i, [x, y])) = self.corner(at) else { return f32::NAN };
        let row = |i: usize| mix(x, &self.heights[i..i + 2]);
        let [north, south] = [row(i), row(i + self.frame.stride())];
        if y > 0.0 { north + (south - north) * y } else { north }
    }

    /// Smoothed metres at a place between samples, by cubic convolution (Keys 1981); NaN where one of the 16 about it is a void.
    pub fn smooth(&self, at: DVec2) -> f32 {
        let Some((i, [x, y])) = self.corner(at) else { return f32::NAN };
        let stride = self.frame.stride();
        if i + 2 * stride + 3 > self.smoothed.len() {
            return f32::NAN;
        }
        let [x, y] = [cubic(x), cubic(y)];
        let row = |k: usize, weight: f32| {
            let row = &self.smoothed[i + k * stride - stride - 1..][..4];
            weight * row.iter().zip(x).map(|(height, weight)| height * weight).sum::<f32>()
        };
        y.iter().enumerate().map(|(k, weight)| row(k, *weight)).sum()
    }

    /// The sample north-west of a place and how far that lies from it, cells; none outside.
    fn corner(&self, at: DVec2) -> Option<(usize, [f32; 2])> {
        let [columns, rows] = self.frame.size.map(|side| side as f64);
        let inside = (0.0..=columns - 1.0).contains(&at.x) && (0.0..=rows - 1.0).contains(&at.y);
        let floor = at.floor();
        inside.then(|| {
            let off = at - floor;
            (self.frame.index([floor.x as usize, floor.y as usize]), [off.x as f32, off.y as f32])
        })
    }
}

/// Between two heights.
fn mix(share: f32, pair: &[f32]) -> f32 {
    if share > 0.0 { pair[0] + (pair[1] - pair[0]) * share } else { pair[0] }
}

/// Weights of the four samples about a place (Catmull and Rom 1974).
fn cubic(x: f32) -> [f32; 4] {
    let [x2, x3] = [x * x, x * x * x];
    [(-x + 2.0 * x2 - x3) / 2.0, (2.0 - 5.0 * x2 + 3.0 * x3) / 2.0, (x + 4.0 * x2 - 3.0 * x3) / 2.0, (x3 - x2) / 2.0]
}
