//! Samples that stay in their files are those that are held, bit by bit.

use std::fs;
use std::path::{Path, PathBuf};
use std::slice;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::surface::normals::gradients;
use hachure::door::surface::rim::rim;
use hachure::geo::{ReadOptions, read_all};
use hachure::surface::Surface;
use hachure::view::{Fixed, choose};

use super::{Raster, copy, cropped, folder, sized_vrt};
use crate::common::shared_dems;
use crate::scenes::Random;

/// A budget that no DEM here fits: 2 KiB, less than one tile.
const TINY: u64 = 1 << 11;
/// One that keeps a few tiles of those here.
const SMALL: u64 = 1 << 16;

/// 200 x 150 samples with voids, one of them a mark that is not declared.
fn rough() -> Raster<f32> {
    let mut random = Random::new(3);
    let values = (0..200 * 150).map(|i| match random.below(30) {
        0 => -9999.0,
        _ if i == 4321 => -32768.0,
        _ => random.between(0.0, 900.0) as f32,
    });
    Raster { nodata: Some(-9999.0), ..Raster::new(200, values.collect()) }
}

/// The same files held, and filed within `memory`.
fn both(paths: &[PathBuf], options: ReadOptions, memory: u64) -> [Dem; 2] {
    let dems = [1 << 30, memory]
        .map(|memory| read_all(paths, &ReadOptions { memory, ..options.clone() }, &|_, _| ()).expect("a DEM"));
    assert_eq!([dems[0].is_filed(), dems[1].is_filed()], [false, true], "{paths:?}");
    dems
}

/// What differs between two DEMs, in a word: nothing.
fn difference([held, filed]: &[Dem; 2]) -> Option<&'static str> {
    let whole = [held.columns(), held.rows()];
    if whole != [filed.columns(), filed.rows()] || held.extent() != filed.extent() {
        return Some("grid");
    }
    let mut random = Random::new(5);
    let mut window = || {
        let first = whole.map(|n| random.below(n as u32 + 2) as usize);
        (first, whole.map(|n| 1 + random.below(n as u32 / 2 + 3) as usize))
    };
    for (first, size) in (0..40).map(|_| window()).chain([([0, 0], whole)]) {
        if held.window(first, size).unwrap() != filed.window(first, size).unwrap() {
            return Some("window");
        }
        if gradients(held, first, size).unwrap() != gradients(filed, first, size).unwrap() {
            return Some("gradients");
        }
    }
    for (c, r) in [(0, 0), (whole[0] - 1, whole[1] - 1), (whole[0] / 2, whole[1] / 3), (whole[0], 0)] {
        if held.height(c, r) != filed.height(c, r) || held.position(c, r) != filed.position(c, r) {
            return Some("sample");
        }
    }
    let [a, b] = [held, filed].map(|dem| (dem.range(), dem.voids(), dem.patches()));
    if a != b || rim(held).unwrap() != rim(filed).unwrap() {
        return Some("survey");
    }
    filed.check().unwrap();
    None
}

#[test]
fn filed_samples_are_the_held_ones() {
    let dir = folder();
    let tif = rough().write("GTiff", &dir.path().join("rough.tif"));
    for (driver, name) in
        [("ENVI", "a.img"), ("VRT", "b.vrt"), ("AAIGrid", "c.asc"), ("HFA", "d.img"), ("RST", "e.rst")]
    {
        copy(&tif, driver, &dir.path().join(name));
    }
    let south_up = Raster { transform: Some([5e5, 30.0, 0.0, 4_197_000.0, 0.0, 20.0]), ..rough() };
    south_up.write("GTiff", &dir.path().join("south.tif"));
    for name in ["rough.tif", "a.img", "b.vrt", "c.asc", "d.img", "e.rst", "south.tif"] {
        for memory in [TINY, SMALL] {
            let options = ReadOptions { exaggeration: 2.5, ..Default::default() };
            assert_eq!(difference(&both(&[dir.path().join(name)], options, memory)), None, "{name}");
        }
    }
    let part = both(slice::from_ref(&tif), cropped([500_100.0, 4_197_500.0, 504_321.0, 4_199_000.0]), TINY);
    assert!(part[0].columns() == 141 && part[0].rows() == 75);
    assert_eq!(difference(&part), None, "a crop");
    // The check itself: another exaggeration, and one sample less.
    let mut dems = both(&[tif], ReadOptions::default(), TINY);
    dems[0] =
        both(&[dir.path().join("a.img")], ReadOptions { exaggeration: 1.001, ..Default::default() }, TINY)[0].clone();
    assert_eq!(difference(&dems), Some("window"));
    dems[0] = part[0].clone();
    assert_eq!(difference(&dems), Some("grid"));
}

