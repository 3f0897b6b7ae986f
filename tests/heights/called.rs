//! What files call their numbers: depths that are heights, bands that are about elevations, words that VRTs and HDF5 keep
//! elsewhere, and the flag that is surer than all of them.

use std::path::Path;

use gdal::Metadata;
use gdal::raster::GdalDataType::Float32;
use hachure::geo::{Encoding, ReadOptions, read};

use super::{Bands, SIDE, assumed, cured, folder, land, one, same, with_steps};
use crate::common::words;

fn turned() -> Vec<f64> {
    land().iter().map(|n| -n).collect()
}

/// What is read of land in a band called `name`, of which this is said.
fn check(path: &Path, name: &'static str, said: &[(&'static str, &'static str)], heights: &[f64]) {
    Bands { names: vec![name], said: said.to_vec(), ..one(&land(), |n| n as f32) }.write(path);
    same(&read(path, &with_steps()).unwrap(), heights, 0.0);
    assert_eq!(assumed(&[path.to_owned()], &with_steps()), Vec::<String>::new(), "{name} {said:?}");
}

#[test]
fn names_of_heights_may_speak_of_depth() {
    let dir = folder();
    let path = dir.path().join("long.tif");
    for long in [
        "snow surface height over ground from snow depth",
        "Elevation relative to sea level (negative values are depth)",
        "Topography and depth",
        "bathymetric depth (positive up)",
        "Altitude or depth",
    ] {
        check(&path, "", &[("long_name", long)], &land());
        check(&path, "", &[("NETCDF_VARNAME", "z"), ("long_name", long)], &land());
    }
    for name in ["elevation", "Height", "altitude", "DEM", "topo"] {
        check(&path, name, &[("long_name", "depth")], &land());
        check(&path, "", &[("NETCDF_VARNAME", name), ("long_name", "depth")], &land());
    }
    check(&path, "depth", &[("long_name", "depth")], &turned());
    check(&path, "elevation", &[("positive", "down")], &turned());
}

#[test]
fn the_flag_is_surer_than_the_file() {
    let dir = folder();
    let path = dir.path().join("flag.tif");
    let read_as = |encoding| {
        let dem = read(&path, &ReadOptions { encoding: Some(encoding), ..with_steps() }).unwrap();
        (words(dem.history().converted()), dem)
    };
    for said in [("positive", "down"), ("standard_name", "depth"), ("long_name", "Depth")] {
        check(&path, "", &[said], &turned());
        let told = words(read(&path, &with_steps()).unwrap().history().converted());
        let line = told.iter().find(|clause| clause.starts_with("depths x -1")).unwrap();
        same(&cured(&path, line, "--encoding"), &land(), 0.0);
        let (told, dem) = read_as(Encoding::Elevations);
        same(&dem, &land(), 0.0);
        assert!(told.iter().all(|clause| !clause.contains("depths")), "{told:?}");
    }
    check(&path, "", &[("positive", "up")], &land());
    let (told, dem) = read_as(Encoding::Depths);
    same(&dem, &turned(), 0.0);
    assert!(told.contains(&"depths x -1 to heights (--encoding depths)".to_owned()), "{told:?}");
    // Where the numbers decide, both ways are told.
    Bands { said: vec![("long_name", "Depth")], ..one(&turned(), |n| n as f32) }.write(&path);
    let line = assumed(std::slice::from_ref(&path), &with_steps()).remove(0);
    same(&cured(&path, &line, "--encoding"), &land(), 0.0);
    let (_, last) = line.rsplit_once("say").unwrap();
    same(&cured(&path, last, "--encoding"), &turned(), 0.0);
}

