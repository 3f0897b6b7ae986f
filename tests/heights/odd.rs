//! Numbers that no rule of one mark or unit fits: signed bytes, marks beside other units, nothing but a mark, junk amid land,
//! holes in pictures of elevations.

use std::path::Path;

use gdal::DriverManager;
use gdal::raster::ColorInterpretation::{BlueBand, GreenBand, RedBand, Undefined};
use gdal::raster::{Buffer, RasterCreationOptions};
use gdal::spatial_ref::SpatialRef;
use hachure::door::cli::values;
use hachure::door::cli::words::line;
use hachure::geo::{Encoding, ReadOptions, read};

use super::{Bands, SIDE, assumed, cured, doubt, folder, land, marked, one, same, with_steps};

/// Bytes of which the file says that they have a sign.
fn signed_bytes(numbers: &[f64], path: &Path) {
    let options = RasterCreationOptions::from_iter(["PIXELTYPE=SIGNEDBYTE"]);
    let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
    let mut file = driver.create_with_band_type_with_options::<u8, _>(path, SIDE, SIDE, 1, &options).unwrap();
    file.set_geo_transform(&[500_000.0, 30.0, 0.0, 5_000_000.0, 0.0, -30.0]).unwrap();
    file.set_spatial_ref(&SpatialRef::from_epsg(32632).unwrap()).unwrap();
    let bytes = numbers.iter().map(|n| *n as i8 as u8).collect();
    file.rasterband(1).unwrap().write((0, 0), (SIDE, SIDE), &mut Buffer::new((SIDE, SIDE), bytes)).unwrap();
    file.close().unwrap();
}

#[test]
fn signed_bytes_are_below_zero() {
    let dir = folder();
    let path = dir.path().join("bytes.tif");
    let numbers: Vec<_> = land().iter().map(|n| (n / 5.0 - 150.0).round()).collect();
    signed_bytes(&numbers, &path);
    let line = doubt(&path, &["8-bit numbers, -128 to 127, are heights"]);
    same(&cured(&path, &line, "--elevation-unit"), &numbers, 0.0);
    let asked = ReadOptions { nodata: values::nodata("-128..-60").unwrap(), ..with_steps() };
    let void: Vec<_> = numbers.iter().map(|n| if *n <= -60.0 { f64::NAN } else { *n }).collect();
    same(&read(&path, &asked).unwrap(), &void, 0.0);
}

#[test]
fn what_is_not_finite_is_refused_as_nodata() {
    for text in ["nan", "-9999,NaN", "inf", "9000..inf", "-inf..-100", "1e999"] {
        let words = values::nodata(text).expect_err(text);
        assert!(words.contains("no data already"), "{text}: {words}");
    }
    assert!(values::nodata("-9999,9000..65535").is_ok());
}

#[test]
fn a_mark_beside_another_unit_leaves_the_unit() {
    let dir = folder();
    let path = dir.path().join("unit.tif");
    let metres = |unit: f64| -> Vec<_> { marked(f64::NAN, &land()).iter().map(|n| (n * unit).round()).collect() };
    let hole =
        |mark: f64, unit: f64| -> Vec<_> { metres(unit).iter().map(|n| if n.is_nan() { mark } else { *n }).collect() };
    one(&hole(-2_147_483_648.0, 100.0), |n| n as i32).write(&path);
    let told = assumed(std::slice::from_ref(&path), &with_steps());
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("--nodata -2147483648,") && told[1].contains("--elevation-unit cm"), "{told:?}");
    let both = ReadOptions {
        nodata: values::nodata("-2147483648").unwrap(),
        elevation_unit: Some(values::elevation_unit("cm").unwrap()),
        ..with_steps()
    };
    assert_eq!(assumed(std::slice::from_ref(&path), &both), Vec::<String>::new());
    same(&read(&path, &both).unwrap(), &marked(f64::NAN, &land()), 1e-3);
    // Without a mark only the unit.
    let plain: Vec<_> = land().iter().map(|n| n * 100.0).collect();
    one(&plain, |n| n as i32).write(&path);
    let told = assumed(std::slice::from_ref(&path), &with_steps());
    assert!(
        told.iter().all(|clause| clause.contains("--elevation-unit cm") && !clause.contains("--nodata")),
        "{told:?}"
    );
    // Many different ones that are heights in no unit.
    let many: Vec<_> =
        land().iter().enumerate().map(|(i, n)| if i < 40 { -1e9 - i as f64 * 64.0 } else { *n }).collect();
    one(&many, |n| n as f32).write(&path);
    let line = doubt(&path, &["40 samples at or below -32767", "--nodata -1000002500..-1000000000)"]);
    let void: Vec<_> = many.iter().map(|n| if *n < 0.0 { f64::NAN } else { *n }).collect();
    same(&cured(&path, &line, "--nodata"), &void, 0.0);
}

