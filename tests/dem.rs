//! Reading of DEMs: values, places, voids, crops, formats.

mod archives;
mod converted;
mod filed;
mod ground;
mod large;
mod layers;
mod mosaics;
mod opened;
mod process;
mod refused;
mod remedies;
mod shared;
mod trusted;
mod typed;
mod wide_layers;

use std::fs;
use std::path::{Path, PathBuf};

use gdal::raster::{Buffer, GdalType};
use gdal::spatial_ref::SpatialRef;
use gdal::{Dataset, DatasetOptions, DriverManager, GdalOpenFlags};
use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::geo::{Info, ReadOptions, info, read};
use tempfile::TempDir;

use crate::common::words;

/// Metres between a decimal elevation and its f32: 3000 m have steps of 0.00025 m.
const F32_METRES: f32 = 0.0005;
/// Metres between places that went through a text header with at least 7 decimals.
const PLACE_METRES: f64 = 1e-6;

const UTM: u32 = 32610;
/// 30 m x 20 m pixels: the cells are not square.
const TRANSFORM: [f64; 6] = [500_000.0, 30.0, 0.0, 4_200_000.0, 0.0, -20.0];

/// A raster to be written: 4 columns, heights row-major.
struct Raster<T> {
    columns: usize,
    values: Vec<T>,
    transform: Option<[f64; 6]>,
    epsg: Option<u32>,
    nodata: Option<f64>,
}

impl<T: GdalType + Copy> Raster<T> {
    fn new(columns: usize, values: Vec<T>) -> Self {
        Self { columns, values, transform: Some(TRANSFORM), epsg: Some(UTM), nodata: None }
    }

    fn write(self, driver: &str, path: &Path) -> PathBuf {
        let driver = DriverManager::get_driver_by_name(driver).unwrap();
        let size = (self.columns, self.values.len() / self.columns);
        let mut file = driver.create_with_band_type::<T, _>(path, size.0, size.1, 1).unwrap();
        self.transform.iter().for_each(|t| file.set_geo_transform(t).unwrap());
        self.epsg.iter().for_each(|code| file.set_spatial_ref(&SpatialRef::from_epsg(*code).unwrap()).unwrap());
        let mut band = file.rasterband(1).unwrap();
        if self.nodata.is_some() {
            band.set_no_data_value(self.nodata).unwrap();
        }
        band.write((0, 0), size, &mut Buffer::new(size, self.values)).unwrap();
        file.close().unwrap();
        path.to_owned()
    }
}

/// 4 x 3 samples of 100 m, 101 m … 111 m.
fn hill() -> Raster<f32> {
    Raster::new(4, (100..112u16).map(f32::from).collect())
}

fn folder() -> TempDir {
    // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
    let _ = read(Path::new(""), &ReadOptions::default());
    tempfile::tempdir().unwrap()
}

fn told(path: &Path) -> Info {
    info(&[path.to_owned()], &ReadOptions::default(), &|_, _| ()).unwrap()
}

fn read_all(path: &Path) -> Dem {
    read(path, &ReadOptions::default()).unwrap()
}

/// Numbers as they stand in the file: multiples of a step, too.
fn with_steps() -> ReadOptions {
    ReadOptions { keep_steps: true, ..Default::default() }
}

/// Whether each sample holds an elevation, row-major.
fn valid(dem: &Dem) -> Vec<bool> {
    (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| dem.height(c, r).is_some())).collect()
}

fn cropped(crop: [f64; 4]) -> ReadOptions {
    ReadOptions { crop: Some(crop), ..Default::default() }
}

/// A VRT of 4 x 3 samples with these elements before its band and in it.
fn vrt(path: &Path, head: &str, band: &str) -> PathBuf {
    sized_vrt(path, 4, 3, head, band)
}

