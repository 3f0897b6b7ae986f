//! Writes lines on the map, with heights, as files of vectors.
//!
//! GDAL writes into memory: so no file is ever half there, and none of its own stands beside one. Of the same lines the same bytes come:
//! the time that a GeoPackage holds is always the same. Memory: the file, once.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use gdal::errors::Result as GdalResult;
use gdal::raster::RasterCreationOptions;
use gdal::spatial_ref::SpatialRef;
use gdal::vector::{Feature, Geometry, LayerAccess, LayerOptions, OGRFieldType, OGRwkbGeometryType};
use gdal::{Dataset, DriverManager, config, vsi};

use super::formats;
use super::source::heard;
use crate::dem::Crs;
use crate::geo::{MapFormat, MapLine};

/// What their layer is called.
const LAYER: &str = "lines";
/// Attributes, in their order.
const FIELDS: [(&str, OGRFieldType::Type); 6] = [
    ("kind", OGRFieldType::OFTString),
    ("layer", OGRFieldType::OFTString),
    ("id", OGRFieldType::OFTString),
    ("order", OGRFieldType::OFTInteger),
    ("depth", OGRFieldType::OFTReal),
    ("length", OGRFieldType::OFTReal),
];
/// Of a map that nobody names: as GeoPackage calls it, by which GDAL knows it.
const UNKNOWN: &str = r#"LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1]]"#;
/// GDAL's option for the time that a GeoPackage holds, and that time.
const TIME: [&str; 2] = ["OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z"];

/// The bytes of a file of lines whose places are of `crs`, unknown or not.
///
/// # Errors
/// GDAL's words where it cannot write.
pub fn write_lines(format: MapFormat, crs: &Crs, lines: &[MapLine]) -> io::Result<Vec<u8>> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    formats::restrict(false);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let ending = MapFormat::ALL.iter().find(|(_, known)| *known == format).map_or("", |(ending, _)| ending);
    let path = PathBuf::from(format!("/vsimem/hachure-{number}.{ending}"));
    let _ = config::set_thread_local_config_option(TIME[0], TIME[1]);
    let (made, complaint) = heard(|| make(&path, format, crs, lines));
    let _ = config::clear_thread_local_config_option(TIME[0]);
    let bytes = heard(|| vsi::get_vsi_mem_file_bytes_owned(&path)).0;
    match complaint.or_else(|| made.err().map(|error| error.to_string())) {
        Some(words) => Err(io::Error::other(words.lines().next().unwrap_or_default().to_owned())),
        None => bytes.map_err(io::Error::other),
    }
}

fn make(path: &Path, format: MapFormat, crs: &Crs, lines: &[MapLine]) -> GdalResult<()> {
    let (driver, of_file, of_layer): (&str, &[&str], &[&str]) = match format {
        MapFormat::GeoPackage => ("GPKG", &[], &[]),
        MapFormat::GeoJson => ("GeoJSON", &[], &["RFC7946=YES", "COORDINATE_PRECISION=10"]),
        MapFormat::Kml => ("KML", &["AltitudeMode=absolute"], &[]),
    };
    let driver = DriverManager::get_driver_by_name(driver)?;
    let options = RasterCreationOptions::from_iter(of_file.iter().copied());
    let mut file = driver.create_with_band_type_with_options::<u8, _>(path, 0, 0, 0, &options)?;
    if format == MapFormat::GeoPackage {
        let mut transaction = file.start_transaction()?;
        fill(&mut transaction, crs, of_layer, lines)?;
        transaction.commit()?;
    } else {
        fill(&mut file, crs, of_layer, lines)?;
    }
    file.close()
}

fn fill(file: &mut Dataset, crs: &Crs, of_layer: &[&str], lines: &[MapLine]) -> GdalResult<()> {
    // Without a word GDAL takes coordinates for degrees.
    let reference = crs.reference().map_or_else(|| SpatialRef::from_wkt(UNKNOWN), Ok)?;
    let ty = OGRwkbGeometryType::wkbLineString25D;
    let layer = file.create_layer(LayerOptions { name: LAYER, srs: Some(&reference), ty, options: Some(of_layer) })?;
    layer.create_defn_fields(&FIELDS)?;
    let fields = FIELDS.iter().map(|(name, _)| layer.defn().field_index(name)).collect::<GdalResult<Vec<_>>>()?;
    for line in lines {
        let mut geometry = Geometry::empty(ty)?;
        line.points.iter().for_each(|point| geometry.add_point((point.x, point.y, point.z)));
        let mut feature = Feature::new(layer.defn())?;
        feature.set_geometry(geometry)?;
        // What is not known is said to be so.
        fields.iter().try_for_each(|field| feature.set_field_null(*field))?;
        line.layer.as_ref().map_or(Ok(()), |layer| feature.set_field_string(fields[1], layer))?;
        line.id.as_ref().map_or(Ok(()), |id| feature.set_field_string(fields[2], id))?;
        line.order.map_or(Ok(()), |order| feature.set_field_integer(fields[3], order.into()))?;
        line.depth.map_or(Ok(()), |depth| feature.set_field_double(fields[4], depth))?;
        feature.set_field_string(fields[0], &line.kind)?;
        feature.set_field_double(fields[5], line.length)?;
        feature.create(&layer)?;
    }
    Ok(())
}
