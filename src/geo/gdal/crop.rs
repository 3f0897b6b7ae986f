//! The rectangle that a crop means on the grid of the files: degrees run round the globe, and axes may be turned.
//!
//! A crop of degrees whose west is beyond its east crosses the meridian where they begin anew: 179 to -179 is 179 to 181.

use glam::DVec2;

use super::crs::CrsPath;
use super::grid::{GeoGrid, span};
use super::lie::ALIGNED_CELLS;
use crate::dem::{Crs, Window};
use crate::error::{Error, Result, Setting};
use crate::message;

/// Turns beyond which a globe may not begin or end, to be laid beside itself there.
const FARTHEST: f64 = 0.75;

/// `crop`, in the coordinates of the file, with its west below its east in those of `grid`. Fails where it is no rectangle there.
pub(super) fn on(grid: &GeoGrid, crop: Option<[f64; 4]>) -> Result<Option<[f64; 4]>> {
    let Some([west, south, east, north]) = crop else { return Ok(None) };
    match grid.crs.turn() {
        _ if west < east => {
            let corners = [DVec2::new(west, south), DVec2::new(east, north)].map(|corner| grid.crs.axes() * corner);
            let [low, high] = span(&corners);
            Ok(Some([low.x, low.y, high.x, high.y]))
        }
        Some(turn) if west <= turn && east + turn > west => Ok(Some([west, south, east + turn, north])),
        _ => {
            let what = format!("{west},{south},{east},{north} has its west beyond its east");
            let other = Setting::Crop.at(format!("{east},{south},{west},{north}"));
            Err(Error::setting(Setting::Crop, what, message!["give the two in the other order: ", other]))
        }
    }
}

/// Columns by which a grid that runs once round the globe is to be laid beside itself, so that a crop across its outer
/// edges finds both sides: west (negative) or east. `None` where that is not needed, or its ends do not meet.
pub(super) fn round_the_globe(grid: &GeoGrid, crop: Option<[f64; 4]>) -> Option<i64> {
    let ([west, _, east, _], turn) = (crop?, grid.crs.turn()?);
    let columns = turn / grid.cell().x;
    let whole = grid.columns as f64;
    let meets = (columns - columns.round()).abs() <= ALIGNED_CELLS && columns.round() <= whole;
    if !grid.is_north_up() || !meets {
        return None;
    }
    let [first, _, last, _] = grid.extent();
    let (middle, centre) = ((west + east) / 2.0, (first + last) / 2.0);
    let moved = grid.crs.near(middle, centre) - middle;
    let (west, east) = (west + moved, east + moved);
    let beside = columns.round() as i64;
    match (west < first, east > last) {
        // Which side is the same to all but longitudes so large that systems refuse them.
        (true, false) | (false, true) if last > FARTHEST * turn => Some(-beside),
        (true, false) | (false, true) if first < -FARTHEST * turn => Some(beside),
        (true, false) => Some(-beside),
        (false, true) => Some(beside),
        _ => None,
    }
}

/// The smallest rectangle of one system around that of another; `None` where its edges have no place there. Degrees run on
/// round the globe from its middle; around a pole they are all.
pub(super) fn carried([west, south, east, north]: [f64; 4], from: &Crs, to: &Crs) -> Option<[f64; 4]> {
    // As four samples have it, in the corners.
    let mut places = Window { first: [0, 0], size: [2, 2] }.outline();
    let (low, size) = (DVec2::new(west, south), DVec2::new(east - west, north - south));
    places.iter_mut().for_each(|place| *place = low + (*place - 0.5) * size);
    let way = CrsPath::between(from, to)?;
    way.carry(&mut places);
    if let Some(turn) = to.turn() {
        let middle = way.place(low + size / 2.0)?.x;
        places.iter_mut().for_each(|place| place.x = to.near(place.x, middle));
        let back = CrsPath::between(to, from).filter(|_| from.turn().is_none());
        let inside = |pole: &DVec2| {
            let place = back.as_ref().and_then(|back| back.place(*pole));
            place.is_some_and(|place| place.cmpge(low).all() && place.cmple(low + size).all())
        };
        let poles = [-1.0, 1.0].map(|side| DVec2::new(middle, side * turn / 4.0));
        let half = DVec2::X * turn / 2.0;
        poles.iter().filter(|pole| inside(pole)).for_each(|pole| places.extend([*pole - half, *pole + half]));
    }
    let [low, high] = span(&places);
    places.iter().all(|place| place.is_finite()).then_some([low.x, low.y, high.x, high.y])
}
