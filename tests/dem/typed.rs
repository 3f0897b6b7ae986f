//! Names and commands in remedies are typed into a shell as they are printed, whatever the names hold.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::archives::{Member, tile, zip};
use super::{Raster, folder, hill};

/// What the program says, started in `folder` with these arguments and nothing between.
fn info(folder: &Path, arguments: &[&OsStr]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hachure")).arg("info").args(arguments).current_dir(folder).output().unwrap()
}

/// A line of a shell that knows `hachure`; `sh` knows no `$'…'` everywhere.
fn typed(shell: &str, folder: &Path, line: &str) -> Output {
    let line = line.replace("hachure ", concat!("'", env!("CARGO_BIN_EXE_hachure"), "' "));
    Command::new(shell).args(["-c", &line]).current_dir(folder).output().unwrap()
}

fn words(ran: &Output) -> String {
    String::from_utf8_lossy(&[ran.stdout.clone(), ran.stderr.clone()].concat()).into_owned()
}

/// What stands between backticks in the one line that the file is refused with.
fn remedies(ran: &Output, what: &str) -> Vec<String> {
    let said = String::from_utf8(ran.stderr.clone()).unwrap();
    assert!(!ran.status.success() && said.lines().count() == 1 && said.contains(what), "{said}");
    assert!(!said.trim_end().contains(char::is_control), "{said:?}");
    said.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Names that a shell, GDAL or a terminal takes for something else.
#[cfg(unix)]
fn odd() -> Vec<OsString> {
    use std::os::unix::ffi::OsStringExt;
    let names: [&[u8]; 8] = [
        b"plain",
        b"my file",
        b"it's",
        b"a:b",
        "höhe".as_bytes(),
        b"gr\xfcn",
        b"d\xfcf e\n'\\\x1b[31m",
        "\u{202e}\u{f00e9}".as_bytes(),
    ];
    names.map(|name| OsString::from_vec(name.to_vec())).to_vec()
}

/// A container of these grids (netCDF, classic): heights of 100 the first, of 200 the second.
fn container(path: &Path, names: &[&str]) {
    let number = |value: usize| (value as u32).to_be_bytes().to_vec();
    let name =
        |name: &str| [number(name.len()), name.as_bytes().to_vec(), vec![0; name.len().wrapping_neg() % 4]].concat();
    let floats = |height: usize| (0..12).flat_map(|_| (height as f32).to_be_bytes()).collect::<Vec<_>>();
    let variables: Vec<_> = names.iter().enumerate().map(|(i, name)| (name, floats(100 * (i + 1)))).collect();
    let header = |mut start: usize| {
        let dimensions = [number(10), number(2), name("y"), number(3), name("x"), number(4)].concat();
        let mut header = [b"CDF\x01".to_vec(), number(0), dimensions, number(0), number(0), number(11)].concat();
        header.extend(number(variables.len()));
        for (called, samples) in &variables {
            // Two dimensions, no attributes, floats.
            let fields = [2, 0, 1, 0, 0, 5, samples.len(), start].map(number).concat();
            header.extend([name(called), fields].concat());
            start += samples.len();
        }
        header
    };
    let samples: Vec<_> = variables.iter().flat_map(|(.., samples)| samples.clone()).collect();
    fs::write(path, [header(header(0).len()), samples].concat()).unwrap();
}

#[test]
#[cfg(unix)]
fn grids_of_a_container_are_names_to_type_and_elevations_the_first() {
    let dir = folder();
    container(&dir.path().join("three.nc"), &["slope", "elevation", "aspect"]);
    for name in odd() {
        let folder = dir.path().join(&name);
        fs::create_dir(&folder).unwrap();
        let mut file = name.clone();
        file.push(".nc");
        fs::copy(dir.path().join("three.nc"), folder.join(&file)).unwrap();
        let way = Path::new(&name).join(&file);
        for (from, way) in [(dir.path(), way.as_os_str()), (&folder, &file), (&folder, folder.join(&file).as_os_str())]
        {
            let names = remedies(&info(from, &[way]), "holds 3 grids, and which one is meant is not said; name one: ");
            assert_eq!(names.len(), 3, "{names:?}");
            let heights = ["200", "100", "300"];
            for (name, height) in names.iter().zip(heights) {
                let ran = typed("bash", from, &format!("hachure info --cell 30 {name}"));
                assert!(ran.status.success() && words(&ran).contains(height), "{name}: {}", words(&ran));
            }
        }
    }
    // No name leads to a grid of a file with quotes in its own.
    let way = dir.path().join("a\"b.nc");
    fs::copy(dir.path().join("three.nc"), &way).unwrap();
    let copy = remedies(&info(dir.path(), &[way.as_os_str()]), "cannot be named");
    assert!(typed("sh", dir.path(), &copy[0]).status.success(), "{copy:?}");
    assert_eq!(remedies(&info(dir.path(), &["dem.nc".as_ref()]), "holds 3 grids").len(), 3);
}

#[test]
fn a_grid_that_is_not_there_is_answered_with_those_that_are() {
    let dir = folder();
    container(&dir.path().join("three.nc"), &["slope", "elevation", "aspect"]);
    container(&dir.path().join("one file.nc"), &["dem"]);
    for (name, count) in
        [("NETCDF:three.nc:nope", 3), ("netcdf:\"three.nc\":Elevation", 3), ("NETCDF:one file.nc:nope", 1)]
    {
        let names = remedies(&info(dir.path(), &[name.as_ref()]), "there is no such grid in that file");
        assert_eq!(names.len(), count, "{names:?}");
        for name in names {
            let ran = typed("sh", dir.path(), &format!("hachure info --cell 30 {name}"));
            assert!(ran.status.success(), "{name}: {}", words(&ran));
        }
    }
    let many: Vec<_> = (0..14).map(|i| format!("grid{i}")).collect();
    let many: Vec<_> = many.iter().map(String::as_str).collect();
    container(&dir.path().join("many.nc"), &many);
    let ran = info(dir.path(), &["many.nc".as_ref()]);
    assert_eq!(remedies(&ran, "holds 14 grids").len(), 12);
    assert!(words(&ran).contains("or one of 2 more"), "{}", words(&ran));
}

#[test]
#[cfg(unix)]
fn a_tile_is_copied_under_any_name_and_over_no_other() {
    let dir = folder();
    for name in odd().into_iter().chain(["-a".into()]) {
        let mut name = name;
        name.push(".hgt");
        fs::write(dir.path().join(&name), tile()).unwrap();
        let ran = match name.as_encoded_bytes().starts_with(b"-") {
            true => info(dir.path(), &["--".as_ref(), &name]),
            false => info(dir.path(), &[&name]),
        };
        let [copy] = &remedies(&ran, "is a .hgt tile")[..] else { panic!("{}", words(&ran)) };
        assert!(typed("bash", dir.path(), copy).status.success(), "{copy}");
        let there = dir.path().join("N45E006.hgt");
        assert_eq!(fs::read(&there).unwrap().len(), tile().len(), "{copy}");
        fs::write(&there, "another").unwrap();
        typed("bash", dir.path(), copy);
        assert_eq!(fs::read(&there).unwrap(), b"another", "{copy}");
        fs::remove_file(there).unwrap();
    }
}

#[test]
fn a_tile_is_unpacked_from_under_any_name_and_over_no_other() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tile = tile();
    let mut archives = Vec::new();
    for (i, name) in ["a/N45E006 [x].hgt", "-b*?.hgt", "it's\n\\d.hgt", "höhe.hgt", "./e.hgt"].iter().enumerate() {
        let other = Member("notes.txt", b"hello", 0);
        archives.push(zip(&at(&format!("{i}.zip")), &[Member(name, &tile, 0), other], 0));
    }
    fs::write(at("c [x].hgt"), &tile).unwrap();
    for (name, flags, member) in [("a.tar", "-cf", "c [x].hgt"), ("b.tgz", "-czf", "./c [x].hgt")] {
        assert!(Command::new("tar").args([flags, name, member]).current_dir(dir.path()).status().unwrap().success());
        archives.push(at(name));
    }
    for archive in archives {
        let ran = info(dir.path(), &[archive.as_os_str()]);
        let [unpack] = &remedies(&ran, "is a .hgt tile")[..] else { panic!("{}", words(&ran)) };
        let unpack = unpack.replace(" IN ", &format!(" '{}' ", archive.display()));
        let tool = typed("sh", dir.path(), "command -v unzip tar");
        if !tool.status.success() {
            continue;
        }
        let ran = typed("bash", dir.path(), &unpack);
        assert!(ran.status.success(), "{unpack}: {}", words(&ran));
        assert!(fs::read(at("N45E006.hgt")).unwrap() == tile, "{unpack}");
        fs::write(at("N45E006.hgt"), "another").unwrap();
        assert!(!typed("sh", dir.path(), &unpack).status.success(), "{unpack}");
        assert_eq!(fs::read(at("N45E006.hgt")).unwrap(), b"another", "{unpack}");
        fs::remove_file(at("N45E006.hgt")).unwrap();
    }
}

