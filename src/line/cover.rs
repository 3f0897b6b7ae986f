//! What the pixels of a page surely hide.
//!
//! Squares of pixels with the farthest that one shows: what lies farther than all that is shown about it, by some squares, is
//! hidden. Cost: a look at each pixel, once. Memory: 4 bytes a square.

use glam::DVec2;

use super::InkRaster;

/// Side of a square, px.
const SIDE: usize = 16;
/// What lies this much farther than all about it is hidden, a share.
const FARTHER: f32 = 1.02;

/// Farthest depths of a page, near / distance, 0 for sky.
#[derive(Debug, Clone)]
pub struct Cover {
    size: [usize; 2],
    farthest: Vec<f32>,
}

impl Cover {
    /// Of a page in one piece.
    pub fn new(raster: &InkRaster) -> Self {
        let [width, height] = [raster.width, raster.height].map(|px| px as usize);
        let size = [width, height].map(|px| px.div_ceil(SIDE).max(1));
        let mut farthest = vec![f32::INFINITY; size[0] * size[1]];
        for (y, row) in raster.pixels.chunks(width.max(1)).enumerate() {
            for (x, pixel) in row.iter().enumerate() {
                let square = &mut farthest[y / SIDE * size[0] + x / SIDE];
                *square = square.min(pixel.depth());
            }
        }
        Self { size, farthest }
    }

    /// Whether what lies at a place of the page or beside it, px, at a depth is surely hidden.
    pub fn hides(&self, place: DVec2, depth: f64) -> bool {
        let at = |v: f64, squares: usize| (v / SIDE as f64).clamp(0.0, squares as f64 - 1.0) as usize;
        let [x, y] = [at(place.x, self.size[0]), at(place.y, self.size[1])];
        let near = |at: usize, squares: usize| at.saturating_sub(1)..(at + 2).min(squares);
        near(y, self.size[1])
            .all(|y| near(x, self.size[0]).all(|x| self.farthest[y * self.size[0] + x] > depth as f32 * FARTHER))
    }
}
