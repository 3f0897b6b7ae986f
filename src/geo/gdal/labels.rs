//! Coordinate systems that a file names and that cannot be its own, by its coordinates alone.
//!
//! Degrees end at the poles and after a turn; cells of less than a millimetre are no land, and mostly degrees under the
//! name of a map. Not handled: a wrong system in which the coordinates are possible; nothing in the file tells.

use glam::DVec2;

use super::crs::CrsPath;
use super::grid::{GeoGrid, looks_like_degrees};
use super::source::Source;
use crate::dem::{Crs, History};
use crate::error::Result;

/// How far, in cells, a sample may lie beyond a pole: rounding of file formats.
const BEYOND_CELLS: f64 = 1e-3;
/// Smallest cell of a map, metres.
const SMALLEST: f64 = 1e-3;
/// How far, in degrees, a DEM may lie outside the area that its system is made for.
const OUTSIDE: f64 = 1.0;

/// Fails where `grid`, in the system that `source` names, cannot lie so.
pub(super) fn check(grid: &GeoGrid, source: &Source, history: &mut History) -> Result<()> {
    match grid.crs.turn() {
        Some(turn) => check_angles(grid, turn, source),
        None => check_lengths(grid, source, history),
    }
}

fn check_angles(grid: &GeoGrid, turn: f64, source: &Source) -> Result<()> {
    let [west, south, east, north] = grid.extent();
    let (pole, cell) = (turn / 4.0, grid.cell());
    let farthest = north.max(-south);
    let what = if farthest > pole + BEYOND_CELLS * cell.y {
        format!(
            "its samples reach latitude {}, and there is none beyond {pole}",
            if north > pole { north } else { south }
        )
    } else if east - west > turn + cell.x || west > 1.5 * turn || east < -1.5 * turn {
        format!("its samples reach from longitude {west} to {east}, and a turn is {turn}")
    } else {
        return Ok(());
    };
    let name = grid.crs.label();
    let what = format!("{what}, so that it cannot be in {name} as it says");
    let farthest = [west, south, east, north].iter().fold(0.0_f64, |most, edge| most.max(edge.abs()));
    let remedy = match farthest > 2.0 * turn {
        true => "name the map that its coordinates are of: `gdal_translate -a_srs EPSG:CODE IN OUT.tif`",
        false => "correct its edges: `gdal_translate -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`",
    };
    Err(source.error(what, remedy))
}

fn check_lengths(grid: &GeoGrid, source: &Source, history: &mut History) -> Result<()> {
    let metres = grid.cell() * grid.crs.metres_per_unit().unwrap_or(1.0);
    let cell = metres.min_element();
    let like_degrees = looks_like_degrees(grid, 1.0);
    let named = !grid.crs.wkt().is_empty();
    if cell < SMALLEST || like_degrees && named && is_elsewhere(grid) {
        let cells = format!("cells of {} x {} m", short(metres.x), short(metres.y));
        let wrong = match named {
            true => format!("{cells} at {} cannot be in {} as it says", place(grid), grid.crs.label()),
            false => format!("{cells} at {} are no land", place(grid)),
        };
        let remedy = match like_degrees {
            true => "where they are degrees, say so: `gdal_translate -a_srs EPSG:4326 IN OUT.tif`",
            false => "correct its edges: `gdal_translate -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`",
        };
        return Err(source.error(wrong, remedy));
    }
    if named && looks_like_degrees(grid, 0.1) {
        history.assume(format!(
            "coordinates are {} of {} (cells so small look like degrees; if they are, say so with \
             `gdal_translate -a_srs EPSG:4326 IN OUT.tif`)",
            grid.crs.units(),
            grid.crs.label()
        ));
    }
    Ok(())
}

/// Whether a grid lies outside the area that the register gives for its system.
fn is_elsewhere(grid: &GeoGrid) -> bool {
    let area = grid.crs.area();
    let place = Crs::lonlat().ok().and_then(|lonlat| CrsPath::between(&grid.crs, &lonlat)?.place(middle(grid)));
    match (area, place) {
        (Some([west, south, east, north]), Some(place)) => {
            let east = if east < west { east + 360.0 } else { east };
            let x = place.x + 360.0 * (((west + east) / 2.0 - place.x) / 360.0).round();
            let inside = (west - OUTSIDE..=east + OUTSIDE).contains(&x);
            !inside || !(south - OUTSIDE..=north + OUTSIDE).contains(&place.y)
        }
        (Some(_), None) => true,
        (None, _) => false,
    }
}

fn middle(grid: &GeoGrid) -> DVec2 {
    grid.centre(grid.whole())
}

fn place(grid: &GeoGrid) -> String {
    let DVec2 { x, y } = middle(grid);
    format!("{},{}", short(x), short(y))
}

/// To four digits.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
