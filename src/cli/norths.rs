//! What the azimuths of a view are counted from: a north at the eye, beside the axes of the world.

use glam::DVec2;

use crate::dem::{Bearings, Georeference, North, convergence_in_words};
use crate::error::{Error, Message, Result, Setting};
use crate::message;

/// Decimals of azimuths that are printed: a twentieth of a pixel on a page of 65536 px and 60 degrees.
const DECIMALS: i32 = 4;

/// The norths at an eye, and which of them is in use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Norths {
    /// The one in use.
    pub north: North,
    /// Its bearing, degrees clockwise from the world's y axis.
    bearing: f64,
    /// Those of both.
    pub bearings: Bearings,
}

impl Norths {
    /// At a place of the world.
    ///
    /// # Errors
    /// [`Error::Setting`] where the north in use is unknown there.
    pub(crate) fn at(georeference: &Georeference, north: North, eye: DVec2) -> Result<Self> {
        let bearings = georeference.bearings(eye)?;
        match bearings.of(north) {
            Some(bearing) => Ok(Self { north, bearing, bearings }),
            None => Err(unknown(georeference, north, bearings.grid.is_some(), eye)?),
        }
    }

    /// The azimuth in the world of one that is counted from the north in use.
    pub(crate) fn in_world(&self, azimuth: f64) -> f64 {
        // What needs no turning stays as it is to the last bit.
        if self.bearing == 0.0 { azimuth } else { (azimuth + self.bearing).rem_euclid(360.0) }
    }

    /// An azimuth of the world counted from the north in use, so rounded that it prints short.
    pub(crate) fn counted(&self, azimuth: f64) -> f64 {
        if self.bearing == 0.0 {
            return azimuth;
        }
        let scale = 10_f64.powi(DECIMALS);
        ((azimuth - self.bearing).rem_euclid(360.0) * scale).round().rem_euclid(360.0 * scale) / scale
    }

    /// How far the two norths are apart, where that is worth a line.
    pub(crate) fn words(&self) -> Option<String> {
        let apart = convergence_in_words(self.bearings.convergence()?)?;
        let Self { north, .. } = self;
        Some(format!("azimuths are counted from {north} north; at the eye {apart} (--north {})", north.other()))
    }
}

/// Why the north in use is unknown.
fn unknown(georeference: &Georeference, north: North, grid_is_known: bool, eye: DVec2) -> Result<Error> {
    let label = georeference.world().label();
    let what = match georeference.lonlat(eye)? {
        Some(place) => {
            format!("there is no {north} north at longitude {:.5}, latitude {:.5} degrees", place.x, place.y)
        }
        None if label.is_empty() => format!("the DEM names no coordinate system, so {north} north is unknown"),
        None => {
            format!("the DEM lies in {label}, of which no place on the globe is known, so {north} north is unknown")
        }
    };
    let remedy: Message = match north {
        North::True if grid_is_known => message!["give ", Setting::North.at(North::Grid)],
        _ => "give an eye farther from the pole".into(),
    };
    Ok(Error::setting(Setting::North, what, remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned_by(bearing: f64) -> Norths {
        let bearings = Bearings { grid: Some(0.0), true_north: Some(bearing) };
        Norths { north: North::True, bearing, bearings }
    }

    #[test]
    fn what_is_counted_is_short_and_between_0_and_360() {
        for bearing in [-145.000_012_345, -0.3, 0.000_011, 179.999_99] {
            let norths = turned_by(bearing);
            for azimuth in (0..3600).map(|tenth| f64::from(tenth) / 10.0).chain([bearing.rem_euclid(360.0)]) {
                let counted = norths.counted(azimuth);
                assert!((0.0..360.0).contains(&counted) && counted.to_string().len() <= 8, "{azimuth}: {counted}");
                let gap = (norths.in_world(counted) - azimuth + 180.0).rem_euclid(360.0) - 180.0;
                assert!(gap.abs() <= 0.5001e-4, "{azimuth} becomes {counted}, {gap} off");
            }
        }
    }

    #[test]
    fn what_needs_no_turning_keeps_its_bits() {
        let azimuth = 0.1 + 0.2;
        assert_eq!((turned_by(0.0).in_world(azimuth), turned_by(0.0).counted(azimuth)), (azimuth, azimuth));
        assert_ne!(turned_by(1e-3).counted(azimuth), azimuth);
    }
}
