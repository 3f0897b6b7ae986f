//! The lines of a drawing on the map, for `--georeferenced`.

use std::borrow::Cow;

use glam::{DVec2, DVec3};

use crate::dem::{Crs, Dem};
use crate::error::{Error, Result, Setting};
use crate::geo::{MapFormat, MapLine};
use crate::line::{Id, Land, Line, Lines, MappedLine, mapped};
use crate::surface::Surface;

/// Longitude and latitude on Earth, in the register of EPSG.
const WGS84: u32 = 4326;

/// The system in which a format has the lines of a DEM: that of its file, or degrees.
///
/// # Errors
/// [`Error::Setting`] for a DEM of which nobody knows where on Earth it lies, in a format of degrees.
pub(super) fn crs(format: MapFormat, dem: &Dem) -> Result<Crs> {
    let georeference = dem.georeference();
    if !format.is_of_globe() {
        return Ok(georeference.file().as_defined());
    }
    georeference.globe()?.filter(|globe| globe.epsg() == Some(WGS84)).ok_or_else(|| {
        let what = match georeference.file().label() {
            label if label.is_empty() => {
                "the DEM names no coordinate system, and this format holds places on Earth alone".to_owned()
            }
            label => {
                format!("the DEM lies in {label}, which is nowhere on Earth, and this format holds places there alone")
            }
        };
        let remedy = "name it .gpkg, or name the system of the DEM, `gdal_translate -a_srs EPSG:CODE IN OUT.tif`";
        Error::setting(Setting::Georeferenced, what, remedy)
    })
}

/// What of lines is drawn, in a system of coordinates; `land` are the lines of the land among them.
///
/// # Errors
/// As [`mapped`]; [`Error::Setting`] for lines where the system has no places.
pub(super) fn lines(
    lines: &Lines,
    land: Option<&Land>,
    surface: &Surface,
    exaggeration: f64,
    crs: &Crs,
) -> Result<Vec<MapLine>> {
    let plain = without_exaggeration(surface, exaggeration);
    let mapped = mapped(lines, land, &plain)?;
    // Seen from straight above there is no eye.
    let eye = Some(lines.eye / DVec3::new(1.0, 1.0, exaggeration)).filter(|eye| eye.is_finite());
    let places: Vec<DVec2> = mapped.iter().flat_map(|line| &line.points).map(|point| point.truncate()).collect();
    let mut places = surface.dem().georeference().places_in(crs, &places).into_iter();
    let mut placed = |point: &DVec3| {
        let place = places.next().flatten().ok_or_else(|| {
            let what = format!("there is no place {},{} m of the map in {}", point.x, point.y, crs.label());
            Error::setting(Setting::Georeferenced, what, "name a .gpkg, or draw a part of the DEM (--crop)")
        })?;
        Ok(place.extend(point.z))
    };
    let of_mapped = |mapped: &MappedLine| {
        Ok(MapLine {
            kind: mapped.line.name().to_owned(),
            layer: match mapped.line {
                Line::Own(layer) => lines.own.get(usize::from(layer)).cloned(),
                _ => None,
            },
            id: mapped.id.map(|id| named(id, mapped.piece)),
            order: mapped.order,
            depth: eye.map(|eye| mapped.distance(eye)),
            length: mapped.length(),
            points: mapped.points.iter().map(&mut placed).collect::<Result<_>>()?,
        })
    };
    mapped.iter().map(of_mapped).collect()
}

/// A run of a chain, called as its strokes are.
fn named(id: Id, piece: u32) -> String {
    match piece {
        0 => id.written(),
        piece => format!("{}-{piece}", id.written()),
    }
}

/// The surface with heights of the land.
fn without_exaggeration(surface: &Surface, exaggeration: f64) -> Cow<'_, Surface> {
    match exaggeration {
        1.0 => Cow::Borrowed(surface),
        factor => Cow::Owned(Surface::new(surface.dem().lowered(factor))),
    }
}
