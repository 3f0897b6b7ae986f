//! The land that slope lines run down: the PN surface, with what ends lines.
//!
//! A place on the lattice of patches is led to the map by a cubic that also bends sideways. There the way downhill is that against
//! the gradient; on the lattice it is what the inverse of the cubic's derivative makes of it. Cost: some 60 ns a place, 100 ns more
//! where it is in another patch than the place before.

use std::sync::Arc;

use glam::{DVec2, DVec3, FloatExt};
use xxhash_rust::xxh3::Xxh3;

use super::SlopeRules;
use super::halved::halved;
use super::stops::Stops;
use crate::dem::Dem;
use crate::error::Result;
use crate::relief::{FlatWater, SurfaceLine, spacing};
use crate::surface::{Patch, Surface};

/// Least gradient that has a direction.
const LEAST_GRADIENT: f64 = 1e-6;
/// Least share of its cell that a facet of the surface covers on the map; where it has less, the surface is about to fold.
const LEAST_COVER: f64 = 0.01;

/// The share of the least gradient under which, at a sample, no line begins about it.
const NEARLY: f64 = 0.5;

/// Metres of water above a place of a channel, or of flow that a ridge parts there, in cells, from which on it ends lines on land at a
/// smaller scale.
pub(super) const LONG_CELLS: f64 = 8.0;

/// The land and its rules.
#[derive(Debug)]
pub(super) struct Land {
    /// Held.
    pub surface: Arc<Surface>,
    /// Metres of the surface's cells.
    pub cell: DVec2,
    /// Metres between the DEM's samples, of which those of the surface are all or some.
    metres: DVec2,
    /// What lies under the surface where that is at a smaller scale: lines lie on it.
    ground: Option<Arc<Surface>>,
    rules: SlopeRules,
    exaggeration: f64,
    /// Least gradient, exaggerated metres a metre.
    least: f64,
    /// Cosine of the most turn.
    turned: f64,
    stops: Stops,
    water: Option<FlatWater>,
}

/// A place of the land.
#[derive(Debug, Clone, Copy)]
pub(super) struct LandPlace {
    /// Metres on the map from the north-west sample, x east and y south, by columns and rows.
    pub at: DVec2,
    /// Exaggerated metres.
    pub height: f64,
    /// Exaggerated metres for a metre east and for one north.
    pub gradient: DVec2,
    /// A metre downhill on the map, by columns and rows as `at` is.
    pub downhill: DVec2,
}

impl LandPlace {
    /// Whether the map's way downhill is no more than so far, by its cosine, from that of another place.
    fn is_towards(&self, other: &Self, cosine: f64) -> bool {
        self.gradient.dot(other.gradient) >= cosine * self.gradient.length() * other.gradient.length()
    }
}

impl Land {
    /// Of a surface; of a filed one its every so-manieth sample is held.
    ///
    /// # Errors
    /// As [`Dem::spaced`].
    pub(super) fn new(
        surface: Arc<Surface>,
        exaggeration: f64,
        rules: SlopeRules,
        stops: &[SurfaceLine],
        water: Option<&FlatWater>,
    ) -> Result<Self> {
        let spacing = spacing(surface.dem());
        let surface = if surface.dem().is_filed() { Arc::new(thinned(surface.dem(), spacing)?) } else { surface };
        let metres = surface.dem().cell() / spacing as f64;
        Ok(Self::on(surface, metres, exaggeration, rules, stops, water))
    }

    fn on(
        surface: Arc<Surface>,
        metres: DVec2,
        exaggeration: f64,
        rules: SlopeRules,
        stops: &[SurfaceLine],
        water: Option<&FlatWater>,
    ) -> Self {
        let dem = surface.dem();
        let cells = [dem.columns(), dem.rows()].map(|samples| samples - 1);
        let scale = (dem.cell() / metres).x.round();
        Self {
            cell: dem.cell(),
            least: (exaggeration * rules.min_slope.to_radians().tan()).max(LEAST_GRADIENT),
            turned: rules.max_turn.to_radians().cos(),
            stops: Stops::new(stops, cells, scale),
            water: water.cloned(),
            ground: None,
            metres,
            rules,
            exaggeration,
            surface,
        }
    }

