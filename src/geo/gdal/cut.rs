//! A crop on a grid of another system, where it is no rectangle: what is outside it is void.
//!
//! Cost: a place of PROJ a sample, on every core. Not handled: edges between samples.

use glam::DVec2;
use rayon::prelude::*;

use super::crs::CrsPath;
use super::raster::Raster;
use crate::dem::Crs;

/// Rows that are cut at once.
const ROWS: usize = 64;

/// West, south, east and north in a system.
#[derive(Debug)]
pub(super) struct Cut {
    pub crop: [f64; 4],
    pub crs: Crs,
}

impl Cut {
    /// Makes the samples of `raster` outside void.
    pub(super) fn cut(&self, raster: &mut Raster) {
        let grid = &raster.grid;
        let bands = raster.metres.par_chunks_mut(grid.columns * ROWS).enumerate();
        bands.for_each(|(band, metres)| {
            let Some(way) = CrsPath::between(&grid.crs, &self.crs) else { return };
            let sample = |i: usize| grid.sample((i % grid.columns) as f64, (band * ROWS + i / grid.columns) as f64);
            let mut places: Vec<_> = (0..metres.len()).map(sample).collect();
            way.carry(&mut places);
            let outside = metres.iter_mut().zip(places).filter(|(_, place)| !is_inside(self.crop, *place, &self.crs));
            outside.for_each(|(metres, _)| *metres = f32::NAN);
        });
    }
}

/// Whether a place in `crs` is inside a crop there.
pub(super) fn is_inside([west, south, east, north]: [f64; 4], place: DVec2, crs: &Crs) -> bool {
    let x = crs.near(place.x, (west + east) / 2.0);
    (west..=east).contains(&x) && (south..=north).contains(&place.y)
}
