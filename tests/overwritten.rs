//! No output replaces an input, under whatever name: nothing is written then, nothing cut short.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gdal::raster::{Buffer, RasterCreationOptions};
use gdal::spatial_ref::SpatialRef;
use gdal::{Dataset, DriverManager};
use hachure::geo::{ReadOptions, read};
use tempfile::TempDir;

use crate::cli::stderr;
use crate::common::netcdf_4;

const SIDE: usize = 24;

/// A folder with terrain in many forms, and the program run in it.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
        let _ = read(Path::new(""), &ReadOptions::default());
        let place = Self(TempDir::new().expect("a folder"));
        let hill = |i: usize| {
            let (x, y) = ((i % SIDE) as f64 - 11.0, (i / SIDE) as f64 - 12.0);
            (90.0 * (-(x * x + y * y) / 40.0).exp()) as u16
        };
        let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
        let mut file = driver.create_with_band_type::<u16, _>(place.path("dem.tif"), SIDE, SIDE, 1).expect("a file");
        file.set_geo_transform(&[5e5, 30.0, 0.0, 4.2e6, 0.0, -30.0]).expect("a place");
        file.set_spatial_ref(&SpatialRef::from_epsg(32610).expect("a CRS")).expect("a CRS");
        let samples = (0..SIDE * SIDE).map(hill).collect();
        let band = file.rasterband(1);
        band.expect("a band").write((0, 0), (SIDE, SIDE), &mut Buffer::new((SIDE, SIDE), samples)).expect("samples");
        file.close().expect("a file");
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn copy(&self, driver: &str, name: &str) {
        let driver = DriverManager::get_driver_by_name(driver).expect("a driver");
        let source = Dataset::open(self.path("dem.tif")).expect("a raster");
        let copy = source.create_copy(&driver, self.path(name), &RasterCreationOptions::default());
        copy.expect("a copy").close().expect("a file");
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.current_dir(self.0.path()).args(arguments).output().expect("hachure runs")
    }

    /// Every file with its bytes.
    fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut open = vec![self.0.path().to_owned()];
        let mut files = BTreeMap::new();
        while let Some(folder) = open.pop() {
            for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
                if entry.path().is_file() {
                    files.insert(entry.path(), fs::read(entry.path()).expect("a file"));
                } else if !entry.path().is_symlink() {
                    open.push(entry.path());
                }
            }
        }
        files
    }

    /// Asserts that it is wrong usage, that `flag` and `named` are named, and that no file is changed or made.
    fn refuses(&self, arguments: &[&str], flag: &str, named: &str) {
        let before = self.files();
        let output = self.run(arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(&format!("error: {flag}: ")) && said.contains(named), "{arguments:?}: {said}");
        assert!(self.files() == before, "{arguments:?} changed files");
    }

    /// The same for `draw DEM -o out.png --size 64x48 --json NAME`.
    fn refuses_report(&self, dem: &str, name: &str) {
        self.refuses(&["draw", dem, "-o", "out.png", "--size", "64x48", "--json", name], "--json", name);
    }
}

