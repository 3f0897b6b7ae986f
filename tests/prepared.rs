//! What is kept of a DEM in its file: frames are those of the held DEM bit by bit, at first and at second sight; what is
//! damaged or of another DEM is noticed.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use hachure::cache::Cache;
use hachure::dem::{Dem, ReadOptions, read, write::write};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::render::Renderer;
use hachure::surface::lattice::CELL_STEPS;
use hachure::surface::{Chunk, Surface};
use hachure::view::Camera;
use tempfile::TempDir;

use crate::common::gpu;
use crate::mixed::variety;
use crate::scenes::Random;

const PAGE: [u32; 2] = [320, 200];
const SAMPLES: [usize; 2] = [1500, 1100];
/// A budget that holds no tile, and one that holds some.
const SMALL: u64 = 1 << 18;
const MODERATE: u64 = 1 << 23;

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
    exaggerated(path, memory, 1.0)
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

    /// The DEM in its file, as another process would prepare it; and what was warned of.
    fn prepared(&self, memory: u64) -> (Surface, Vec<String>) {
        self.prepared_times(memory, 1.0)
    }

    /// The same with every height multiplied.
    fn prepared_times(&self, memory: u64, exaggeration: f64) -> (Surface, Vec<String>) {
        let surface = Surface::new(exaggerated(&self.dem(), memory, exaggeration));
        let warn = |words: &str| self.said.borrow_mut().push(words.to_owned());
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
fn frames(surface: &Surface) -> Vec<(Vec<Chunk>, Vec<u8>)> {
    let plan = Plan::new(Detail::Adaptive { error_px: 0.7 }, Method::Walk, Border::On);
    let renderer = Renderer::new(gpu(), surface, plan, PAGE).expect("a renderer");
    let frame = |camera| {
        let drawn = renderer.draw(camera).expect("a frame");
        (renderer.lattice().chunks().to_vec(), bytemuck::cast_slice(&drawn.raster.pixels).to_vec())
    };
    let frames = cameras(surface).iter().map(frame).collect();
    let [levels, seams] = variety(&renderer.lattice());
    assert!(levels > 3 && seams > 20, "{levels} levels, {seams} seams");
    frames
}

#[test]
fn frames_of_a_filed_dem_are_those_of_the_held_one() {
    for voids in [false, true] {
        let place = Place::new(voids);
        let held = Surface::new(dem(&place.dem(), 1 << 30));
        let expected = frames(&held);
        let steps: Vec<u32> = expected.iter().flat_map(|(chunks, _)| chunks.iter().map(|chunk| chunk.step)).collect();
        let coarse = [2, 4, 8].map(|spacing| steps.iter().filter(|step| **step == spacing * CELL_STEPS).count());
        assert!(coarse.iter().all(|chunks| *chunks > 2), "{coarse:?} chunks of levels 1/2, 1/4, 1/8");
        assert!(steps.iter().any(|step| *step < CELL_STEPS), "no chunk is finer than the grid");
        assert_eq!(held.dem().voids() > 1000, voids);
        assert!(frames(&Surface::new(dem(&place.dem(), SMALL))) == expected, "voids {voids}: nothing kept");
        for sight in ["first", "second"] {
            let (surface, said) = place.prepared(SMALL);
            assert_eq!(said, Vec::<String>::new());
            assert!(frames(&surface) == expected, "voids {voids}: {sight} sight");
            assert_eq!(surface.dem().survey(&|_| ()).unwrap().patches, held.dem().patches());
            assert!(!surface.dem().has_damaged_overviews());
        }
        assert_eq!(place.kept().len(), 1);
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

#[test]
fn what_is_damaged_is_made_anew() {
    let place = Place::new(false);
    let (surface, _) = place.prepared(SMALL);
    let expected = frames(&surface);
    let kept = place.kept().remove(0);
    let whole = fs::read(&kept).expect("a file");
    let end = content(&whole);
    let header = u64::from_le_bytes(*whole[..end - 8].last_chunk().expect("a footer")) as usize;
    // The header, the last of the pyramid, where the header begins, the hash, of what it was made, its name, an end cut off,
    // and nothing at all.
    let tail = whole.len() - 40;
    let damages: Vec<_> = [header, end - 20, end - 16, end - 1, end, tail].map(|at| changed(whole.clone(), at)).into();
    for damaged in damages.into_iter().chain([whole[..end - 1000].to_vec(), Vec::new()]) {
        fs::write(&kept, damaged).expect("a file");
        let (surface, said) = place.prepared(SMALL);
        assert_eq!(said, ["what was kept of the DEM is damaged: it is made anew"]);
        assert!(frames(&surface) == expected);
        assert!(fs::read(&kept).expect("a file") == whole, "not what it was");
    }
    // All blocks but the hashes that prove them.
    let damaged = (0..header).step_by(999).fold(whole.clone(), changed);
    fs::write(&kept, damaged).expect("a file");
    let (surface, said) = place.prepared(SMALL);
    assert_eq!(said, Vec::<String>::new());
    assert!(!surface.dem().has_damaged_overviews());
    assert!(frames(&surface) == expected, "damaged samples are drawn");
    assert!(surface.dem().has_damaged_overviews(), "frames do not look at them");
    place.cache().discard_damaged(surface.dem(), &|words| place.said.borrow_mut().push(words.to_owned()));
    assert_eq!(place.said.take(), ["what was kept of the DEM is damaged: it is made anew next time"]);
    assert_eq!(place.kept(), Vec::<PathBuf>::new());
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
    let expected = frames(&Surface::new(dem(&place.dem(), 1 << 30)));
    assert!(expected != before, "nothing can be noticed");
    let (surface, said) = place.prepared(SMALL);
    assert_eq!(said, Vec::<String>::new());
    assert!(frames(&surface) == expected, "what was kept of the older one is drawn");
    assert_eq!(place.kept().len(), 2);
}

#[test]
fn a_folder_that_cannot_be_written_costs_a_warning() {
    let place = Place::new(false);
    fs::write(place.folder.path().join("cache"), "a file where a folder should be").expect("a file");
    let (surface, said) = place.prepared(SMALL);
    assert!(said.len() == 1 && said[0].starts_with("what was made of the DEM is not cached"), "{said:?}");
    assert!(frames(&surface) == frames(&Surface::new(dem(&place.dem(), 1 << 30))));
}

#[test]
fn an_exaggeration_needs_no_other_look_and_changes_nothing_else() {
    let place = Place::new(true);
    place.prepared_times(SMALL, 2.5);
    let made = fs::metadata(&place.kept()[0]).expect("a file").len();
    for exaggeration in [2.5, 1.0, 0.4] {
        let plain = Surface::new(exaggerated(&place.dem(), SMALL, exaggeration));
        let held = exaggerated(&place.dem(), 1 << 30, exaggeration);
        let expected = frames(&plain);
        let (surface, said) = place.prepared_times(SMALL, exaggeration);
        assert_eq!(said, Vec::<String>::new());
        assert!(frames(&surface) == expected, "{exaggeration}: another picture than without a cache");
        let figures = |dem: &Dem| (dem.range(), dem.voids(), dem.patches());
        assert_eq!(figures(surface.dem()), figures(&held), "{exaggeration}");
        for spacing in [2, 16, 64] {
            let [first, size] = [[spacing * 3, spacing * 2], [20, 15]];
            let bits =
                |dem: &Dem| dem.spaced(first, spacing, size).expect("samples").into_iter().map(f32::to_bits).collect();
            let [kept, held]: [Vec<u32>; 2] = [bits(surface.dem()), bits(&held)];
            assert!(kept == held, "{exaggeration}: every {spacing}th");
        }
    }
    assert_eq!((place.kept().len(), fs::metadata(&place.kept()[0]).expect("a file").len()), (1, made));
}