    /// The same at half the scale, where only longer ones of all `stops` end lines; none of land that is small.
    ///
    /// # Errors
    /// As [`halved`].
    pub(super) fn halved(&self, stops: &[SurfaceLine]) -> Result<Option<Self>> {
        let Some(dem) = halved(self.surface.dem())? else { return Ok(None) };
        let long = LONG_CELLS * dem.cell().min_element();
        let stops = long_stops(stops, long);
        let surface = Arc::new(Surface::new(dem));
        let land = Self::on(surface, self.metres, self.exaggeration, self.rules, &stops, self.water.as_ref());
        let ground = self.ground.clone().unwrap_or_else(|| self.surface.clone());
        Ok(Some(Self { ground: Some(ground), ..land }))
    }

    /// The height of what lies under a place of the surface, by the samples around it, exaggerated metres; none at voids and
    /// outside.
    pub(super) fn height(&self, place: &LandPlace) -> Option<f64> {
        let on_ground = |ground: &Arc<Surface>| {
            let dem = ground.dem();
            let at = place.at / dem.cell();
            let last = DVec2::new(dem.columns() as f64, dem.rows() as f64) - 1.0;
            let corner = at.min(last - 1.0).as_usizevec2();
            let DVec2 { x: u, y: v } = at - corner.as_dvec2();
            let height = |c: usize, r: usize| dem.height(corner.x + c, corner.y + r).map(f64::from);
            let along = |r: usize| Some(height(0, r)?.lerp(height(1, r)?, u));
            at.cmple(last).all().then(|| Some(along(0)?.lerp(along(1)?, v))).flatten()
        };
        self.ground.as_ref().map_or(Some(place.height), on_ground)
    }

    /// Adds to a hash what lines depend on beside the heights.
    pub(super) fn identify(&self, hash: &mut Xxh3) {
        hash.update(bytemuck::bytes_of(&[self.least, self.turned, self.cell.x]));
        hash.update(&[self.water.is_some().into()]);
        self.water.iter().for_each(|water| water.identify(hash));
        self.stops.identify(hash);
        self.surface.limits().identify(hash);
    }

    /// Metres on the map of a column and row of the DEM.
    pub(super) fn metres(&self, at: DVec2) -> DVec2 {
        at * self.metres
    }

    /// The column and row of the DEM of such metres.
    pub(super) fn samples(&self, at: DVec2) -> DVec2 {
        at / self.metres
    }

    /// Whether the land about a place may slope enough for a line to begin there, as its nearest sample tells.
    pub(super) fn may_slope(&self, at: DVec2) -> bool {
        let dem = self.surface.dem();
        let [c, r] = (at / self.cell).round().max(DVec2::ZERO).as_usizevec2().to_array();
        let is_inside = c < dem.columns() && r < dem.rows();
        is_inside && self.surface.gradient(c, r).length_squared() >= (NEARLY * self.least).powi(2)
    }

    /// Whether lines may be on land of a gradient, exaggerated metres a metre.
    pub(super) fn is_steep(&self, gradient: DVec2) -> bool {
        gradient.length_squared() >= self.least * self.least
    }

    /// The share of the way between two places at which a line ends.
    pub(super) fn met(&self, [from, to]: [DVec2; 2]) -> Option<f64> {
        self.stops.met([from / self.cell, to / self.cell])
    }

    /// Whether a line through `seed` may be at a place.
    pub(super) fn allows(&self, place: &LandPlace, seed: &LandPlace) -> bool {
        let is_water = |water: &FlatWater| {
            let at = self.samples(place.at).round().as_usizevec2();
            water.is_water(at.x, at.y)
        };
        self.is_steep(place.gradient)
            && place.is_towards(seed, self.turned)
            && self.height(place).is_some()
            && !self.water.as_ref().is_some_and(is_water)
    }
}

