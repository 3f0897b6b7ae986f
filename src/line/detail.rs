//! Level of detail of lines on the land: how strongly a page shows each.
//!
//! A line is worth drawing where its length and its relief fill so many pixels, and where the land to both sides stands up from it,
//! or falls from it, so that an eye sees why it is there. Method: a ramp for each of these, the least counts; averaged along the
//! page, then carried down the tree of branches, so that a branch that is drawn always reaches its junction, and what it joins is
//! no weaker there. Every ramp is continuous in the eye: lines fade, none pops. The ramps are those that a study of two DEMs of
//! 30 m found.
//!
//! Cost: a projection of each point of each line that may fill some pixels. Does not handle: land that hides a line, which is
//! looked at later.

use glam::{DVec2, DVec3, FloatExt};
use rayon::prelude::*;

use super::along::fade;
use crate::dem::Dem;
use crate::relief::{LineKind, SurfaceLine, SurfacePoint};
use crate::view::Perspective;

/// Lengths of a branch on the page up to which it is left out, and from which it is whole, px.
const LENGTH: [f64; 2] = [10.0, 120.0];
/// The same of how far it falls, px.
const DROP: [f64; 2] = [2.0, 16.0];
/// The same of how far the land beside it stands up or falls, px and metres.
const ACROSS: [f64; 2] = [0.4, 3.0];
const ACROSS_M: [f64; 2] = [2.0, 10.0];
/// The same of the slope there.
const SLOPE: [f64; 2] = [0.03, 0.2];
/// How far aside on the page the land is looked at, px; and between how many cells.
const ASIDE: f64 = 14.0;
const ASIDE_CELLS: [f64; 3] = [3.0, 6.0, 12.0];
/// Streams longer than this are drawn through flat land too, metres.
const RIVER: [f64; 2] = [2000.0, 4000.0];
/// Lengths of lines that no relief need show up to which they are left out, and from which they are whole, px.
const PLAIN_LENGTH: [f64; 2] = [2.0, 12.0];
/// Along the page, what the land beside a line says is averaged over this to either side, px.
const SOFT: f64 = 10.0;
/// Width of a stream of the first order as a share of that of one of the fourth.
const LEAST_WIDTH: f64 = 0.6;
const WHOLE_ORDER: f64 = 4.0;
/// Lengths of ridges on the page between which their width grows as that of streams does by order, px.
const RIDGE_WIDTH: [f64; 2] = [60.0, 500.0];

/// Lines on the land of a DEM, with where their points lie in its world.
#[derive(Debug, Clone, Default)]
pub struct Land {
    /// The lines.
    lines: Vec<SurfaceLine>,
    /// Of each line each point: metres of the exaggerated world, on the surface between samples.
    world: Vec<Vec<DVec3>>,
    /// Exaggerated metres for one of the land.
    exaggeration: f64,
    /// Metres of a cell.
    cell: f64,
}

/// Where a point of the world stands on a page.
#[derive(Debug, Clone, Copy)]
pub struct OnPage {
    /// Px from its top left corner.
    pub place: DVec2,
    /// Near / distance along the view axis.
    pub depth: f64,
    /// Pixels that a metre across the view takes there.
    pub scale: f64,
}

impl OnPage {
    /// In perspective; `None` behind the near plane.
    pub fn seen(world: DVec3, perspective: &Perspective) -> Option<Self> {
        let ahead = perspective.distance(world) > perspective.near();
        let (place, depth) = perspective.project(world);
        ahead.then(|| Self { place, depth, scale: perspective.scale(depth) })
    }
}

/// How a page shows a line: of each of its points.
#[derive(Debug, Clone, Default)]
pub struct Shown {
    /// How strongly, 0 to 1; empty for a line that it does not show.
    pub weights: Vec<f32>,
    /// Where; `None` of what stands on no page.
    pub places: Vec<Option<OnPage>>,
}

impl Land {
    /// Lines on the land of a DEM whose heights are exaggerated by this factor.
    pub fn new(dem: &Dem, exaggeration: f64, lines: Vec<SurfaceLine>) -> Self {
        let [west, .., north] = dem.extent();
        let place = |point: &SurfacePoint| {
            let world = DVec2::new(west, north) + point.at * dem.cell() * DVec2::new(1.0, -1.0);
            world.extend(height(dem, point.at))
        };
        let world = lines.iter().map(|line| line.points.iter().map(place).collect()).collect();
        Self { lines, world, exaggeration, cell: dem.cell().min_element() }
    }

