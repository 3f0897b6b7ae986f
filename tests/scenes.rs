//! Devices, cameras and pictures that several test modules share.

use std::sync::OnceLock;

use glam::DVec3;
use hachure::dem::Dem;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::line::InkRaster;
use hachure::plan::{Border, Method, Plan};
use hachure::render::{Frame, Renderer};
use hachure::surface::{Level, Surface};
use hachure::truth::Mask;
use hachure::view::Camera;

pub use crate::common::gpu;
use crate::judged::mask;

/// Every method with its name.
pub const METHODS: [(&str, Method); Method::ALL.len()] = {
    let mut named = [("", Method::Walk); Method::ALL.len()];
    let mut i = 0;
    while i < named.len() {
        named[i] = (Method::ALL[i].entry().name, Method::ALL[i]);
        i += 1;
    }
    named
};

/// The same adapter without 64-bit atomics.
///
/// # Panics
/// Without an adapter.
pub fn gpu_without_int64() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open(&AdapterChoice::Best, Int64::Never).expect("an adapter"))
}

/// The level with `n` subdivisions.
pub fn level(n: u32) -> Level {
    Level::new(n).expect("a level")
}

/// A camera at `eye` that looks at `target`.
pub fn look(eye: DVec3, target: DVec3, fov: f64, [width, height]: [u32; 2]) -> Camera {
    let d = target - eye;
    let azimuth = d.x.atan2(d.y).to_degrees();
    let altitude = d.z.atan2(d.truncate().length()).to_degrees();
    Camera { eye, azimuth, altitude, fov, width, height }
}

/// One frame.
pub fn draw(surface: &Surface, camera: &Camera, level: Level, method: Method, border: Border) -> Frame {
    let renderer = renderer(gpu(), surface, camera, level, method, border);
    renderer.frame(camera).expect("a frame");
    renderer.read().expect("its pixels")
}

/// The ink of one frame.
pub fn draw_mask(surface: &Surface, camera: &Camera, level: Level, method: Method, border: Border) -> Mask {
    let renderer = renderer(gpu(), surface, camera, level, method, border);
    mask(&renderer.draw(camera).expect("a frame").raster, renderer.near())
}

/// A renderer for pages of the camera's size.
pub fn renderer<'a>(
    gpu: &'a Gpu,
    surface: &'a Surface,
    camera: &Camera,
    level: Level,
    method: Method,
    border: Border,
) -> Renderer<'a> {
    Renderer::new(gpu, surface, Plan::new(level, method, border), [camera.width, camera.height]).expect("a renderer")
}

/// How many pixels are ink.
pub fn count_ink(raster: &InkRaster) -> usize {
    raster.pixels.iter().filter(|p| p.is_ink()).count()
}

/// Numbers that look random and are the same on every run (Marsaglia 2003, xorshift64*).
pub struct Random(u64);

impl Random {
    /// Starts the sequence of a seed other than 0.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 32 bits.
    pub fn bits(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32
    }

    /// A whole number from 0 to `end - 1`.
    pub fn below(&mut self, end: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(end)) >> 32) as u32
    }

    /// A number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.bits()) / f64::from(u32::MAX)
    }
}

/// A rough terrain: waves of several lengths and noise of `noise` m, all times `exaggeration`; with `voids`, one sample
/// in forty and a block are void.
pub fn rough(columns: usize, rows: usize, exaggeration: f64, noise: f64, voids: bool) -> Dem {
    let mut random = Random::new(7);
    let mut heights = Vec::new();
    for r in 0..rows {
        for c in 0..columns {
            let (x, y) = (c as f64, r as f64);
            let waves = 60.0 * (x / 9.0).sin() * (y / 7.0).cos() + 25.0 * ((x + y) / 4.0).sin();
            let height = waves + noise * (f64::from(random.below(1 << 16)) / 32768.0 - 1.0);
            let block = (10..17).contains(&c) && (20..24).contains(&r);
            let void = random.below(40) == 0 || block;
            heights.push(if voids && void { f32::NAN } else { (height * exaggeration) as f32 });
        }
    }
    Dem::from_heights(columns, glam::DVec2::splat(20.0), glam::DVec2::new(325_000.0, 4_118_000.0), heights)
}
