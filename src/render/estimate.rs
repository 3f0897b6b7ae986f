//! What a frame may take, before a device hears of it: for farms that book memory and time.
//!
//! Buffers follow from the plan. Times are those of two cores with a software driver (llvmpipe), through the medians of three
//! flights: 260 000 facets with strokes at 320 x 180 (36 ms), 3.7 million at 1280 x 720 with strokes (407 ms) and masks alone
//! (188 ms); no other views were tried, and another device is another matter. Starts are those of 0.25 and of 3.0 million samples
//! (1.3 and 1.8 s, and 7.0 s for the channels and ridges of the latter), hachures those of a flight there: 1.3 s a frame of 1280 x
//! 720, of views 0.4 s (the sample) to 4.2 s (new land, 1600 x 1000). Memory counts the device's too, which a software
//! driver keeps in it; measured were 232 and 465 MiB.

use crate::dem::Dem;
use crate::error::Result;
use crate::gpu::{Capacity, sizes};
use crate::plan::batches::BATCH_CHUNKS;
use crate::plan::{Detail, Frame, LandLines};
use crate::relief::LandWanted;
use crate::surface::Surface;
use crate::surface::lattice::CHUNK_VERTICES;

/// Seconds of a frame whatever it shows.
const SECONDS: f64 = 0.008;
/// Seconds a facet: to the mask, and for curves, their chains and strokes.
const OF_FACET: [f64; 2] = [41e-9, 101e-9];
/// Seconds a pixel, and of hachures.
const OF_PIXEL: f64 = 30e-9;
const OF_HATCHED: f64 = 1.4e-6;
/// Seconds a sample, once for a DEM: what is read and made of it, and channels and ridges where lines lie on the land.
const OF_SAMPLE_ONCE: f64 = 0.2e-6;
const OF_RELIEF_ONCE: f64 = 2.3e-6;
/// Seconds until a process draws, whatever it draws.
const ONCE: f64 = 1.2;
/// Seconds a sample, of a plan, and of its hachures.
const OF_SAMPLE_SECONDS: f64 = 50e-9;
const OF_SAMPLE_HATCHED: f64 = 2e-6;
/// Bytes of the program and its driver.
const PROGRAM: u64 = 209 << 20;
/// Bytes a sample that is held: height, normal, and what is made of them.
const OF_SAMPLE: u64 = 16;
/// Bytes of the lines that hachures are drawn of, beside those a sample of land at smaller scales.
const OF_SLOPES: u64 = 192 << 20;
/// Bytes a pixel of drawings on their way to their files, of which there are up to three.
const OF_DRAWING: u64 = 3 * 24;

/// What a frame may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate {
    /// Samples of the DEM, or of the part of it that is taken: at most so many are read.
    pub samples: u64,
    /// Facets.
    pub facets: u64,
    /// Seconds before the first frame of a process, where no cache holds what is made of the DEM.
    pub start: f64,
    /// Seconds, once the device is warm.
    pub seconds: f64,
    /// Bytes of the process, those of the device included.
    pub memory: u64,
    /// Bytes on the device.
    pub device: u64,
}

impl Estimate {
    /// What is done already.
    pub(crate) const NOTHING: Self = Self { samples: 0, facets: 0, start: 0.0, seconds: 0.0, memory: 0, device: 0 };

    /// Of the plan of a DEM, which no device sees.
    pub(crate) fn of_plan(dem: &Dem, land: &LandWanted) -> Self {
        let samples = samples(dem);
        let [hatched, of_slopes] = if land.slopes.is_some() { [samples, OF_SLOPES] } else { [0; 2] };
        Self {
            samples,
            start: start(samples, !land.is_nothing()),
            seconds: SECONDS + samples as f64 * OF_SAMPLE_SECONDS + hatched as f64 * OF_SAMPLE_HATCHED,
            memory: PROGRAM + samples * OF_SAMPLE + of_slopes,
            ..Self::NOTHING
        }
    }

    /// Of a frame that is planned.
    ///
    /// # Errors
    /// As [`sizes::of_page`].
    pub(crate) fn of(frame: &Frame, surface: &Surface) -> Result<Self> {
        let (facets, [width, height]) = (frame.facets(surface), frame.pieces.page());
        let pixels = u64::from(width) * u64::from(height);
        let least = Capacity::of(&frame.lattice);
        let capacity = match frame.plan.detail {
            Detail::Uniform(_) => least,
            Detail::Adaptive { .. } => Capacity::FIRST.grown(least),
        };
        let of_scene = sizes::of_scene(capacity);
        let of_page = sizes::of_page(frame.pieces.largest())?;
        let batch = u64::from(capacity.chunks.min(BATCH_CHUNKS));
        let of_curves = if frame.plan.has_curves() { batch * u64::from(CHUNK_VERTICES) * sizes::WORD_BYTES } else { 0 };
        let device = of_scene.iter().chain(&of_page).map(|(_, bytes)| bytes).sum::<u64>() + of_curves;
        let samples = samples(surface.dem());
        let held = if surface.dem().held().is_ok() { samples } else { 0 };
        let of_facet = OF_FACET[usize::from(frame.plan.has_curves())];
        let [hatched, of_scales, of_slopes] =
            if frame.plan.hachures.is_some() { [pixels, held, OF_SLOPES] } else { [0; 3] };
        Ok(Self {
            samples,
            facets,
            start: start(samples, frame.plan.land == LandLines::On),
            seconds: SECONDS + facets as f64 * of_facet + pixels as f64 * OF_PIXEL + hatched as f64 * OF_HATCHED,
            memory: PROGRAM + held * OF_SAMPLE + of_scales * OF_SAMPLE / 3 + of_slopes + device + pixels * OF_DRAWING,
            device,
        })
    }
}

/// Seconds once for a process and a DEM of so many samples.
fn start(samples: u64, has_land: bool) -> f64 {
    let of_relief = if has_land { OF_RELIEF_ONCE } else { 0.0 };
    ONCE + samples as f64 * (OF_SAMPLE_ONCE + of_relief)
}

fn samples(dem: &Dem) -> u64 {
    dem.columns() as u64 * dem.rows() as u64
}