#[test]
fn mosaics_are_read_by_windows() {
    let dir = folder();
    let tile = |name: &str, column: f64, row: f64, nodata| {
        let transform = Some([5e5 + column * 30.0, 30.0, 0.0, 42e5 - row * 20.0, 0.0, -20.0]);
        Raster { transform, nodata, ..rough() }.write("GTiff", &dir.path().join(name))
    };
    let tiles = [
        tile("a.tif", 0.0, 0.0, Some(-9999.0)),
        tile("b.tif", 170.0, 31.0, Some(-9999.0)),
        tile("c.tif", -90.0, 140.0, None),
    ];
    let dems = both(&tiles, ReadOptions::default(), SMALL);
    assert_eq!([dems[0].columns(), dems[0].rows()], [460, 290]);
    assert_eq!(difference(&dems), None);
    let source = |name: &str, [c, r]: [u32; 2]| {
        format!(
            "<ComplexSource><SourceFilename relativeToVRT=\"1\">{name}</SourceFilename><NODATA>-9999</NODATA>\
             <SrcRect xOff=\"0\" yOff=\"0\" xSize=\"200\" ySize=\"150\"/>\
             <DstRect xOff=\"{c}\" yOff=\"{r}\" xSize=\"200\" ySize=\"150\"/></ComplexSource>"
        )
    };
    let parts = [source("a.tif", [0, 0]), source("b.tif", [190, 77]), source("c.tif", [50, 150])].concat();
    let vrt = sized_vrt(&dir.path().join("m.vrt"), 400, 300, "", &format!("<NoDataValue>-9999</NoDataValue>{parts}"));
    assert_eq!(difference(&both(&[vrt], ReadOptions::default(), TINY)), None);
}

#[test]
fn every_format_of_shared_terrain_is_read_by_windows() {
    let Some(shared) = shared_dems() else { return };
    let dir = folder();
    let formats = shared.join("formats");
    let head = "<SRS>EPSG:32611</SRS><GeoTransform>273000, 27.5, 0, 4181000, 0, -27.5</GeoTransform>";
    let names = super::shared::HALF_DOME.into_iter().chain(["halfdome_scaled.vrt", "halfdome_u16.png"]);
    for (i, name) in names.enumerate() {
        // All are in degrees, which are warped as a whole: their samples are laid on a map as they are.
        let path = formats.join(name).display().to_string();
        let path = if name.ends_with(".gz") { format!("/vsigzip/{path}") } else { path };
        let file = gdal::Dataset::open(&path).unwrap();
        let (columns, rows) = file.raster_size();
        let source = format!("<SimpleSource><SourceFilename>{path}</SourceFilename></SimpleSource>");
        let vrt = sized_vrt(&dir.path().join(format!("placed_{i}.vrt")), columns as u32, rows as u32, head, &source);
        let options = ReadOptions { allow_remote: true, ..Default::default() };
        assert_eq!(difference(&both(&[vrt], options, SMALL)), None, "{name}");
    }
    for name in ["west_temple_50m.tif", "yosemite_utm11n_30m.tif", "yosemite_calif3_feet.tif", "SainteHelens.dem"] {
        assert_eq!(difference(&both(&[shared.join(name)], ReadOptions::default(), SMALL)), None, "{name}");
    }
    // Tiles of 512 x 512 samples and strips, cut in the middle.
    let crop = cropped([556_000.0, 5_111_000.0, 569_000.0, 5_125_000.0]);
    let part = both(&[shared.join("sthelens_utm10n_10m.tif")], crop, SMALL);
    assert!(part[0].columns() > 1024 && part[0].rows() > 1024, "{} x {}", part[0].columns(), part[0].rows());
    assert_eq!(difference(&part), None);
    let netcdf = PathBuf::from(format!("NETCDF:{}:dem", shared.join("topo.nc").display()));
    assert_eq!(difference(&both(&[netcdf], ReadOptions::default(), SMALL)), None);
}

