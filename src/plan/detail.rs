//! At which level each chunk is drawn.
//!
//! From the eye outwards, each chunk is split until its facets deviate little enough on the page. What is beside the page
//! or hidden by nearer land stays as coarse as its neighbours allow. The level of a chunk depends on the surface and the
//! camera alone.

use std::cell::Cell;
use std::collections::HashSet;

use glam::{DVec2, DVec3};

use super::horizon::Horizon;
use super::left_out::Omission;
use super::{Culling, Curves};
use crate::error::Result;
use crate::surface::lattice::{CELL_STEPS, CHUNK_QUADS, Role};
use crate::surface::quadtree::Splits;
use crate::surface::{Lattice, Level, Pyramid, Surface};
use crate::view::Camera;

/// Largest deviation of facets on the page unless told otherwise, px.
pub const ERROR_PX: f64 = 0.15;
/// How many times as long as their largest deviation sides of facets may be on the page: lines may end wrongly by as much,
/// however little the facets deviate.
const SIDES: f64 = 25.0;
/// How many times as far facets may deviate where all face the eye, or all face away, and no rim is near: no line runs
/// inside, at most along the edge, whose other side is finer or faces the other way as surely.
const CALM: f64 = 4.0;
/// How many times as far as their deviation facets may leave a patch whose sides bend this way and that.
const BENDS: f64 = 2.2;

/// How fine facets are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Detail {
    /// Of one level everywhere.
    Uniform(Level),
    /// Each chunk of its own level, so that facets deviate from the surface by at most so many pixels on the page where a
    /// line may run, and four times as many elsewhere.
    Adaptive {
        /// Pixels, above 0.
        error_px: f64,
    },
}

/// Adaptive, with [`ERROR_PX`].
impl Default for Detail {
    fn default() -> Self {
        Self::Adaptive { error_px: ERROR_PX }
    }
}

impl From<Level> for Detail {
    fn from(level: Level) -> Self {
        Self::Uniform(level)
    }
}

/// The lattice of a frame: chunks as coarse as `error_px` allows where they can be seen, or could but for nearer land if
/// all curves are asked for; else as their neighbours allow.
/// Those that neither appear nor can be crossed by a walk are left out. And what it does without for that.
///
/// # Errors
/// See [`Lattice::adaptive`].
pub fn adaptive(
    surface: &Surface,
    camera: &Camera,
    error_px: f64,
    culling: Culling,
    curves: Curves,
) -> Result<(Lattice, Vec<Omission>)> {
    let (dem, pyramid) = (surface.dem(), surface.pyramid()?);
    let mut demand = Demand::new(surface, pyramid, camera, error_px);
    if curves == Curves::All {
        demand.horizon = None;
    }
    let frustum = DetailView::frustum(surface, camera);
    let from = dem.grid_place(camera.eye.truncate()) * f64::from(CELL_STEPS);
    let tree = Lattice::grow(dem, pyramid.coarsest_step(), from.to_array(), &mut demand)?;
    let role = |origin, step| {
        let bounds = pyramid.bounds(origin, step)?;
        let seen = demand.view.meets(bounds) && !demand.is_hidden(origin, step);
        let crossed = culling == Culling::Off || frustum.meets(bounds);
        seen.then_some(Role::Seen).or(crossed.then_some(Role::Crossed))
    };
    let drops = Cell::new(false);
    let lattice = Lattice::adaptive(dem, tree, |origin, step| {
        let role = role(origin, step);
        drops.set(drops.get() || role.is_none());
        role
    })?;
    // Chunks coarser than the grid take some of its samples.
    let skips_samples = drops.get() || lattice.chunks().iter().any(|chunk| chunk.step > CELL_STEPS);
    let left_out = [(Omission::FineFacets, demand.stops), (Omission::Samples, skips_samples)];
    Ok((lattice, left_out.into_iter().filter(|(_, is_left_out)| *is_left_out).map(|(what, _)| what).collect()))
}

