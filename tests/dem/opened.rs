//! What a file is in a raster's place, names of any bytes, tiles named oddly, labels that cannot be, poles and 180 degrees.

use std::fs;
use std::path::{Path, PathBuf};

use hachure::dem::Dem;
use hachure::door::cli::words;
use hachure::door::cli::words::exit_code;
use hachure::geo::{ReadOptions, read};

use super::archives::{Member, tile, zip};
use super::refused::{refused, refused_with};
use super::{Raster, cropped, folder, hill, read_all, told};

#[test]
fn what_stands_in_a_rasters_place_is_called_by_its_name() {
    let dir = folder();
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    let zipped = zip(&dir.path().join("inner.zip"), &[Member("hill.tif", &fs::read(&tif).unwrap(), 0)], 0);
    let cases: [(&str, &[u8], &[&str]); 17] = [
        (
            "page.tif",
            b"\n<!doctype HTML><html><head><title>404\nNot Found</title>",
            &["web page (\"404 Not Found\")", "browser"],
        ),
        ("page.nc", b"<html><body>404 Not Found</body></html>", &["web page"]),
        ("page.asc", b"\xef\xbb\xbf<!-- x --><HTML><body>", &["web page"]),
        ("page.hgt", b"<html><body>404 Not Found</body></html>", &["web page"]),
        (
            "lfs.tif",
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n",
            &["git-LFS", "`git lfs pull`"],
        ),
        ("annex.tif", b"/annex/objects/SHA256E-s9--0.tif\n", &["git-annex", "`git annex get IN`"]),
        ("json.tif", b"{\"error\": \"no such tile\"}", &["is JSON", "no such tile"]),
        ("list.tif", b"[{\"error\": 1}]", &["is JSON"]),
        ("s3.tif", b"<?xml version=\"1.0\"?><Error><Code>NoSuchKey</Code></Error>", &["is XML", "(\"NoSuchKey\")"]),
        ("ows.tif", b"<ServiceException code=\"x\">no layer</ServiceException>", &["is XML", "no layer"]),
        ("paper.tif", b"%PDF-1.7\n", &["is a PDF"]),
        ("photo.tif", b"\xff\xd8\xff\xe0\0\x10JFIF\0", &["picture (JPEG)"]),
        ("points.tif", b"LASF\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", &["cloud of points"]),
        ("zeros.tif", &[0; 4096], &["zeros alone", "download it again"]),
        ("packed.tif", b"7z\xbc\xaf\x27\x1c\0\x04", &["7z archive", "`7z x IN`"]),
        ("packed.tif.bz2", b"BZh91AY&SY", &["packed with bzip2", "`bunzip2 -c IN > OUT.tif`"]),
        ("packed.tar.xz", b"\xfd7zXZ\0\0", &["packed with xz", "`tar -xkf IN`"]),
    ];
    for (name, bytes, words) in cases {
        let path = dir.path().join(name);
        fs::write(&path, bytes).unwrap();
        refused(&path, words);
    }
    let renamed = dir.path().join("renamed.tif");
    fs::copy(zipped, &renamed).unwrap();
    refused(&renamed, &["zip archive by another name", "`unzip IN`"]);
    // Text of another kind is not called anything.
    fs::write(dir.path().join("notes.tif"), "[package]\nname = \"notes\"\n").unwrap();
    refused(&dir.path().join("notes.tif"), &["no raster format that hachure reads"]);
}

#[test]
#[cfg(unix)]
fn names_that_are_no_utf8_open() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let dir = folder();
    let at = |name: &[u8]| dir.path().join(OsStr::from_bytes(name));
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    let truth = read_all(&tif);
    let same = |path: &Path| assert_eq!(read_all(path).held().unwrap().heights(), truth.held().unwrap().heights());
    let bytes = fs::read(&tif).unwrap();
    // Beside them stand files of the names that bytes replaced would give.
    for name in [b"h\xf6he.tif".as_slice(), "h\u{f00f6}he.tif".as_bytes()] {
        fs::write(at(name), &bytes).unwrap();
        same(&at(name));
    }
    fs::write(at("h\u{fffd}he.tif".as_bytes()), "another").unwrap();
    same(&at(b"h\xf6he.tif"));
    fs::rename(zip(&at(b"a.zip"), &[Member("a.tif", &bytes, 0)], 0), at(b"h\xf6he.zip")).unwrap();
    same(&at(b"h\xf6he.zip"));
    same(Path::new(OsStr::from_bytes(&[b"/vsizip/", at(b"h\xf6he.zip").as_os_str().as_bytes(), b"/a.tif"].concat())));
    let vrt = |source: &[u8]| {
        let head: &[u8] =
            b"<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><SRS>EPSG:32610</SRS><GeoTransform>500000, 30, \
            0, 4200000, 0, -20</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>\
            <SourceFilename relativeToVRT=\"1\">";
        let tail: &[u8] = b"</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
        fs::write(at(b"m\xf6saic.vrt"), [head, source, tail].concat()).unwrap();
        at(b"m\xf6saic.vrt")
    };
    same(&vrt(b"h\xf6he.tif"));
    refused_with(&vrt(b"g\xf6ne.tif"), &ReadOptions::default(), &["which it names, is not there"]);
    let filed = read(at(b"h\xf6he.tif"), &ReadOptions { memory: 1, ..Default::default() }).unwrap();
    assert_eq!(filed.window([0, 0], [4, 3]).unwrap().heights(), truth.held().unwrap().heights());
    let said = super::archives::says(&[&at(b"h\xf6he.tif")]);
    assert!(said.contains("4 columns x 3 rows"), "{said}");
    refused(&at(b"missing\xff.tif"), &["no such file"]);
}