#[test]
fn bands_and_parts_are_the_whole() {
    let dir = folder();
    let path = rough().write("GTiff", &dir.path().join("rough.tif"));
    let surfaces = both(&[path], ReadOptions::default(), SMALL).map(Surface::new);
    let mut next = 0;
    for band in surfaces[1].bands(2) {
        let band = band.unwrap();
        assert_eq!(band.rows.start, next);
        next = band.rows.end;
        for r in band.rows.start.saturating_sub(2)..(next + 2).min(150) {
            for c in 0..200 {
                assert_eq!(band.surface.dem().position(c, r), surfaces[0].dem().position(c, r));
                assert_eq!(band.surface.gradient(c, r), surfaces[0].gradient(c, r), "{c}, {r}");
            }
        }
    }
    assert_eq!(next, 150);
    assert_eq!(surfaces[0].bands(2).next().unwrap().unwrap().rows, 0..150, "held: one band");
    let part = surfaces[1].part([190, 140], [33, 33]).unwrap();
    assert_eq!(part.gradient(199, 149), surfaces[0].gradient(199, 149));
    assert_eq!((part.dem().height(188, 140), part.dem().columns()), (None, 200));
    let beyond = part.dem().window([150, 120], [50, 30]).unwrap();
    for (c, r) in [(150, 120), (188, 149), (189, 138), (189, 139), (199, 149)] {
        let inside = c >= 189 && r >= 139;
        assert_eq!(beyond.height(c, r), surfaces[0].dem().height(c, r).filter(|_| inside), "{c}, {r}");
    }
    let level = crate::scenes::level(4);
    let places = [[503_000.0, 4_198_000.0], [500_200.0, 4_199_800.0]].map(DVec2::from_array);
    for place in places {
        let [held, filed] = surfaces.each_ref().map(|surface| surface.height_below(place, level));
        assert_eq!(held, filed);
    }
    assert!(surfaces[1].gradients().is_err() && surfaces[1].dem().held().is_err());
}

#[test]
fn a_view_of_a_filed_dem_is_chosen_from_a_thinned_one() {
    let dir = folder();
    let height = |i: usize| 50.0 + 40.0 * ((i % 2500) as f32 / 130.0).sin() * ((i / 2500) as f32 / 170.0).cos();
    let path = Raster::new(2500, (0..2500 * 2000).map(height).collect()).write("GTiff", &dir.path().join("wide.tif"));
    let dems = both(&[path], ReadOptions::default(), 1 << 24);
    assert_eq!(dems[1].thinning(), 2);
    let thinned = dems[1].thinned().unwrap();
    assert_eq!([thinned.columns(), thinned.rows()], [1250, 1000]);
    assert_eq!(thinned.position(700, 900), dems[0].position(1400, 1800));
    let [held, filed] = dems.each_ref().map(|dem| choose(dem, Fixed::default(), 60.0, 480, 270).unwrap());
    assert!((held.eye - filed.eye).length() < 1000.0 && held.azimuth == filed.azimuth, "{held:?} {filed:?}");
}

#[test]
fn what_must_be_held_is_refused_beyond_the_budget() {
    let dir = folder();
    let path = rough().write("GTiff", &dir.path().join("rough.tif"));
    let refused = |options: ReadOptions, words: &[&str]| {
        super::refused::refused_with(&path, &ReadOptions { memory: SMALL, ..options }, words)
    };
    let filled = ReadOptions { fill_voids: true, ..Default::default() };
    refused(filled, &["needs 1 MiB of memory where voids are filled", "--memory 1MiB", "gdal_fillnodata.py"]);
    let coarse = ReadOptions { resample: Some(35.0), ..Default::default() };
    refused(coarse, &["where they are warped", "--memory", "gdalwarp -t_srs EPSG:32610"]);
    let shifted = Raster { transform: Some([5e5 + 15.0, 30.0, 0.0, 42e5, 0.0, -20.0]), ..rough() };
    let beside = shifted.write("GTiff", &dir.path().join("beside.tif"));
    let options = ReadOptions { memory: SMALL, ..Default::default() };
    let error = read_all(&[path.clone(), beside], &options, &|_, _| ()).unwrap_err().to_string();
    assert!(error.contains(" is laid between the samples of others"), "{error}");
    let void = Raster { nodata: Some(-1.0), ..Raster::new(100, vec![-1.0f32; 10_000]) };
    let void = void.write("GTiff", &dir.path().join("void.tif"));
    let told = hachure::geo::info(&[void], &options, &|_, _| ()).unwrap_err().to_string();
    assert!(told.contains("holds no elevation, all 10000 samples are void"), "{told}");
}