/// The parts of lines whose water is so long, metres: those that tell of larger forms. They join nothing.
pub(super) fn long_stops(stops: &[SurfaceLine], metres: f64) -> Vec<SurfaceLine> {
    let long = |line: &SurfaceLine| {
        let from = line.points.partition_point(|point| f64::from(point.length) < metres);
        SurfaceLine {
            kind: line.kind,
            order: line.order,
            points: line.points[from..].to_vec(),
            closed: line.closed && from == 0,
            joins: None,
        }
    };
    stops.iter().map(long).filter(|line| line.points.len() > 1).collect()
}

/// The surface of a DEM's every so-manieth sample, held.
fn thinned(dem: &Dem, spacing: usize) -> Result<Surface> {
    let size = [dem.columns(), dem.rows()].map(|samples| samples.div_ceil(spacing).max(2));
    let heights = dem.spaced([0, 0], spacing, size)?;
    let origin = dem.position(0, 0).truncate();
    Ok(Surface::new(Dem::from_heights(size[0], dem.cell() * spacing as f64, origin, heights)))
}

/// Goes over the land, and knows the patch that it is on.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    /// Where.
    pub land: &'a Land,
    patch: Option<(PatchAt, Patch)>,
}

/// Column, row and half of a patch.
type PatchAt = [usize; 3];

impl<'a> Walker<'a> {
    /// Nowhere yet.
    pub(super) fn new(land: &'a Land) -> Self {
        Self { land, patch: None }
    }

    /// A place by its metres; none outside, at voids, where the surface is level and where it folds.
    pub(super) fn place(&mut self, at: DVec2) -> Option<LandPlace> {
        let (dem, cell) = (self.land.surface.dem(), self.land.cell);
        let place = at / cell;
        let last = DVec2::new(dem.columns() as f64, dem.rows() as f64) - 1.0;
        let inside = place.cmpge(DVec2::ZERO).all() && place.cmple(last).all();
        let corner = place.min(last - 1.0).as_usizevec2();
        let DVec2 { x: u, y: v } = place - corner.as_dvec2();
        let half = usize::from(v < u);
        let patch = if inside { self.patch([corner.x, corner.y, half])? } else { return None };
        let weights = if half == 0 { [1.0 - v, v - u, u] } else { [1.0 - u, v, u - v] };
        let by_weight = patch.derivatives(weights);
        let point = by_weight.iter().zip(weights).map(|(by, weight)| *by * weight).sum::<DVec3>() / 3.0;
        let [a, b, c] = by_weight;
        let [east, south] = if half == 0 { [c - b, b - a] } else { [c - a, b - c] };
        // Points down, for east and south are a left-handed pair.
        let normal = east.cross(south);
        let gradient = normal.truncate() / -normal.z;
        let way = -gradient.normalize_or_zero();
        let downhill = DVec2::new(way.perp_dot(south.truncate()), east.truncate().perp_dot(way)) / normal.z * cell;
        let is_sloping = normal.z <= -LEAST_COVER * cell.x * cell.y && gradient.length_squared() > 0.0;
        is_sloping.then(|| LandPlace { at, height: point.z, gradient, downhill: downhill.normalize_or_zero() })
    }

    /// A patch; none where a corner is a void.
    fn patch(&mut self, at: PatchAt) -> Option<&Patch> {
        if self.patch.is_none_or(|(held, _)| held != at) {
            self.patch = Some((at, made(&self.land.surface, at)?));
        }
        self.patch.as_ref().map(|(_, patch)| patch)
    }
}

/// The patch of a half of the cell at a column and row.
fn made(surface: &Surface, [c, r, half]: PatchAt) -> Option<Patch> {
    let dem = surface.dem();
    let third = if half == 0 { [c, r + 1] } else { [c + 1, r] };
    let [nw, se, third] = [[c, r], [c + 1, r + 1], third].map(|[c, r]| {
        let normal = (-surface.gradient(c, r)).extend(1.0).normalize();
        dem.height(c, r).map(|_| (dem.position(c, r), normal))
    });
    let corners = if half == 0 { [nw?, third?, se?] } else { [nw?, se?, third?] };
    Some(Patch::new(corners.map(|corner| corner.0), corners.map(|corner| corner.1)))
}
