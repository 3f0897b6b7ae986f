//! Every way a file can be refused: one line with the file, what is wrong and a remedy.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gdal::Dataset;
use hachure::door::cli::words;
use hachure::door::cli::words::{exit_code, line};
use hachure::door::dem::{LARGEST_SIDE, MAX_SAMPLES};
use hachure::geo::{ReadOptions, info, read};

use super::{Raster, copy, cropped, folder, hill, read_all, sized_vrt, vrt};
/// Reading `path` fails with one line that names the file, holds all `words`, and exit code 1; so does `info`.
pub fn refused(path: &Path, words: &[&str]) -> String {
    let line = refused_with(path, &ReadOptions::default(), words);
    let told = info(&[path.to_owned()], &ReadOptions::default(), &|_, _| ());
    assert_eq!(words::line(&told.unwrap_err()), line);
    line
}

pub fn refused_with(path: &Path, options: &ReadOptions, words: &[&str]) -> String {
    let error = read(path, options).expect_err(&format!("{} was read", path.display()));
    let line = line(&error);
    assert!(!line.contains('\n'), "more than one line: {line}");
    assert!(line.contains(&hachure::error::shown(path)), "no path: {line}");
    assert!(line.split_once("; ").is_some_and(|(_, remedy)| remedy.len() > 10), "no remedy: {line}");
    words.iter().for_each(|word| assert!(line.contains(word), "no {word:?}: {line}"));
    assert_eq!(exit_code(&error), 1, "{line}");
    line
}

#[test]
fn crop_beside_the_grid_or_too_narrow_is_refused() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    let extent = "500015,4199950,500105,4199990";
    refused_with(&path, &cropped([0.0, 0.0, 9.0, 9.0]), &["no sample lies inside --crop", extent]);
    refused_with(&path, &cropped([500_106.0, 4_199_900.0, 500_200.0, 4_200_000.0]), &["no sample", extent]);
    refused_with(&path, &cropped([500_040.0, 4_199_900.0, 500_050.0, 4_200_000.0]), &["--crop leaves 1 x 3", "widen"]);
}

#[test]
fn senseless_options_are_wrong_usage() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    for crop in [[9.0, 0.0, 1.0, 9.0], [0.0, 9.0, 9.0, 9.0], [f64::NAN, 0.0, 1.0, 1.0], [0.0, 0.0, f64::INFINITY, 1.0]]
    {
        let error = read(&path, &cropped(crop)).unwrap_err();
        assert_eq!(exit_code(&error), 2);
        assert!(line(&error).starts_with("--crop: "), "{error}");
    }
    for exaggeration in [0.0, -1.0, f64::NAN, f64::INFINITY, 1001.0] {
        let error = read(&path, &ReadOptions { exaggeration, ..Default::default() }).unwrap_err();
        assert_eq!(exit_code(&error), 2);
        assert!(line(&error).starts_with("--exaggeration: "), "{error}");
    }
}

#[test]
fn files_that_are_no_raster() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    refused(&at("missing.tif"), &["no such file", "spelling"]);
    refused(dir.path(), &["directory", "name the file"]);
    fs::write(at("empty.tif"), "").unwrap();
    refused(&at("empty.tif"), &["empty", "copy or download"]);
    fs::write(at("notes.txt"), "Went up at dawn.\nCame down at dusk.\n").unwrap();
    refused(&at("notes.txt"), &["raster format", "GeoTIFF"]);
    fs::write(
        at("peaks.geojson"),
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}"#,
    )
    .unwrap();
    refused(&at("peaks.geojson"), &["not a raster", "gdal_grid"]);
    fs::write(at("grid.hdr"), "ENVI\nsamples = 4\n").unwrap();
    refused(&at("grid.hdr"), &["header file", "gdalinfo"]);
    refused(Path::new("NETCDF:missing.nc:dem"), &["no such file"]);
    #[cfg(unix)]
    refused(Path::new("/dev/null"), &["not a regular file"]);
}

#[test]
fn truncated_files_are_damaged_never_sea() {
    let dir = folder();
    let whole = dir.path().join("whole.tif");
    Raster::new(200, (0..40_000u32).map(|v| 1000.0 + v as f32 / 7.0).collect()).write("GTiff", &whole);
    let bytes = fs::read(&whole).unwrap();
    assert_eq!(read_all(&whole).rows(), 200);
    for keep in [4, 100, 1_000, bytes.len() / 2, bytes.len() - 1] {
        let path = dir.path().join(format!("cut_{keep}.tif"));
        fs::write(&path, &bytes[..keep]).unwrap();
        refused(&path, &["("]);
    }
    for (driver, name) in [("ENVI", "cut.img"), ("EHdr", "cut.bil"), ("AAIGrid", "cut.asc"), ("PNG", "cut.png")] {
        let path = dir.path().join(name);
        copy(&whole, driver, &path);
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        refused(&path, &["damaged or cut short", "download it again"]);
    }
}

