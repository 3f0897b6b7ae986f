//! What is kept of a DEM in its file: frames are those of the held DEM bit by bit, at first and at second sight; what is
//! damaged or of another DEM is noticed.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use glam::DVec3;
use hachure::cache::Cache;
use hachure::dem::Dem;
use hachure::door::cli::words::told;
use hachure::door::surface::Chunk;
use hachure::door::surface::lattice::CELL_STEPS;
use hachure::error::Message;
use hachure::geo::{ReadOptions, read, write};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;
use tempfile::TempDir;

use crate::common::gpu;
use crate::frames::Planned;
use crate::mixed::variety;
use crate::scenes::Random;

const PAGE: [u32; 2] = [320, 200];
const SAMPLES: [usize; 2] = [1500, 1100];
/// A budget that holds no tile, and one that holds some.
const SMALL: u64 = 1 << 18;
const MODERATE: u64 = 1 << 23;
/// Factor on every height, unless a test has its own.
const EXAGGERATION: f64 = 1.5;

/// Hills of 30 m cells with small bumps; voids around (700, 500) and here and there.
fn write_hills(path: &Path, height: f64, voids: bool) {
    let row = |r: usize| {
        let sample = |c: usize| {
            let (x, y) = (c as f64, r as f64);
            let z = height * (x / 37.0).sin() * (y / 29.0).cos() + 6.0 * (x * 1.7 + y).sin() + 300.0;
            let block = (690..740).contains(&c) && (480..520).contains(&r);
            let void = voids && (block || (c * 7919 + r * 104_729).is_multiple_of(90_001));
            if void { f32::NAN } else { z as f32 }
        };
        (0..SAMPLES[0]).map(sample).collect()
    };
    write(path, SAMPLES, 30.0, row, &|_| ()).expect("a file");
}

fn dem(path: &Path, memory: u64) -> Dem {
    exaggerated(path, memory, EXAGGERATION)
}

fn exaggerated(path: &Path, memory: u64, exaggeration: f64) -> Dem {
    let dem = read(path, &ReadOptions { memory, exaggeration, ..Default::default() }).expect("a DEM");
    assert_eq!(dem.is_filed(), memory <= MODERATE);
    dem
}

/// A folder with a DEM and a cache.
struct Place {
    folder: TempDir,
    /// What was warned of.
    said: RefCell<Vec<String>>,
}

impl Place {
    fn new(voids: bool) -> Self {
        let place = Self { folder: tempfile::tempdir().expect("a folder"), said: RefCell::default() };
        write_hills(&place.dem(), 200.0, voids);
        place
    }

    fn dem(&self) -> PathBuf {
        self.folder.path().join("hills.tif")
    }

    fn cache(&self) -> Cache {
        Cache::in_folder(self.folder.path().join("cache"))
    }

    /// The files of the cache.
    fn kept(&self) -> Vec<PathBuf> {
        let files = fs::read_dir(self.folder.path().join("cache")).expect("a folder");
        let mut files: Vec<_> = files.map(|entry| entry.expect("an entry").path()).collect();
        files.sort();
        files
    }

    /// The only file of a kind.
    fn only(&self, kind: &str) -> PathBuf {
        let of_kind = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind));
        let files: Vec<_> = self.kept().into_iter().filter(of_kind).collect();
        let [file] = &files[..] else { panic!("{kind}: {files:?}") };
        file.clone()
    }

    /// The DEM in its file, as another process would prepare it; and what was warned of.
    fn prepared(&self, memory: u64) -> (Arc<Surface>, Vec<String>) {
        self.prepared_times(memory, EXAGGERATION)
    }

    /// The same with another exaggeration.
    fn prepared_times(&self, memory: u64, exaggeration: f64) -> (Arc<Surface>, Vec<String>) {
        let surface = Arc::new(Surface::new(exaggerated(&self.dem(), memory, exaggeration)));
        let warn = |message: &Message| self.said.borrow_mut().push(told(message));
        self.cache().prepare(&surface, &warn, &|_| ()).expect("samples");
        (surface, self.said.take())
    }
}

