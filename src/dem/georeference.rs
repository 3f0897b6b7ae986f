//! Where a raster lies: geotransform and coordinate reference system, taken only as north-up metres.
//!
//! Anything else is refused with the command that mends it. Not handled: degrees, feet, rotated and south-up grids.

use std::ops::RangeInclusive;

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use glam::DVec2;

use super::source::{Source, heard};
use crate::error::{Error, Result};

/// How far, in cells, a rotated row may leave its line before the grid counts as rotated: rounding of file formats.
const STRAIGHT_CELLS: f64 = 1e-3;
/// How far, in cells, a crop edge may miss a sample centre and still hold it: rounding of decimal coordinates.
const CROP_CELLS: f64 = 1e-6;
/// Relative difference of a linear unit to the metre that is still a metre.
const METRE_EPSILON: f64 = 1e-9;
/// Cells below this size, inside the range of degrees and without a CRS, are taken for degrees: 0.1 degree is 11 km.
const DEGREE_CELL: f64 = 0.1;
/// Sound cell sizes in any unit: from a centimetre in degrees to a thousand kilometres in metres.
const CELLS: RangeInclusive<f64> = 1e-7..=1e6;
/// No coordinate of a map is beyond this, in any unit.
const FARTHEST: f64 = 1e9;
/// Latitude where UTM ends in the north and in the south, degrees.
const UTM_NORTH: f64 = 84.0;
const UTM_SOUTH: f64 = -80.0;

/// A north-up grid in metres.
#[derive(Debug, Clone)]
pub(super) struct Georeference {
    /// North-west corner of the north-west sample's pixel, metres.
    corner: DVec2,
    /// Metres between columns and rows, both positive.
    pub cell: DVec2,
    /// Name of the coordinate reference system, empty when the file has none.
    pub crs: String,
    /// Its EPSG code, where the file names one.
    pub epsg: Option<u32>,
}

/// A rectangle of samples inside a raster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    /// First column and row.
    pub first: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Georeference {
    /// Of `source`. Fails unless it lies north-up in metres.
    pub fn of(source: &Source) -> Result<Self> {
        let (reference, _) = heard(|| source.dataset.spatial_ref());
        let reference = reference.ok();
        let transform = geotransform(source)?;
        check_north_up(source, &transform)?;
        check_size(source, &transform)?;
        match &reference {
            Some(reference) => check_metres(source, &transform, reference)?,
            None => check_not_degrees(source, &transform)?,
        }
        let [x, dx, _, y, _, dy] = transform;
        let (crs, epsg) = reference.map(identity).unwrap_or_default();
        Ok(Self { corner: DVec2::new(x, y), cell: DVec2::new(dx, -dy), crs, epsg })
    }

    /// Easting and northing of the centre of sample (c, r), metres.
    pub fn sample(&self, c: usize, r: usize) -> DVec2 {
        self.corner + DVec2::new(c as f64 + 0.5, -(r as f64 + 0.5)) * self.cell
    }

    /// The samples whose centres lie inside `crop` (west, south, east, north), `None` when it holds none.
    pub fn window(&self, source: &Source, crop: [f64; 4]) -> Option<Window> {
        let [west, south, east, north] = crop;
        let columns = [west - self.corner.x, east - self.corner.x].map(|x| x / self.cell.x);
        let rows = [self.corner.y - north, self.corner.y - south].map(|y| y / self.cell.y);
        let (c, width) = centres_within(columns, source.columns)?;
        let (r, height) = centres_within(rows, source.rows)?;
        Some(Window { first: [c, r], size: [width, height] })
    }
}

/// First and number of the pixel centres 0.5, 1.5 … below `count` inside `from..=to`.
fn centres_within([from, to]: [f64; 2], count: usize) -> Option<(usize, usize)> {
    let first = (from - 0.5 - CROP_CELLS).ceil().max(0.0);
    let last = (to - 0.5 + CROP_CELLS).floor().min(count as f64 - 1.0);
    (first <= last).then(|| (first as usize, (last - first) as usize + 1))
}