#[test]
fn a_mosaic_without_its_parts_is_damaged() {
    let dir = folder();
    let band = "<SimpleSource><SourceFilename relativeToVRT=\"1\">gone.tif</SourceFilename></SimpleSource>";
    let path = vrt(&dir.path().join("mosaic.vrt"), "", band);
    refused_with(&path, &ReadOptions::default(), &["damaged or cut short", "gone.tif"]);
    // Asked again, GDAL may fail without a word.
    refused_with(&path, &ReadOptions::default(), &["damaged or cut short", "copy or download"]);
}

#[test]
fn what_is_no_surface_is_refused() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    for (columns, samples, size) in [(5, 5, "5 x 1"), (1, 5, "1 x 5"), (1, 1, "1 x 1")] {
        let path = Raster::new(columns, vec![1.0f32; samples]).write("GTiff", &at("line.tif"));
        refused(&path, &[size, "at least 2 x 2", "larger grid"]);
    }
    let void = Raster { nodata: Some(-1.0), ..Raster::new(2, vec![-1.0f32; 4]) };
    refused(&void.write("GTiff", &at("void.tif")), &["no elevation", "all 4 samples are void", "gdalinfo", "--band"]);
    let complex = "dataType=\"CFloat32\" band=\"1\">";
    refused(&vrt(&at("complex.vrt"), "", complex), &["complex numbers", "gdal_translate"]);
    let unscaled = "<Scale>0</Scale>";
    refused(&vrt(&at("scale.vrt"), "", unscaled), &["scale 0", "gdal_translate -a_scale"]);
}

#[test]
fn too_many_samples_are_refused_before_they_are_read() {
    let dir = folder();
    let huge = sized_vrt(&dir.path().join("huge.vrt"), 1_000_000, 1_000_000, "", "<Scale>1</Scale>");
    let longest = format!("at most {LARGEST_SIDE} along a side fit");
    refused(&huge, &["1000000 x 1000000 samples", &longest, "--crop", "--resample"]);
    let part = read(&huge, &cropped([20_000_000.0, -9_000_000.0, 20_000_900.0, -8_999_400.0])).unwrap();
    assert_eq!((part.columns(), part.rows()), (30, 30));
    let most = sized_vrt(&dir.path().join("most.vrt"), 8193, 4096, "", "<Scale>1</Scale>");
    let filled = ReadOptions { fill_voids: true, ..Default::default() };
    let fit = format!("at most {MAX_SAMPLES} fit where voids are filled");
    let line = refused_with(&most, &filled, &["8193 x 4096 = 33558528 samples", &fit, "gdal_fillnodata.py"]);
    // The remedy is one.
    let metres: f64 = line.rsplit("--resample ").next().unwrap().split(' ').next().unwrap().parse().unwrap();
    let coarser = ReadOptions { resample: Some(metres), ..Default::default() };
    assert!(read(&most, &coarser).unwrap().columns() > 4000);
    let wide = sized_vrt(&dir.path().join("wide.vrt"), 40_000, 40_000, "", "<Scale>1</Scale>");
    let coarse = ReadOptions { resample: Some(1000.0), ..Default::default() };
    refused_with(&wide, &coarse, &["1600000000 samples would be read to be warped", "--crop"]);
    let degrees = "<SRS>EPSG:4326</SRS><GeoTransform>8, 1e-5, 0, 47, 0, -1e-5</GeoTransform>";
    let fine = sized_vrt(&dir.path().join("fine.vrt"), 1_000_000, 1_000_000, degrees, "<Scale>1</Scale>");
    refused(&fine, &["samples, at most", "fit where they are warped", "gdalwarp", "--crop", "--resample"]);
    let part = read(&fine, &cropped([9.0, 46.0, 9.001, 46.001])).unwrap();
    assert!((80..=100).contains(&part.columns()), "{}", part.columns());
}

#[test]
fn places_that_make_no_sense_are_refused() {
    let dir = folder();
    let nowhere = Raster { transform: None, ..hill() }.write("GTiff", &dir.path().join("nowhere.tif"));
    refused(&nowhere, &["no geotransform", "--cell M"]);
    let infinite = Raster { transform: Some([5e5, f64::INFINITY, 0.0, 4e6, 0.0, -30.0]), ..hill() };
    refused(&infinite.write("GTiff", &dir.path().join("infinite.tif")), &["no geotransform", "--cell M"]);
    let gcps = "<GCPList Projection=\"EPSG:32610\"><GCP Id=\"1\" Pixel=\"0\" Line=\"0\" X=\"1\" Y=\"2\"/></GCPList>";
    refused(&vrt(&dir.path().join("gcps.vrt"), gcps, "<Scale>1</Scale>"), &["control points", "gdalwarp"]);
    let nonsense =
        [[1e300, 30.0, 0.0, 4e6, 0.0, -30.0], [5e5, 1e-300, 0.0, 4e6, 0.0, -30.0], [5e5, 30.0, 30.0, 4e6, 30.0, 30.0]];
    for transform in nonsense {
        let path = Raster { transform: Some(transform), ..hill() }.write("GTiff", &dir.path().join("far.tif"));
        refused(&path, &["makes no sense", "gdal_translate -a_ullr"]);
    }
    // A shear of a millionth of a cell over the whole grid is rounding.
    let straight = Raster { transform: Some([5e5, 30.0, 1e-6, 4e6, 0.0, -30.0]), ..hill() };
    read_all(&straight.write("GTiff", &dir.path().join("straight.tif")));
}

