//! The same land elsewhere: moved so that every bit must stay, or turned so that nearly all ink must.
//!
//! Shifts by whole cells, sizes by a power of two and heights by whole metres change no difference between numbers of few binary
//! digits. Half turns and transpositions keep the diagonal of each cell and so the surface; f32 rounds otherwise in them. A quarter
//! turn changes the diagonal and is another surface: it has a truth of its own, and promises nothing here.

use glam::{DVec2, DVec3};

use crate::dem::Dem;
use crate::truth::{Inked, Mask};
use crate::view::Camera;

/// Columns and rows of a shift.
const CELLS: DVec2 = DVec2::new(37.0, -91.0);
/// Times as large.
const TIMES: f64 = 8.0;
/// Metres higher.
const METRES: f64 = 301.0;

/// Land and eye somewhere else.
#[derive(Debug, Clone)]
pub struct Moved {
    /// How, in a word or two.
    pub how: &'static str,
    /// The land.
    pub dem: Dem,
    /// Where an eye goes, and how it looks then.
    pub camera: fn(&Dem, &Camera) -> Camera,
    /// Whether pages are mirrored, left for right.
    pub mirrors: bool,
}

/// The moves that keep every bit.
pub fn same_bits(dem: &Dem) -> [Moved; 3] {
    let origin = dem.position(0, 0).truncate();
    let shift = |dem: &Dem| CELLS * dem.cell();
    let same = |_: usize, _: usize, height: f32| height;
    [
        Moved {
            how: "shifted",
            dem: remade(dem, dem.cell(), origin + shift(dem), same),
            camera: |dem, camera| Camera { eye: camera.eye + (CELLS * dem.cell()).extend(0.0), ..*camera },
            mirrors: false,
        },
        Moved {
            how: "8 times as large",
            dem: remade(dem, dem.cell() * TIMES, origin * TIMES, |_, _, height| height * TIMES as f32),
            camera: |_, camera| Camera { eye: camera.eye * TIMES, ..*camera },
            mirrors: false,
        },
        Moved {
            how: "raised",
            dem: remade(dem, dem.cell(), origin, |_, _, height| height + METRES as f32),
            camera: |_, camera| Camera { eye: camera.eye + DVec3::Z * METRES, ..*camera },
            mirrors: false,
        },
    ]
}

/// The moves that keep the surface: a half turn, and a transposition, which mirrors pages.
pub fn turned(dem: &Dem) -> [Moved; 2] {
    let (columns, rows, origin) = (dem.columns(), dem.rows(), dem.position(0, 0).truncate());
    let height = |c, r| dem.height(c, r).unwrap_or(f32::NAN);
    let turned = (0..columns * rows).map(|i| height(columns - 1 - i % columns, rows - 1 - i / columns));
    let transposed = (0..columns * rows).map(|i| height(i / rows, i % rows));
    let cell = DVec2::new(dem.cell().y, dem.cell().x);
    [
        Moved {
            how: "turned by 180 degrees",
            dem: Dem::from_heights(columns, dem.cell(), origin, turned.collect()),
            camera: |dem, camera| {
                let [west, south, east, north] = dem.extent();
                let about = DVec2::new(west + east, south + north);
                let eye = (about - camera.eye.truncate()).extend(camera.eye.z);
                Camera { eye, azimuth: camera.azimuth + 180.0, ..*camera }
            },
            mirrors: false,
        },
        Moved {
            how: "transposed",
            dem: Dem::from_heights(rows, cell, origin, transposed.collect()),
            camera: |dem, camera| {
                let corner = dem.position(0, 0).truncate();
                let d = camera.eye.truncate() - corner;
                let eye = (corner - DVec2::new(d.y, d.x)).extend(camera.eye.z);
                Camera { eye, azimuth: 270.0 - camera.azimuth, ..*camera }
            },
            mirrors: true,
        },
    ]
}

fn remade(dem: &Dem, cell: DVec2, origin: DVec2, height: impl Fn(usize, usize, f32) -> f32) -> Dem {
    let columns = dem.columns();
    let heights = (0..columns * dem.rows()).map(|i| {
        let (c, r) = (i % columns, i / columns);
        height(c, r, dem.height(c, r).unwrap_or(f32::NAN))
    });
    Dem::from_heights(columns, cell, origin, heights.collect())
}

/// A mask, left for right.
pub fn mirrored(mask: &Mask) -> Mask {
    let mut inked: Vec<Inked> =
        mask.inked.iter().map(|p| Inked { column: mask.size[0] - 1 - p.column, ..*p }).collect();
    inked.sort_by_key(|p| (p.row, p.column));
    Mask { size: mask.size, inked }
}

/// How many words differ; all where there are not as many.
pub fn differing(a: &[u64], b: &[u64]) -> usize {
    if a.len() == b.len() { a.iter().zip(b).filter(|(a, b)| a != b).count() } else { a.len().max(b.len()) }
}

/// How two masks of one page differ.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Difference {
    /// Pixels that are ink of one and not of the other.
    pub pixels: usize,
    /// Those of them that have no ink of the other within 1 px: column and row.
    pub far: Vec<[u32; 2]>,
    /// Pixels of ink of the two, in the mean.
    pub ink: f64,
}

impl Difference {
    /// Between two masks.
    pub fn of(a: &Mask, b: &Mask) -> Self {
        let (of_a, of_b) = (a.pixels(), b.pixels());
        let pixels = of_a.iter().zip(&of_b).filter(|(a, b)| a != b).count();
        let far = [alone(a, b), alone(b, a)].concat();
        Self { pixels, far, ink: (a.inked.len() + b.inked.len()) as f64 / 2.0 }
    }

    /// Pixels that differ as a share of the ink; 0 without ink.
    pub fn share(&self) -> f64 {
        self.pixels as f64 / self.ink.max(1.0)
    }
}

/// Pixels of ink with none of the other in the 3 x 3 about them: column and row.
pub fn alone(mask: &Mask, other: &Mask) -> Vec<[u32; 2]> {
    let there = other.pixels();
    let [width, height] = other.size;
    let is_there = |p: &Inked| {
        let span = |at: u32, size: u32| at.saturating_sub(1)..=(at + 1).min(size - 1);
        span(p.row, height).any(|row| span(p.column, width).any(|column| there[(row * width + column) as usize]))
    };
    mask.inked.iter().filter(|p| !is_there(p)).map(|p| [p.column, p.row]).collect()
}
