//! The crate built without GDAL: it draws whatever it is given, and says of rasters that it cannot read them.
#![cfg(not(feature = "gdal"))]

use std::fs;
use std::process::{Command, Output};
use std::sync::Arc;

use glam::DVec2;
use hachure::dem::{Crs, Dem, Georeference, History, Tiles, Tiling, Transform, Unit, Window, fractal};
use hachure::error::{Error, Message, Result};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::line::Marks;
use hachure::plan::Plan;
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::{Fixed, choose};
use tempfile::TempDir;

/// Columns and rows.
const SIZE: [usize; 2] = [90, 70];
/// What every refusal says, and its remedy.
const WORDS: [&str; 2] = ["this hachure was built without GDAL", "its default features: `cargo build --release`"];

/// Fractal relief that is made as it is asked for.
#[derive(Debug)]
struct Relief;

impl Tiles for Relief {
    fn size(&self) -> [usize; 2] {
        SIZE
    }

    fn tiling(&self) -> Tiling {
        Tiling::whole([32, 32], SIZE)
    }

    fn is_parallel(&self) -> bool {
        true
    }

    fn read(&self, Window { first, size }: Window) -> Result<Vec<f32>> {
        let rows = first[1]..first[1] + size[1];
        Ok(rows.flat_map(|r| fractal::row(SIZE[0], r)[first[0]..first[0] + size[0]].to_vec()).collect())
    }

    fn stamp(&self) -> Option<u128> {
        Some(1)
    }

    fn check(&self) -> Result<()> {
        Ok(())
    }

    fn marks(&self) -> usize {
        0
    }

    fn assumed(&self) -> Vec<Message> {
        vec!["nobody surveyed it".into()]
    }

    fn all_void(&self) -> Error {
        Error::limit("all void", "give others")
    }
}

/// A map whose north is the globe's, a degree every 100 km.
#[derive(Debug)]
struct Plain;

impl Transform for Plain {
    fn place(&self, _: &Crs, to: &Crs, place: DVec2) -> Option<DVec2> {
        Some(if to.is_geographic() { place / 1e5 } else { place * 1e5 })
    }

    fn lonlat(&self, _: &Crs) -> Result<Option<Crs>> {
        Ok(Some(Crs::new("globe".into(), "globe".into(), None, Unit::Angle(1_f64.to_radians()))))
    }
}

/// How many pixels a frame covers, and its ink.
fn drawn(dem: Dem) -> (u64, Marks) {
    let surface = Arc::new(Surface::new(dem));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 160, 120).expect("a view");
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter"));
    let mut renderer = Renderer::new(gpu, surface).expect("a renderer");
    let page = renderer.page(&Plan::default(), &camera, |_| ()).expect("a page");
    (page.covered, page.marks)
}

#[test]
fn heights_are_drawn_wherever_they_come_from() {
    let heights: Vec<f32> = (0..SIZE[1]).flat_map(|r| fractal::row(SIZE[0], r)).collect();
    let cell = DVec2::splat(fractal::CELL);
    let held = Dem::from_heights(SIZE[0], cell, DVec2::ZERO, heights);
    let filed = Dem::from_tiles(Arc::new(Relief), cell, DVec2::ZERO, 1.0, 1 << 20);
    assert!(filed.is_filed() && filed.stamp() == Some(1));
    assert_eq!(filed.survey(&|_| ()).expect("a survey").assumed, [Message::from("nobody surveyed it")]);
    let (held, filed) = (drawn(held), drawn(filed));
    assert!(held.0 > 1000 && held.1.inked() > 100, "nothing is drawn");
    assert_eq!(held, filed, "the same heights make another drawing");
    let higher = Dem::from_tiles(Arc::new(Relief), cell, DVec2::ZERO, 2.0, 1 << 20);
    assert_ne!(filed, drawn(higher), "the check must see other heights");
}

#[test]
fn places_are_found_by_whoever_knows_the_way() {
    let map = Crs::new("map".into(), "map".into(), None, Unit::Length(1.0, "metre".into()));
    let placed = Georeference::new(map.clone(), map.clone(), Arc::new(Plain));
    let dem = Dem::from_heights(2, DVec2::ONE, DVec2::ZERO, vec![0.0; 4]).with_source(placed, History::default());
    let place = DVec2::new(2e5, 3e5);
    assert_eq!(dem.georeference().lonlat(place).expect("no error"), Some(DVec2::new(2.0, 3.0)));
    assert_eq!(dem.georeference().place_in(&map, place), Some(place));
    let nowhere = Georeference::unknown();
    assert_eq!(nowhere.lonlat(place).expect("no error"), None);
    assert_eq!(nowhere.place_in(&map, place), None, "nobody knows the way");
    assert_eq!(nowhere.place_in(&Crs::unknown(), place), Some(place));
}

fn run(folder: &TempDir, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
    command.current_dir(folder.path()).args(arguments).output().expect("hachure runs")
}

#[test]
fn rasters_are_refused_in_one_line_before_any_gpu_starts() {
    let folder = TempDir::new().expect("a folder");
    let commands: [&[&str]; 6] = [
        // An adapter that nobody has is refused when it is looked for.
        &["draw", "a.tif", "-o", "out.png", "--adapter", "nobody's"],
        &["compare", "a.tif", "-o", "report", "--adapter", "nobody's"],
        &["info", "a.tif"],
        &["cache", "--make", "a.tif"],
        &["generate", "dem", "-o", "out.tif", "--size", "8x8"],
        &["draw", "a.tif", "-o", "out.png", "--eye", "0,0,9", "--crs", "EPSG:32611"],
    ];
    for arguments in commands {
        let output = run(&folder, arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{arguments:?}: {said}");
        assert!(WORDS.iter().all(|words| said.contains(words)), "{arguments:?}: {said}");
        assert_eq!(fs::read_dir(&folder).expect("the folder").count(), 0, "{arguments:?} left files behind");
    }
    for arguments in [["--version"], ["--help"]] {
        let output = run(&folder, &arguments);
        assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}: {output:?}");
    }
}
