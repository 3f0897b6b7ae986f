//! Every remedy is typed as it is printed, and helps.
//!
//! The program refuses an input, or warns of it; what stands between backticks in its words is run by a shell with the
//! placeholders filled in, and the program reads the result without that refusal or warning.

use std::fs;
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;

use gdal::DriverManager;

use super::archives::{Member, tile, zip};
use super::{Raster, folder, hill, sized_vrt, vrt};

/// An input with a fault, and how its remedies are typed.
struct Case {
    /// Words of the refusal or warning; the remedies stand behind them.
    words: &'static str,
    /// What is read, in this order, with flags.
    arguments: Vec<String>,
    /// Which of the arguments the remedy is for: `IN`.
    input: usize,
    /// What else to fill in.
    fill: &'static [(&'static str, &'static str)],
    /// What comes of it: takes the place of the input.
    result: &'static str,
    /// Flags that are left out once the remedy has done their work.
    without: &'static [&'static str],
}

impl Case {
    fn new(words: &'static str, input: &Path) -> Self {
        let arguments = vec![input.to_str().unwrap().to_owned()];
        Self { words, arguments, input: 0, fill: &[], result: "OUT.tif", without: &[] }
    }

    fn with(mut self, flags: &[&str]) -> Self {
        self.arguments.extend(flags.iter().map(|flag| (*flag).to_owned()));
        self
    }

    fn fill(self, fill: &'static [(&'static str, &'static str)]) -> Self {
        Self { fill, ..self }
    }

    fn result(self, result: &'static str) -> Self {
        Self { result, ..self }
    }

    /// Tries each remedy; how many were.
    fn check(&self, folder: &Path) -> usize {
        let info = |arguments: &[String]| {
            let ran =
                Command::new(env!("CARGO_BIN_EXE_hachure")).arg("info").args(arguments).current_dir(folder).output();
            let ran = ran.unwrap();
            (ran.status.success(), String::from_utf8_lossy(&[ran.stdout, ran.stderr].concat()).into_owned())
        };
        let (_, said) = info(&self.arguments);
        let (_, rest) = said.split_once(self.words).unwrap_or_else(|| panic!("no {:?}: {said}", self.words));
        let line = rest.lines().next().unwrap();
        let remedies: Vec<_> = line.split('`').skip(1).step_by(2).collect();
        assert!(!remedies.is_empty(), "no remedy: {said}");
        for remedy in &remedies {
            let mut arguments = self.arguments.clone();
            if remedy.starts_with("--") {
                arguments.extend(remedy.split(' ').map(str::to_owned));
            } else if remedy.trim_start_matches('\'').starts_with("/vsi") {
                arguments[self.input] = remedy.trim_matches('\'').to_owned();
            } else {
                if !self.run(remedy, folder) {
                    continue;
                }
                arguments[self.input] = self.result.to_owned();
                arguments.retain(|argument| !self.without.contains(&argument.as_str()));
            }
            let (read, after) = info(&arguments);
            assert!(read && !after.contains(self.words), "{remedy}: {after}");
            let _ = fs::remove_file(folder.join(self.result));
        }
        remedies.len()
    }

    /// Types a command; whether its tool is there.
    fn run(&self, remedy: &str, folder: &Path) -> bool {
        let command = remedy.rsplit("; ").next().unwrap();
        let tool = command.split(' ').next().unwrap();
        let found = Command::new("sh").args(["-c", &format!("command -v {tool} >/dev/null")]).status().unwrap();
        if !found.success() {
            let _ = writeln!(stderr(), "SKIP {remedy}: no {tool} on this machine");
            return false;
        }
        let files = self.arguments.iter().skip(self.input).take_while(|argument| !argument.starts_with("--"));
        let files: Vec<_> = files.map(|file| format!("'{file}'")).collect();
        let line = remedy.replace("IN...", &files.join(" "));
        let word = |word: &str| match self.fill.iter().find(|(name, _)| *name == word.trim_start_matches("EPSG:")) {
            _ if word == "IN" => files[0].clone(),
            Some((name, value)) => word.replace(name, value),
            None => word.to_owned(),
        };
        let line = line.split(' ').map(word).collect::<Vec<_>>().join(" ");
        let ran = Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap();
        assert!(ran.status.success(), "{line}: {}", String::from_utf8_lossy(&ran.stderr));
        true
    }
}

/// 60 x 60 samples placed so.
fn placed(path: PathBuf, transform: [f64; 6], epsg: Option<u32>) -> PathBuf {
    let values = (0..3600u16).map(|i| 500.0 + f32::from(i % 60) + f32::from(i / 60)).collect();
    Raster { transform: Some(transform), epsg, ..Raster::new(60, values) }.write("GTiff", &path)
}

const UTM: &[(&str, &str)] = &[("CODE", "32610")];

