//! Every way a file can be refused: one line with the file, what is wrong and a remedy.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gdal::Dataset;
use glam::DVec2;
use hachure::dem::{MAX_SAMPLES, ReadOptions, info, read};

use super::{HALF_DOME, Raster, copy, cropped, folder, hill, read_all, sized_vrt, vrt};
use crate::common::shared_dems;

/// Reading `path` fails with one line that names the file, holds all `words`, and exit code 1; so does `info`.
pub fn refused(path: &Path, words: &[&str]) -> String {
    let line = refused_with(path, &ReadOptions::default(), words);
    assert_eq!(info(path).unwrap_err().to_string(), line);
    line
}

fn refused_with(path: &Path, options: &ReadOptions, words: &[&str]) -> String {
    let error = read(path, options).expect_err(&format!("{} was read", path.display()));
    let line = error.to_string();
    assert!(!line.contains('\n'), "more than one line: {line}");
    assert!(line.contains(&path.display().to_string()), "no path: {line}");
    assert!(line.split_once("; ").is_some_and(|(_, remedy)| remedy.len() > 10), "no remedy: {line}");
    words.iter().for_each(|word| assert!(line.contains(word), "no {word:?}: {line}"));
    assert_eq!(error.exit_code(), 1, "{line}");
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
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().starts_with("--crop: "), "{error}");
    }
    for exaggeration in [0.0, -1.0, f64::NAN, f64::INFINITY, 1001.0] {
        let error = read(&path, &ReadOptions { exaggeration, ..Default::default() }).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().starts_with("--exaggeration: "), "{error}");
    }
}

#[test]
fn files_that_are_no_raster() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    refused(&at("missing.tif"), &["no such file", "spelling"]);
    refused(dir.path(), &["directory", "name the raster file"]);
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
    refused(Path::new("/vsicurl/http://localhost/x.tif"), &["no such file"]);
    refused(Path::new("NETCDF:missing.nc:dem"), &["no such file"]);
    #[cfg(unix)]
    refused(Path::new("/dev/null"), &["not a regular file"]);
}

#[test]
fn a_container_lists_its_grids() {
    let Some(shared) = shared_dems() else { return };
    let path = shared.join("topo.nc");
    let line = refused(&path, &["grids", "name the one"]);
    let name = line.split('`').nth(1).unwrap();
    assert_eq!(name, format!("NETCDF:{}:dem", path.display()));
    let dem = read_all(Path::new(name));
    assert_eq!((dem.columns(), dem.rows(), dem.cell()), (156, 168, DVec2::splat(50.0)));
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
    refused(&void.write("GTiff", &at("void.tif")), &["no elevation", "all 4 samples are void", "gdalinfo"]);
    let complex = "dataType=\"CFloat32\" band=\"1\">";
    refused(&vrt(&at("complex.vrt"), "", complex), &["complex numbers", "gdal_translate"]);
    let unscaled = "<Scale>0</Scale>";
    refused(&vrt(&at("scale.vrt"), "", unscaled), &["scale 0", "gdal_translate -a_scale"]);
}

#[test]
fn too_many_samples_are_refused_before_they_are_read() {
    let dir = folder();
    let huge = sized_vrt(&dir.path().join("huge.vrt"), 1_000_000, 1_000_000, "", "<Scale>1</Scale>");
    let line = refused(&huge, &["1000000 x 1000000 = 1000000000000 samples", "at most 33554432 fit", "--crop"]);
    assert!(line.contains(&MAX_SAMPLES.to_string()));
    let part = read(&huge, &cropped([20_000_000.0, -9_000_000.0, 20_000_900.0, -8_999_400.0])).unwrap();
    assert_eq!((part.columns(), part.rows()), (30, 30));
    let most = sized_vrt(&dir.path().join("most.vrt"), 8193, 4096, "", "<Scale>1</Scale>");
    refused(&most, &["8193 x 4096 = 33558528 samples"]);
}

#[test]
fn degrees_are_sent_to_their_utm_zone() {
    let dir = folder();
    for (place, zone) in [([-119.6, 37.8], "EPSG:32611"), ([170.1, -43.5], "EPSG:32759"), ([10.0, 88.0], "EPSG:3413")] {
        let transform = Some([place[0], 0.001, 0.0, place[1], 0.0, -0.001]);
        let degrees = Raster { transform, epsg: Some(4326), ..hill() };
        let path = degrees.write("GTiff", &dir.path().join("degrees.tif"));
        refused(&path, &["in degrees", &format!("gdalwarp -t_srs {zone} ")]);
    }
    let nameless = Raster { transform: Some([-119.6, 0.001, 0.0, 37.8, 0.0, -0.001]), epsg: None, ..hill() };
    refused(&nameless.write("GTiff", &dir.path().join("nameless.tif")), &["look like degrees", "-a_srs EPSG:4326"]);
}

