//! Level of detail of lines on the land: how strongly a page shows each.
//!
//! A line is worth drawing where its length and its relief fill so many pixels, and where the land to both sides stands up from it,
//! or falls from it, so that an eye sees why it is there. Method: a ramp for each of these, the least counts; averaged along the
//! page, then carried down the tree of branches, so that a branch that is drawn always reaches its junction, and what it joins is
//! no weaker there. Every ramp is continuous in the eye: lines fade, none pops. The ramps are those that a study of two DEMs of
//! 30 m found.
//!
//! What is seen is told by angles about the eye, not by the page: a line is drawn as strongly wherever the eye looks.
//!
//! Cost: a look at each point of each line that may fill some pixels. Does not handle: land that hides a line, which is
//! looked at later.

use std::sync::Arc;

use glam::{DVec2, DVec3, FloatExt};
use rayon::prelude::*;

use super::along::fade;
use super::laid::line_of;
use super::way::{LandWay, WayPoint};
use crate::dem::Dem;
use crate::error::Result;
use crate::relief::{LineKind, Slopes, SurfaceLine, SurfacePoint, spacing};

/// Lengths of a branch on the page up to which it is left out, and from which it is whole, px.
pub(super) const LENGTH: [f64; 2] = [10.0, 120.0];
/// The same of how far it falls, px.
pub(super) const DROP: [f64; 2] = [2.0, 16.0];
/// The same of how far the land beside it stands up or falls, px and metres.
pub(super) const ACROSS: [f64; 2] = [0.4, 3.0];
pub(super) const ACROSS_M: [f64; 2] = [2.0, 10.0];
/// The same of the slope there.
pub(super) const SLOPE: [f64; 2] = [0.03, 0.2];
/// How far aside on the page the land is looked at, px; and between how many cells.
const ASIDE: f64 = 14.0;
const ASIDE_CELLS: [f64; 3] = [3.0, 6.0, 12.0];
/// Streams longer than this are drawn through flat land too, metres.
const RIVER: [f64; 2] = [2000.0, 4000.0];
/// Lengths of lines that no relief need show up to which they are left out, and from which they are whole, px.
pub(super) const PLAIN_LENGTH: [f64; 2] = [2.0, 12.0];
/// Along the page, what the land beside a line says is averaged over this to either side, px.
const SOFT: f64 = 10.0;
/// Weights up to which no pen shows a line, and from which it is as wide as it should be.
const SEEN: [f64; 2] = [0.04, 0.12];
/// Width of a stream of the first order as a share of that of one of the fourth.
const LEAST_WIDTH: f64 = 0.6;
const WHOLE_ORDER: f64 = 4.0;
/// Lengths of ridges on the page between which their width grows as that of streams does by order, px.
const RIDGE_WIDTH: [f64; 2] = [60.0, 500.0];

/// Lines on the land of a DEM, with where their points lie in its world.
#[derive(Debug, Clone, Default)]
pub struct Land {
    lines: Vec<SurfaceLine>,
    /// Of each line each point: metres of the exaggerated world, on the surface between samples.
    world: Vec<Vec<DVec3>>,
    /// Of each line: what it lies in.
    spheres: Vec<Sphere>,
    /// Exaggerated metres for one of the land.
    exaggeration: f64,
    /// Metres of a cell.
    cell: f64,
    /// Lines down its slopes.
    slopes: Option<Arc<Slopes>>,
}

/// What a line lies in.
#[derive(Debug, Clone, Copy, Default)]
struct Sphere {
    middle: DVec3,
    radius: f64,
    /// Of the line, m.
    length: f64,
}

/// Where lines are looked at from. What is seen from an eye is the same wherever it looks.
#[derive(Debug, Clone, Copy)]
pub enum From {
    /// An eye in the exaggerated world that sees so many pixels for a unit of angle in the middle of its page.
    Eye(DVec3, f64),
    /// Straight above, so many pixels for a metre.
    Above(f64),
}