/// Near and far views over the hills.
fn cameras(surface: &Surface) -> Vec<Camera> {
    let [west, south, east, north] = surface.dem().extent();
    let mut random = Random::new(17);
    let mut camera = |azimuth: f64, altitude: f64| {
        let eye = DVec3::new(
            random.between(west, east),
            random.between(south, (south + north) / 2.0),
            random.between(800.0, 1500.0),
        );
        Camera { eye, azimuth, altitude, fov: 60.0, width: PAGE[0], height: PAGE[1] }
    };
    vec![camera(0.0, -4.0), camera(30.0, -10.0), camera(310.0, -2.0)]
}

/// Each frame's lattice and page, bit by bit.
fn frames(surface: &Arc<Surface>) -> Vec<(Vec<Chunk>, Vec<u8>)> {
    let plan = Plan::new(Detail::Adaptive { error_px: 0.7 }, Method::Walk, Border::On);
    let mut renderer = Planned::new(gpu(), surface, plan);
    let mut frame = |camera| {
        let drawn = renderer.draw(camera).expect("a frame");
        (renderer.lattice().chunks().to_vec(), bytemuck::cast_slice(&drawn.raster.pixels).to_vec())
    };
    let frames = cameras(surface).iter().map(&mut frame).collect();
    let [levels, seams] = variety(&renderer.lattice());
    assert!(levels > 3 && seams > 20, "{levels} levels, {seams} seams");
    frames
}

#[test]
fn frames_of_a_filed_dem_are_those_of_the_held_one() {
    for voids in [false, true] {
        let place = Place::new(voids);
        let held = Arc::new(Surface::new(dem(&place.dem(), 1 << 30)));
        let expected = frames(&held);
        let steps: Vec<u32> = expected.iter().flat_map(|(chunks, _)| chunks.iter().map(|chunk| chunk.step)).collect();
        let coarse = [2, 4, 8].map(|spacing| steps.iter().filter(|step| **step == spacing * CELL_STEPS).count());
        assert!(coarse.iter().all(|chunks| *chunks > 2), "{coarse:?} chunks of levels 1/2, 1/4, 1/8");
        assert!(steps.iter().any(|step| *step < CELL_STEPS), "no chunk is finer than the grid");
        assert_eq!(held.dem().voids() > 1000, voids);
        assert!(frames(&Arc::new(Surface::new(dem(&place.dem(), SMALL)))) == expected, "voids {voids}: nothing kept");
        for sight in ["first", "second"] {
            let (surface, said) = place.prepared(SMALL);
            assert_eq!(said, Vec::<String>::new());
            assert!(frames(&surface) == expected, "voids {voids}: {sight} sight");
            assert_eq!(surface.dem().survey(&|_| ()).unwrap().patches, held.dem().patches());
            assert!(!surface.dem().has_damaged_overviews());
        }
        assert_eq!(place.kept(), [place.only("bounds"), place.only("heights")]);
    }
}

#[test]
fn spaced_samples_are_exact_subsets() {
    let place = Place::new(true);
    let held = dem(&place.dem(), 1 << 30);
    let (kept, plain) = (place.prepared(MODERATE).0, dem(&place.dem(), MODERATE));
    let mut random = Random::new(11);
    let bits = |heights: Vec<f32>| heights.into_iter().map(f32::to_bits).collect::<Vec<_>>();
    for spacing in [1, 2, 4, 8, 16, 32, 64, 3] {
        for _ in 0..6 {
            let first = SAMPLES.map(|n| random.below((n / spacing) as u32 + 3) as usize * spacing);
            let size = [1 + random.below(40) as usize, 1 + random.below(40) as usize];
            let at = |i: usize| [0, 1].map(|k| first[k] + [i % size[0], i / size[0]][k] * spacing);
            let expected = (0..size[0] * size[1]).map(|i| held.height(at(i)[0], at(i)[1]).unwrap_or(f32::NAN));
            let expected = bits(expected.collect());
            for dem in [&held, kept.dem(), &plain] {
                let spaced = bits(dem.spaced(first, spacing, size).expect("samples"));
                assert!(spaced == expected, "every {spacing}th of {size:?} from {first:?}");
            }
        }
    }
}

