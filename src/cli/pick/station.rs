//! Where an eye stands, as surveyors call it: what it sights of the land, and what stands in the way.

use glam::{DVec2, DVec3};

use super::place::{Decimals, HiddenBy, Located, Sighting, Slope};
use crate::cli::view_report::ViewReport;
use crate::cli::viewpoint::View;
use crate::error::Result;
use crate::gpu::uniforms::near_plane;
use crate::surface::{Level, Met, Surface};
use crate::view::Perspective;

/// Land hides a place where it stands over it by more than this: drawn lines are no truer. Px.
const OVER: f64 = 0.05;
/// How high above a place is looked for what is not hidden, metres for each of distance; and how closely, metres.
const HIGHEST: f64 = 64.0;
const CLOSELY: f64 = 0.01;

/// An eye over a surface.
#[derive(Clone, Copy)]
pub(super) struct Station<'a> {
    pub surface: &'a Surface,
    pub view: &'a View,
    pub perspective: Perspective,
    /// Exaggerated metres for one of the land.
    exaggeration: f64,
    /// The facets that stand for the surface.
    level: Level,
}

impl<'a> Station<'a> {
    /// The eye of a view of a surface whose heights are exaggerated by a factor, told by facets of a level.
    pub(super) fn new(surface: &'a Surface, view: &'a View, exaggeration: f64, level: Level) -> Self {
        let perspective = Perspective::new(&view.camera, near_plane(surface.dem()));
        Self { surface, view, perspective, exaggeration, level }
    }

    /// What lies first behind a place of the page.
    ///
    /// # Errors
    /// As [`Surface::first_met`].
    pub(super) fn behind(&self, place: DVec2) -> Result<Option<Met>> {
        let (eye, ray) = (self.perspective.eye(), self.view.camera.ray(place));
        let [west, south, east, north] = self.surface.dem().extent();
        let [low, high] = self.heights();
        let [near, far] = [eye.min(DVec3::new(west, south, low)), eye.max(DVec3::new(east, north, high))];
        // Beyond there is nothing.
        let farthest = near.distance(far);
        self.surface.first_met(eye + ray * self.perspective.near(), eye + ray * farthest, self.level)
    }

    /// The highest land over a place of the map.
    ///
    /// # Errors
    /// As [`Surface::first_met`].
    pub(super) fn below(&self, map: DVec2) -> Result<Option<Met>> {
        let [low, high] = self.heights();
        self.surface.first_met(map.extend(high), map.extend(low), self.level)
    }

    /// Heights below and above all land: patches may stand over their samples.
    fn heights(&self) -> [f64; 2] {
        let [low, high] = self.surface.dem().range().unwrap_or_default().map(f64::from);
        let over = high - low + 1.0;
        [low - over, high + over]
    }

    /// What hides a place, if anything does: what lies first before it, less what the page does not tell.
    ///
    /// # Errors
    /// As [`Surface::first_met`].
    pub(super) fn hides(&self, place: DVec3) -> Result<Option<Met>> {
        let eye = self.perspective.eye();
        let way = place - eye;
        let over = OVER * way.length() / self.perspective.focal();
        // What lies before the near plane is not drawn.
        let (near, ahead) = (self.perspective.near(), self.perspective.distance(place));
        let near = if ahead > near { near / ahead } else { 0.0 };
        self.surface.first_met(eye + way * near, place + DVec3::Z * over, self.level)
    }

    /// What is told of land that hides a place.
    ///
    /// # Errors
    /// As [`Self::hides`] and [`Self::located`].
    pub(super) fn hidden_by(&self, met: &Met, place: DVec3) -> Result<HiddenBy> {
        let (closely, highest) = (CLOSELY * self.exaggeration, HIGHEST * place.distance(self.perspective.eye()));
        let is_seen = |height: f64| Ok(self.hides(place + DVec3::Z * height)?.is_none());
        let mut heights = [0.0, closely];
        while heights[1] <= highest && !is_seen(heights[1])? {
            heights = [heights[1], 2.0 * heights[1]];
        }
        while heights[1] <= highest && heights[1] - heights[0] > closely {
            let middle = f64::midpoint(heights[0], heights[1]);
            heights = if is_seen(middle)? { [heights[0], middle] } else { [middle, heights[1]] };
        }
        Ok(HiddenBy {
            located: self.located(met.place)?,
            sighting: self.sighting(met.place),
            seen_from_m: (heights[1] <= highest).then(|| heights[1] / self.exaggeration),
        })
    }

    /// Where a place of the exaggerated world lies.
    ///
    /// # Errors
    /// Those of [`Georeference::lonlat`](crate::dem::Georeference::lonlat).
    pub(super) fn located(&self, world: DVec3) -> Result<Located> {
        let georeference = self.surface.dem().georeference();
        let map = world.truncate();
        Ok(Located {
            place: georeference.place_in(georeference.file(), map).map(|place| place.to_array()),
            lonlat: georeference.lonlat(map)?.map(|place| place.to_array()),
            elevation_m: world.z / self.exaggeration,
            decimals: Decimals::of(self.surface.dem()),
        })
    }

    /// How a place of the exaggerated world lies from the eye.
    pub(super) fn sighting(&self, world: DVec3) -> Sighting {
        let way = (world - self.perspective.eye()) * DVec3::new(1.0, 1.0, self.exaggeration.recip());
        let (map_distance_m, norths) = (way.truncate().length(), self.view.norths.bearings);
        let azimuth = (map_distance_m > 0.0).then(|| way.x.atan2(way.y).to_degrees());
        let from = |north: Option<f64>| Some((azimuth? - north?).rem_euclid(360.0));
        Sighting {
            distance_m: way.length(),
            map_distance_m,
            true_bearing: from(norths.true_north),
            grid_bearing: from(norths.grid),
            vertical_angle: way.z.atan2(map_distance_m).to_degrees(),
            decimals: Decimals::of(self.surface.dem()),
        }
    }

    /// How the land lies where a ray met it.
    ///
    /// # Errors
    /// Those of [`Georeference::bearings`](crate::dem::Georeference::bearings).
    pub(super) fn slope(&self, met: &Met) -> Result<Slope> {
        // Heights of the land are lower by the exaggeration, and its normal is steeper by that.
        let normal = met.normal * DVec3::new(1.0, 1.0, self.exaggeration);
        let level = normal.truncate().length();
        let norths = self.surface.dem().georeference().bearings(met.place.truncate())?;
        let (north, of_north) = match norths.true_north {
            Some(bearing) => ("true", Some(bearing)),
            None => ("grid", norths.grid),
        };
        let azimuth = (level > 0.0).then(|| normal.x.atan2(normal.y).to_degrees());
        Ok(Slope {
            slope: level.atan2(normal.z).to_degrees(),
            falls_towards: azimuth.zip(of_north).map(|(azimuth, north)| (azimuth - north).rem_euclid(360.0)),
            north,
        })
    }

    /// Degrees between the land where a ray met it and the line of sight to there.
    pub(super) fn off_sight(&self, met: &Met) -> f64 {
        // As in `sighting` and in `slope`.
        let way = (met.place - self.perspective.eye()) * DVec3::new(1.0, 1.0, self.exaggeration.recip());
        let normal = met.normal * DVec3::new(1.0, 1.0, self.exaggeration);
        normal.normalize().dot(way.normalize()).abs().min(1.0).asin().to_degrees()
    }

    /// The view that it is of.
    pub(super) fn view_report(&self) -> ViewReport {
        ViewReport::of(self.view, self.surface.dem().georeference(), self.exaggeration)
    }
}
