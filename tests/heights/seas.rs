//! Depths, and grids whose places stand in arrays of their own.

use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;

use hachure::door::cli::words::line;
use hachure::geo::{ReadOptions, read};

use super::{Bands, FILED, SIDE, assumed, folder, land, one, same, with_steps};
use crate::common::words;

type Said = &'static [(&'static str, &'static str)];

/// A file of numbers with these attributes of its band.
fn with(numbers: &[f64], said: Said, path: &Path) -> PathBuf {
    Bands { said: said.to_vec(), ..one(numbers, |n| n as f32) }.write(path)
}

#[test]
fn depths_become_heights() {
    let dir = folder();
    let path = dir.path().join("depth.tif");
    let (up, down): (Vec<_>, Vec<_>) = (land(), land().iter().map(|n| -n).collect());
    let cases: [(Said, bool); 9] = [
        (&[("positive", "down")], true),
        (&[("positive", "Down"), ("standard_name", "altitude")], true),
        (&[("standard_name", "sea_floor_depth_below_geoid")], true),
        (&[("long_name", "Ocean depth")], true),
        (&[("NETCDF_VARNAME", "z"), ("long_name", "water depth below datum")], true),
        (&[("positive", "up"), ("standard_name", "depth")], false),
        (&[("standard_name", "height"), ("long_name", "height or depth")], false),
        (&[("long_name", "depths of thought")], false),
        (&[("units", "m")], false),
    ];
    for (said, is_depth) in cases {
        with(&up, said, &path);
        for memory in [1 << 30, FILED] {
            let dem = read(&path, &ReadOptions { memory, ..with_steps() }).unwrap();
            same(&dem, if is_depth { &down } else { &up }, 0.0);
            let told =
                words(dem.history().converted()).iter().any(|clause| clause.starts_with("depths x -1 to heights ("));
            assert_eq!(told, is_depth, "{said:?}: {:?}", dem.history());
        }
    }
    // What a person calls depth and is below zero is a height already.
    with(&down, &[("long_name", "Depth")], &path);
    same(&read(&path, &with_steps()).unwrap(), &down, 0.0);
    let told = assumed(std::slice::from_ref(&path), &with_steps());
    assert!(told[0].contains("heights already, though the long name is \"Depth\""), "{told:?}");
    // Marks stay what they are.
    let mut fill = up.clone();
    fill[..SIDE].fill(9.969_21e36);
    with(&fill, &[("positive", "down")], &path);
    fill[..SIDE].fill(f64::NAN);
    let void: Vec<_> = fill.iter().map(|n| -n).collect();
    same(&read(&path, &with_steps()).unwrap(), &void, 0.0);
}

#[test]
fn what_is_said_of_a_variable_is_said_of_its_band() {
    let dir = folder();
    let path = with(&land(), &[("NETCDF_VARNAME", "z")], &dir.path().join("variable.tif"));
    let options = gdal::DatasetOptions { open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE, ..Default::default() };
    let mut file = gdal::Dataset::open_ex(&path, options).unwrap();
    gdal::Metadata::set_metadata_item(&mut file, "time#positive", "down", "").unwrap();
    file.close().unwrap();
    same(&read(&path, &with_steps()).unwrap(), &land(), 0.0);
    let options = gdal::DatasetOptions { open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE, ..Default::default() };
    let mut file = gdal::Dataset::open_ex(&path, options).unwrap();
    gdal::Metadata::set_metadata_item(&mut file, "z#positive", "down", "").unwrap();
    file.close().unwrap();
    let down: Vec<_> = land().iter().map(|n| -n).collect();
    same(&read(&path, &with_steps()).unwrap(), &down, 0.0);
}

/// A grid of land whose longitudes and latitudes stand in arrays beside it, as VRT.
fn curved(folder: &Path) -> PathBuf {
    let place = |i: usize| ((i % SIDE) as f64, (i / SIDE) as f64);
    let turned = |along: f64, across: f64, from: f64| {
        (0..SIDE * SIDE).map(|i| from + (place(i).0 * along + place(i).1 * across) / 2400.0).collect::<Vec<_>>()
    };
    Bands::new(vec![turned(1.0, 0.2, 10.0)]).write(&folder.join("lon.tif"));
    Bands::new(vec![turned(0.2, -1.0, 45.0)]).write(&folder.join("lat.tif"));
    one(&land(), |n| n as f32).write(&folder.join("land.tif"));
    let at = |name: &str| folder.join(name).display().to_string();
    let arrays = [("X_DATASET", at("lon.tif")), ("Y_DATASET", at("lat.tif"))];
    let steps = ["X_BAND", "Y_BAND", "PIXEL_STEP", "LINE_STEP"].map(|key| (key, "1".to_owned()));
    let zero = ["PIXEL_OFFSET", "LINE_OFFSET"].map(|key| (key, "0".to_owned()));
    let wgs = gdal::spatial_ref::SpatialRef::from_epsg(4326).unwrap().to_wkt().unwrap();
    let items: String = (arrays.into_iter().chain(steps).chain(zero).chain([("SRS", wgs.replace('"', "&quot;"))]))
        .map(|(key, value)| format!("<MDI key=\"{key}\">{value}</MDI>"))
        .collect();
    let text = format!(
        "<VRTDataset rasterXSize=\"{SIDE}\" rasterYSize=\"{SIDE}\"><Metadata domain=\"GEOLOCATION\">{items}</Metadata>\
         <VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"1\">land.tif\
         </SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>"
    );
    let path = folder.join("curved.vrt");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn curved_grids_are_refused_with_a_line_that_works() {
    let dir = folder();
    let path = curved(dir.path());
    let refused = |options| line(&read(&path, &options).expect_err("a curved grid was read"));
    let line = refused(with_steps());
    assert!(line.contains("gdalwarp -geoloc") && !line.contains("--cell"), "{line}");
    assert_eq!(refused(ReadOptions { cell: Some(30.0), ..with_steps() }), line, "with --cell");
    let mut words = line.split('`').nth(1).unwrap().split(' ');
    let out = dir.path().join("out.tif");
    let mut command = Command::new(words.next().unwrap());
    for word in words {
        match word {
            "IN" => command.arg(&path),
            "OUT.tif" => command.arg(&out),
            word => command.arg(word),
        };
    }
    let Ok(done) = command.output() else {
        let _ = writeln!(stderr(), "SKIP curved_grids_are_refused_with_a_line_that_works: install gdalwarp (gdal-bin)");
        return;
    };
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let dem = read(&out, &with_steps()).unwrap();
    let [low, high] = dem.range().unwrap();
    assert!((395.0..410.0).contains(&low) && (1280.0..1315.0).contains(&high), "{low} to {high} m");
    let share = dem.voids() as f64 / (dem.columns() * dem.rows()) as f64;
    assert!(share > 0.05 && share < 0.6, "{share} of voids: the corners are no land");
}