/// Bytes of an artefact in a file of the cache: before a text of so many bytes, and a tail of 40.
fn content(whole: &[u8]) -> usize {
    let text = whole[whole.len() - 24..].first_chunk().map(|text| u64::from_le_bytes(*text)).expect("a tail");
    whole.len() - 40 - text as usize
}

/// The bytes of a file with one of them changed.
fn changed(mut bytes: Vec<u8>, at: usize) -> Vec<u8> {
    bytes[at] ^= 1;
    bytes
}

/// The file with a byte changed at each of these places, in turn; with an end cut off; and empty.
fn damages(whole: &[u8], places: &[usize]) -> Vec<Vec<u8>> {
    let changed = places.iter().map(|at| changed(whole.to_vec(), *at));
    changed.chain([whole[..whole.len() - 1000].to_vec(), Vec::new()]).collect()
}

/// Where the header of a file of heights begins.
fn header(whole: &[u8]) -> usize {
    u64::from_le_bytes(*whole[..content(whole) - 8].last_chunk().expect("a footer")) as usize
}

#[test]
fn what_is_damaged_is_made_anew() {
    let place = Place::new(false);
    let expected = frames(&place.prepared(SMALL).0);
    let (bounds, heights) = (place.only("bounds"), place.only("heights"));
    let whole = [&bounds, &heights].map(|file| fs::read(file).expect("a file"));
    let [of_bounds, of_heights] = whole.each_ref().map(|whole| content(whole));
    let tail = whole.each_ref().map(|whole| whole.len() - 40);
    // The first and last of the squares, the hash, of what they were made, their name.
    let places = [0, of_bounds - 9, of_bounds - 1, of_bounds, tail[0]];
    let mut made_anew = Vec::new();
    for damaged in damages(&whole[0], &places) {
        fs::write(&bounds, damaged).expect("a file");
        let (surface, said) = place.prepared(SMALL);
        assert_eq!(said, ["what was kept of the DEM is damaged: it is made anew"]);
        assert!(surface.dem().samples_read() > 0, "bounds are of the surface as drawn");
        made_anew = vec![surface];
        assert!(fs::read(&bounds).expect("a file") == whole[0], "not what it was");
    }
    // The header, the last of the index, where the header begins, the hash, of what they were made, their name.
    let places = [header(&whole[1]), of_heights - 20, of_heights - 16, of_heights - 1, of_heights, tail[1]];
    for damaged in damages(&whole[1], &places) {
        fs::write(&heights, damaged).expect("a file");
        let (surface, said) = place.prepared(SMALL);
        assert_eq!(said, ["what was kept of the DEM is damaged: it is made anew"]);
        assert_eq!(surface.dem().samples_read(), 0, "heights alone are of the DEM without exaggeration");
        made_anew.truncate(1);
        made_anew.push(surface);
        assert!(fs::read(&heights).expect("a file") == whole[1], "not what it was");
    }
    assert!(made_anew.iter().all(|surface| frames(surface) == expected), "another picture");
    assert_eq!(place.kept(), [bounds, heights]);
}

#[test]
fn damaged_blocks_are_noticed_when_they_are_read() {
    let place = Place::new(false);
    let expected = frames(&place.prepared(SMALL).0);
    let (bounds, kept) = (place.only("bounds"), place.only("heights"));
    let whole = fs::read(&kept).expect("a file");
    // All blocks but the hashes that prove them.
    let damaged = (0..header(&whole)).step_by(999).fold(whole.clone(), changed);
    fs::write(&kept, damaged).expect("a file");
    let (surface, said) = place.prepared(SMALL);
    assert_eq!(said, Vec::<String>::new());
    assert!(!surface.dem().has_damaged_overviews());
    assert!(frames(&surface) == expected, "damaged samples are drawn");
    assert!(surface.dem().has_damaged_overviews(), "frames do not look at them");
    place.cache().discard_damaged(surface.dem(), &|message| place.said.borrow_mut().push(told(message)));
    assert_eq!(place.said.take(), ["what was kept of the DEM is damaged: it is made anew next time"]);
    assert_eq!(place.kept(), [bounds]);
    let (surface, said) = place.prepared(SMALL);
    assert!(said.is_empty() && fs::read(&kept).expect("a file") == whole);
    place.cache().discard_damaged(surface.dem(), &|words| panic!("{words}"));
}