#[test]
fn what_stands_beside_a_dem_is_not_replaced() {
    let place = Place::new();
    place.copy("ENVI", "envi.img");
    for name in ["dem.tif.msk", "dem.tif.ovr", "dem.tif.aux.xml", "dem.wld", "dem.tfw", "dem.prj", "dem.TIF.MSK"] {
        let bytes = if name.ends_with("xml") { &b"<PAMDataset/>"[..] } else { b"30\n0\n0\n-30\n500015\n4199985\n" };
        fs::write(place.path(name), bytes).expect("a file");
        place.refuses_report("dem.tif", name);
        fs::remove_file(place.path(name)).expect("a file");
    }
    place.refuses_report("envi.img", "envi.hdr");
    place.refuses_report("envi.img", "envi.img.aux.xml");
    // What stands beside another file is nobody's.
    fs::write(place.path("other.wld"), "old").expect("a file");
    let output = place.run(&["draw", "dem.tif", "-o", "out.png", "--size", "64x48", "--json", "other.wld"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_ne!(fs::read(place.path("other.wld")).expect("a file"), b"old");
}

#[test]
fn what_a_name_or_a_vrt_leads_to_is_not_replaced() {
    let place = Place::new();
    place.copy("PNG", "z.png");
    fs::create_dir(place.path("parts")).expect("a folder");
    place.copy("PNG", "parts/part.png");
    let gzip = Command::new("gzip").arg("-k").arg(place.path("z.png")).status().expect("gzip runs");
    assert!(gzip.success());
    fs::rename(place.path("z.png.gz"), place.path("y.png")).expect("a file");
    let vrt = |name: &str, source: &str| {
        let text = format!(
            "<VRTDataset rasterXSize=\"{SIDE}\" rasterYSize=\"{SIDE}\"><SRS>EPSG:32610</SRS><GeoTransform>500000, 30, 0, \
             4200000, 0, -30</GeoTransform><VRTRasterBand dataType=\"UInt16\" band=\"1\"><SimpleSource><SourceFilename \
             relativeToVRT=\"1\">{source}</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>"
        );
        fs::write(place.path(name), text).expect("a VRT");
    };
    vrt("inner.vrt", "parts/part.png");
    vrt("outer.vrt", "inner.vrt");
    let draw = |dem: &'static str, out: &'static str| ["draw", dem, "--size", "64x48", "-o", out];
    let zipped = ["draw", "/vsigzip/y.png", "--cell", "30", "--size", "64x48", "-o", "y.png"];
    place.refuses(&zipped, "--output", "y.png");
    place.refuses(&draw("outer.vrt", "parts/part.png"), "--output", "part.png");
    place.refuses(&draw("inner.vrt", "./parts/../parts/part.png"), "--output", "part.png");
    place.refuses_report("outer.vrt", "inner.vrt");
    place.refuses_report("outer.vrt", "parts/part.png.aux.xml");
    if netcdf_4(&place.path("dem.tif"), &place.path("n.nc")) {
        place.refuses_report("NETCDF:n.nc:Band1", "n.nc");
    }
    place.refuses_report("GTIFF_DIR:1:dem.tif", "dem.tif");
}

#[cfg(unix)]
#[test]
fn links_and_ways_round_name_the_same_file() {
    let place = Place::new();
    fs::create_dir_all(place.path("d/sub")).expect("a folder");
    std::os::unix::fs::symlink("d", place.path("link-to-d")).expect("a link");
    place.copy("PNG", "p.png");
    fs::hard_link(place.path("p.png"), place.path("hard.png")).expect("a link");
    std::os::unix::fs::symlink("p.png", place.path("soft.png")).expect("a link");
    for out in ["hard.png", "soft.png", "d/../p.png", "p.png"] {
        place.refuses(&["draw", "p.png", "--size", "64x48", "-o", out], "--output", out);
    }
    for mask in ["link-to-d/x.png", "d/sub/../x.png", "d/x.png"] {
        let words = ["draw", "dem.tif", "--size", "64x48", "-o", "d/x.png", "--mask", mask];
        place.refuses(&words, "--mask", "another output already");
    }
    let words = ["draw", "dem.tif", "--size", "64x48", "-o", "d/x.png", "--mask", "d/sub/x.png"];
    let output = place.run(&words);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn a_report_replaces_none_of_the_files_it_is_made_of() {
    let place = Place::new();
    fs::create_dir(place.path("dir")).expect("a folder");
    place.copy("PNG", "dir/v_truth.png");
    let views = "{\"views\": [{\"name\": \"v\", \"dem\": \"v_truth.png\", \"eye\": [100, 10, 200], \"azimuth\": 10}]}";
    for name in ["dir/results.json", "views.json"] {
        fs::write(place.path(name), views).expect("a file");
    }
    let compare = |dem: &'static str, views: &'static str| {
        ["compare", dem, "-o", "dir", "--views", views, "--levels", "1", "--methods", "walk", "--no-cache"]
    };
    place.refuses(&compare("dir/v_truth.png", "views.json"), "--output", "v_truth.png");
    fs::copy(place.path("dir/v_truth.png"), place.path("v_truth.png")).expect("a file");
    let nowhere = [&compare("v_truth.png", "dir/results.json")[..], &["--cell", "30"]].concat();
    place.refuses(&nowhere, "--output", "results.json");
}

#[test]
#[cfg(unix)]
fn standard_output_that_goes_to_a_file_is_that_file() {
    let place = Place::new();
    let to = |name: &str| fs::OpenOptions::new().append(true).create(true).open(place.path(name)).expect("a file");
    for (name, outputs) in [
        ("both", ["--mask", "-", "--json", "both"]),
        ("both", ["--mask", "-", "--json", "/dev/stdout"]),
        ("dem.tif", ["--mask", "mask.png", "--json", "-"]),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.current_dir(place.0.path()).args(["draw", "dem.tif", "-o", "o.png", "--size", "32x24"]).args(outputs);
        let before = fs::read(place.path("dem.tif")).expect("the DEM");
        let output = command.stdout(to(name)).output().expect("hachure runs");
        assert_eq!(output.status.code(), Some(2), "{outputs:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("give each file a name of its own"), "{}", stderr(&output));
        assert!(!place.path("o.png").exists() && fs::read(place.path("dem.tif")).expect("the DEM") == before);
        if name == "both" {
            assert_eq!(fs::read(place.path("both")).expect("a file"), b"");
        }
    }
}