fn sized_vrt(path: &Path, columns: u32, rows: u32, head: &str, band: &str) -> PathBuf {
    let placed = "<SRS>EPSG:32610</SRS><GeoTransform>500000, 30, 0, 4200000, 0, -20</GeoTransform>";
    let head = if head.is_empty() { placed } else { head };
    let band = if band.starts_with('<') { format!("dataType=\"Float32\" band=\"1\">{band}") } else { band.to_owned() };
    let text = format!(
        "<VRTDataset rasterXSize=\"{columns}\" rasterYSize=\"{rows}\">{head}<VRTRasterBand {band}</VRTRasterBand></VRTDataset>"
    );
    fs::write(path, text).unwrap();
    path.to_owned()
}

#[test]
fn samples_lie_in_the_middle_of_their_pixels() {
    let dir = folder();
    let dem = read_all(&hill().write("GTiff", &dir.path().join("hill.tif")));
    assert_eq!((dem.columns(), dem.rows()), (4, 3));
    assert_eq!(dem.cell(), DVec2::new(30.0, 20.0));
    assert_eq!(dem.position(0, 0), DVec3::new(500_015.0, 4_199_990.0, 100.0));
    assert_eq!(dem.position(3, 2), DVec3::new(500_105.0, 4_199_950.0, 111.0));
    assert_eq!(dem.extent(), [500_015.0, 4_199_950.0, 500_105.0, 4_199_990.0]);
    assert_eq!(dem.georeference().world().label(), "WGS 84 / UTM zone 10N (EPSG:32610)");
    assert_eq!(dem.georeference().file(), dem.georeference().world());
    assert_eq!(dem.voids(), 0);
}

#[test]
fn exaggeration_multiplies_metres() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    let dem = read(&path, &ReadOptions { exaggeration: 2.5, ..Default::default() }).unwrap();
    assert_eq!(dem.range(), Some([250.0, 277.5]));
}

#[test]
fn voids_declared_and_not() {
    let dir = folder();
    let heights =
        [-9999.0, f32::NAN, f32::INFINITY, -32767.0, -32768.0, f32::MIN, 1e20, -67.0, 0.0, 65535.0, -9998.0, 8.0];
    let declared = Raster { nodata: Some(-9999.0), ..Raster::new(4, heights.to_vec()) };
    let path = declared.write("GTiff", &dir.path().join("voids.tif"));
    let dem = read_all(&path);
    let expected = [false, false, false, false, false, false, false, true, true, true, true, true];
    assert_eq!(valid(&dem), expected);
    assert_eq!(dem.height(0, 0), None);
    assert_eq!(dem.height(3, 1), Some(-67.0));
    assert!(dem.held().unwrap().heights().iter().all(|h| h.is_finite()));
    let undeclared = Raster::new(4, heights.to_vec()).write("GTiff", &dir.path().join("undeclared.tif"));
    assert_eq!(read_all(&undeclared).height(0, 0), Some(-9999.0), "-9999 is a number until it is declared");
    let told = told(&undeclared);
    assert!(words(told.history.assumed()).iter().any(|a| a.starts_with("4 samples at or below -32767 ")), "{told}");
}

#[test]
fn nodata_is_the_number_as_stored() {
    let dir = folder();
    let zero_is_sea = Raster { nodata: Some(0.0), ..Raster::new(4, vec![0i16, 1, 2, 3, 4, 5, 6, 7]) };
    assert_eq!(read_all(&zero_is_sea.write("GTiff", &dir.path().join("sea.tif"))).voids(), 1);
    let long = Raster::new(2, vec![5i64, 6, 7, 8]).write("GTiff", &dir.path().join("long.tif"));
    let flags = GdalOpenFlags::GDAL_OF_UPDATE;
    let file = Dataset::open_ex(&long, DatasetOptions { open_flags: flags, ..Default::default() }).unwrap();
    file.rasterband(1).unwrap().set_no_data_value_i64(Some(6)).unwrap();
    file.close().unwrap();
    assert_eq!(valid(&read_all(&long)), [true, false, true, true]);
    hill().write("GTiff", &dir.path().join("hill.tif"));
    let scaled = "<NoDataValue>105</NoDataValue><Scale>0.1</Scale><Offset>-3</Offset><SimpleSource>\
                  <SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    let dem = read_all(&vrt(&dir.path().join("scaled.vrt"), "", scaled));
    assert_eq!(dem.height(1, 1), None, "105 is compared before scale and offset");
    assert!((dem.height(0, 0).unwrap() - 7.0).abs() < F32_METRES);
    assert!((dem.height(3, 2).unwrap() - 8.1).abs() < F32_METRES);
}