#[test]
fn axes_of_the_map_are_turned_in_the_file_too() {
    let dir = folder();
    // Southing and westing: rows for columns.
    let transform = Some([1_055_147.0, 30.0, 0.0, 706_011.0, 0.0, -20.0]);
    let path = Raster { transform, epsg: Some(5513), ..rough() }.write("GTiff", &dir.path().join("south.tif"));
    let dems = both(slice::from_ref(&path), ReadOptions::default(), SMALL);
    assert_eq!((dems[0].columns(), dems[0].rows()), (150, 200));
    assert_eq!(difference(&dems), None);
}

#[test]
fn info_of_a_filed_dem_says_the_same() {
    let dir = folder();
    let path = rough().write("GTiff", &dir.path().join("rough.tif"));
    let [held, filed] = [1 << 30, TINY].map(|memory| {
        hachure::geo::info(slice::from_ref(&path), &ReadOptions { memory, ..Default::default() }, &|_, _| ()).unwrap()
    });
    assert_eq!(held, filed);
    assert!(held.to_string().contains("1 samples at or below -32767"), "{held}");
}

/// `rough` in tiles of 64 x 64 samples, deflated, so that a cut loses some of them alone.
fn tiled(path: &Path) -> PathBuf {
    let plain = rough().write("GTiff", &path.with_extension("plain.tif"));
    let options = gdal::raster::RasterCreationOptions::from_iter(["TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64"]);
    let driver = gdal::DriverManager::get_driver_by_name("GTiff").unwrap();
    gdal::Dataset::open(plain).unwrap().create_copy(&driver, path, &options).unwrap().close().unwrap();
    path.to_owned()
}

#[test]
fn an_error_in_the_middle_of_reading_is_one_line() {
    let dir = folder();
    let path = tiled(&dir.path().join("tiled.tif"));
    let options = ReadOptions { memory: TINY, ..Default::default() };
    let whole = fs::read(&path).unwrap();
    let dem = read_all(slice::from_ref(&path), &options, &|_, _| ()).unwrap();
    let error = |first, size| dem.window(first, size).err().map(|e| e.to_string()).unwrap_or_default();
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let cut = error([0, 100], [200, 50]);
    assert!(cut.starts_with(&format!("{}: is damaged or cut short", path.display())), "{cut}");
    assert!(!cut.contains('\n') && cut.ends_with("copy or download it again"), "{cut}");
    // That handle is gone, and another would be on another file.
    let changed = error([0, 0], [9, 9]);
    assert!(changed.contains("has changed since it was opened; run again"), "{changed}");
    // Nobody has asked for a sample, and yet what was drawn of two states of a file is of neither.
    assert_eq!(dem.check().unwrap_err().to_string(), changed);
    // Those who return no error keep the first, and say it whenever they are asked.
    assert_eq!((dem.height(3, 140), dem.range(), dem.voids()), (None, None, 0));
    for _ in 0..2 {
        assert_eq!(dem.check().unwrap_err().to_string(), changed);
    }
    assert!(
        rim(&dem).is_err() && dem.survey(&|_| ()).is_err() && Surface::new(dem.clone()).part([0, 0], [5, 5]).is_err()
    );
    fs::remove_file(&path).unwrap();
    assert!(error([0, 0], [9, 9]).contains("there is no such file"));
}

#[test]
fn a_stamp_changes_with_the_file_and_the_way_of_reading() {
    let dir = folder();
    let path = rough().write("GTiff", &dir.path().join("rough.tif"));
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">rough.tif</SourceFilename></SimpleSource>";
    let vrt = sized_vrt(&dir.path().join("over.vrt"), 200, 150, "", source);
    let stamp = |options: ReadOptions| {
        read_all(slice::from_ref(&vrt), &ReadOptions { memory: TINY, ..options }, &|_, _| ()).unwrap().stamp().unwrap()
    };
    let first = stamp(ReadOptions::default());
    assert_eq!(first, stamp(ReadOptions::default()));
    assert_eq!(first, stamp(ReadOptions { exaggeration: 2.0, ..Default::default() }), "heights are kept as they are");
    assert_eq!(first, stamp(ReadOptions { memory: SMALL, ..Default::default() }));
    assert_ne!(first, stamp(cropped([500_100.0, 4_197_500.0, 505_000.0, 4_199_900.0])));
    let file = fs::File::options().write(true).open(&path).unwrap();
    file.set_modified(std::time::SystemTime::UNIX_EPOCH).unwrap();
    assert_ne!(first, stamp(ReadOptions::default()), "a file that the VRT names has changed");
}