    /// The lines, and where their points lie, metres of the exaggerated world.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&SurfaceLine, &[DVec3])> {
        self.lines.iter().zip(self.world.iter().map(Vec::as_slice))
    }

    /// How a page shows each line, given where it shows points of the world.
    pub fn shown(&self, on_page: impl Fn(DVec3) -> Option<OnPage> + Sync) -> Vec<Shown> {
        let of_line = |i: usize| self.alone(i, &on_page);
        let mut shown: Vec<Shown> = (0..self.lines.len()).into_par_iter().map(of_line).collect();
        // Branches stand behind what they join.
        for i in (0..self.lines.len()).rev() {
            let line = &self.lines[i];
            let weights = &mut shown[i].weights;
            if !matches!(line.kind, LineKind::Drainage | LineKind::Ridge) || weights.is_empty() {
                continue;
            }
            let mut strongest = 0.0_f32;
            for weight in weights.iter_mut() {
                strongest = strongest.max(*weight);
                *weight = strongest;
            }
            let joined = line.joins.map(|at| at.map(|at| at as usize));
            let onto = joined.and_then(|[onto, at]| shown.get_mut(onto)?.weights.get_mut(at));
            onto.into_iter().for_each(|weight| *weight = weight.max(strongest));
        }
        let width = |(line, shown): (&SurfaceLine, &mut Shown)| {
            let width = width(line, shown) as f32;
            shown.weights.iter_mut().for_each(|weight| *weight *= width);
        };
        self.lines.par_iter().zip(&mut shown).for_each(width);
        shown
    }

    /// A line by its own merit.
    fn alone(&self, i: usize, on_page: &impl Fn(DVec3) -> Option<OnPage>) -> Shown {
        let (line, world) = (&self.lines[i], &self.world[i]);
        let places: Vec<Option<OnPage>> = world.iter().map(|point| on_page(*point)).collect();
        let steps: Vec<f64> = places.windows(2).map(|pair| step(pair[0], pair[1])).collect();
        let length: f64 = steps.iter().sum();
        let scale = |at: Option<OnPage>| at.map_or(0.0, |at| at.scale);
        let by_length = match line.kind {
            LineKind::Shore | LineKind::Own => fade(PLAIN_LENGTH, length),
            LineKind::Drainage | LineKind::Ridge => {
                let falls = line.points.iter().zip(&places);
                let falls = falls.map(|(point, at)| f64::from(point.drop) * self.exaggeration * scale(*at));
                fade(LENGTH, length).min(fade(DROP, falls.fold(0.0, f64::max)))
            }
        };
        if by_length <= 0.0 {
            return Shown::default();
        }
        let beside = |(point, at): (&SurfacePoint, &Option<OnPage>)| self.beside(line.kind, point, scale(*at));
        let beside: Vec<f64> = line.points.iter().zip(&places).map(beside).collect();
        let weights = averaged(&beside, &steps).into_iter().map(|beside| beside.min(by_length) as f32).collect();
        Shown { weights, places }
    }

    /// What the land beside a point says for drawing it, where so many pixels are a metre.
    fn beside(&self, kind: LineKind, point: &SurfacePoint, scale: f64) -> f64 {
        if point.across[0].is_infinite() {
            return 1.0;
        }
        let [near, middle, far] = ASIDE_CELLS;
        let cells = (ASIDE / scale.max(1e-12) / self.cell).clamp(near, far);
        let [a, b, c] = point.across.map(f64::from);
        let across = match cells <= middle {
            true => a.lerp(b, (cells - near) / (middle - near)),
            false => b.lerp(c, (cells - middle) / (far - middle)),
        };
        let river = if kind == LineKind::Drainage { fade(RIVER, point.length.into()) } else { 0.0 };
        let by_slope = fade(SLOPE, across / (cells * self.cell)).max(river);
        let by_relief = fade(ACROSS, across * self.exaggeration * scale).min(fade(ACROSS_M, across));
        by_relief.max(river).min(by_slope)
    }
}

/// Width of a line as a share of its pen's.
fn width(line: &SurfaceLine, shown: &Shown) -> f64 {
    let share = match line.kind {
        LineKind::Drainage | LineKind::Own => (f64::from(line.order) - 1.0) / (WHOLE_ORDER - 1.0),
        LineKind::Ridge => fade(RIDGE_WIDTH, shown.places.windows(2).map(|pair| step(pair[0], pair[1])).sum()),
        LineKind::Shore => 1.0,
    };
    LEAST_WIDTH.lerp(1.0, share.clamp(0.0, 1.0))
}

/// From one point to the next on the page, px; nothing where one of them is behind the eye.
fn step(a: Option<OnPage>, b: Option<OnPage>) -> f64 {
    a.zip(b).map_or(0.0, |(a, b)| a.place.distance(b.place))
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

/// Exaggerated metres of the land between its samples, of those that are there.
fn height(dem: &Dem, at: DVec2) -> f64 {
    let (cell, share) = (at.floor(), at.fract());
    let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
        let weight = if x == 1 { share.x } else { 1.0 - share.x } * if y == 1 { share.y } else { 1.0 - share.y };
        let [c, r] = [cell.x as usize + x, cell.y as usize + y];
        dem.height(c, r).filter(|_| weight > 0.0).map_or([0.0; 2], |height| [f64::from(height) * weight, weight])
    });
    let [sum, weight] = corners.into_iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    if weight > 0.0 { sum / weight } else { 0.0 }
}