#[test]
fn sixteen_bit_sentinels_survive_a_scale() {
    let dir = folder();
    let heights = vec![-32768i16, -32767, 1000, 2000];
    Raster::new(2, heights).write("GTiff", &dir.path().join("decimetres.tif"));
    let band = "dataType=\"Int16\" band=\"1\"><Scale>0.1</Scale><SimpleSource>\
                <SourceFilename relativeToVRT=\"1\">decimetres.tif</SourceFilename></SimpleSource>";
    let dem = read_all(&sized_vrt(&dir.path().join("scaled.vrt"), 2, 2, "", band));
    assert_eq!(valid(&dem), [false, false, true, true]);
}

#[test]
fn masked_samples_are_voids() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("masked.tif"));
    let flags = GdalOpenFlags::GDAL_OF_UPDATE;
    let file = Dataset::open_ex(&path, DatasetOptions { open_flags: flags, ..Default::default() }).unwrap();
    let mut band = file.rasterband(1).unwrap();
    band.create_mask_band(true).unwrap();
    let mut seen = vec![255u8; 12];
    seen[6] = 0;
    band.open_mask_band().unwrap().write((0, 0), (4, 3), &mut Buffer::new((4, 3), seen)).unwrap();
    file.close().unwrap();
    let dem = read_all(&path);
    assert_eq!((dem.voids(), dem.height(2, 1)), (1, None));
}

#[test]
fn the_first_of_many_bands_counts() {
    let dir = folder();
    let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
    let path = dir.path().join("bands.tif");
    let mut file = driver.create_with_band_type::<i16, _>(&path, 2, 2, 3).unwrap();
    file.set_geo_transform(&TRANSFORM).unwrap();
    for band in 1..=3 {
        file.rasterband(band).unwrap().fill(band as f64 * 100.0, None).unwrap();
    }
    file.close().unwrap();
    assert_eq!(read_all(&path).range(), Some([100.0, 100.0]));
    let told = told(&path);
    assert!(words(told.history.assumed()).iter().any(|a| a.starts_with("elevations are in band 1 of 3 (")), "{told}");
    assert!(words(told.history.assumed()).iter().any(|a| a.contains("no coordinate system")), "{told}");
    let third = read(&path, &ReadOptions { band: Some(3), ..Default::default() }).unwrap();
    assert_eq!(third.range(), Some([300.0, 300.0]));
    assert!(words(third.history().assumed()).iter().all(|a| !a.contains("band")), "the band was chosen");
}

#[test]
fn crop_keeps_centres_inside() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    // Centres: 500015, 45, 75, 105 and 4199990, 70, 50. An edge on a centre keeps it, a hair further does not.
    let dem = read(&path, &cropped([500_045.0, 4_199_950.0, 500_104.9, 4_199_970.0])).unwrap();
    assert_eq!((dem.columns(), dem.rows()), (2, 2));
    assert_eq!(dem.held().unwrap().heights(), [105.0, 106.0, 109.0, 110.0]);
    assert_eq!(dem.position(0, 0), DVec3::new(500_045.0, 4_199_970.0, 105.0));
    let wide = read(&path, &cropped([0.0, 0.0, 1e9, 1e9])).unwrap();
    assert_eq!((wide.columns(), wide.rows()), (4, 3));
}

