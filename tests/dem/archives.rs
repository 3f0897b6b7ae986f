//! Archives: one readable raster is taken, several are listed as names to type, and none ends the process.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use hachure::geo::{ReadOptions, read};

use super::refused::{refused, refused_with};
use super::{copy, folder, hill, read_all, sized_vrt, told};
use crate::common::words;

/// A member of a zip archive: its name, its bytes, and how it says that it is packed (0 stored).
pub struct Member<'a>(pub &'a str, pub &'a [u8], pub u16);

/// A zip archive written by hand, so that it may say anything of its members; `flags` 1 means encrypted.
pub fn zip(path: &Path, members: &[Member], flags: u16) -> PathBuf {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for Member(name, bytes, method) in members {
        let start = file.len() as u32;
        let sizes = [crc32(bytes), bytes.len() as u32, bytes.len() as u32].map(u32::to_le_bytes).concat();
        let common = [[20, flags, *method, 0, 33].map(u16::to_le_bytes).concat(), sizes].concat();
        let length = (name.len() as u16).to_le_bytes();
        file.extend([b"PK\x03\x04".as_slice(), &common, &length, &[0; 2], name.as_bytes(), bytes].concat());
        let rest = [[0; 12].as_slice(), &start.to_le_bytes()].concat();
        directory.extend([b"PK\x01\x02\x14\0".as_slice(), &common, &length, &rest, name.as_bytes()].concat());
    }
    let counts = [0, 0, members.len() as u16, members.len() as u16].map(u16::to_le_bytes).concat();
    let places = [directory.len() as u32, file.len() as u32].map(u32::to_le_bytes).concat();
    fs::write(path, [&file, &directory, b"PK\x05\x06".as_slice(), &counts, &places, &[0; 2]].concat()).unwrap();
    path.to_owned()
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

/// A tile of the Shuttle mission.
pub fn tile() -> Vec<u8> {
    let height = |i: usize| (400 + (i / 1201) % 90 + (i % 1201) % 70) as i16;
    (0..1201 * 1201).flat_map(|i| height(i).to_be_bytes()).collect()
}

/// The bytes of the hill as GeoTIFF.
fn tif(folder: &Path) -> Vec<u8> {
    fs::read(hill().write("GTiff", &folder.join("hill.tif"))).unwrap()
}

fn tar(folder: &Path, flags: &str, name: &str, files: &[&str]) -> PathBuf {
    let ran = Command::new("tar").args([flags, name]).args(files).current_dir(folder).status().unwrap();
    assert!(ran.success());
    folder.join(name)
}

/// What the program says of a file, in a process of its own, which must end by itself.
pub fn says(arguments: &[&Path]) -> String {
    let ran = Command::new(env!("CARGO_BIN_EXE_hachure")).arg("info").args(arguments).output().unwrap();
    assert!(ran.status.code().is_some_and(|code| code <= 1), "{arguments:?}: {:?}", ran.status);
    String::from_utf8_lossy(&[ran.stdout, ran.stderr].concat()).into_owned()
}

#[test]
fn the_one_raster_of_an_archive_is_taken_and_said() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tif = tif(dir.path());
    fs::create_dir(at("deep")).unwrap();
    fs::write(at("deep/a.tif"), &tif).unwrap();
    fs::write(at("readme.txt"), "hello").unwrap();
    let readme = Member("readme.txt", b"hello", 0);
    let overview = Member("deep/a.tif.ovr", &tif, 0);
    let paths = [
        zip(&at("one.zip"), &[Member("deep/a.tif", &tif, 0)], 0),
        zip(&at("ONE.ZIP"), &[readme, Member("deep/a.tif", &tif, 0), overview, Member("deep/._a.tif", b"x", 0)], 0),
        tar(dir.path(), "-cf", "one.tar", &["readme.txt", "deep/a.tif"]),
        tar(dir.path(), "-czf", "one.tar.gz", &["readme.txt", "deep/a.tif"]),
        tar(dir.path(), "-czf", "one.tgz", &["deep"]),
    ];
    let truth = read_all(&at("hill.tif"));
    for path in &paths {
        let dem = read_all(path);
        assert_eq!(dem.held().unwrap().heights(), truth.held().unwrap().heights(), "{}", path.display());
        let said = words(dem.history().converted())
            .iter()
            .any(|clause| clause.starts_with("deep/a.tif is taken of the archive"));
        assert!(said, "{:?}", dem.history());
    }
    // Samples that stay in their files are read on other threads, each with a handle of its own.
    let filed = read(&paths[1], &ReadOptions { memory: 1, ..Default::default() }).unwrap();
    assert_eq!(filed.window([0, 0], [4, 3]).unwrap().heights(), truth.held().unwrap().heights());
}