impl From {
    /// Where a place of the world stands about what sees it, px, and how many pixels a metre across the view takes there.
    pub(super) fn sees(self, world: DVec3) -> (DVec3, f64) {
        match self {
            Self::Eye(eye, focal) => {
                let scale = focal / world.distance(eye).max(f64::MIN_POSITIVE);
                ((world - eye) * scale, scale)
            }
            Self::Above(scale) => (world.truncate().extend(0.0) * scale, scale),
        }
    }

    /// Most pixels that a line takes.
    fn most(self, line: &Sphere) -> f64 {
        let scale = match self {
            Self::Eye(eye, focal) => focal / (line.middle.distance(eye) - line.radius).max(f64::MIN_POSITIVE),
            Self::Above(scale) => scale,
        };
        line.length * scale
    }
}

impl Land {
    /// Lines on the land of a DEM whose heights are exaggerated by this factor.
    ///
    /// # Errors
    /// As [`Dem::spaced`].
    pub fn new(dem: &Dem, exaggeration: f64, lines: Vec<SurfaceLine>) -> Result<Self> {
        let (spacing, heights) = (spacing(dem), Heights::of(dem)?);
        let [west, .., north] = dem.extent();
        let place = |point: &SurfacePoint| {
            let world = DVec2::new(west, north) + point.at * dem.cell() * DVec2::new(1.0, -1.0);
            world.extend(heights.at(point.at))
        };
        let world: Vec<Vec<DVec3>> = lines.iter().map(|line| line.points.iter().map(place).collect()).collect();
        let spheres = world.iter().map(|points| Sphere::about(points)).collect();
        let cell = dem.cell().min_element() * spacing as f64;
        Ok(Self { lines, world, spheres, exaggeration, cell, slopes: None })
    }

    /// The same with lines down its slopes.
    pub fn with_slopes(self, slopes: Arc<Slopes>) -> Self {
        Self { slopes: Some(slopes), ..self }
    }

    /// A line by its own merit, and how long it is seen, px.
    fn alone(&self, i: usize, from: From) -> (Vec<f32>, f64) {
        let (line, world) = (&self.lines[i], &self.world[i]);
        let least = if is_branch(line) { LENGTH[0] } else { PLAIN_LENGTH[0] };
        if from.most(&self.spheres[i]) <= least {
            return (Vec::new(), 0.0);
        }
        let (places, scales): (Vec<DVec3>, Vec<f64>) = world.iter().map(|point| from.sees(*point)).unzip();
        let steps: Vec<f64> = places.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
        let length: f64 = steps.iter().sum();
        let by_length = if is_branch(line) {
            let falls = line.points.iter().zip(&scales);
            let falls = falls.map(|(point, scale)| f64::from(point.drop) * self.exaggeration * scale);
            let by_drop = fade(DROP, falls.fold(0.0, f64::max));
            fade(LENGTH, length).min(by_drop.max(line.points.last().map_or(0.0, |end| river(line.kind, end))))
        } else {
            fade(PLAIN_LENGTH, length)
        };
        if by_length <= 0.0 {
            return (Vec::new(), length);
        }
        let beside = |(point, scale): (&SurfacePoint, &f64)| self.beside(line.kind, point, *scale);
        let beside: Vec<f64> = line.points.iter().zip(&scales).map(beside).collect();
        let weights = averaged(&beside, &steps).into_iter().map(|beside| beside.min(by_length) as f32).collect();
        (weights, length)
    }

    /// What the land beside a point says for drawing it, where so many pixels are a metre.
    fn beside(&self, kind: LineKind, point: &SurfacePoint, scale: f64) -> f64 {
        match point.across[0] {
            across if across.is_infinite() => return 1.0,
            across if across.is_nan() => return 0.0,
            _ => {}
        }
        let (across, aside) = self.across(point, scale);
        let river = river(kind, point);
        let by_slope = fade(SLOPE, across / aside).max(river);
        let by_relief = fade(ACROSS, across * self.exaggeration * scale).min(fade(ACROSS_M, across));
        by_relief.max(river).min(by_slope)
    }

