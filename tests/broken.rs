//! Files that break or change while frames are drawn of them: the next frame fails, whatever was read before.

use std::fs::{self, File, FileTimes, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use glam::DVec3;
use hachure::cache::Cache;
use hachure::geo::{ReadOptions, read, write};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::{Level, Surface};
use hachure::view::Camera;

use crate::cli::{Place, stderr};
use crate::common::gpu;
use crate::frames::Planned;

const PAGE: [u32; 2] = [96, 64];
const SAMPLES: [usize; 2] = [700, 520];

fn write_hills(path: &Path, height: f64) {
    let sample = |c: usize, r: usize| {
        let (x, y) = (c as f64, r as f64);
        (height * (x / 37.0).sin() * (y / 29.0).cos() + 6.0 * (x * 1.7 + y).sin() + 300.0) as f32
    };
    write(path, SAMPLES, 30.0, |r| (0..SAMPLES[0]).map(|c| sample(c, r)).collect(), &|_| ()).expect("a file");
}

/// What happens to a file of hills at its path.
type Breaking = fn(&Path);

/// Ways in which a file breaks; in all but the first its size stays, and its times seem to.
const BREAKINGS: [(&str, Breaking); 4] = [
    ("truncated", |path| {
        let file = OpenOptions::new().write(true).open(path).expect("the file");
        let length = file.metadata().expect("its size").len();
        file.set_len(length / 2).expect("half of it");
    }),
    ("overwritten in the middle", |path| {
        let times = fs::metadata(path).expect("times");
        let mut file = OpenOptions::new().write(true).open(path).expect("the file");
        file.seek(SeekFrom::Start(times.len() / 3)).expect("a third");
        file.write_all(&vec![0x5a; times.len() as usize / 3]).expect("other bytes");
        put_back(&file, &times);
    }),
    ("replaced", |path| {
        let times = fs::metadata(path).expect("times");
        let other = path.with_extension("other.tif");
        write_hills(&other, 190.0);
        let file = OpenOptions::new().write(true).open(&other).expect("the other");
        file.set_len(times.len()).expect("the same size");
        put_back(&file, &times);
        fs::rename(&other, path).expect("a rename");
    }),
    ("removed", |path| fs::remove_file(path).expect("no file")),
];

fn put_back(file: &File, times: &fs::Metadata) {
    let times = FileTimes::new()
        .set_accessed(times.accessed().expect("a time"))
        .set_modified(times.modified().expect("a time"));
    file.set_times(times).expect("older times");
}

fn camera(surface: &Surface, azimuth: f64, east: f64) -> Camera {
    let [west, south, far, north] = surface.dem().extent();
    let eye = DVec3::new(west + (far - west) * east, (south + north) / 2.0, 900.0);
    Camera { eye, azimuth, altitude: -8.0, fov: 60.0, width: PAGE[0], height: PAGE[1] }
}

#[test]
fn a_file_that_breaks_between_frames_fails_the_next() {
    let adaptive = Detail::Adaptive { error_px: 0.5 };
    let one = Detail::Uniform(Level::new(1).expect("a level"));
    for (detail, prepared, ways) in
        [(adaptive, true, &BREAKINGS[..]), (adaptive, false, &BREAKINGS[1..2]), (one, false, &BREAKINGS[1..2])]
    {
        for (way, breaking) in ways {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("hills.tif");
            write_hills(&path, 200.0);
            let options = ReadOptions { memory: 1 << 20, ..Default::default() };
            let surface = Arc::new(Surface::new(read(&path, &options).expect("a DEM")));
            assert!(surface.dem().is_filed());
            if prepared {
                let cache = Cache::in_folder(folder.path().join("cache"));
                cache.prepare(&surface, &|_| (), &|_| ()).expect("overviews");
            }
            let plan = Plan::new(detail, Method::Walk, Border::On);
            let mut renderer = Planned::new(gpu(), &surface, plan);
            renderer.page(&camera(&surface, 30.0, 0.2)).expect("a page of the whole file");
            renderer.time_of_frame(&camera(&surface, 35.0, 0.2)).expect("a frame of the whole file");
            // Clocks of file systems tick every few milliseconds.
            sleep(Duration::from_millis(20));
            breaking(&path);
            let other = camera(&surface, 250.0, 0.9);
            let about = format!("{detail:?}, prepared: {prepared}, {way}");
            let error = renderer.page(&other).map(drop).expect_err(&about).to_string();
            assert!(error.contains("hills.tif: "), "{about}: {error}");
            assert!(renderer.frame(&other).is_err(), "{about}: a frame");
            assert!(renderer.draw(&other).is_err(), "{about}: a frame read back");
            assert!(renderer.time_of_frame(&other).is_err(), "{about}: a frame by the clock");
            assert!(renderer.timed_frame(&other).is_err(), "{about}: passes by the clock");
        }
    }
}

#[test]
fn what_stands_beside_a_file_belongs_to_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, vrt] = ["hills.tif", "hills.vrt"].map(|name| folder.path().join(name));
    write_hills(&path, 200.0);
    let bands = format!(
        "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{1}\"><SRS>EPSG:32632</SRS>\
         <GeoTransform>489500, 30, 0, 5547800, 0, -30</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">\
         <SimpleSource><SourceFilename relativeToVRT=\"1\">hills.tif</SourceFilename><SourceBand>1</SourceBand>\
         </SimpleSource></VRTRasterBand></VRTDataset>",
        SAMPLES[0], SAMPLES[1]
    );
    fs::write(&vrt, bands).expect("a VRT");
    let options = ReadOptions { memory: 1 << 20, ..Default::default() };
    let dem = read(&vrt, &options).expect("a DEM");
    dem.window([0, 0], [64, 64]).expect("samples");
    dem.check().expect("nothing has changed");
    sleep(Duration::from_millis(20));
    BREAKINGS[2].1(&path);
    let error = dem.check().expect_err("its source is another").to_string();
    assert!(error.contains("hills.vrt: has changed since it was opened (/"), "{error}");
    assert!(error.contains("hills.tif)"), "{error}");
}

#[test]
fn a_damaged_file_leaves_no_drawing() {
    let place = Place::new();
    write_hills(&place.path("hills.tif"), 200.0);
    BREAKINGS[1].1(&place.path("hills.tif"));
    let draw = ["draw", "hills.tif", "-o", "out.png", "--size", "64x48", "--memory", "1MiB"];
    let output = place.run(&draw);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("is damaged or cut short"), "{}", stderr(&output));
    assert_eq!(place.written(), ["hills.tif"]);
}