#[test]
fn another_dem_of_the_same_name_is_looked_at_anew() {
    let place = Place::new(false);
    let (surface, _) = place.prepared(SMALL);
    let before = frames(&surface);
    write_hills(&place.dem(), 190.0, false);
    let expected = frames(&Arc::new(Surface::new(dem(&place.dem(), 1 << 30))));
    assert!(expected != before, "nothing can be noticed");
    let (surface, said) = place.prepared(SMALL);
    assert_eq!(said, Vec::<String>::new());
    assert!(frames(&surface) == expected, "what was kept of the older one is drawn");
    assert_eq!(place.kept().len(), 4);
}

#[test]
fn a_folder_that_cannot_be_written_costs_a_warning() {
    let place = Place::new(false);
    fs::write(place.folder.path().join("cache"), "a file where a folder should be").expect("a file");
    let (surface, said) = place.prepared(SMALL);
    assert!(said.len() == 1 && said[0].starts_with("what was made of the DEM is not cached"), "{said:?}");
    assert!(frames(&surface) == frames(&Arc::new(Surface::new(dem(&place.dem(), 1 << 30)))));
}

#[test]
fn heights_are_made_once_for_all_exaggerations() {
    let place = Place::new(true);
    place.prepared_times(SMALL, 2.5);
    let made = fs::read(place.only("heights")).expect("a file");
    for (exaggeration, looks) in [(2.5, false), (1.0, true), (0.4, true)] {
        let held = Arc::new(Surface::new(exaggerated(&place.dem(), 1 << 30, exaggeration)));
        let expected = frames(&held);
        for looks in [looks, false] {
            let (surface, said) = place.prepared_times(SMALL, exaggeration);
            assert_eq!(said, Vec::<String>::new());
            assert_eq!(
                surface.dem().samples_read() > 0,
                looks,
                "{exaggeration}: its bounds need a look, and that once"
            );
            assert!(frames(&surface) == expected, "{exaggeration}: another picture than of the held DEM");
            let figures = |dem: &Dem| (dem.range(), dem.voids(), dem.patches());
            assert_eq!(figures(surface.dem()), figures(held.dem()), "{exaggeration}");
            for spacing in [2, 16, 64] {
                let [first, size] = [[spacing * 3, spacing * 2], [20, 15]];
                let bits = |dem: &Dem| -> Vec<u32> {
                    dem.spaced(first, spacing, size).expect("samples").into_iter().map(f32::to_bits).collect()
                };
                assert!(bits(surface.dem()) == bits(held.dem()), "{exaggeration}: every {spacing}th");
            }
        }
    }
    assert_eq!(place.kept().len(), 4, "one of heights, three of bounds");
    assert!(fs::read(place.only("heights")).expect("a file") == made, "heights depend on who made them");
}

#[test]
fn who_wants_the_same_waits_and_others_wait_for_the_heights() {
    let place = Place::new(false);
    let (path, cache) = (place.dem(), place.cache());
    let looked = thread::scope(|scope| {
        let prepared = |exaggeration: f64| {
            let (path, cache) = (path.clone(), cache.clone());
            scope.spawn(move || {
                let surface = Arc::new(Surface::new(exaggerated(&path, SMALL, exaggeration)));
                cache.prepare(&surface, &|words| panic!("{words}"), &|_| ()).expect("samples");
                surface.dem().samples_read() > 0
            })
        };
        [2.5, 2.5, 0.4, 0.4].map(prepared).map(|work| work.join().expect("no panic"))
    });
    assert!(looked[0] != looked[1] && looked[2] != looked[3], "{looked:?}: one of two looks at every sample");
    place.only("heights");
    assert_eq!(place.kept().len(), 3, "{:?}", place.kept());
}

#[test]
fn neither_makes_room_for_the_other() {
    let place = Place::new(false);
    let cache = place.cache().with_size(1);
    for looks in [true, false, false] {
        let surface = Arc::new(Surface::new(dem(&place.dem(), SMALL)));
        cache.prepare(&surface, &|words| panic!("{words}"), &|_| ()).expect("samples");
        assert_eq!(surface.dem().samples_read() > 0, looks);
        assert_eq!(place.kept(), [place.only("bounds"), place.only("heights")]);
    }
}