/// A VRT of the first band of `file` that says nothing itself.
fn bare_vrt(path: &Path, file: &str, band: usize, inner: &str) {
    let text = format!(
        "<VRTDataset rasterXSize=\"{SIDE}\" rasterYSize=\"{SIDE}\"><SRS>EPSG:32632</SRS>\
         <GeoTransform>500000, 30, 0, 5000000, 0, -30</GeoTransform><VRTRasterBand dataType=\"{}\" band=\"1\">\
         <ComplexSource><SourceFilename relativeToVRT=\"1\">{file}</SourceFilename><SourceBand>{band}</SourceBand>{inner}\
         </ComplexSource></VRTRasterBand></VRTDataset>",
        Float32.name()
    );
    std::fs::write(path, text).unwrap();
}

#[test]
fn what_a_file_says_holds_in_a_vrt_of_it() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let read = |name: &str| read(at(name), &with_steps()).unwrap();
    check(&at("down.tif"), "", &[("positive", "down")], &turned());
    bare_vrt(&at("bare.vrt"), "down.tif", 1, "");
    same(&read("bare.vrt"), &turned(), 0.0);
    bare_vrt(&at("outer.vrt"), "bare.vrt", 1, "");
    same(&read("outer.vrt"), &turned(), 0.0);
    // One that turns the numbers over has done so.
    bare_vrt(&at("turned.vrt"), "down.tif", 1, "<ScaleOffset>0</ScaleOffset><ScaleRatio>-1</ScaleRatio>");
    same(&read("turned.vrt"), &turned(), 0.0);
    // Of several bands the one that it takes.
    let numbers: Vec<f32> = land().iter().map(|n| *n as f32).collect();
    let path = Bands::new(vec![numbers.clone(), numbers]).write(&at("two.tif"));
    let options = gdal::DatasetOptions { open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE, ..Default::default() };
    let file = gdal::Dataset::open_ex(path, options).unwrap();
    file.rasterband(2).unwrap().set_metadata_item("positive", "down", "").unwrap();
    file.close().unwrap();
    bare_vrt(&at("first.vrt"), "two.tif", 1, "");
    same(&read("first.vrt"), &land(), 0.0);
    bare_vrt(&at("second.vrt"), "two.tif", 2, "");
    same(&read("second.vrt"), &turned(), 0.0);
}

#[test]
fn hdf5_puts_the_variable_before_each_word() {
    let dir = folder();
    let path = dir.path().join("hdf5.tif");
    check(&path, "", &[("depth_positive", "Down ")], &turned());
    check(&path, "", &[("z_standard_name", "sea_floor_depth_below_geoid")], &turned());
    check(&path, "", &[("z_long_name", "Depth"), ("z_units", "m")], &turned());
    check(&path, "", &[("elevation_long_name", "depth")], &land());
    check(&path, "", &[("z_positive", "up"), ("z_long_name", "depth")], &land());
}

#[test]
fn bands_about_elevations_are_not_taken_for_them() {
    let dir = folder();
    let path = dir.path().join("bands.tif");
    let heights: Vec<f32> = land().iter().map(|n| *n as f32).collect();
    let other = vec![1.0; SIDE * SIDE];
    for (names, taken) in [
        (vec!["elevation_uncertainty", "elevation"], 2),
        (vec!["elevation error", "elevation"], 2),
        (vec!["Elevation_count", "x", "y", "DEM"], 4),
        (vec!["mean slope", "z"], 2),
        (vec!["slope of DEM", "Z (m)"], 2),
        (vec!["height above elevation of datum", "DEM"], 2),
        (vec!["DEM std", "DEM aspect", "dem_quality", "mean_elev", "height mask"], 4),
        (vec!["mean", "Elevation (m)"], 2),
    ] {
        let mut bands = vec![other.clone(); names.len()];
        bands[taken - 1].clone_from(&heights);
        Bands { names: names.clone(), ..Bands::new(bands) }.write(&path);
        same(&read(&path, &with_steps()).unwrap(), &land(), 0.0);
        let told = assumed(std::slice::from_ref(&path), &with_steps());
        assert!(told[0].contains(&format!("in band {taken} of {}", names.len())), "{names:?}: {told:?}");
    }
}