#[test]
fn nothing_but_a_mark_is_told() {
    let dir = folder();
    let path = dir.path().join("all.tif");
    one(&vec![-9999.0; SIDE * SIDE], |n| n as f32).write(&path);
    let words = ["6400 samples (100.0 %) of exactly -9999 are heights (there are no others", "--nodata -9999)"];
    doubt(&path, &words);
    let half: Vec<_> = land().iter().enumerate().map(|(i, n)| if i % SIDE < 40 { -9999.0 } else { *n }).collect();
    one(&half, |n| n as f32).write(&path);
    let crop = ReadOptions { crop: Some([500_000.0, 4_998_000.0, 500_900.0, 4_999_500.0]), ..with_steps() };
    let told = assumed(std::slice::from_ref(&path), &crop);
    assert!(
        told.len() == 1 && told[0].contains("there are no others") && told[0].contains("--nodata -9999)"),
        "{told:?}"
    );
    // A plain is one.
    one(&vec![-12.0; SIDE * SIDE], |n| n as f32).write(&path);
    assert_eq!(assumed(&[path], &with_steps()), Vec::<String>::new());
}

#[test]
fn junk_amid_land_may_be_no_heights() {
    let dir = folder();
    let path = dir.path().join("junk.tif");
    let junk = |i: usize| match i % 40 {
        0 => Some(9000.0 + (i * 7919 % 55_000) as f64),
        7 => Some(-12_000.0 - (i * 7919 % 18_000) as f64),
        _ => None,
    };
    let numbers: Vec<_> = land().iter().enumerate().map(|(i, n)| junk(i).unwrap_or(*n)).collect();
    one(&numbers, |n| n as f32).write(&path);
    let line = doubt(&path, &["below all land on Earth", "above all land on Earth", "--elevation-unit dm"]);
    let void: Vec<_> = land().iter().enumerate().map(|(i, n)| junk(i).map_or(*n, |_| f64::NAN)).collect();
    same(&cured(&path, &line, "--nodata"), &void, 0.0);
}

#[test]
fn pictures_of_elevations_have_holes() {
    let dir = folder();
    let path = dir.path().join("packed.tif");
    let (whole, holes) = (land(), marked(f64::NAN, &land()));
    let packed = |heights: &[f64]| {
        let number = |metres: f64| if metres.is_nan() { 0 } else { ((metres + 10_000.0) * 10.0).round() as u32 };
        [16, 8, 0].map(|shift| heights.iter().map(|metres| (number(*metres) >> shift) as u8).collect()).to_vec()
    };
    let colours = || vec![RedBand, GreenBand, BlueBand, Undefined];
    let asked = ReadOptions { encoding: Some(Encoding::TerrainRgb), ..with_steps() };
    let black: Vec<Vec<u8>> = packed(&holes);
    Bands { colours: colours(), ..Bands::new(black) }.write(&path);
    same(&read(&path, &asked).unwrap(), &holes, 1e-4);
    let opaque: Vec<u8> = marked(0.0, &vec![255.0; SIDE * SIDE]).iter().map(|n| *n as u8).collect();
    Bands { colours: colours(), ..Bands::new([packed(&whole), vec![opaque]].concat()) }.write(&path);
    let line = line(&read(&path, &with_steps()).expect_err("a picture was read"));
    same(&cured(&path, &line, "--encoding"), &holes, 1e-4);
}