/// The six numbers of the geotransform, finite, or the error for a raster that lies nowhere.
fn geotransform(source: &Source) -> Result<[f64; 6]> {
    const NOWHERE: [f64; 6] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let (transform, _) = heard(|| source.dataset.geo_transform());
    match transform {
        Ok(t) if t.iter().all(|v| v.is_finite()) && t != NOWHERE => Ok(t),
        _ if !source.dataset.gcps().is_empty() => Err(source.error(
            "has control points but no geotransform",
            "rectify it first: `gdalwarp -t_srs EPSG:CODE -r cubic IN OUT.tif` with the code of a CRS in metres",
        )),
        _ => Err(source.error(
            "does not say where it lies (no geotransform)",
            "give it its outer edges in metres: `gdal_translate -a_srs EPSG:CODE -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`",
        )),
    }
}

fn check_north_up(source: &Source, &[_, dx, row_x, _, column_y, dy]: &[f64; 6]) -> Result<()> {
    let remedy = "turn it north-up first: `gdalwarp -r cubic -ot Float32 -dstnodata -32768 IN OUT.tif`";
    let drift = [row_x * source.rows as f64 / dx, column_y * source.columns as f64 / dy];
    if dx == 0.0 || dy == 0.0 || drift.iter().any(|cells| cells.abs() > STRAIGHT_CELLS) {
        return Err(source.error("its rows do not run from west to east (rotated or sheared)", remedy));
    }
    if dx < 0.0 {
        return Err(source.error("its columns run from east to west (mirrored)", remedy));
    }
    if dy > 0.0 {
        return Err(source.error("its rows run from south to north (south-up)", remedy));
    }
    Ok(())
}

/// Cells and coordinates that f64 tells apart and a planet holds, in whatever unit.
fn check_size(source: &Source, transform: &[f64; 6]) -> Result<()> {
    let &[x, dx, _, y, _, dy] = transform;
    let [middle_x, middle_y] = centre(source, transform);
    let near = [x, y, middle_x, middle_y].iter().all(|v| v.abs() <= FARTHEST);
    if near && [dx, -dy].iter().all(|cell| CELLS.contains(cell)) {
        return Ok(());
    }
    Err(source.error(
        format!("its place makes no sense: cells of {dx} x {}, the north-west corner at {x},{y}", -dy),
        "correct its edges: `gdal_translate -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`",
    ))
}

/// A projected CRS whose unit is the metre.
fn check_metres(source: &Source, transform: &[f64; 6], reference: &SpatialRef) -> Result<()> {
    if reference.is_geographic() || reference.is_derived_geographic() {
        let [x, y] = centre(source, transform).map(|v| (v * reference.angular_units()).to_degrees());
        return Err(in_degrees(source, [x, y]));
    }
    if reference.is_geocentric() || (reference.is_vertical() && !reference.is_compound()) {
        let name = reference.name().unwrap_or_default();
        return Err(source.error(
            format!("its coordinate system \"{name}\" is no map projection"),
            "project it first: `gdalwarp -t_srs EPSG:CODE -r cubic IN OUT.tif` with the code of a CRS in metres",
        ));
    }
    let metres = reference.linear_units();
    if (metres - 1.0).abs() > METRE_EPSILON {
        let unit = reference.linear_units_name().unwrap_or_else(|| format!("{metres} m"));
        let place = longitude_latitude(reference, centre(source, transform));
        let target = place.map_or("EPSG:CODE".to_owned(), |at| format!("EPSG:{}", metric_epsg(at)));
        return Err(source.error(
            format!("its map unit is \"{unit}\", not the metre"),
            format!("warp it to metres first: {}", warp_to(&target)),
        ));
    }
    check_vertical_metres(source, reference)
}

/// The vertical part of a compound CRS, which counts where the band itself names no unit.
fn check_vertical_metres(source: &Source, reference: &SpatialRef) -> Result<()> {
    if !reference.is_compound() || !source.band()?.unit().is_empty() {
        return Ok(());
    }
    let unit = |child| reference.get_attr_value("COMPD_CS|VERT_CS|UNIT", child).ok().flatten();
    let metres = unit(1).and_then(|factor| factor.parse::<f64>().ok()).unwrap_or(1.0);
    if (metres - 1.0).abs() <= METRE_EPSILON {
        return Ok(());
    }
    Err(source.error(
        format!("its elevations are in \"{}\", not metres", unit(0).unwrap_or_default()),
        format!("convert them first: `gdal_translate -ot Float32 -scale 0 1 0 {metres} IN OUT.tif`"),
    ))
}

