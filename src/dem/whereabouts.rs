//! Where a DEM lies, in words: what is said where a place is not on it.

use std::path::Path;

use glam::DVec2;

use super::{Crs, Dem};
use crate::error::{Error, Result};

/// The system of a DEM, and where in it the DEM lies, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Whereabouts {
    /// The name of the system, in quotes.
    pub named: String,
    /// `between X,Y and X,Y metres`, or another unit.
    pub within: String,
}

impl Whereabouts {
    /// Of a DEM, in the system of its file.
    pub(crate) fn of(dem: &Dem) -> Self {
        let ([west, south, east, north], georeference) = (dem.extent(), dem.georeference());
        let file = georeference.file();
        let corner = |x, y| georeference.place_in(file, DVec2::new(x, y)).unwrap_or(DVec2::new(x, y));
        let (one, other) = (corner(west, south), corner(east, north));
        let [low, high] = [one.min(other), one.max(other)];
        let decimals = if file.is_geographic() { 6 } else { 2 };
        let pair = |place: DVec2| format!("{:.decimals$},{:.decimals$}", place.x, place.y);
        Self {
            named: if file.label().is_empty() { "no named system".to_owned() } else { format!("\"{}\"", file.label()) },
            within: format!("between {} and {} {}", pair(low), pair(high), file.units()),
        }
    }

    /// Fails where nothing leads from `given`, the system of a file of places, to that of the DEM; `noun`: what the file has.
    ///
    /// # Errors
    /// [`Error::Input`] of `path`; those of [`Georeference::globe`](super::Georeference::globe).
    pub(crate) fn check_way(dem: &Dem, path: &Path, given: &Crs, noun: &str) -> Result<()> {
        let georeference = dem.georeference();
        if given == georeference.file() || georeference.globe()?.is_some() {
            return Ok(());
        }
        let named = Self::of(dem).named;
        let what = format!(
            "lies in {}, and the DEM in {named}, of which nobody knows where on the globe it is",
            given.label()
        );
        let remedy = format!(
            "name the system of the DEM, `gdal_translate -a_srs EPSG:CODE IN OUT.tif`, or give {noun} in its coordinates"
        );
        Err(Error::input(path, what, remedy))
    }
}