#[test]
fn units_and_systems_nobody_knows_are_refused() {
    let dir = folder();
    refused(&vrt(&dir.path().join("odd.vrt"), "", "<UnitType>degC</UnitType>"), &["\"degC\"", "--elevation-unit"]);
    // Names in files may break lines and move cursors.
    let line =
        refused(&vrt(&dir.path().join("esc.vrt"), "", "<UnitType>a&#10;b&#27;[31m</UnitType>"), &["\"a b [31m\""]);
    assert!(!line.contains(char::is_control));
    let tiny = Raster { transform: Some([8.0, 0.01, 0.0, 46.0, 0.0, -0.01]), epsg: Some(4326), ..hill() };
    refused(&tiny.write("GTiff", &dir.path().join("tiny.tif")), &["4 x 3 samples", "at least 5 x 5", "larger grid"]);
    let globe = Raster { epsg: Some(4978), ..hill() }.write("GTiff", &dir.path().join("globe.tif"));
    refused(&globe, &["no map projection", "-a_srs EPSG:CODE"]);
    let whole = Raster { transform: Some([-180.0, 90.0, 0.0, 90.0, 0.0, -60.0]), epsg: Some(4326), ..hill() };
    refused(&whole.write("GTiff", &dir.path().join("whole.tif")), &["spans 270 x 120 degrees", "--crop"]);
    for north in [120.0, 95.0] {
        let beyond = Raster { transform: Some([8.0, 1.0, 0.0, north, 0.0, -5.0]), epsg: Some(4326), ..hill() };
        refused(&beyond.write("GTiff", &dir.path().join("beyond.tif")), &["none beyond 90", "-a_ullr"]);
    }
}

#[test]
fn flags_against_what_the_file_says_are_wrong_usage() {
    let dir = folder();
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    let wrong = |options: ReadOptions, words: &str| {
        let error = read(&path, &options).unwrap_err();
        assert_eq!(exit_code(&error), 2, "{error}");
        assert!(line(&error).starts_with(words), "{error}");
    };
    wrong(ReadOptions { cell: Some(10.0), ..Default::default() }, "--cell: ");
    for metres in [0.0, -1.0, f64::NAN, 1e9] {
        wrong(ReadOptions { cell: Some(metres), ..Default::default() }, "--cell: ");
        wrong(ReadOptions { resample: Some(metres), ..Default::default() }, "--resample: ");
    }
}

#[test]
fn a_cell_larger_than_the_dem_leaves_nothing() {
    let dir = folder();
    let path = Raster::new(10, vec![7.0f32; 100]).write("GTiff", &dir.path().join("hill.tif"));
    let coarse = ReadOptions { resample: Some(500.0), ..Default::default() };
    refused_with(&path, &coarse, &["no 2 x 2 cells of 500 m", "--resample"]);
}

#[test]
fn gdal_stays_silent() {
    let stderr = |child: &str| {
        let test = std::env::current_exe().unwrap();
        let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stdout));
        String::from_utf8(ran.stderr).unwrap()
    };
    assert_eq!(stderr("dem::refused::child_reads_bad_files"), "");
    assert!(stderr("dem::refused::child_lets_gdal_speak").contains("ERROR"), "the check must see GDAL where it speaks");
}

#[test]
#[ignore = "run by gdal_stays_silent in a process of its own"]
fn child_reads_bad_files() {
    let dir = folder();
    let path = cut_short(dir.path());
    assert!(read(&path, &ReadOptions::default()).is_err());
    for text in ["no raster at all", "<VRTDataset><Open>", "<VRTDataset rasterXSize=\"4\"/>"] {
        fs::write(&path, text).unwrap();
        assert!(read(&path, &ReadOptions::default()).is_err());
    }
}

#[test]
#[ignore = "run by gdal_stays_silent in a process of its own"]
fn child_lets_gdal_speak() {
    let dir = folder();
    let file = Dataset::open(cut_short(dir.path())).unwrap();
    assert!(file.rasterband(1).unwrap().read_band_as::<f32>().is_err());
}

/// A GeoTIFF that lacks the end of its samples.
fn cut_short(folder: &Path) -> PathBuf {
    let path = hill().write("GTiff", &folder.join("hill.tif"));
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 20]).unwrap();
    path
}