#[test]
fn several_are_listed_as_names_that_can_be_typed() {
    let dir = folder();
    let tif = tif(dir.path());
    fs::write(dir.path().join("b.tif"), &tif).unwrap();
    let members = [Member("a b.tif", &tif, 0), Member("deep/it's.tif", &tif, 0), Member("notes.txt", b"hello", 0)];
    let paths = [
        zip(&dir.path().join("two.zip"), &members, 0),
        tar(dir.path(), "-cf", "two.tar", &["hill.tif", "b.tif"]),
        tar(dir.path(), "-czf", "two.tar.gz", &["hill.tif", "b.tif"]),
    ];
    for path in &paths {
        let line = refused(path, &["holds 2 rasters, and which one is meant is not said", "name one: `"]);
        let (_, names) = line.split_once("; name one: ").unwrap();
        let names: Vec<_> = names.split(", ").map(|name| name.trim_matches('`')).collect();
        assert_eq!(names.len(), 2, "{line}");
        for name in names {
            let name = name.replace(r"'\''", "\u{1}").replace('\'', "").replace('\u{1}', "'");
            assert_eq!(told(Path::new(&name)).columns, 4, "{name}");
        }
    }
    refused(&paths[0].join("gone.tif"), &["cannot be read"]);
    let typed = |after: &str| PathBuf::from(format!("/vsizip/{}{after}", paths[0].display()));
    refused(&typed("/gone.tif"), &["no such file in that archive", "two.zip/a b.tif"]);
    refused(&typed(""), &["holds 2 rasters"]);
    assert_eq!(told(&typed("/deep")).columns, 4, "a folder of an archive with one raster");
}

#[test]
fn an_archive_without_a_raster_says_what_it_holds() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tif = tif(dir.path());
    let inner = fs::read(zip(&at("inner.zip"), &[Member("a.tif", &tif, 0)], 0)).unwrap();
    let none = |name: &str, members: &[Member], words: &[&str]| refused(&zip(&at(name), members, 0), words);
    none("none.zip", &[], &["empty zip archive", "download it again"]);
    none(
        "text.zip",
        &[Member("notes.txt", b"hello", 0)],
        &["no raster that hachure reads (1 file, notes.txt for one)"],
    );
    none("lines.zip", &[Member("a.shp", b"x", 0), Member("a.dbf", b"x", 0)], &["points, lines or areas (a.shp)"]);
    none("zips.zip", &[Member("inner.zip", &inner, 0)], &["another archive (inner.zip)", "`unzip IN`"]);
    none("page.zip", &[Member("a.tif", b"<html><title>Gone</title>", 0)], &["a.tif is a web page (\"Gone\")"]);
    let vrt = b"<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><VRTRasterBand/></VRTDataset>";
    none("vrt.zip", &[Member("a.vrt", vrt, 0)], &["a VRT (a.vrt)", "`unzip IN`"]);
    none("void.zip", &[Member("a.tif", b"", 0)], &["its member a.tif is empty"]);
    fs::write(at("page.zip"), "<!DOCTYPE html>\n<html><head><title>Log in</title></head></html>").unwrap();
    refused(&at("page.zip"), &["web page (\"Log in\")", "browser"]);
    fs::write(at("cut.zip"), &inner[..inner.len() / 2]).unwrap();
    refused(&at("cut.zip"), &["damaged archive", "download it again"]);
    refused(&PathBuf::from(format!("/vsizip/{}/inner.zip/a.tif", at("zips.zip").display())), &["archive"]);
}

