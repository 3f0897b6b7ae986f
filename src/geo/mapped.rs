//! Lines for other programs that know where they lie: the formats that hold them, and what each line says.

use std::path::Path;

use glam::DVec3;

/// A format of vectors on the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapFormat {
    /// A database of OGC, in any system of coordinates.
    GeoPackage,
    /// RFC 7946, in degrees of WGS 84.
    GeoJson,
    /// Of OGC, in degrees of WGS 84.
    Kml,
}

/// A line with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MapLine {
    /// What it draws.
    pub kind: String,
    /// The layer of the user's own that it is of.
    pub layer: Option<String>,
    /// Unique among lines that have one.
    pub id: Option<String>,
    /// Of streams and own lines.
    pub order: Option<u8>,
    /// Metres from the eye to its nearest point, where there is an eye.
    pub depth: Option<f64>,
    /// Metres along it.
    pub length: f64,
    /// In the system of the file, heights in metres.
    pub points: Vec<DVec3>,
}

impl MapFormat {
    /// All of them, by the endings of their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("gpkg", Self::GeoPackage), ("geojson", Self::GeoJson), ("kml", Self::Kml)];

    /// The format that a name asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let ends_in = |ending: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
        Self::ALL.into_iter().find(|(ending, _)| ends_in(ending)).map(|(_, format)| format)
    }

    /// Whether it holds degrees of WGS 84 alone.
    pub(crate) fn is_of_globe(self) -> bool {
        self != Self::GeoPackage
    }
}
