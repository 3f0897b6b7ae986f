//! Reads lines of the user's own from a vector file: all lines of its layers, areas by their rims.
//!
//! Geometries of several parts are taken apart, arcs become lines by GDAL's step of 4 degrees. What is no line is counted. Cost:
//! all features are read. Not handled: heights, which the land has itself; borders that two areas share are two lines.

use std::path::Path;

use gdal::vector::{
    Feature, FieldValue, Geometry, Layer, LayerAccess, OGRwkbGeometryType as Kind, geometry_type_flatten,
};
use glam::DVec2;

use super::vectors::{Purpose, Vectors, system_of};
use crate::error::{Error, Result};
use crate::geo::{OwnLayer, OwnLine, OwnLines};

/// Attributes that say how much a line weighs, in any case, the first that a line has as a whole number.
const ORDERS: [&str; 5] = ["order", "strahler", "stream_order", "ord_stra", "class"];

/// The lines in a file, or in one layer of it, `FILE:LAYER`. Files on a network only where these are allowed.
///
/// # Errors
/// [`Error::Input`] where the file cannot be read, and where there is no line in it.
pub fn own_lines(path: &Path, allow_remote: bool) -> Result<OwnLines> {
    let vectors = Vectors::open(path, Purpose::Lines, allow_remote)?;
    let mut layers = vectors.read(read)?;
    let points: usize = layers.iter().map(|layer| layer.points_left_out).sum();
    if layers.iter().all(|layer| layer.lines.is_empty()) {
        let what = if points > 0 { "holds points, no line and no area" } else { "holds no line and no area" };
        return Err(Error::input(
            path,
            what,
            "give a file with lines, perhaps made of points by `qgis_process run native:pointstopath`",
        ));
    }
    layers.retain(|layer| !layer.lines.is_empty() || layer.points_left_out > 0);
    Ok(OwnLines { layers })
}

fn read(layer: &mut Layer) -> OwnLayer {
    let crs = system_of(layer);
    let fields: Vec<String> = layer.defn().fields().map(|field| field.name()).collect();
    let of_order = |known: &&str| fields.iter().position(|name| name.eq_ignore_ascii_case(known));
    let orders: Vec<usize> = ORDERS.iter().filter_map(of_order).collect();
    let mut read = OwnLayer { name: layer.name(), crs, lines: Vec::new(), points_left_out: 0 };
    for feature in layer.features() {
        let Some(geometry) = feature.geometry().filter(|geometry| !geometry.is_empty()) else { continue };
        let order = orders.iter().find_map(|field| order(&feature, *field)).unwrap_or(1);
        straightened(geometry, |geometry| take(geometry, order, &mut read));
    }
    read
}

/// The lines and rings of a geometry, and how many points it has that are none of theirs.
fn take(geometry: &Geometry, order: u8, onto: &mut OwnLayer) {
    match geometry_type_flatten(geometry.geometry_type()) {
        Kind::wkbPoint => onto.points_left_out += 1,
        Kind::wkbLineString => {
            let count = geometry.point_count() as i32;
            let place = |(x, y, _): (f64, f64, f64)| DVec2::new(x, y);
            let mut places: Vec<DVec2> = (0..count).map(|i| place(geometry.get_point(i))).collect();
            places.dedup();
            let closed = places.len() > 3 && places.first() == places.last();
            if closed {
                places.pop();
            }
            if places.len() > 1 {
                onto.lines.push(OwnLine { places, closed, order });
            }
        }
        _ => (0..geometry.geometry_count()).for_each(|i| take(&geometry.get_geometry(i), order, onto)),
    }
}

/// Hands on a geometry without arcs.
fn straightened(geometry: &Geometry, take: impl FnOnce(&Geometry)) {
    // SAFETY: the geometry lives as long as its feature; what GDAL makes of it is destroyed once, after its last use, by
    // nobody else: a lazy geometry does not own what it wraps.
    unsafe {
        if gdal_sys::OGR_G_HasCurveGeometry(geometry.c_geometry(), 1) == 0 {
            return take(geometry);
        }
        let handle = gdal_sys::OGR_G_GetLinearGeometry(geometry.c_geometry(), 0.0, std::ptr::null_mut());
        if !handle.is_null() {
            let straight = Geometry::lazy_feature_geometry();
            straight.set_c_geometry(handle);
            take(&straight);
            gdal_sys::OGR_G_DestroyGeometry(handle);
        }
    }
}

/// The order that a field holds, from 1 on, where it is a whole number.
fn order(feature: &Feature, field: usize) -> Option<u8> {
    let number = match feature.field(field).ok().flatten()? {
        FieldValue::IntegerValue(number) => f64::from(number),
        FieldValue::Integer64Value(number) => number as f64,
        FieldValue::RealValue(number) => number,
        FieldValue::StringValue(text) => text.trim().parse().ok()?,
        _ => return None,
    };
    (number.fract() == 0.0).then(|| number.clamp(1.0, 255.0) as u8)
}
