//! Devices, terrains and cameras that several test modules share.

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::LatticePoint;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::surface::{Level, Surface};
use hachure::view::Camera;

pub use crate::common::gpu;

/// A north-west sample far from the origin, as UTM has them.
pub const ORIGIN: DVec2 = DVec2::new(325_249.3, 4_117_889.7);

/// The same adapter without 64-bit atomics.
///
/// # Panics
/// Without an adapter.
pub fn gpu_without_int64() -> &'static Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| Arc::new(Gpu::open(&AdapterChoice::Best, Int64::Never).expect("an adapter")))
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

/// A camera at `eye` that looks this way, 60 degrees across.
pub fn aimed(eye: DVec3, azimuth: f64, altitude: f64, [width, height]: [u32; 2]) -> Camera {
    Camera { eye, azimuth, altitude, fov: 60.0, width, height }
}

/// The point `above` metres over the surface at a place in columns and rows, to the nearest 1/64 cell.
pub fn over(surface: &Surface, column: f64, row: f64, above: f64) -> DVec3 {
    let at = LatticePoint { x: (column * 64.0) as u32, y: (row * 64.0) as u32 };
    surface.position(at).expect("a place on the surface") + DVec3::Z * above
}

/// Numbers that look random and are the same on every run (Marsaglia 2003, xorshift64*).
pub struct Random(u64);

impl Random {
    /// Starts the sequence of a seed other than 0.
    pub fn new(seed: u64) -> Self {
        assert!(seed != 0, "0 stays 0");
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
    Dem::from_heights(columns, DVec2::splat(20.0), DVec2::new(325_000.0, 4_118_000.0), heights)
}

/// What lies between the numbers of [`hashed`] places: the golden ratio of 2^64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// From 0 to 1, by the number of a place alone (Steele, Lea, Flood 2014, splitmix64).
pub fn hashed(number: u64) -> f64 {
    let mut z = number.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// White noise of `relief` metres around 1500 m: every slope at every cell.
pub fn noise(seed: u64, samples: [usize; 2], cell: f64, relief: f64) -> Vec<f32> {
    let first = seed ^ (cell as u64) << 32;
    let number = |i: usize| first.wrapping_add((i as u64).wrapping_mul(GOLDEN));
    (0..samples[0] * samples[1]).map(|i| (1500.0 + (hashed(number(i)) - 0.5) * relief) as f32).collect()
}

/// The surface of such heights, square cells of `cell` metres, far from the origin.
pub fn surface(columns: usize, cell: f64, heights: Vec<f32>) -> Arc<Surface> {
    Arc::new(Surface::new(Dem::from_heights(columns, DVec2::splat(cell), ORIGIN, heights)))
}

/// A surface of [`noise`].
pub fn noisy(seed: u64, samples: [usize; 2], cell: f64, relief: f64) -> Arc<Surface> {
    surface(samples[0], cell, noise(seed, samples, cell, relief))
}
