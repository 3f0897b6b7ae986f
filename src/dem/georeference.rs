//! Where a DEM lies on Earth: its world coordinates beside those of its file, and longitude and latitude.

use std::sync::Arc;

use glam::DVec2;

use super::systems::{Crs, Transform};
use crate::error::Result;

/// Two systems of coordinates: that of the file as it came, and that in which the DEM stands north-up in metres.
///
/// World coordinates are metres: those of the world's system times its unit.
#[derive(Debug, Clone)]
pub struct Georeference {
    file: Crs,
    world: Crs,
    /// Nothing where nobody placed the grid.
    transform: Option<Arc<dyn Transform>>,
}

/// Whether the systems are the same, whoever leads from one to another.
impl PartialEq for Georeference {
    fn eq(&self, other: &Self) -> bool {
        self.file == other.file && self.world == other.world
    }
}

impl Georeference {
    /// `world` must be a system of lengths, not of angles. `transform` leads from these to other systems.
    pub fn new(file: Crs, world: Crs, transform: Arc<dyn Transform>) -> Self {
        Self { file, world, transform: Some(transform) }
    }

    /// Of a grid that nobody placed.
    pub fn unknown() -> Self {
        Self { file: Crs::unknown(), world: Crs::unknown(), transform: None }
    }

    /// The system of the file, of the first one where there are several.
    pub fn file(&self) -> &Crs {
        &self.file
    }

    /// The system whose coordinates, in metres, are the world's.
    pub fn world(&self) -> &Crs {
        &self.world
    }

    /// World place in metres of a place in `crs`; `None` where there is no such place or the DEM's system is unknown.
    pub fn world_place(&self, crs: &Crs, place: DVec2) -> Option<DVec2> {
        Some(self.carried(crs, &self.world, place)? * self.world.metres_per_unit()?)
    }

    /// World places in metres of many places in `crs`, each `None` as for [`Self::world_place`].
    pub(crate) fn world_places(&self, crs: &Crs, places: &[DVec2]) -> Vec<Option<DVec2>> {
        let one_system = *crs == self.world;
        let (Some(unit), Some(transform), false) = (self.world.metres_per_unit(), &self.transform, one_system) else {
            return places.iter().map(|place| self.world_place(crs, *place)).collect();
        };
        transform.places(crs, &self.world, places).into_iter().map(|place| Some(place? * unit)).collect()
    }

    /// Places in `crs` of many world places in metres, each `None` as for [`Self::world_place`].
    pub(crate) fn places_in(&self, crs: &Crs, places: &[DVec2]) -> Vec<Option<DVec2>> {
        let one_system = *crs == self.world;
        let (Some(unit), Some(transform), false) = (self.world.metres_per_unit(), &self.transform, one_system) else {
            return places.iter().map(|place| self.place_in(crs, *place)).collect();
        };
        let places: Vec<DVec2> = places.iter().map(|place| *place / unit).collect();
        transform.places(&self.world, crs, &places)
    }

    /// Place in `crs` of a world place in metres; `None` as for [`Self::world_place`].
    pub fn place_in(&self, crs: &Crs, world: DVec2) -> Option<DVec2> {
        self.carried(&self.world, crs, world / self.world.metres_per_unit()?)
    }

    /// Degrees of longitude and latitude of a world place in metres, in [`Self::globe`]; `None` where there is none.
    ///
    /// # Errors
    /// Those of [`Transform::lonlat`].
    pub fn lonlat(&self, world: DVec2) -> Result<Option<DVec2>> {
        Ok(self.globe()?.and_then(|globe| self.place_in(&globe, world)))
    }

    /// The place in one system of a place in another; the same place where both are one, known or not.
    fn carried(&self, from: &Crs, to: &Crs, place: DVec2) -> Option<DVec2> {
        if from == to {
            return place.is_finite().then_some(place);
        }
        self.transform.as_ref()?.place(from, to, place)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Georeference {
    /// Longitude and latitude on the DEM's body: WGS 84 on Earth, the DEM's own ellipsoid elsewhere; `None` where the DEM
    /// lies on no globe, or nobody says where.
    ///
    /// # Errors
    /// Those of [`Transform::lonlat`].
    pub fn globe(&self) -> Result<Option<Crs>> {
        self.transform.as_ref().map_or(Ok(None), |transform| transform.lonlat(&self.world))
    }
}