#[test]
fn systems_and_places() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let metres = [500_000.0, 30.0, 0.0, 4_200_000.0, 0.0, -30.0];
    let degrees = [10.0, 1.0 / 3600.0, 0.0, 46.0, 0.0, -1.0 / 3600.0];
    let edges: &[_] =
        &[("WEST", "500000"), ("NORTH", "4200000"), ("EAST", "501800"), ("SOUTH", "4198200"), ("CODE", "32610")];
    let globe: &[_] = &[("WEST", "10"), ("NORTH", "46.06"), ("EAST", "10.06"), ("SOUTH", "46")];
    let gcp = |x: u32, y: u32| {
        let (east, north) = (500_000 + 30 * x, 4_200_000 - 20 * y);
        format!("<GCP Id=\"{x}{y}\" Pixel=\"{x}\" Line=\"{y}\" X=\"{east}\" Y=\"{north}\"/>")
    };
    let gcps = [gcp(0, 0), gcp(4, 0), gcp(0, 3), gcp(4, 3)].concat();
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    hill().write("GTiff", &at("hill.tif"));
    let nowhere = Raster { transform: None, epsg: None, ..hill() }.write("GTiff", &at("nowhere.tif"));
    let cases = [
        Case::new("none beyond 90", &placed(at("utm.tif"), metres, Some(4326))).fill(UTM),
        Case::new("none beyond 90", &placed(at("pole.tif"), [10.0, 0.001, 0.0, 90.03, 0.0, -0.001], Some(4326)))
            .fill(globe),
        Case::new("and a turn is 360", &placed(at("turn.tif"), [600.0, 0.01, 0.0, 46.0, 0.0, -0.01], Some(4326)))
            .fill(globe),
        Case::new("cannot be in", &placed(at("degrees.tif"), degrees, Some(32632))),
        Case::new("look like degrees", &placed(at("odd.tif"), [0.0, 0.05, 0.0, 3.0, 0.0, -0.05], Some(3413))).fill(UTM),
        Case::new("cannot be in", &placed(at("tiny.tif"), [5e5, 1e-5, 0.0, 4e6, 0.0, -1e-5], Some(32610))).fill(edges),
        Case::new("makes no sense", &placed(at("far.tif"), [1e300, 30.0, 0.0, 4e6, 0.0, -30.0], Some(32610)))
            .fill(edges),
        Case::new("no map projection", &placed(at("globe.tif"), metres, Some(4978))).fill(UTM),
        Case::new("no coordinate system is named", &placed(at("bare.tif"), metres, None)).fill(UTM),
        Case::new(
            "control points",
            &vrt(&at("gcps.vrt"), &format!("<GCPList Projection=\"EPSG:32610\">{gcps}</GCPList>"), source),
        )
        .fill(UTM),
        Case::new("cannot be laid beside others", &nowhere).with(&["hill.tif"]).fill(edges),
        Case::new("lies in no named coordinate system", &placed(at("bare2.tif"), metres, None)).with(&["hill.tif"]),
        Case::new("too much of the globe", &placed(at("wide.tif"), [-180.0, 6.0, 0.0, 60.0, 0.0, -2.0], Some(4326))),
        Case::new("no 2 x 2 cells of", &placed(at("sliver.tif"), [10.0, 0.001, 0.0, 90.0, 0.0, -0.001], Some(4326))),
        Case::new(
            "map metres are metres on the ground",
            &placed(at("web.tif"), [1e6, 30.0, 0.0, 6e6, 0.0, -30.0], Some(3857)),
        )
        .with(&["--no-warp"]),
    ];
    let remedies: usize = cases.iter().map(|case| case.check(dir.path())).sum();
    assert!(remedies >= cases.len(), "{remedies}");
}

#[test]
fn numbers_and_limits() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    let tif = hill().write("GTiff", &at("hill.tif"));
    let complex = sized_vrt(&at("complex.vrt"), 4, 3, "", &format!("dataType=\"CFloat32\" band=\"1\">{source}"));
    let marked = Raster::new(2, vec![-32768i16, 5, 6, 7]).write("GTiff", &at("marked.tif"));
    let void = Raster {
        nodata: Some(-1.0),
        ..Raster::new(4, (0..16u8).map(|i| if i == 5 { -1.0 } else { f32::from(i) }).collect())
    };
    let void = void.write("GTiff", &at("void.tif"));
    let degrees = placed(at("degrees.tif"), [10.0, 0.001, 0.0, 46.0, 0.0, -0.001], Some(4326));
    let beside = placed(at("beside.tif"), [500_007.0, 17.0, 0.0, 4_200_003.0, 0.0, -17.0], Some(32610));
    DriverManager::get_driver_by_name("GTiff")
        .unwrap()
        .create_with_band_type::<u8, _>(at("three.tif"), 4, 4, 3)
        .unwrap();
    let python = "subClass=\"VRTDerivedRasterBand\" dataType=\"Float32\" band=\"1\">\
                  <PixelFunctionLanguage>Python</PixelFunctionLanguage>";
    let options = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename>\
                   <OpenOptions><OOI key=\"NUM_THREADS\">1</OOI></OpenOptions></SimpleSource>";
    let memory = ["--memory", "1KiB"];
    let cases = [
        Case::new("complex numbers", &complex),
        Case::new("scale 0", &vrt(&at("scale.vrt"), "", &format!("<Scale>0</Scale>{source}"))),
        Case::new("samples at or below -32767", &marked).fill(&[("N", "-32768")]),
        Case::new("options for GDAL's drivers", &vrt(&at("options.vrt"), "", options)),
        Case::new("where they are warped", &degrees).with(&memory),
        Case::new("where they are warped", &super::ground::mars(&at("mars.tif"))).with(&memory),
        Case {
            without: &["--fill-voids"],
            ..Case::new("where voids are filled", &void).with(&["--fill-voids", "--memory", "10B"])
        },
        Case {
            without: &["beside.tif"],
            ..Case::new("is laid between the samples of others", &tif).with(&["beside.tif", "--memory", "1KiB"])
        },
    ];
    assert!(beside.is_file());
    let remedies: usize = cases.iter().map(|case| case.check(dir.path())).sum();
    assert!(remedies >= cases.len(), "{remedies}");
    let code = super::refused::refused(&sized_vrt(&at("python.vrt"), 4, 3, "", python), &["holds code"]);
    assert!(code.ends_with("`gdal_translate --config GDAL_VRT_ENABLE_PYTHON YES IN OUT.tif`"), "{code}");
    let larger =
        super::refused::refused_with(&degrees, &hachure::geo::ReadOptions { memory: 1024, ..Default::default() }, &[]);
    let flag = larger.split("give --memory ").nth(1).unwrap().split(' ').next().unwrap();
    let case = Case::new("file", &degrees).with(&["--memory", flag]);
    let ran = Command::new(env!("CARGO_BIN_EXE_hachure")).arg("info").args(&case.arguments).output().unwrap();
    assert!(ran.status.success(), "--memory {flag}");
}