/// Of each chunk of a lattice whether some of it is not beside the page's map projection.
///
/// # Errors
/// As [`Surface::pyramid`].
pub fn across(surface: &Surface, lattice: &Lattice, camera: &Camera) -> Result<impl Iterator<Item = bool>> {
    let (pyramid, frustum) = (surface.pyramid()?, DetailView::frustum(surface, camera));
    let bounds = lattice.chunks().iter().map(|chunk| pyramid.bounds(chunk.origin, chunk.step));
    Ok(bounds.map(move |bounds| bounds.is_some_and(|bounds| frustum.meets(bounds))))
}

/// What lies on the inner side of planes through the eye. Metres from sample (0, 0).
struct DetailView {
    eye: DVec3,
    inward: Vec<DVec3>,
}

impl DetailView {
    /// What some ray of the page passes over or under.
    fn frustum(surface: &Surface, camera: &Camera) -> Self {
        let inward = camera.frustum().into_iter().flatten().map(|n| n.extend(0.0)).collect();
        Self { eye: camera.eye - surface.dem().position(0, 0).with_z(0.0), inward }
    }

    /// Whether some of a box may.
    fn meets(&self, [low, high]: [DVec3; 2]) -> bool {
        let (middle, reach) = ((low + high) / 2.0 - self.eye, (high - low) / 2.0);
        self.inward.iter().all(|inward| inward.dot(middle) + inward.abs().dot(reach) >= 0.0)
    }
}

/// What a camera asks of chunks.
struct Demand<'a> {
    pyramid: &'a Pyramid,
    view: DetailView,
    has_voids: bool,
    /// Lattice place of the last sample.
    end: [u32; 2],
    /// `None` where all land counts as seen.
    horizon: Option<Horizon>,
    /// Largest deviation for each metre of distance, metres.
    tolerance: f64,
    /// Largest step for each metre of distance, lattice units.
    widest: f64,
    /// Squares found hidden, by their corner and size.
    hidden: HashSet<([u32; 2], u32)>,
    /// Whether a chunk was left coarser than it could be.
    stops: bool,
}

impl<'a> Demand<'a> {
    fn new(surface: &Surface, pyramid: &'a Pyramid, camera: &Camera, error_px: f64) -> Self {
        let [right, up, forward] = camera.axes();
        let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0 + 1.0;
        let (side, rise) = (right * camera.focal(), up * camera.focal());
        let sides = [side, -side].map(|side| forward * half.x + side);
        let ends = [rise, -rise].map(|rise| forward * half.y + rise);
        // In a corner of the page things look larger than in its middle at the same distance.
        let corner = camera.focal().hypot(half.length());
        Self {
            pyramid,
            view: DetailView {
                eye: camera.eye - surface.dem().position(0, 0).with_z(0.0),
                inward: [&[forward][..], &sides, &ends].concat(),
            },
            has_voids: surface.dem().voids() > 0,
            end: [surface.dem().columns(), surface.dem().rows()].map(|samples| (samples as u32 - 1) * CELL_STEPS),
            horizon: Horizon::new(surface, camera),
            tolerance: error_px / corner,
            widest: SIDES * error_px / corner / surface.dem().cell().max_element() * f64::from(CELL_STEPS),
            hidden: HashSet::new(),
            stops: false,
        }
    }

    /// Whether a chunk lies in a square that was found hidden.
    fn is_hidden(&self, origin: [u32; 2], step: u32) -> bool {
        let largest = CHUNK_QUADS * self.pyramid.coarsest_step();
        let mut sizes = std::iter::successors(Some(CHUNK_QUADS * step), |size| (*size < largest).then_some(2 * size));
        sizes.any(|size| self.hidden.contains(&(origin.map(|at| at / size * size), size)))
    }

    /// Whether all land of a square lies below the horizon, part by part.
    fn below_horizon(&self, origin: [u32; 2], step: u32, depth: u32) -> bool {
        let Some(bounds) = self.pyramid.bounds(origin, step) else { return true };
        if self.horizon.as_ref().is_none_or(|horizon| horizon.hides(bounds)) {
            return self.horizon.is_some();
        }
        let half = CHUNK_QUADS * step / 2;
        let mut quarters = [[0, 0], [half, 0], [0, half], [half, half]].into_iter();
        depth > 0
            && step > self.pyramid.finest_step()
            && quarters.all(|[x, y]| self.below_horizon([origin[0] + x, origin[1] + y], step / 2, depth - 1))
    }