#[test]
fn a_tile_named_oddly_says_what_name_it_needs() {
    let dir = folder();
    let tile = tile();
    for (name, needs) in [
        ("N45W074T86.hgt", "N45W074.hgt`"),
        ("N45E006 (1).hgt", "N45E006.hgt`"),
        ("n45e006_v3.HGT", "N45E006.hgt`"),
        ("srtm tile.hgt", "south-west corner"),
    ] {
        fs::write(dir.path().join(name), &tile).unwrap();
        refused(&dir.path().join(name), &[".hgt tile", "`cp ", needs]);
    }
    fs::write(dir.path().join("n45e006.hgt"), &tile).unwrap();
    assert_eq!(told(&dir.path().join("n45e006.hgt")).columns, 962);
    fs::write(dir.path().join("N45E006.hgt"), &tile[..2_000_000]).unwrap();
    refused(&dir.path().join("N45E006.hgt"), &["2000000 bytes, not 2884802", "download it again"]);
}

/// A hill of so many samples under a label.
fn labelled(path: PathBuf, [columns, rows]: [usize; 2], transform: [f64; 6], epsg: u32) -> PathBuf {
    let height = |i: usize| 500.0 + 90.0 * ((i % columns) as f32 / 5.0).sin() + (i / columns) as f32;
    let values = (0..columns * rows).map(height).collect();
    Raster { transform: Some(transform), epsg: Some(epsg), ..Raster::new(columns, values) }.write("GTiff", &path)
}

#[test]
fn labels_that_cannot_be_are_refused_with_the_one_that_may() {
    let dir = folder();
    let second = 1.0 / 3600.0;
    let at =
        |size: [usize; 2], transform: [f64; 6], epsg: u32| labelled(dir.path().join("a.tif"), size, transform, epsg);
    let metres = [497_000.0, 30.0, 0.0, 5_003_000.0, 0.0, -30.0];
    refused(&at([60, 60], metres, 4326), &["latitude 5002985", "cannot be in WGS 84 (EPSG:4326)", "-a_srs EPSG:CODE"]);
    let easts = [600.0, 0.1, 0.0, 50.0, 0.0, -0.1];
    refused(&at([60, 60], easts, 4326), &["longitude 600.05 to 605.95", "-a_ullr"]);
    let degrees = |step: f64| [10.0, step, 0.0, 46.0, 0.0, -step];
    for (step, epsg) in [(second, 32632), (3.0 * second, 3857), (second, 2056), (30.0 * second, 32632), (0.25, 25832)] {
        refused(&at([60, 60], degrees(step), epsg), &["cannot be in", "`gdal_translate -a_srs EPSG:4326 IN OUT.tif`"]);
    }
    let feet = [1e6, 1e-3, 0.0, 1e6, 0.0, -1e-3];
    refused(&at([60, 60], feet, 2227), &["0.0003048", "-a_ullr"]);
    // What may be is drawn, with a word where it looks odd.
    let near_pole = read_all(&at([60, 60], [-1.5, 0.05, 0.0, 1.5, 0.0, -0.05], 3413));
    assert!(near_pole.history().assumed().iter().any(|clause| words::told(clause).contains("look like degrees")));
    let ordinary = read_all(&at([60, 60], metres, 32632));
    assert_eq!(ordinary.history().assumed(), []);
    // A whole turn, as it is found in either way.
    for west in [0.0, -180.0] {
        refused(&at([360, 60], [west, 1.0, 0.0, 60.0, 0.0, -1.0], 4326), &["too much of the globe"]);
    }
}