    /// How far the land beside a point stands up or falls, and how far aside that is, metres of the land.
    pub(super) fn across(&self, point: &SurfacePoint, scale: f64) -> (f64, f64) {
        let [near, middle, far] = ASIDE_CELLS;
        let cells = (ASIDE / scale.max(f64::MIN_POSITIVE) / self.cell).clamp(near, far);
        let [a, b, c] = point.across.map(f64::from);
        let across = match cells <= middle {
            true => a.lerp(b, (cells - near) / (middle - near)),
            false => b.lerp(c, (cells - middle) / (far - middle)),
        };
        (across, cells * self.cell)
    }

    /// Exaggerated metres for one of the land.
    pub(super) fn exaggeration(&self) -> f64 {
        self.exaggeration
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Land {
    /// Lines down its slopes, where it has them.
    pub fn slopes(&self) -> Option<&Slopes> {
        self.slopes.as_deref()
    }

    /// The lines, and where their points lie, metres of the exaggerated world.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&SurfaceLine, &[DVec3])> {
        self.lines.iter().zip(self.world.iter().map(Vec::as_slice))
    }

    /// The lines that are shown, each point as strongly as it is.
    pub fn ways(&self, from: From) -> Vec<LandWay> {
        let way = |((line, world), weights): ((&SurfaceLine, &[DVec3]), Vec<f32>)| {
            let points = line.points.iter().zip(world).zip(&weights);
            let point = |((point, world), weight): ((&SurfacePoint, &DVec3), &f32)| WayPoint {
                at: point.at,
                world: *world,
                weight: *weight,
                black: 1.0,
            };
            let points: Vec<WayPoint> = points.map(point).collect();
            (points.len() > 1).then_some(LandWay { line: line_of(line.kind), points, closed: line.closed })
        };
        self.iter().zip(self.shown(from)).filter_map(way).collect()
    }

    /// How strongly each point of each line is shown, 0 to 1; nothing of lines that are not.
    pub fn shown(&self, from: From) -> Vec<Vec<f32>> {
        let mut shown: Vec<(Vec<f32>, f64)> =
            (0..self.lines.len()).into_par_iter().map(|i| self.alone(i, from)).collect();
        // Branches stand behind what they join.
        for (i, line) in self.lines.iter().enumerate().rev() {
            let weights = &mut shown[i].0;
            if !is_branch(line) || weights.is_empty() {
                continue;
            }
            let mut strongest = 0.0_f32;
            for weight in weights.iter_mut() {
                strongest = strongest.max(*weight);
                *weight = strongest;
            }
            let Some([onto, at]) = line.joins.map(|at| at.map(|at| at as usize)) else { continue };
            // What it joins may not be worth drawing by itself.
            shown[onto].0.resize(self.lines[onto].points.len(), 0.0);
            shown[onto].0[at] = shown[onto].0[at].max(strongest);
        }
        let wide = |(line, (mut weights, length)): (&SurfaceLine, (Vec<f32>, f64))| {
            for (weight, point) in weights.iter_mut().zip(&line.points) {
                let seen = fade(SEEN, f64::from(*weight)) as f32;
                *weight *= if point.across[0].is_nan() { 0.0 } else { seen * width(line, point, length) as f32 };
            }
            if weights.iter().all(|weight| *weight == 0.0) { Vec::new() } else { weights }
        };
        self.lines.iter().zip(shown).map(wide).collect()
    }
}

impl Sphere {
    fn about(points: &[DVec3]) -> Self {
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or_default();
        let length = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        Self { middle: low.midpoint(high), radius: low.distance(high) / 2.0, length }
    }
}

/// Whether a line is drawn for the relief that it tells of, and is of a tree.
pub(super) fn is_branch(line: &SurfaceLine) -> bool {
    matches!(line.kind, LineKind::Drainage | LineKind::Ridge)
}

/// How far a stream is a river here, which is drawn whatever the relief.
pub(super) fn river(kind: LineKind, point: &SurfacePoint) -> f64 {
    if kind == LineKind::Drainage { fade(RIVER, point.length.into()) } else { 0.0 }
}

/// Width at a point of a line that is seen so long, px, as a share of its pen's: a stream is as broad at its end as its order
/// says, and grows to that by its length.
fn width(line: &SurfaceLine, point: &SurfacePoint, length: f64) -> f64 {
    let by_order = (f64::from(line.order) - 1.0) / (WHOLE_ORDER - 1.0);
    let share = match line.kind {
        LineKind::Drainage => {
            let end = line.points.last().map_or(1.0, |end| end.length).max(f32::MIN_POSITIVE);
            by_order * f64::from(point.length / end).sqrt()
        }
        LineKind::Own(_) => by_order,
        LineKind::Ridge => fade(RIDGE_WIDTH, length),
        LineKind::Shore => 1.0,
    };
    LEAST_WIDTH.lerp(1.0, share.clamp(0.0, 1.0))
}

/// Values at points averaged along a line over about [`SOFT`] px to both sides, by its steps.
fn averaged(values: &[f64], steps: &[f64]) -> Vec<f64> {
    let n = values.len();
    let step = |i: usize| steps.get(i).copied().unwrap_or(0.0);
    // What of the line a point stands for.
    let mass: Vec<f64> = (0..n).map(|i| 1e-6 + step(i) + if i > 0 { step(i - 1) } else { 0.0 }).collect();
    let mut sums: Vec<[f64; 2]> = (0..n).map(|i| [values[i] * mass[i], mass[i]]).collect();
    for backward in [false, true] {
        let mut run = [0.0; 2];
        for k in 0..n {
            let i = if backward { n - 1 - k } else { k };
            let way = if k == 0 { 0.0 } else { step(if backward { i } else { i - 1 }) };
            let fade = (-way / SOFT).exp();
            run = run.map(|sum| sum * fade);
            sums[i] = [sums[i][0] + run[0], sums[i][1] + run[1]];
            run = [run[0] + values[i] * mass[i], run[1] + mass[i]];
        }
    }
    sums.into_iter().map(|[sum, mass]| sum / mass).collect()
}

/// Heights of a DEM to tell distances by: of one that stays in its file every k-th.
enum Heights<'a> {
    Held(&'a Dem),
    Spaced { spacing: f64, columns: usize, heights: Vec<f32> },
}

impl<'a> Heights<'a> {
    fn of(dem: &'a Dem) -> Result<Self> {
        if !dem.is_filed() {
            return Ok(Self::Held(dem));
        }
        let spacing = spacing(dem);
        let size = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(spacing));
        let heights = dem.spaced([0, 0], spacing, size)?;
        Ok(Self::Spaced { spacing: spacing as f64, columns: size[0], heights })
    }

    /// Exaggerated metres between samples, of those that are there.
    fn at(&self, at: DVec2) -> f64 {
        let at = if let Self::Spaced { spacing, .. } = self { at / *spacing } else { at };
        let (cell, share) = (at.floor(), at.fract());
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
            let weight =
                (if x == 1 { share.x } else { 1.0 - share.x }) * (if y == 1 { share.y } else { 1.0 - share.y });
            let height = self.sample(cell.x as usize + x, cell.y as usize + y).filter(|_| weight > 0.0);
            height.map_or([0.0; 2], |height| [f64::from(height) * weight, weight])
        });
        let [sum, weight] = corners.into_iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        if weight > 0.0 { sum / weight } else { 0.0 }
    }

    fn sample(&self, c: usize, r: usize) -> Option<f32> {
        match self {
            Self::Held(dem) => dem.height(c, r),
            Self::Spaced { columns, heights, .. } => {
                let inside = c < *columns;
                heights.get(r * columns + c).copied().filter(|height| inside && height.is_finite())
            }
        }
    }
}
