//! Files of every format with some of their bytes changed.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use gdal::raster::RasterCreationOptions;
use gdal::{Dataset, DriverManager};

use super::{Yard, each, typed, words, write_hill};
use crate::common::netcdf_4;
use crate::scenes::Random;

const RUNS: u64 = 240;
/// Every so many runs a picture is drawn; else the file is read.
const DRAWN: u64 = 16;
/// Samples along a side: of `.hgt` there are 1201.
const SIDE: usize = 48;

/// Files to change, each with what stands beside it and is changed as well.
fn originals(folder: &Path) -> Vec<Vec<PathBuf>> {
    let plain = folder.join("plain.tif");
    write_hill(&plain, SIDE);
    let source = Dataset::open(&plain).expect("a DEM");
    let at = |name: &str| folder.join(name);
    let copy = |driver: &str, name: &str, options: &[&str]| {
        let driver = DriverManager::get_driver_by_name(driver).expect(driver);
        let options = RasterCreationOptions::from_iter(options.iter().copied());
        source.create_copy(&driver, at(name), &options).expect(name).close().expect(name);
        at(name)
    };
    let bare = |name: &str| copy("GTiff", name, &[]);
    let files = vec![
        vec![plain.clone()],
        vec![bare("strips.tif")],
        vec![copy("GTiff", "lzw.tif", &["COMPRESS=LZW", "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"])],
        vec![copy("AAIGrid", "grid.asc", &[]), at("grid.prj")],
        vec![copy("ENVI", "envi.img", &[]), at("envi.hdr")],
        vec![copy("EHdr", "ehdr.flt", &[]), at("ehdr.hdr"), at("ehdr.prj")],
        vec![copy("HFA", "hfa.img", &[])],
        vec![copy("netCDF", "classic.nc", &[])],
        if netcdf_4(&plain, &at("four.nc")) { vec![at("four.nc")] } else { vec![plain.clone()] },
        vec![copy("RST", "idrisi.rst", &[]), at("idrisi.rdc")],
        vec![copy("VRT", "nested.vrt", &[]), plain.clone()],
        vec![hgt(&at("N46E008.hgt"))],
        vec![gzip(&bare("packed.tif"), &at("packed.tif.gz"))],
    ];
    files.into_iter().map(|files| files.into_iter().filter(|file| file.is_file()).collect()).collect()
}

/// A tile of SRTM 3".
fn hgt(path: &Path) -> PathBuf {
    let heights = (0..1201 * 1201).map(|i| (500 + i / 1201 % 90 + i % 70) as i16);
    fs::write(path, heights.flat_map(i16::to_be_bytes).collect::<Vec<_>>()).expect("a tile");
    path.to_owned()
}

fn gzip(from: &Path, to: &Path) -> PathBuf {
    let packed = std::process::Command::new("gzip").arg("-c").arg(from).output().expect("gzip runs").stdout;
    fs::File::create(to).and_then(|mut file| file.write_all(&packed)).expect("a file");
    to.to_owned()
}

/// Changes bytes, near the head as often as anywhere.
pub(super) fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(6) {
        let end = if random.below(2) == 0 { bytes.len().min(600) } else { bytes.len() } as u32;
        if end == 0 {
            return;
        }
        let at = random.below(end) as usize;
        let length = (random.below(40) as usize + 1).min(bytes.len() - at);
        match random.below(7) {
            0 | 1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes[at] = random.bits() as u8,
            3 => bytes[at..at + length].fill(if random.below(2) == 0 { 0 } else { 0xff }),
            4 => bytes.truncate(at),
            5 => drop(bytes.drain(at..at + length)),
            _ => {
                let again = bytes[at..at + length].to_vec();
                drop(bytes.splice(at..at, again));
            }
        }
    }
}

#[test]
fn changed_files_are_read_or_refused() {
    let folder = Yard::new();
    let originals = originals(folder.0.path());
    each(1, RUNS, |seed, random| {
        let yard = Yard::new();
        let files = &originals[(seed % originals.len() as u64) as usize];
        let changed = random.below(files.len() as u32) as usize;
        let name = |file: &PathBuf| file.file_name().and_then(OsStr::to_str).expect("a name").to_owned();
        for (i, file) in files.iter().enumerate() {
            let mut bytes = fs::read(file).expect("a file");
            if i == changed {
                mutate(&mut bytes, random);
            }
            fs::write(yard.path(&name(file)), bytes).expect("a file");
        }
        let before: Vec<_> = files.iter().map(|file| fs::read(yard.path(&name(file))).expect("a file")).collect();
        let dem = name(&files[0]);
        let run = if seed % DRAWN == 0 {
            words(&format!("draw {dem} -o out.png --size 48x32 --mask out-mask.png"))
        } else {
            words(&format!("info {dem}"))
        };
        let what = format!("seed {seed:#x}, {}", typed(&run));
        let ended = yard.run(&run);
        ended.check(&what);
        yard.check_files(&what);
        let drawn = ["out.png", "out-mask.png"].map(|name| yard.path(name).exists());
        assert_eq!(drawn, [ended.code == Some(0) && seed % DRAWN == 0; 2], "{what}: {}", ended.said);
        let after: Vec<_> = files.iter().map(|file| fs::read(yard.path(&name(file))).expect("a file")).collect();
        assert!(before == after, "{what} changed its input");
    });
}

#[test]
fn a_change_is_a_change() {
    let mut random = Random::new(5);
    let changed = (0..50).filter(|_| {
        let mut bytes = vec![7; 1000];
        mutate(&mut bytes, &mut random);
        bytes != vec![7; 1000]
    });
    assert!(changed.count() > 45, "mutants that are none");
}