#[test]
fn poles_are_refused_or_drawn_and_never_panic() {
    let dir = folder();
    let at = |size: [usize; 2], transform: [f64; 6]| labelled(dir.path().join("pole.tif"), size, transform, 4326);
    let fine = |west: f64, north: f64| [west, 0.001, 0.0, north, 0.0, -0.001];
    for (west, north) in [(10.0, 90.03), (-180.0, 90.03), (0.0, -89.97), (10.0, 90.001), (10.0, -90.0)] {
        refused(&at([60, 60], fine(west, north)), &["there is none beyond 90", "-a_ullr"]);
        let path = dir.path().join("pole.tif");
        for metres in [0.001, 1.0, 1e6] {
            assert!(read(&path, &ReadOptions { resample: Some(metres), ..Default::default() }).is_err());
        }
    }
    // Meridians run together: what is left is narrower than its cells.
    for north in [90.0, 90.0005] {
        refused(&at([60, 60], fine(10.0, north)), &["no 2 x 2 cells of", "-dstnodata"]);
    }
    for (north, side) in [(90.0, 1.0), (-85.0, -1.0)] {
        let cap = read_all(&at([720, 100], [-180.0, 0.5, 0.0, north, 0.0, -0.05]));
        let middle = cap.georeference().lonlat(middle(&cap)).unwrap().unwrap();
        assert!(side * middle.y > 87.0 && cap.voids() == 0, "{middle}");
    }
}

fn middle(dem: &Dem) -> glam::DVec2 {
    let [west, south, east, north] = dem.extent();
    glam::DVec2::new((west + east) / 2.0, (south + north) / 2.0)
}

#[test]
fn crops_run_across_180_degrees() {
    let dir = folder();
    let heights = |path: &Path, crop: [f64; 4]| {
        let dem = read(path, &cropped(crop)).unwrap();
        assert_eq!(dem.voids(), 0);
        let lonlat = dem.georeference().lonlat(middle(&dem)).unwrap().unwrap();
        (dem.held().unwrap().heights().to_vec(), lonlat)
    };
    let across = |path: &Path, crops: &[[f64; 4]], longitude: f64| {
        let (first, middle) = heights(path, crops[0]);
        let off = (middle.x - longitude + 540.0).rem_euclid(360.0) - 180.0;
        assert!(off.abs() < 0.1, "{}: {middle}", path.display());
        for crop in crops {
            assert!(heights(path, *crop).0 == first, "{}: {crop:?}", path.display());
        }
        first
    };
    let line = [[179.0, -17.0, -179.0, -16.5], [179.0, -17.0, 181.0, -16.5], [-181.0, -17.0, -179.0, -16.5]];
    for west in [178.0, -182.0] {
        let name = dir.path().join(format!("line{west}.tif"));
        let path = labelled(name, [400, 200], [west, 0.01, 0.0, -16.0, 0.0, -0.01], 4326);
        assert!(across(&path, &line, 180.0).len() > 8000);
    }
    // Round the globe the outer edges meet, wherever the file begins.
    let globes = [-180.0, 0.0].map(|west: f64| {
        let path = dir.path().join(format!("globe{west}.tif"));
        let height = |i: usize| 500.0 + 90.0 * (west + (i % 3600) as f64 * 0.1 + 0.05).to_radians().sin() as f32;
        let values = (0..3600 * 60).map(height).collect();
        let transform = Some([west, 0.1, 0.0, -14.0, 0.0, -0.1]);
        Raster { transform, epsg: Some(4326), ..Raster::new(3600, values) }.write("GTiff", &path)
    });
    let greenwich = [[-1.0, -17.0, 1.0, -16.5], [359.0, -17.0, 1.0, -16.5], [359.0, -17.0, 361.0, -16.5]];
    for (crops, longitude) in [(&line, 180.0), (&greenwich, 0.0)] {
        let [one, other] = globes.each_ref().map(|path| across(path, crops, longitude));
        assert!(one.len() == 100 && one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 0.01), "{longitude}");
    }
    // Metres have no other side.
    let path = hill().write("GTiff", &dir.path().join("hill.tif"));
    let error = read(&path, &cropped([500_105.0, 4_199_950.0, 500_015.0, 4_199_990.0])).unwrap_err();
    assert_eq!(exit_code(&error), 2);
    assert!(
        words::line(&error)
            .ends_with("its east; give the two in the other order: --crop 500015,4199950,500105,4199990"),
        "{error}"
    );
}

#[test]
fn the_file_without_a_system_is_the_one_named() {
    let dir = folder();
    let moved = |columns: f64| Some([500_000.0 + columns * 30.0, 30.0, 0.0, 4_200_000.0, 0.0, -20.0]);
    let bare = Raster { epsg: None, ..hill() }.write("GTiff", &dir.path().join("bare.tif"));
    let named = [4.0, 8.0].map(|columns| {
        Raster { transform: moved(columns), ..hill() }.write("GTiff", &dir.path().join(format!("named{columns}.tif")))
    });
    let [one, other] = named;
    for order in [[&bare, &one, &other], [&one, &bare, &other], [&one, &other, &bare]] {
        let paths = order.map(PathBuf::clone);
        let error = hachure::geo::read_all(&paths, &ReadOptions::default(), &|_, _| ()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}: lies in no named coordinate system", bare.display())), "{error}");
        assert!(error.contains("`gdal_translate -a_srs EPSG:32610 IN OUT.tif`"), "{error}");
    }
}