    /// Whether all facets of a square, at every level, face the eye, or all face away, and none has a side on the rim.
    fn is_calm(&self, origin: [u32; 2], step: u32, [low, high]: [DVec3; 2]) -> bool {
        let end = origin.map(|at| at + CHUNK_QUADS * step);
        let inside = (0..2).all(|axis| origin[axis] > 0 && end[axis] < self.end[axis]);
        if !inside || self.has_voids && self.pyramid.fences(origin, step).is_none() {
            return false;
        }
        let to_eye = [self.view.eye - high, self.view.eye - low];
        // How far the eye may lie above the plane of a facet.
        let [[a, b], [c, d]] = self.pyramid.slopes(origin, step).map(|slope| to_eye.map(|way| slope * way.truncate()));
        let least = to_eye[0].z - a.max(b).max(c).max(d).element_sum();
        let most = to_eye[1].z - a.min(b).min(c).min(d).element_sum();
        least > 0.0 || most < 0.0
    }

    /// Whether the page shows what the facets of a square lack. Notes the square where nearer land hides it.
    fn wants(&mut self, origin: [u32; 2], step: u32, bounds: [DVec3; 2]) -> bool {
        let deviation = self.pyramid.deviation(origin, step);
        if deviation.is_infinite() {
            // Seen or not: where the rim is wrong, so is what a neighbour shares with it.
            return true;
        }
        if !self.view.meets(bounds) {
            return false;
        }
        if self.below_horizon(origin, step, 2) {
            self.hidden.insert((origin, CHUNK_QUADS * step));
            return false;
        }
        let calm = self.is_calm(origin, step, bounds);
        let distance = self.distance(bounds) * if calm { CALM } else { 1.0 };
        deviation > self.tolerance * distance || f64::from(step) > self.widest * distance
    }

    /// From the eye to the nearest place of a box, metres.
    fn distance(&self, [low, high]: [DVec3; 2]) -> f64 {
        self.view.eye.clamp(low, high).distance(self.view.eye)
    }

    /// Raises the horizon by the land of a square, part by part where it is wide.
    fn raise(&mut self, origin: [u32; 2], step: u32, deviation: f64) {
        let pyramid = self.pyramid;
        let (Some(bounds), Some(horizon)) = (pyramid.bounds(origin, step), &mut self.horizon) else { return };
        let [low, high] = bounds.map(DVec3::truncate);
        let wide = horizon.is_wide(low, high);
        if step > CELL_STEPS && !wide {
            // So far and narrow, or beside the page, that it hides little.
            return;
        }
        if step > pyramid.finest_step() && wide {
            let half = CHUNK_QUADS * step / 2;
            for [x, y] in [[0, 0], [half, 0], [0, half], [half, half]] {
                self.raise([origin[0] + x, origin[1] + y], step / 2, deviation);
            }
        }
        let Some(horizon) = &mut self.horizon else { return };
        if step <= CELL_STEPS {
            // Between samples land may dip below its fence, and facets below the land.
            let lowered = deviation * BENDS + f64::from(pyramid.relief(origin, step).beyond);
            horizon.raise(low, high, pyramid.fences(origin, step), lowered);
        }
    }
}

impl Splits for Demand<'_> {
    fn splits(&mut self, origin: [u32; 2], size: u32) -> bool {
        let (pyramid, step) = (self.pyramid, size / CHUNK_QUADS);
        let Some(bounds) = pyramid.bounds(origin, step).filter(|_| step > 1) else { return false };
        let wanted = self.wants(origin, step, bounds);
        self.stops |= !wanted;
        wanted
    }

    /// Beside a coarser chunk a facet of level 1 spans two cells, one of which may lack its patch.
    fn stands_among_equals(&self, origin: [u32; 2], size: u32) -> bool {
        let step = size / CHUNK_QUADS;
        self.has_voids && step == CELL_STEPS && self.pyramid.fences(origin, step).is_none()
    }

    fn done(&mut self, origin: [u32; 2], size: u32, split: bool) {
        let step = size / CHUNK_QUADS;
        // What is split further is looked at as a square of the finest layer.
        let finest = self.pyramid.finest_step();
        if step == finest || step > finest && !split {
            self.raise(origin, step, self.pyramid.deviation(origin, step));
        }
    }
}