/// Without a CRS coordinates count as metres, unless they look like longitude and latitude.
fn check_not_degrees(source: &Source, &[x, dx, _, y, _, dy]: &[f64; 6]) -> Result<()> {
    let far = [x + dx * source.columns as f64, y + dy * source.rows as f64];
    let on_globe = [x, far[0]].iter().all(|v| v.abs() <= 360.0) && [y, far[1]].iter().all(|v| v.abs() <= 90.0);
    if !on_globe || dx >= DEGREE_CELL || -dy >= DEGREE_CELL {
        return Ok(());
    }
    Err(source.error(
        format!("names no coordinate system, and cells of {dx} x {} look like degrees", -dy),
        "name it: `gdal_translate -a_srs EPSG:4326 IN OUT.tif` for degrees, else the EPSG code of a CRS in metres",
    ))
}

fn in_degrees(source: &Source, place: [f64; 2]) -> Error {
    let remedy = format!("warp it to metres first: {}", warp_to(&format!("EPSG:{}", metric_epsg(place))));
    source.error("is in degrees, not metres", remedy)
}

/// Cubic, as elevations need, and with a mark for the corners that the turned grid leaves empty.
fn warp_to(target: &str) -> String {
    format!("`gdalwarp -t_srs {target} -r cubic -ot Float32 -dstnodata -32768 IN OUT.tif`")
}

/// The middle of the raster in the units of its CRS.
fn centre(source: &Source, &[x, dx, _, y, _, dy]: &[f64; 6]) -> [f64; 2] {
    [x + dx * source.columns as f64 / 2.0, y + dy * source.rows as f64 / 2.0]
}

/// EPSG code of the UTM zone (WGS 84) of a place in degrees, beyond UTM of polar stereographic.
fn metric_epsg([longitude, latitude]: [f64; 2]) -> u32 {
    if latitude > UTM_NORTH {
        return 3413;
    }
    if latitude < UTM_SOUTH {
        return 3031;
    }
    let zone = ((longitude + 180.0).rem_euclid(360.0) / 6.0).floor().clamp(0.0, 59.0) as u32 + 1;
    if latitude < 0.0 { 32700 + zone } else { 32600 + zone }
}

/// Degrees of a place in `reference`, `None` when PROJ cannot say.
fn longitude_latitude(reference: &SpatialRef, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let convert = || {
        let mut degrees = SpatialRef::from_epsg(4326)?;
        degrees.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        let mut from = reference.clone();
        from.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        let (mut x, mut y) = ([x], [y]);
        CoordTransform::new(&from, &degrees)?.transform_coords(&mut x, &mut y, &mut [])?;
        Ok::<_, gdal::errors::GdalError>([x[0], y[0]])
    };
    heard(convert).0.ok().filter(|place| place.iter().all(|v| v.is_finite()))
}

/// Name and EPSG code of a CRS. Old formats give its parameters alone; those of UTM are recognised.
fn identity(mut reference: SpatialRef) -> (String, Option<u32>) {
    let name = reference.name().unwrap_or_default();
    if let Some(code) = epsg(&reference) {
        return (name, Some(code));
    }
    let (recognised, _) = heard(|| reference.auto_identify_epsg());
    let code = recognised.ok().and_then(|()| epsg(&reference));
    let (registered, _) = heard(|| code.and_then(|code| SpatialRef::from_epsg(code).ok()?.name()));
    (registered.unwrap_or(name), code)
}

fn epsg(reference: &SpatialRef) -> Option<u32> {
    let known = reference.auth_name().is_some_and(|name| name == "EPSG");
    known.then(|| reference.auth_code().ok()?.try_into().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_and_poles() {
        assert_eq!(metric_epsg([-119.53, 37.7]), 32611);
        assert_eq!(metric_epsg([174.0, -41.0]), 32760);
        assert_eq!(metric_epsg([180.0, 10.0]), 32601);
        assert_eq!(metric_epsg([241.0, 37.0]), 32611);
        assert_eq!(metric_epsg([0.0, 85.0]), 3413);
        assert_eq!(metric_epsg([0.0, -85.0]), 3031);
    }

    #[test]
    fn a_centre_on_the_edge_is_inside() {
        assert_eq!(centres_within([0.5, 2.5], 9), Some((0, 3)));
        assert_eq!(centres_within([0.51, 2.49], 9), Some((1, 1)));
        assert_eq!(centres_within([-7.0, 99.0], 9), Some((0, 9)));
        assert_eq!(centres_within([9.0, 12.0], 9), None);
        assert_eq!(centres_within([0.6, 1.4], 9), None);
    }
}
