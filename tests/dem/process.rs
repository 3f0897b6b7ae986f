//! What only a process of its own shows: few files at once, another PROJ, and silence of libraries.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::{Raster, copy, folder, hill};
use crate::common::netcdf_4;

/// The program in a shell, after `before`.
fn shell(folder: &Path, before: &str, arguments: &str) -> Output {
    let line = format!("{before} {} {arguments}", env!("CARGO_BIN_EXE_hachure"));
    Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&[output.stdout.clone(), output.stderr.clone()].concat()).into_owned()
}

#[test]
#[cfg(unix)]
fn many_files_need_few_handles() {
    let dir = folder();
    fs::create_dir(dir.path().join("tiles")).unwrap();
    let mut sources = String::new();
    for (c, r) in (0..120).map(|i| (i % 20, i / 20)) {
        let transform = Some([5e5 + f64::from(c) * 120.0, 30.0, 0.0, 42e5 - f64::from(r) * 60.0, 0.0, -20.0]);
        let values = (0..12u16).map(|i| (c + 20 * r) as f32 + f32::from(i) / 16.0).collect();
        let name = format!("tiles/t{r:02}{c:02}.tif");
        Raster { transform, ..Raster::new(4, values) }.write("GTiff", &dir.path().join(&name));
        sources += &format!(
            "<SimpleSource><SourceFilename relativeToVRT=\"1\">{name}</SourceFilename><SrcRect xOff=\"0\" yOff=\"0\" \
             xSize=\"4\" ySize=\"3\"/><DstRect xOff=\"{}\" yOff=\"{}\" xSize=\"4\" ySize=\"3\"/></SimpleSource>",
            4 * c,
            3 * r
        );
    }
    super::sized_vrt(&dir.path().join("all.vrt"), 80, 18, "", &sources);
    let many = shell(dir.path(), "ulimit -n 1024;", "info tiles/*.tif");
    assert!(words(&many).contains("80 columns x 18 rows") && words(&many).contains("elevation  0.0 to 119.7 m"));
    // Fewer than there are files; held, filed, and as one VRT.
    for flags in ["", "--memory 1KiB"] {
        let few = shell(dir.path(), "ulimit -n 64;", &format!("info {flags} tiles/*.tif"));
        assert_eq!(words(&few), words(&many), "{flags}");
        let vrt = shell(dir.path(), "ulimit -n 64;", &format!("info {flags} all.vrt"));
        assert!(words(&vrt).contains("elevation  0.0 to 119.7 m"), "{}", words(&vrt));
    }
}

#[test]
#[cfg(unix)]
fn a_register_of_systems_that_is_none_is_named_with_its_path() {
    let dir = folder();
    hill().write("GTiff", &dir.path().join("hill.tif"));
    assert!(shell(dir.path(), "", "info hill.tif").status.success());
    fs::create_dir(dir.path().join("empty")).unwrap();
    fs::create_dir(dir.path().join("junk")).unwrap();
    fs::write(dir.path().join("junk/proj.db"), "no register at all").unwrap();
    for variable in ["PROJ_DATA", "PROJ_LIB"] {
        for (folder, what) in [("empty", "is not there"), ("junk", "cannot be used"), ("nowhere", "is not there")] {
            let set = format!("unset PROJ_DATA PROJ_LIB; export {variable}=$PWD/{folder};");
            for name in ["hill.tif", "--crop 500000,4100000,600000,4300000 hill.tif"] {
                let ran = shell(dir.path(), &set, &format!("info {name}"));
                let said = words(&ran);
                assert_eq!((ran.status.code(), said.lines().count()), (Some(1), 1), "{said}");
                assert!(said.contains(&format!("/{folder}/proj.db")) && said.contains(what), "{said}");
                let remedy = said.split('`').nth(1).unwrap();
                assert_eq!(remedy, format!("unset {variable}"));
                let helped = shell(dir.path(), &format!("{set} {remedy};"), &format!("info {name}"));
                assert!(helped.status.success(), "{}", words(&helped));
            }
        }
    }
    // What the register does not know is still the user's number.
    let draw = shell(dir.path(), "", "draw hill.tif -o a.png --eye 0,0,9 --crs EPSG:999999");
    assert!(words(&draw).contains("EPSG:999999 is unknown"), "{}", words(&draw));
}

#[test]
fn libraries_under_gdal_are_silent() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let values = (0..90_000u32).map(|i| (i as f32 / 700.0).sin() * 90.0).collect();
    let tif = Raster::new(300, values).write("GTiff", &at("hill.tif"));
    let mut cases = Vec::new();
    if !netcdf_4(&tif, &at("hill.nc")) {
        return;
    }
    let whole = fs::read(at("hill.nc")).unwrap();
    for (i, (name, at_share)) in ["a.nc", "b.h5", "c.nc", "d.h5"].into_iter().zip([3, 4, 6, 9]).enumerate() {
        let mut bytes = whole.clone();
        match i % 2 {
            0 => bytes.truncate(whole.len() * at_share / 10),
            _ => (0..40).for_each(|k| bytes[2000 + k * (whole.len() - 2001) / 41] ^= 0x5a),
        }
        fs::write(at(name), bytes).unwrap();
        cases.push(name.to_owned());
        cases.push(format!("HDF5:{name}://Band1"));
    }
    copy(&tif, "GTiff", &at("keys.tif"));
    let bytes = fs::read(at("keys.tif")).unwrap();
    // A system of its own with a unit of length that nobody knows, as libgeotiff asks PROJ behind GDAL's back.
    let keys = |bytes: &[u8], from: u16, to: u16| {
        let places = (0..bytes.len() - 1).filter(|place| bytes[*place..*place + 2] == from.to_le_bytes());
        let places: Vec<_> = places.collect();
        assert!(!places.is_empty(), "{from} among the keys");
        let mut bytes = bytes.to_vec();
        places.iter().for_each(|place| bytes[*place..*place + 2].copy_from_slice(&to.to_le_bytes()));
        bytes
    };
    for (name, unit) in [("keys0.tif", 9999), ("keys1.tif", 40_000)] {
        fs::write(at(name), keys(&keys(&bytes, 9001, unit), 32610, 32767)).unwrap();
        cases.push(name.to_owned());
    }
    let mut failed = 0;
    for case in &cases {
        for flags in ["", "--memory 1KiB"] {
            let ran = shell(dir.path(), "", &format!("info {flags} {case}"));
            failed += usize::from(!ran.status.success());
            let said = String::from_utf8_lossy(&ran.stderr).into_owned();
            let own = |line: &str| line.starts_with("error: ") || line.starts_with("warning: ");
            assert!(said.lines().all(own) && ran.status.code().is_some(), "{case} {flags}: {said}");
            assert!(ran.status.success() || said.lines().count() == 1, "{case} {flags}: {said}");
        }
    }
    assert!(failed > 4, "only {failed} files of {} are damaged", cases.len());
}