#[test]
fn feet_are_refused_on_every_axis() {
    let dir = folder();
    let californian = Raster { transform: Some([6.8e6, 100.0, 0.0, 2.1e6, 0.0, -100.0]), epsg: Some(2227), ..hill() };
    let path = californian.write("GTiff", &dir.path().join("feet.tif"));
    refused(&path, &["US survey foot", "gdalwarp -t_srs EPSG:32611 "]);
    for (unit, factor) in
        [("ft", "0.3048 "), ("US survey foot", "0.3048006096"), ("us-ft", "0.3048006096"), ("Feet", "0.3048 ")]
    {
        let path = vrt(&dir.path().join("up.vrt"), "", &format!("<UnitType>{unit}</UnitType>"));
        refused(
            &path,
            &[&unit.to_lowercase(), "not metres", &format!("gdal_translate -ot Float32 -scale 0 1 0 {factor}")],
        );
    }
    refused(&vrt(&dir.path().join("odd.vrt"), "", "<UnitType>degC</UnitType>"), &["degc", "metres per unit"]);
    for unit in ["m", "metre", "Meters", ""] {
        read_all(&vrt(&dir.path().join("up.vrt"), "", &format!("<UnitType>{unit}</UnitType>")));
    }
    let compound = "<SRS>EPSG:32610+6360</SRS><GeoTransform>500000, 30, 0, 4200000, 0, -20</GeoTransform>";
    refused(
        &vrt(&dir.path().join("compound.vrt"), compound, "<Scale>1</Scale>"),
        &["foot", "-scale 0 1 0 0.3048006096"],
    );
}

#[test]
fn turned_grids_are_refused() {
    let dir = folder();
    let turned = [
        ([5e5, 30.0, 4.0, 4e6, 4.0, -30.0], "rotated or sheared"),
        ([5e5, 30.0, 0.0, 4e6, 0.0, 30.0], "south-up"),
        ([5e5, -30.0, 0.0, 4e6, 0.0, -30.0], "mirrored"),
        ([5e5, 0.0, 30.0, 4e6, 30.0, 0.0], "rotated or sheared"),
        ([5e5, f64::INFINITY, 0.0, 4e6, 0.0, -30.0], "no geotransform"),
    ];
    for (transform, word) in turned {
        let path = Raster { transform: Some(transform), ..hill() }.write("GTiff", &dir.path().join("turned.tif"));
        refused(&path, &[word, "`gdal"]);
    }
    let nowhere = Raster { transform: None, ..hill() }.write("GTiff", &dir.path().join("nowhere.tif"));
    refused(&nowhere, &["no geotransform", "-a_ullr WEST NORTH EAST SOUTH"]);
    let gcps = "<GCPList Projection=\"EPSG:32610\"><GCP Id=\"1\" Pixel=\"0\" Line=\"0\" X=\"1\" Y=\"2\"/></GCPList>";
    refused(&vrt(&dir.path().join("gcps.vrt"), gcps, "<Scale>1</Scale>"), &["control points", "gdalwarp"]);
    for transform in [[1e300, 30.0, 0.0, 4e6, 0.0, -30.0], [5e5, 1e-300, 0.0, 4e6, 0.0, -30.0]] {
        let path = Raster { transform: Some(transform), ..hill() }.write("GTiff", &dir.path().join("far.tif"));
        refused(&path, &["makes no sense", "gdal_translate -a_ullr"]);
    }
    // A shear of a millionth of a cell over the whole grid is rounding.
    let straight = Raster { transform: Some([5e5, 30.0, 1e-6, 4e6, 0.0, -30.0]), ..hill() };
    read_all(&straight.write("GTiff", &dir.path().join("straight.tif")));
}

#[test]
fn half_dome_in_degrees_is_refused_in_every_format() {
    let Some(shared) = shared_dems() else { return };
    for name in HALF_DOME {
        let word = match name {
            "halfdome.asc.gz" => "look like degrees",
            "halfdome_u16.png" => "no geotransform",
            _ => "gdalwarp -t_srs EPSG:32611",
        };
        refused(&shared.join("formats").join(name), &[word]);
    }
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
    fs::write(&path, "no raster at all").unwrap();
    assert!(read(&path, &ReadOptions::default()).is_err());
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

#[test]
fn shared_terrain_in_feet_and_degrees_is_refused() {
    let Some(shared) = shared_dems() else { return };
    refused(&shared.join("yosemite_calif3_feet.tif"), &["us survey foot", "-scale 0 1 0 0.3048006096"]);
    refused(&shared.join("inl_idaho_feet.tif"), &["\"ft\"", "-scale 0 1 0 0.3048 "]);
    refused(&shared.join("N48W125.hgt.zip"), &["in degrees", "EPSG:32610"]);
}
