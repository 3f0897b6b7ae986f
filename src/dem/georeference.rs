//! Where a DEM lies on Earth: its world coordinates beside those of its file, and longitude and latitude.

use glam::DVec2;

use super::crs::{Crs, Way};
use crate::error::Result;

/// Two systems of coordinates: that of the file as it came, and that in which the DEM stands north-up in metres.
///
/// World coordinates are metres: those of the world's system times its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Georeference {
    file: Crs,
    world: Crs,
}

impl Georeference {
    /// `world` must be a system of lengths, not of angles.
    pub(super) fn new(file: Crs, world: Crs) -> Self {
        Self { file, world }
    }

    /// Of a grid that nobody placed.
    pub fn unknown() -> Self {
        Self::new(Crs::unknown(), Crs::unknown())
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
        Some(Way::between(crs, &self.world)?.place(place)? * self.world.metres_per_unit()?)
    }

    /// Place in `crs` of a world place in metres; `None` as for [`Self::world_place`].
    pub fn place_in(&self, crs: &Crs, world: DVec2) -> Option<DVec2> {
        Way::between(&self.world, crs)?.place(world / self.world.metres_per_unit()?)
    }

    /// Degrees of longitude and latitude (WGS 84) of a world place in metres; `None` where the system is unknown.
    ///
    /// # Errors
    /// Those of [`Crs::lonlat`].
    pub fn lonlat(&self, world: DVec2) -> Result<Option<DVec2>> {
        if self.world.wkt().is_empty() {
            return Ok(None);
        }
        Ok(self.place_in(&Crs::lonlat()?, world))
    }
}
