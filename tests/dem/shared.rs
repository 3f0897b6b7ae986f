//! Every file of shared terrain is read, and says what was done to it.

use std::fs;
use std::path::{Path, PathBuf};

use gdal::Dataset;
use glam::DVec2;
use hachure::dem::Dem;
use hachure::geo::{Info, ReadOptions, info, read};

use super::{read_all, refused::refused, told, with_steps};
use crate::common::shared_dems;

/// Metres between formats of one terrain: whole-metre formats round by half a metre, text formats by a little more.
const FORMATS_METRES: f32 = 0.501;
/// The same after a warp: the weights of cubic convolution add up to 1.25 a direction, 1.56 in all, without their signs.
const WARPED_METRES: f32 = 0.79;

/// The Half Dome crop in every format that says where it lies.
pub const HALF_DOME: [&str; 10] = [
    "halfdome_f64.tif",
    "halfdome_bigtiff_lzw.tif",
    "halfdome.asc",
    "halfdome.asc.gz",
    "halfdome_f.flt",
    "halfdome_i.bil",
    "halfdome_envi.img",
    "halfdome.nc",
    "halfdome.dem",
    "halfdome.vrt",
];

fn worst(a: &Dem, b: &[f32]) -> f32 {
    assert_eq!(a.held().unwrap().heights().len(), b.len());
    a.held().unwrap().heights().iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn half_dome_is_the_same_terrain_in_every_format() {
    let Some(shared) = shared_dems() else { return };
    let formats = shared.join("formats");
    let dems = HALF_DOME.map(|name| read(formats.join(name), &with_steps()).unwrap());
    for (name, dem) in HALF_DOME.iter().zip(&dems) {
        assert_eq!((dem.extent(), dem.voids()), (dems[0].extent(), 0), "{name}");
        let gap = worst(dem, dems[0].held().unwrap().heights());
        assert!(gap <= WARPED_METRES, "{name}: {gap} m");
    }
    assert_ne!(
        dems[0].held().unwrap().heights(),
        dems[5].held().unwrap().heights(),
        "whole metres must differ from f64"
    );
    // The scaled one declares tenths over the same numbers: the same shape, a tenth as high.
    let scaled = read(formats.join("halfdome_scaled.vrt"), &ReadOptions { exaggeration: 10.0, ..with_steps() });
    assert!(worst(&scaled.unwrap(), dems[0].held().unwrap().heights()) < 0.01);
    // The image is nowhere: its samples are those of the file, before any warp.
    let image = formats.join("halfdome_u16.png");
    refused(&image, &["no geotransform", "--cell M"]);
    let image = read(image, &ReadOptions { cell: Some(27.5), ..with_steps() }).unwrap();
    let file = Dataset::open(formats.join("halfdome_f64.tif")).unwrap();
    let raw = file.rasterband(1).unwrap().read_band_as::<f32>().unwrap();
    assert!(worst(&image, raw.data()) <= FORMATS_METRES);
}

/// File, samples, EPSG code of the map it is drawn in, lowest and highest metres in the file, share of voids, and how
/// far a warp may lower or raise the extremes, metres.
type Row = (&'static str, [usize; 2], Option<u32>, [f32; 2], f64, f32);

const FILES: [Row; 15] = [
    ("west_temple_50m.tif", [120, 140], Some(26912), [1176.2, 2365.4], 0.0, 0.1),
    ("zion_srtm3.tif", [402, 499], Some(32612), [1024.0, 2892.0], 0.0, 26.0),
    ("sthelens_utm10n_10m.tif", [1450, 2073], Some(26910), [567.6, 2536.6], 0.0225, 0.1),
    ("SainteHelens.dem", [327, 468], Some(26710), [682.0, 2543.0], 0.0271, 0.1),
    ("half_dome_ned1.tif", [887, 953], Some(32611), [1175.0, 3568.0], 0.0, 12.0),
    ("yosemite_utm11n_30m.tif", [863, 923], Some(26911), [1175.9, 3563.6], 0.0534, 0.1),
    ("yosemite_calif3_feet.tif", [834, 894], Some(2227), [1175.6, 3561.6], 0.0208, 0.1),
    ("inl_idaho_feet.tif", [1145, 1142], None, [1345.1, 3696.6], 0.0, 0.1),
    ("mt_rainier_90m.tif", [968, 1423], Some(32610), [263.0, 4371.0], 0.0065, 6.0),
    ("N46E008.tif", [988, 1433], Some(32632), [187.0, 4173.0], 0.0719, 24.0),
    ("N36E137.hgt", [1043, 1307], Some(32653), [-19.0, 3178.0], 0.0, 2.0),
    ("N48W125.hgt.zip", [2846, 4354], Some(32610), [-13.0, 1095.0], 0.5007, 34.0),
    ("coastal_flat_nodata.tif", [239, 265], Some(32617), [1.0, 26.0], 0.0777, 3.0),
    ("craterlake-elev-16bit-30m.tif", [362, 318], Some(32610), [1289.0, 1880.0], 0.3035, 6.0),
    ("topo.nc", [156, 168], Some(32611), [2383.8, 3581.2], 0.0, 0.1),
];

/// What must be said of some of them.
const WORDS: [(&str, &str); 9] = [
    ("SainteHelens.dem", "heights are multiples of 1 m: drawn is the smoothest surface within 0.5 m of them"),
    ("N36E137.hgt", "heights are multiples of 1 m"),
    ("yosemite_calif3_feet.tif", "elevations x 0.3048006096012192 to metres (\"US survey foot\")"),
    ("yosemite_calif3_feet.tif", "coordinates x 0.30480060960121924 to metres"),
    ("inl_idaho_feet.tif", "elevations x 0.3048 to metres (\"ft\")"),
    ("half_dome_ned1.tif", "warped from degrees (NAD83 (EPSG:4269)) to WGS 84 / UTM zone 11N (EPSG:32611)"),
    ("craterlake-elev-16bit-30m.tif", "39489 samples at or below -32767 or above 100000 m are voids"),
    ("N36E137.hgt", "square cells of 83.1 m, the largest rectangle inside the data"),
    ("coastal_flat_nodata.tif", "cubic"),
];

fn named(shared: &Path, name: &str) -> PathBuf {
    match name {
        "topo.nc" => PathBuf::from(format!("NETCDF:{}:dem", shared.join(name).display())),
        _ => shared.join(name),
    }
}

#[test]
fn every_shared_file_is_read() {
    let Some(shared) = shared_dems() else { return };
    for (name, [columns, rows], epsg, [low, high], voids, slack) in FILES {
        let told = told(&named(&shared, name));
        let near = |a: usize, b: usize| a.abs_diff(b) <= 1;
        assert!(near(told.columns, columns) && near(told.rows, rows), "{name}:\n{told}");
        assert_eq!(told.crs.epsg(), epsg, "{name}:\n{told}");
        let [lowest, highest] = told.range;
        // Heights that are multiples of a step lie within half of it.
        let slack = slack + told.history.steps().iter().fold(0.0, |most: f64, step| most.max(*step)) as f32 / 2.0;
        assert!((lowest - low).abs() <= slack + 0.1 && (highest - high).abs() <= slack + 0.1, "{name}:\n{told}");
        assert!((told.void_share() - voids).abs() < 0.0006, "{name}: {} of voids:\n{told}", told.void_share());
        for (_, words) in WORDS.iter().filter(|(of, _)| *of == name) {
            assert!(told.to_string().contains(words), "{name} does not say {words:?}:\n{told}");
        }
    }
}

#[test]
fn every_shared_file_is_listed() {
    let Some(shared) = shared_dems() else { return };
    let listed = |name: &str| {
        let alone = ["INDEX.md", "n37_w123_1arc_v3_deflate.tif", "korea_srtm3_4400.tif", "formats"];
        FILES.iter().any(|row| row.0 == name) || alone.contains(&name)
    };
    for entry in fs::read_dir(shared).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(listed(&name), "{name} is read by no test");
    }
}

#[test]
fn the_sample_is_a_part_of_its_tile() {
    let Some(shared) = shared_dems() else { return };
    let sample = read_all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif"));
    // The sample was warped to 30 m by gdalwarp: our own way from the tile must end at the same heights.
    let [west, south, east, north] = [-122.59, 37.765, -122.4, 37.915];
    let options = ReadOptions { crop: Some([west, south, east, north]), resample: Some(15.0), ..Default::default() };
    let ours = read(shared.join("n37_w123_1arc_v3_deflate.tif"), &options).unwrap();
    // Half a cell beside, in any direction, they must differ more.
    let off = |dx: i64, dy: i64| {
        let (mut compared, mut sum) = (0, 0.0);
        for (c, r) in (1..ours.rows() - 1).flat_map(|r| (1..ours.columns() - 1).map(move |c| (c, r))) {
            let at = sample.grid_place(ours.position(c, r).truncate());
            let (x, y) = (at.x.round(), at.y.round());
            let inside = x >= 0.0 && y >= 0.0 && x < sample.columns() as f64 && y < sample.rows() as f64;
            if !inside || (at - DVec2::new(x, y)).length() > 1e-6 {
                continue;
            }
            let beside = ours.height((c as i64 + dx) as usize, (r as i64 + dy) as usize).unwrap();
            sum += f64::from((beside - sample.height(x as usize, y as usize).unwrap()).abs());
            compared += 1;
        }
        assert!(compared > 100_000, "{compared} samples");
        sum / f64::from(compared)
    };
    let here = off(0, 0);
    let beside = [(-1, 0), (1, 0), (0, -1), (0, 1)].map(|(dx, dy)| off(dx, dy));
    println!("the tile is {here:.3} m off the sample on average, half a cell beside {beside:.3?} m");
    assert!(here < 0.7 && beside.iter().all(|beside| *beside > 2.0 * here), "{here} m; {beside:?}");
}

#[test]
fn voids_of_rainier_and_the_alps_are_holes_or_filled() {
    let Some(shared) = shared_dems() else { return };
    for (name, left) in [("mt_rainier_90m.tif", 0), ("N46E008.tif", 0)] {
        let holes = read_all(&shared.join(name));
        let filled: Info =
            info(&[shared.join(name)], &ReadOptions { fill_voids: true, ..Default::default() }, &|_, _| ()).unwrap();
        assert!(holes.voids() > 8000 && filled.voids == left, "{name}: {} of {} left", filled.voids, holes.voids());
        let words = format!("{} voids filled from up to 100 samples away", holes.voids());
        assert!(filled.to_string().contains(&words), "{filled}");
    }
}

#[test]
fn a_container_lists_its_grids() {
    let Some(shared) = shared_dems() else { return };
    let path = shared.join("topo.nc");
    let line = refused(&path, &["grids", "name one: `NETCDF:"]);
    let name = line.split('`').nth(1).unwrap();
    assert_eq!(name, format!("NETCDF:{}:dem", path.display()));
    let dem = read_all(Path::new(name));
    assert_eq!((dem.columns(), dem.rows(), dem.cell()), (156, 168, DVec2::splat(50.0)));
}