#[test]
fn every_format_gives_the_same_grid() {
    let dir = folder();
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    let truth = read_all(&tif);
    let copies = [("ENVI", "a.img"), ("VRT", "b.vrt"), ("AAIGrid", "c.asc"), ("netCDF", "d.nc"), ("RST", "e.rst")];
    for (driver, name) in copies {
        copy(&tif, driver, &dir.path().join(name));
    }
    hill().write("EHdr", &dir.path().join("f.bil"));
    for name in copies.map(|(_, name)| name).into_iter().chain(["f.bil"]) {
        let dem = read_all(&dir.path().join(name));
        assert_eq!(dem.held().unwrap().heights(), truth.held().unwrap().heights(), "{name}");
        let gap = (dem.position(3, 2) - truth.position(3, 2)).length();
        assert!(gap < PLACE_METRES, "{name}: {gap} m");
        assert!((dem.cell() - truth.cell()).length() < PLACE_METRES, "{name}");
    }
}

/// Writes the raster `from` again as `driver` does, to `to`.
fn copy(from: &Path, driver: &str, to: &Path) {
    let driver = DriverManager::get_driver_by_name(driver).unwrap();
    Dataset::open(from).unwrap().create_copy(&driver, to, &Default::default()).unwrap().close().unwrap();
}

#[test]
fn metres_without_a_coordinate_system_are_taken() {
    let dir = folder();
    let path = dir.path().join("bare.asc");
    fs::write(&path, "ncols 2\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -1\n5 6\n-1 8.5\n")
        .unwrap();
    let dem = read_all(&path);
    assert_eq!(dem.position(1, 1), DVec3::new(1015.0, 2005.0, 8.5));
    assert_eq!((valid(&dem), dem.georeference().world().name()), (vec![true, true, false, true], ""));
    assert!(words(dem.history().assumed())[0].starts_with("coordinates are metres (no coordinate system"));
    copy(&path, "AAIGrid", Path::new(&format!("/vsigzip/{}", dir.path().join("bare.asc.gz").display())));
    assert_eq!(read_all(&dir.path().join("bare.asc.gz")).held().unwrap().heights(), dem.held().unwrap().heights());
    assert!(!dir.path().join("bare.asc.gz.properties").exists());
    let png = Raster { transform: None, epsg: None, ..Raster::new(2, vec![7u16, 8, 9, 10]) };
    let tif = png.write("GTiff", &dir.path().join("png.tif"));
    let path = dir.path().join("sixteen.png");
    copy(&tif, "PNG", &path);
    refused::refused(&path, &["no geotransform", "--cell M"]);
    fs::write(dir.path().join("sixteen.wld"), "10\n0\n0\n-10\n5\n95\n").unwrap();
    assert_eq!(read_all(&path).position(0, 0), DVec3::new(5.0, 95.0, 7.0));
}

#[test]
fn info_says_what_a_file_holds() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let told = told(&path);
    assert_eq!((told.columns, told.rows, told.crs.epsg(), told.voids), (500, 500, Some(32610), 0));
    assert_eq!(told.extent, [536_715.0, 4_180_515.0, 551_685.0, 4_195_485.0]);
    assert_eq!(told.cell, [30.0, 30.0]);
    // The file holds tenths of a metre.
    assert_eq!(told.history.steps().len(), 1);
    assert!((told.history.steps()[0] - 0.1).abs() < 1e-9, "{told}");
    assert!(told.range[0].abs() <= 0.05 && (told.range[1] - 338.4).abs() <= 0.05 + F32_METRES, "{told}");
    let lines = told.to_string();
    let column = |line: &str| line.len() - line.split_once(' ').unwrap().1.trim_start().len();
    assert!(lines.lines().all(|line| column(line) == 11), "not aligned:\n{lines}");
    for part in ["GeoTIFF", "500 columns x 500 rows", "WGS 84 / UTM zone 10N (EPSG:32610)", " to 338.", "0 (0.0 %)"] {
        assert!(lines.contains(part), "no {part:?}:\n{lines}");
    }
    assert!(
        lines.contains("\nconverted  heights are multiples of 0.1 m: drawn is the smoothest surface within 0.05 m")
    );
    let kept = info(&[path], &with_steps(), &|_, _| ()).unwrap();
    assert!(kept.range[0] == 0.0 && (kept.range[1] - 338.4).abs() < F32_METRES, "{kept}");
    assert!(kept.to_string().contains("0.0 to 338.4 m"), "{kept}");
}