#[test]
fn packed_and_misnamed_files() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tif = hill().write("GTiff", &at("hill.tif"));
    let bytes = fs::read(&tif).unwrap();
    fs::write(at("N45E006 (1).hgt"), tile()).unwrap();
    fs::write(at("srtm tile.hgt"), tile()).unwrap();
    let mut cases = vec![
        Case::new("is a .hgt tile", &at("N45E006 (1).hgt")).result("N45E006.hgt"),
        Case::new("is a .hgt tile", &at("srtm tile.hgt")).result("N45E006.hgt"),
        Case::new("that says none", &zip(&at("tile.zip"), &[Member("tile.hgt", &tile(), 0)], 0)).result("N45E006.hgt"),
        Case::new("rasters", &zip(&at("two.zip"), &[Member("a.tif", &bytes, 0), Member("b.tif", &bytes, 0)], 0)),
    ];
    let inner = fs::read(zip(&at("in.zip"), &[Member("inner.tif", &bytes, 0)], 0)).unwrap();
    cases.push(
        Case::new("another archive", &zip(&at("out.zip"), &[Member("inner.zip", &inner, 0)], 0)).result("inner.zip"),
    );
    fs::write(at("zip.tif"), &inner).unwrap();
    cases.push(Case::new("zip archive by another name", &at("zip.tif")).result("inner.tif"));
    // Made by the tools that undo it.
    let made = [
        ("gzip -c hill.tif > gz.tif", "packed with gzip", "gz.tif", "OUT.tif"),
        ("bzip2 -c hill.tif > hill.tif.bz2", "packed with bzip2", "hill.tif.bz2", "OUT.tif"),
        ("xz -c hill.tif > hill.tif.xz", "packed with xz", "hill.tif.xz", "OUT.tif"),
        ("zstd -qc hill.tif > hill.tif.zst", "packed with Zstandard", "hill.tif.zst", "OUT.tif"),
        (
            "cp hill.tif member.tif && tar -cf tar.tif member.tif",
            "tar archive by another name",
            "tar.tif",
            "member.tif",
        ),
        ("cp hill.tif packed.tif && tar -cJf all.tar.xz packed.tif", "packed with xz", "all.tar.xz", "packed.tif"),
        ("cp hill.tif z.tif && zip -qZ bzip2 bz.zip z.tif && rm z.tif", "with bzip2", "bz.zip", "z.tif"),
        ("cp hill.tif e.tif && zip -qP secret e.zip e.tif && rm e.tif", "is encrypted", "e.zip", "e.tif"),
        (
            "cp hill.tif l.tif && python3 -c \"import zipfile; zipfile.ZipFile('l.zip', 'w', 14).write('l.tif')\"",
            "LZMA",
            "l.zip",
            "lzma/l.tif",
        ),
    ];
    for (make, words, name, result) in made {
        let ran = Command::new("sh").args(["-c", make]).current_dir(dir.path()).output().unwrap();
        if !ran.status.success() {
            let _ = writeln!(stderr(), "SKIP {make}: {}", String::from_utf8_lossy(&ran.stderr));
            continue;
        }
        // Unpacked, it is there again.
        if result != "OUT.tif" {
            let _ = fs::remove_file(at(result));
        }
        cases.push(Case::new(words, &at(name)).result(result).fill(&[("PASSWORD", "secret"), ("FOLDER", "lzma")]));
    }
    let remedies: usize = cases.iter().map(|case| case.check(dir.path())).sum();
    assert!(remedies > cases.len(), "{remedies}");
}
