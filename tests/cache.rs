//! The folder of what is kept: what its files depend on, who makes them, what goes, what is left alone.

use std::fs::{self, File, FileTimes};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use gdal::raster::Buffer;
use gdal::{DriverManager, Metadata};
use hachure::cache::{Cache, CacheObserver};
use hachure::dem::Dem;
use hachure::door::cache::{CacheKey, CacheKind, KeptEntry, NewEntry};
use hachure::door::cli::words::told;
use hachure::geo::{ReadOptions, read};
use tempfile::TempDir;

use crate::cli::stderr;

const SIDE: usize = 150;
/// No DEM here is held within it.
const SMALL: u64 = 1 << 16;

/// A folder with `two.tif`, two bands of hills, and a cache.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
        let _ = read(Path::new(""), &ReadOptions::default());
        let place = Self(TempDir::new().expect("a folder"));
        place.write("GTiff", "two.tif", 30.0);
        place
    }

    /// Hills of this height in band 1, others in band 2; no georeference.
    fn write(&self, driver: &str, name: &str, height: f32) {
        let driver = DriverManager::get_driver_by_name(driver).expect("a driver");
        let mut file = driver.create_with_band_type::<f32, _>(self.path(name), SIDE, SIDE, 2).expect("a file");
        for band in [1, 2] {
            let sample = |i: usize| {
                let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
                height * ((x / (7 * band) as f32).sin() * (y / 9.0).cos()) + 40.0
            };
            let samples = Buffer::new((SIDE, SIDE), (0..SIDE * SIDE).map(sample).collect());
            file.set_geo_transform(&[5e5, 30.0, 0.0, 4.2e6, 0.0, -30.0]).expect("a place");
            file.rasterband(band).expect("a band").write((0, 0), (SIDE, SIDE), &mut samples.clone()).expect("samples");
        }
        file.close().expect("a file");
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn cache(&self) -> Cache {
        Cache::in_folder(self.path("cache"))
    }

    fn dem(&self, name: &str, options: ReadOptions) -> Dem {
        let dem = read(self.path(name), &ReadOptions { memory: SMALL, ..options }).expect("a DEM");
        assert!(dem.is_filed());
        dem
    }

    fn stamp(&self, name: &str) -> u128 {
        self.dem(name, ReadOptions::default()).stamp().expect("a file on the disk")
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.current_dir(self.0.path()).args(arguments).output().expect("hachure runs")
    }

    /// Draws `two.tif` from its file with these flags too; the mask, and what was said on standard error.
    fn draw(&self, flags: &[&str]) -> (Vec<u8>, String) {
        let view = ["--eye", "502250,4194000,260", "--azimuth", "0", "--altitude", "-8", "--size", "160x100"];
        let words =
            ["draw", "--hachures", "none", "two.tif", "--memory", "64KiB", "-o", "out.png", "--mask", "mask.png"];
        let output = self.run(&[&words[..], &view, flags].concat());
        assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
        (fs::read(self.path("mask.png")).expect("a mask"), stderr(&output))
    }

    /// Names in the cache.
    fn kept(&self) -> Vec<String> {
        let files = fs::read_dir(self.path("cache")).expect("a folder");
        let mut names: Vec<_> =
            files.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// What is kept of something by number.
fn key(number: u128) -> CacheKey {
    CacheKey {
        kind: CacheKind { name: "truth", format: 7, words: ["a number", "a kept number"] },
        hash: number,
        of: format!("number {number}"),
    }
}

/// Gets `number` with 1000 bytes of it, and what was warned of; `made` counts how often they are made.
fn get(cache: &Cache, number: u128, made: &AtomicUsize, slow: Duration) -> (Vec<u8>, Vec<String>) {
    let warnings = std::cell::RefCell::new(Vec::new());
    let hearing = CacheObserver { warn: &|message| warnings.borrow_mut().push(told(message)), progress: &|_| () };
    let recall = |mut kept: KeptEntry| {
        let mut bytes = vec![0; kept.bytes as usize];
        std::io::Read::read_exact(&mut kept.file, &mut bytes)?;
        Ok(bytes)
    };
    let make = |sheet: Option<NewEntry>, _: &dyn Fn(f64)| {
        made.fetch_add(1, Ordering::Relaxed);
        thread::sleep(slow);
        let bytes = vec![number as u8; 1000];
        sheet.into_iter().for_each(|mut sheet| {
            sheet.write(&bytes);
            drop(sheet.publish().expect("a file"));
        });
        Ok(bytes)
    };
    let bytes = cache.get(&key(number), hearing, recall, make).expect("made");
    (bytes, warnings.into_inner())
}

#[test]
fn a_key_holds_band_files_and_what_stands_beside_them() {
    let place = Place::new();
    let first = place.stamp("two.tif");
    assert_eq!(first, place.stamp("two.tif"));
    let band = |band| place.dem("two.tif", ReadOptions { band: Some(band), ..Default::default() }).stamp();
    assert_eq!(band(1), Some(first));
    assert_ne!(band(2), Some(first));
    // A mask that comes, changes and goes.
    let mask = |value: u8| {
        let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
        let mut file = driver.create_with_band_type::<u8, _>(place.path("m.tif"), SIDE, SIDE, 1).expect("a file");
        file.set_metadata_item("INTERNAL_MASK_FLAGS_1", "2", "").expect("flags");
        file.set_metadata_item("INTERNAL_MASK_FLAGS_2", "2", "").expect("flags");
        let mut samples = Buffer::new((SIDE, SIDE), vec![value; SIDE * SIDE]);
        file.rasterband(1).expect("a band").write((0, 0), (SIDE, SIDE), &mut samples).expect("samples");
        file.close().expect("a file");
        fs::rename(place.path("m.tif"), place.path("two.tif.msk")).expect("a mask");
    };
    let mut stamps = vec![first];
    for value in [255, 254] {
        mask(value);
        stamps.push(place.stamp("two.tif"));
    }
    fs::remove_file(place.path("two.tif.msk")).expect("a mask");
    assert_eq!(place.stamp("two.tif"), first);
    fs::write(place.path("two.tfw"), "30\n0\n0\n-30\n500015\n4199985\n").expect("a world file");
    stamps.push(place.stamp("two.tif"));
    fs::remove_file(place.path("two.tfw")).expect("a world file");
    // Other content of the same size and time.
    let times = fs::metadata(place.path("two.tif")).expect("a file").modified().expect("a time");
    place.write("GTiff", "two.tif", 31.0);
    let file = File::options().write(true).open(place.path("two.tif")).expect("a file");
    file.set_modified(times).expect("a time");
    stamps.push(place.stamp("two.tif"));
    let different: std::collections::HashSet<_> = stamps.iter().collect();
    assert_eq!(different.len(), stamps.len(), "{stamps:?}");
    // The order of bytes is in a file of its own, as long as before.
    place.write("ENVI", "envi.img", 30.0);
    let header = fs::read_to_string(place.path("envi.hdr")).expect("a header");
    assert!(header.contains("byte order = 0"), "{header}");
    let before = place.stamp("envi.img");
    fs::write(place.path("envi.hdr"), header.replace("byte order = 0", "byte order = 1")).expect("a header");
    let swapped = read(place.path("envi.img"), &ReadOptions { memory: SMALL, ..Default::default() });
    assert_ne!(swapped.expect("a DEM").stamp(), Some(before));
}

#[test]
fn pictures_from_a_cache_are_those_without_one() {
    let place = Place::new();
    fs::write(place.path("none"), "a file where a folder should be").expect("a file");
    let mut masks = Vec::new();
    for flags in [&["--band", "1"][..], &["--band", "1", "--exaggeration", "2.5"], &["--band", "2"]] {
        let (without, said) = place.draw(&[flags, &["--cache", "none"]].concat());
        assert!(said.contains("is not cached"), "{said}");
        for sight in ["first", "second"] {
            let (mask, said) = place.draw(&[flags, &["--cache", "cache"]].concat());
            assert!(mask == without, "{flags:?}, {sight} sight");
            assert!(!said.contains("cache"), "{said}");
        }
        masks.push(without);
    }
    assert!(masks[0] != masks[1] && masks[0] != masks[2], "bands and exaggerations draw the same");
    assert_eq!(place.kept().len(), 5, "heights of two bands, bounds of three surfaces");
}

#[test]
fn what_has_changed_while_it_is_drawn_fails() {
    let place = Place::new();
    let dem = place.dem("two.tif", ReadOptions { exaggeration: 2.0, ..Default::default() });
    dem.check().expect("as it was");
    fs::write(place.path("two.prj"), "LOCAL_CS[\"x\"]").expect("a file");
    dem.check().expect("what came since is not read");
    place.write("GTiff", "two.tif", 33.0);
    let error = dem.check().expect_err("it has changed").to_string();
    assert!(error.contains("two.tif: has changed since it was opened"), "{error}");
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_neither_read_nor_written() {
    let place = Place::new();
    let made = AtomicUsize::new(0);
    let cache = place.cache();
    fs::create_dir(place.path("cache")).expect("a folder");
    let path = place.path("cache").join(key(1).file_name());
    let victim = place.path("victim");
    fs::write(&victim, "precious").expect("a file");
    let fifo = || assert!(Command::new("mkfifo").arg(&path).status().expect("mkfifo runs").success());
    let make: [&dyn Fn(); 4] = [
        &fifo,
        &|| fs::create_dir(&path).expect("a folder"),
        &|| std::os::unix::fs::symlink(&victim, &path).expect("a link"),
        &|| std::os::unix::fs::symlink(place.path("nowhere"), &path).expect("a link"),
    ];
    for (i, make) in make.into_iter().enumerate() {
        make();
        let (bytes, said) = get(&cache, 1, &made, Duration::ZERO);
        assert_eq!((bytes.len(), made.load(Ordering::Relaxed)), (1000, i + 1));
        assert!(said.len() == 1 && said[0].contains(&key(1).file_name()) && said[0].contains("remove it"), "{said:?}");
        assert_eq!(fs::read_to_string(&victim).expect("a file"), "precious");
        assert!(!path.is_file() || path.is_symlink() && !place.path("nowhere").exists());
        fs::remove_file(&path).or_else(|_| fs::remove_dir(&path)).expect("gone");
    }
    // The whole program, which must not wait for the other end of a pipe.
    let (mask, _) = place.draw(&["--cache", "cache"]);
    let name = place.kept().remove(0);
    fs::remove_file(place.path("cache").join(&name)).expect("gone");
    assert!(Command::new("mkfifo").arg(place.path("cache").join(&name)).status().expect("mkfifo runs").success());
    let (again, said) = place.draw(&["--cache", "cache"]);
    assert!(again == mask && said.contains(&name) && said.contains("remove it"), "{said}");
}

#[test]
fn one_makes_and_others_wait() {
    let place = Place::new();
    let made = AtomicUsize::new(0);
    let cache = place.cache();
    thread::scope(|scope| {
        let ask = || get(&cache, 3, &made, Duration::from_millis(400));
        let askers: Vec<_> = (0..4).map(|_| scope.spawn(ask)).collect();
        for asker in askers {
            assert_eq!(asker.join().expect("no panic"), (vec![3; 1000], Vec::new()));
        }
    });
    assert_eq!(made.load(Ordering::Relaxed), 1);
    assert_eq!(place.kept(), [key(3).file_name()], "locks go");
    // A lock that nobody has written for long is taken over, at once.
    let lock = place.path("cache").join(key(4).file_name() + ".lock");
    let file = File::create(lock).expect("a lock");
    file.set_modified(SystemTime::now() - Duration::from_secs(60)).expect("a time");
    let start = Instant::now();
    get(&cache, 4, &made, Duration::ZERO);
    assert!(start.elapsed() < Duration::from_secs(5) && made.load(Ordering::Relaxed) == 2);
    assert_eq!(place.kept().len(), 2);
}

#[test]
fn what_is_another_artefact_or_damaged_is_made_anew() {
    let place = Place::new();
    let (made, cache) = (AtomicUsize::new(0), place.cache());
    let file = |number| place.path("cache").join(key(number).file_name());
    get(&cache, 1, &made, Duration::ZERO);
    get(&cache, 2, &made, Duration::ZERO);
    let whole = fs::read(file(1)).expect("a file");
    for bytes in [fs::read(file(2)).expect("a file"), whole[..whole.len() - 1].to_vec(), Vec::new(), vec![0; 5000]] {
        fs::write(file(1), bytes).expect("a file");
        let before = made.load(Ordering::Relaxed);
        let (bytes, said) = get(&cache, 1, &made, Duration::ZERO);
        assert_eq!((bytes, made.load(Ordering::Relaxed)), (vec![1; 1000], before + 1));
        assert_eq!(said, ["a kept number is damaged: it is made anew"]);
        assert!(fs::read(file(1)).expect("a file") == whole);
    }
}

#[test]
fn what_was_used_longest_ago_goes_but_not_what_is_open() {
    let place = Place::new();
    let (made, cache) = (AtomicUsize::new(0), place.cache());
    let file = |number| place.path("cache").join(key(number).file_name());
    let used = |number, seconds| {
        let then = SystemTime::now() - Duration::from_secs(seconds);
        File::options().write(true).open(file(number)).expect("a file").set_times(FileTimes::new().set_modified(then))
    };
    for number in 1..=3 {
        get(&cache, number, &made, Duration::ZERO);
        used(number, 1000 - 100 * number as u64).expect("a time");
    }
    for strange in ["truth-notes.txt", "notes", "prepared-xyz"] {
        fs::write(place.path("cache").join(strange), vec![0; 5000]).expect("a file");
    }
    // Used again, the first is the youngest.
    get(&cache, 1, &made, Duration::ZERO);
    assert_eq!(made.load(Ordering::Relaxed), 3);
    let small = cache.clone().with_size(2500);
    get(&small, 4, &made, Duration::ZERO);
    assert_eq!([1, 2, 3, 4].map(|number| file(number).exists()), [true, false, false, true]);
    used(1, 5000).expect("a time");
    let open = File::open(file(1)).expect("a file");
    open.lock_shared().expect("a lock");
    get(&cache.clone().with_size(10), 5, &made, Duration::ZERO);
    assert_eq!([1, 4, 5].map(|number| file(number).exists()), [true, false, true], "open, old, just made");
    let told = cache.list();
    assert_eq!(told.iter().map(|shown| shown.of.as_deref()).collect::<Vec<_>>(), [Some("number 5"), Some("number 1")]);
    assert_eq!(cache.clear().stayed, 1);
    drop(open);
    assert_eq!((cache.clear().files, place.kept().len()), (1, 3), "other names are not hachure's");
}

#[test]
fn a_cache_is_made_listed_and_cleared() {
    let place = Place::new();
    let run = |flags: &[&str]| {
        let output = place.run(&[&["cache", "--cache", "cache"], flags].concat());
        assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
        String::from_utf8(output.stdout).expect("text")
    };
    assert!(run(&[]).contains("cache: 0 files, 0B of 2GiB"));
    assert!(run(&["--make", "two.tif", "--memory", "64KiB", "--band", "2"]).contains("two.tif: ready"));
    assert!(run(&["--make", "two.tif", "--band", "2"]).contains("nothing to keep"));
    let kept = place.kept();
    let [bounds, heights] = &kept[..] else { panic!("{kept:?}") };
    let told = run(&["--cache-size", "3MiB"]);
    let words = [bounds, heights, "  bounds    ", "  heights   ", "two.tif", "cache: 2 files", "of 3MiB"];
    assert!(words.iter().all(|word| told.contains(word)), "{told}");
    let bytes = || [bounds, heights].map(|name| fs::metadata(place.path("cache").join(name)).expect("a file").len());
    let before = bytes();
    place.draw(&["--cache", "cache", "--band", "2"]);
    assert_eq!((place.kept(), bytes()), (kept.clone(), before), "what was made is used");
    place.draw(&["--cache", "cache", "--band", "2", "--exaggeration", "1.5"]);
    assert!(run(&[]).contains("two.tif, exaggerated 1.5 times"));
    assert!(run(&["--clear"]).contains("3 files of"));
    assert_eq!(place.kept(), Vec::<String>::new());
    for wrong in [&["two.tif"][..], &["--make"], &["--make", "--clear", "two.tif"]] {
        assert_eq!(place.run(&[&["cache"], wrong].concat()).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn making_warns_of_numbers_as_drawing_does() {
    let place = Place::new();
    let row = |r: usize| {
        let high = |c: usize| 2000.0 + 50.0 * ((c + 2 * r) as f32 / 9.0).sin();
        (0..SIDE).map(|c| if c < 20 && r < 20 { -9999.0 } else { high(c) }).collect()
    };
    hachure::geo::write(&place.path("marked.tif"), [SIDE; 2], 30.0, row, &|_| ()).expect("a file");
    let make = || {
        let output = place.run(&["cache", "--cache", "cache", "--make", "marked.tif", "--memory", "64KiB"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    let first = make();
    assert!(
        first.contains("assumed that") && first.contains("if they mark missing data, add --nodata -9999)"),
        "{first}"
    );
    assert_eq!(make(), first, "what is kept says the same");
}

#[test]
fn grids_of_a_container_and_members_of_an_archive_are_apart() {
    let place = Place::new();
    place.write("GTiff", "low.tif", 5.0);
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    for (name, options) in [("two.tif", vec![]), ("low.tif", vec!["APPEND_SUBDATASET=YES"])] {
        let source = gdal::Dataset::open(place.path(name)).expect("a raster");
        let options = gdal::raster::RasterCreationOptions::from_iter(options);
        source.create_copy(&driver, place.path("pages.tif"), &options).expect("a page").close().expect("a file");
    }
    let packed =
        Command::new("tar").current_dir(place.0.path()).args(["-cf", "both.tar", "two.tif", "low.tif"]).status();
    assert!(packed.expect("tar runs").success());
    let at = |name: &str| place.path(name).to_string_lossy().into_owned();
    let (pages, tar) = (at("pages.tif"), at("both.tar"));
    for names in [
        [format!("GTIFF_DIR:1:{pages}"), format!("GTIFF_DIR:2:{pages}")],
        [format!("/vsitar/{tar}/two.tif"), format!("/vsitar/{tar}/low.tif")],
    ] {
        let view =
            ["--eye", "502250,4194000,260", "--azimuth", "0", "--altitude", "-8", "--size", "160x100", "-o", "o.png"];
        let draw = |name: &str, flags: &[&str]| {
            let output = place.run(&[&["draw", name, "--mask", "m.png"], &view[..], flags].concat());
            assert!(output.status.success(), "{name}: {}", stderr(&output));
            fs::read(place.path("m.png")).expect("a mask")
        };
        let filed = ["--memory", "64KiB", "--cache", "members"];
        let drawn = names.each_ref().map(|name| [draw(name, &filed), draw(name, &filed), draw(name, &[])]);
        for [cold, warm, held] in &drawn {
            assert!(cold == held && warm == held, "{names:?}");
        }
        assert!(drawn[0] != drawn[1], "{names:?}: two pictures that are the same prove nothing");
    }
}

#[test]
fn what_cannot_be_kept_is_no_success_of_making() {
    let place = Place::new();
    fs::write(place.path("file"), "a file where a folder should be").expect("a file");
    let output = place.run(&["cache", "--make", "two.tif", "--memory", "64KiB", "--cache", "file"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("is not kept in file; give a folder that can be written, with --cache DIR"), "{said}");
    let output = place.run(&["cache", "--make", "two.tif", "--memory", "64KiB", "--cache", "folder"]);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn outputs_in_the_folder_of_a_cache_are_not_swept_away() {
    let place = Place::new();
    let (cache, old) = (place.cache(), SystemTime::now() - Duration::from_secs(3600));
    fs::create_dir(place.path("cache")).expect("a folder");
    let names = [".hachure-a1b2c3", ".hachure-cache-a1b2c3"].map(|name| place.path("cache").join(name));
    for name in &names {
        File::create(name).and_then(|file| file.set_modified(old)).expect("an old file");
    }
    cache.clear();
    assert_eq!(names.map(|name| name.exists()), [true, false]);
}

#[test]
#[cfg(unix)]
fn another_mode_or_name_is_no_change() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new();
    let dem = place.dem("two.tif", ReadOptions::default());
    fs::set_permissions(place.path("two.tif"), fs::Permissions::from_mode(0o600)).expect("a mode");
    fs::hard_link(place.path("two.tif"), place.path("same.tif")).expect("a link");
    dem.check().expect("the same samples");
    let mut bytes = fs::read(place.path("two.tif")).expect("bytes");
    bytes[2000] ^= 1;
    fs::write(place.path("two.tif"), bytes).expect("other bytes");
    assert!(dem.check().unwrap_err().to_string().contains("has changed since it was opened"));
}
