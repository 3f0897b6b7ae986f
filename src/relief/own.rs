//! Lines of the user's own on a DEM, cut where they leave it or enter voids.
//!
//! Method: edges are straight in the file's coordinates; `carry` leads them to the DEM, `land` cuts them at its voids. Cost: a
//! place on a map for every eight cells of line; an edge that misses the DEM costs a comparison. Not handled: lines that jump
//! over the meridian of 180 degrees, and lines finer than cells, which stay as fine as they are.

mod carry;
mod land;

use std::path::Path;

use glam::DVec2;

use super::{LineKind, SurfaceLine, SurfacePoint};
use crate::dem::{Crs, Dem, Whereabouts};
use crate::error::{Error, Result};
use crate::geo::{OwnLayer, OwnLine, OwnLines};

/// The lines of a file on a DEM, in the order of the file, at steps of at most a cell; layers that have lines are numbered from
/// `first` on. Places of layers that name no system are taken for those of the DEM's file. `path`: what the file is called.
///
/// # Errors
/// [`Error::Input`] where nothing leads from the file's system to the DEM's, and where no line has a part on the land; as
/// [`Dem::validity`].
pub fn own_lines(path: &Path, given: &OwnLines, dem: &Dem, first: usize) -> Result<Vec<SurfaceLine>> {
    match on_dem(path, given, dem, first)? {
        (lines, _) if !lines.is_empty() => Ok(lines),
        (_, true) => Err(Error::input(
            path,
            "its lines lie in voids of the DEM alone",
            "give lines over its land, or fill its voids",
        )),
        (_, false) => Err(outside(path, given, dem)),
    }
}

/// The same for who draws without where no line has a part on the land.
///
/// # Errors
/// As [`own_lines`], but for that.
pub(crate) fn own_lines_if_any(path: &Path, given: &OwnLines, dem: &Dem, first: usize) -> Result<Vec<SurfaceLine>> {
    on_dem(path, given, dem, first).map(|(lines, _)| lines)
}

/// The lines, and whether the DEM has a place for any, be it a void.
fn on_dem(path: &Path, given: &OwnLines, dem: &Dem, first: usize) -> Result<(Vec<SurfaceLine>, bool)> {
    let (mut lines, mut reach_dem) = (Vec::new(), false);
    for (number, layer) in (first..).zip(given.drawn()) {
        // What is beyond the last number goes with that.
        let kind = LineKind::Own(u16::try_from(number).unwrap_or(u16::MAX));
        let crs = system(layer.crs.as_ref(), dem);
        Whereabouts::check_way(dem, path, crs, "lines")?;
        let parts = carry::to_grid(&layer.lines, crs, dem);
        for (line, parts) in layer.lines.iter().zip(parts) {
            reach_dem |= !parts.is_empty();
            let on_land = parts.iter().map(|part| land::on_land(part, dem)).collect::<Result<Vec<_>>>()?;
            lines.extend(
                joined(on_land.concat(), line)
                    .into_iter()
                    .filter_map(|(part, closed)| surface_line(kind, &part, closed, line.order, dem.cell())),
            );
        }
    }
    Ok((lines, reach_dem))
}

/// The system of places of which a file says this.
fn system<'a>(named: Option<&'a Crs>, dem: &'a Dem) -> &'a Crs {
    named.unwrap_or(dem.georeference().file())
}

/// Parts of a line, and whether each is closed: the last one goes on in the first where a closed line begins on the land.
fn joined(mut parts: Vec<Vec<DVec2>>, line: &OwnLine) -> Vec<(Vec<DVec2>, bool)> {
    let mut closed = false;
    let goes_on =
        line.closed && parts.first().and_then(|part| part.first()) == parts.last().and_then(|part| part.last());
    if let Some(mut last) = if goes_on { parts.pop() } else { None } {
        last.pop();
        closed = parts.is_empty();
        match parts.first_mut() {
            Some(first) => {
                last.append(first);
                *first = last;
            }
            None => parts.push(last),
        }
    }
    parts.into_iter().map(|part| (part, closed)).collect()
}

/// A line through places of the grid; `None` where it has no length.
fn surface_line(kind: LineKind, places: &[DVec2], closed: bool, order: u8, cell: DVec2) -> Option<SurfaceLine> {
    let mut length = 0.0;
    let point = |i: usize| {
        length += i.checked_sub(1).map_or(0.0, |before| ((places[i] - places[before]) * cell).length());
        SurfacePoint { at: places[i], across: [f32::INFINITY; 3], length: length as f32, drop: f32::INFINITY }
    };
    let points: Vec<_> = (0..places.len()).map(point).collect();
    (points.len() > 1).then_some(SurfaceLine { kind, order, points, closed, joins: None })
}

/// The error for lines that are nowhere over the DEM.
fn outside(path: &Path, given: &OwnLines, dem: &Dem) -> Error {
    let Whereabouts { named, within } = Whereabouts::of(dem);
    let between = |layer: &OwnLayer| {
        let places = || layer.lines.iter().flat_map(|line| &line.places).copied().filter(|place| place.is_finite());
        let (low, high) = (places().reduce(DVec2::min)?, places().reduce(DVec2::max)?);
        let system = system(layer.crs.as_ref(), dem);
        let decimals = if system.is_geographic() { 6 } else { 2 };
        let of = if system.label().is_empty() { String::new() } else { format!(" of {}", system.label()) };
        Some(format!(
            "between {:.decimals$},{:.decimals$} and {:.decimals$},{:.decimals$}{of}",
            low.x, low.y, high.x, high.y
        ))
    };
    let lie = given.layers.iter().find_map(between).unwrap_or_else(|| "nowhere".to_owned());
    let what = format!("lies outside the DEM: {lie}, and the DEM {within} of {named}");
    Error::input(path, what, "give lines over the DEM, x first, in the system that the file names")
}