#[test]
#[cfg(unix)]
fn members_of_archives_under_any_name_can_be_typed() {
    let dir = folder();
    let tif = fs::read(hill().write("GTiff", &dir.path().join("hill.tif"))).unwrap();
    for (i, name) in odd().iter().enumerate() {
        let folder = dir.path().join(i.to_string());
        fs::create_dir(&folder).unwrap();
        for ending in ["x.tif", "y.tif"] {
            let mut file = name.clone();
            file.push(ending);
            fs::write(folder.join(file), &tif).unwrap();
        }
        let mut archive = name.clone();
        archive.push(".tar");
        let mut tar = Command::new("tar");
        tar.args(["--force-local", "-cf"]).arg(&archive).args(["-C", &i.to_string(), "."]);
        assert!(tar.current_dir(dir.path()).status().unwrap().success());
        let names = remedies(&info(dir.path(), &[&archive]), "holds 2 rasters");
        assert_eq!(names.len(), 2, "{names:?}");
        for name in names {
            let ran = typed("bash", dir.path(), &format!("hachure info {name}"));
            assert!(ran.status.success(), "{name}: {}", words(&ran));
        }
    }
}

#[test]
fn archives_whose_members_lie_outside_say_so_and_can_be_unpacked() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tif = fs::read(hill().write("GTiff", &at("hill.tif"))).unwrap();
    let mut archives = vec![
        (zip(&at("root.zip"), &[Member("/abs/a.tif", &tif, 0), Member("/abs/b.tif", &tif, 0)], 0), "FOLDER/abs/a.tif"),
        (zip(&at("up.zip"), &[Member("../a.tif", &tif, 0)], 0), "FOLDER/a.tif"),
    ];
    for (name, flags) in [("all.tar", "-cPf"), ("above.tgz", "-czPf")] {
        let ran = Command::new("tar").args([flags, name]).arg(at("hill.tif")).current_dir(dir.path()).status();
        assert!(ran.unwrap().success());
        archives.push((at(name), ""));
    }
    for (archive, result) in archives {
        let ran = info(dir.path(), &[archive.as_os_str()]);
        let [unpack] = &remedies(&ran, "holds members outside the archive's own folder (")[..] else {
            panic!("{}", words(&ran))
        };
        let inside = archive.with_extension("in");
        fs::create_dir(&inside).unwrap();
        let ran = typed("sh", &inside, &unpack.replace(" IN", &format!(" '{}'", archive.display())));
        assert!(ran.status.success(), "{unpack}: {}", words(&ran));
        let below = at("hill.tif");
        let result =
            if result.is_empty() { inside.join(below.strip_prefix("/").unwrap()) } else { inside.join(result) };
        assert!(fs::read(&result).unwrap() == tif, "{unpack}: {}", result.display());
    }
}