#[test]
fn no_archive_of_a_tile_ends_the_process() {
    let dir = folder();
    let tile = tile();
    let at = |kind: &str| {
        fs::create_dir(dir.path().join(kind)).unwrap();
        dir.path().join(kind).join("N45E006.hgt.zip")
    };
    let whole = zip(&at("whole"), &[Member("N45E006.hgt", &tile, 0)], 0);
    assert_eq!(told(&whole).columns, 962);
    let mut cases = vec![(whole, "962 columns")];
    for (kind, method, words) in
        [("nine", 9, "deflate64"), ("twelve", 12, "bzip2"), ("fourteen", 14, "LZMA"), ("zstd", 93, "Zstandard")]
    {
        cases.push((zip(&at(kind), &[Member("N45E006.hgt", &tile, method)], 0), words));
    }
    cases.push((zip(&at("encrypted"), &[Member("N45E006.hgt", &tile, 0)], 1), "encrypted"));
    let header = at("header");
    let mut bytes = fs::read(zip(&header, &[Member("N45E006.hgt", &tile, 0)], 0)).unwrap();
    bytes[..4].fill(b'x');
    fs::write(&header, &bytes).unwrap();
    cases.push((header, "damaged or cut short"));
    cases.push((zip(&at("empty"), &[], 0), "empty zip archive"));
    cases.push((zip(&at("text"), &[Member("readme.txt", b"hello", 0)], 0), "no raster"));
    cases.push((zip(&at("void"), &[Member("N45E006.hgt", b"", 0)], 0), "is empty"));
    cases.push((
        zip(&at("misnamed"), &[Member("tile.hgt", &tile, 0)], 0),
        "`(set -C; unzip -p IN tile.hgt > N45E006.hgt)`",
    ));
    let two = [Member("N45E006.hgt", &tile, 0), Member("N45E007.hgt", &tile, 0)];
    cases.push((zip(&at("two"), &two, 0), "N45E006.hgt is taken of the archive"));
    for (path, words) in &cases {
        let said = says(&[path]);
        assert!(said.contains(words), "{}: {said}", path.display());
        // A VRT beside it makes GDAL's own driver open it.
        let source =
            "<SimpleSource><SourceFilename relativeToVRT=\"1\">N45E006.hgt.zip</SourceFilename></SimpleSource>";
        let vrt = sized_vrt(&path.with_file_name("around.vrt"), 40, 40, "", source);
        let around = says(&[&vrt]);
        assert!(!said.starts_with("error") || around.starts_with("error"), "{}: {around}", vrt.display());
    }
    let inner = fs::read(&cases[2].0).unwrap();
    let outer = zip(&dir.path().join("outer.zip"), &[Member("N45E006.hgt.zip", &inner, 0)], 0);
    for name in [outer.clone(), PathBuf::from(format!("/vsizip/{}/N45E006.hgt.zip", outer.display()))] {
        assert!(says(&[&name]).contains("unpack it"), "{}", name.display());
    }
}

#[test]
fn several_grids_in_an_archive_are_to_be_unpacked() {
    let dir = folder();
    copy(&hill().write("GTiff", &dir.path().join("hill.tif")), "GPKG", &dir.path().join("a.gpkg"));
    let bytes = fs::read(dir.path().join("a.gpkg")).unwrap();
    let path = zip(&dir.path().join("a.zip"), &[Member("a.gpkg", &bytes, 0)], 0);
    assert_eq!(told(&path).columns, 4);
    refused_with(&path, &ReadOptions { band: Some(9), ..Default::default() }, &["band 9"]);
}