#[test]
fn answers_of_servers_and_cut_containers_are_told() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let says = |name: &str| {
        let ran = info(dir.path(), &[name.as_ref()]);
        assert!(!ran.status.success(), "{name}");
        words(&ran)
    };
    for words in ["Not Found", "404: Not Found\n", "Access denied.", "upstream connect error or disconnect"] {
        for name in ["a.tif", "a.asc", "a.nc", "a.zip", "a.tar.gz", "N45E006.hgt"] {
            fs::write(at(name), words).unwrap();
            let said = says(name);
            assert!(said.contains(&format!("one line of text, not a raster ({:?}", words.trim())), "{said}");
        }
    }
    container(&at("three.nc"), &["slope", "elevation", "aspect"]);
    let hdf = b"\x89HDF\r\n\x1a\n\0\0\0\0\0\x08\x08\0\x04\0\x10\0\0\0\0\0".repeat(3);
    for whole in [fs::read(at("three.nc")).unwrap(), hdf] {
        for keep in [8, 20, 60] {
            fs::write(at("cut.nc"), &whole[..keep]).unwrap();
            for name in ["cut.nc", "NETCDF:cut.nc:slope"] {
                let said = says(name);
                assert!(said.contains("damaged or cut short") && said.contains("download it again"), "{keep}: {said}");
            }
        }
    }
}

#[test]
#[cfg(unix)]
fn words_of_gdal_hold_no_second_name() {
    use std::os::unix::ffi::OsStrExt;
    let dir = folder();
    let tif = Raster::new(100, (0..10_000u16).collect()).write("GTiff", &dir.path().join("whole.tif"));
    let bytes = fs::read(tif).unwrap();
    let name = OsStr::from_bytes(b"gr\xfcn. a.tif");
    for keep in [100, bytes.len() / 2] {
        fs::write(dir.path().join(name), &bytes[..keep]).unwrap();
        let said = words(&info(dir.path(), &[name]));
        assert!(said.contains("gr\\xfcn. a.tif: ") && said.contains(" ("), "{said}");
        assert!(!said.contains(dir.path().to_str().unwrap()), "{said}");
    }
}
