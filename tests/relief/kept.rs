//! Lines that are kept are those that would be found.

use std::cell::RefCell;

use hachure::cache::{Cache, CacheObserver};
use hachure::dem::Dem;
use hachure::door::cli::words::told;
use hachure::door::relief::FlowLines;
use hachure::relief::{ChannelArea, SurfaceLine};
use tempfile::TempDir;

use super::rough;

const BOTH: [FlowLines; 2] = [FlowLines::Drainage(ChannelArea::Auto), FlowLines::Ridges];

/// The lines, and what was said.
fn creases(cache: &Cache, dem: &Dem, exaggeration: f64, creases: &[FlowLines]) -> (Vec<Vec<SurfaceLine>>, Vec<String>) {
    let said = RefCell::new(Vec::new());
    let warn = |message: &hachure::error::Message| said.borrow_mut().push(told(message));
    let lines =
        cache.creases(dem, exaggeration, creases, CacheObserver { warn: &warn, progress: &|_| () }).expect("creases");
    (lines, said.into_inner())
}

fn files(folder: &TempDir) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder.path()).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = paths.filter(|path| path.to_string_lossy().contains("creases-")).collect();
    files.sort();
    files
}

#[test]
fn what_is_kept_is_what_is_found() {
    let (folder, dem) = (TempDir::new().expect("a folder"), rough(5, [80, 70]));
    let cache = Cache::in_folder(folder.path().to_owned());
    let (fresh, _) = creases(&Cache::none(), &dem, 1.0, &BOTH);
    assert!(fresh.iter().all(|lines| !lines.is_empty()));
    for _ in 0..2 {
        assert_eq!(creases(&cache, &dem, 1.0, &BOTH), (fresh.clone(), Vec::new()));
    }
    assert_eq!(files(&folder).len(), 2);
}

#[test]
fn each_is_kept_by_all_that_it_depends_on() {
    let (folder, dem) = (TempDir::new().expect("a folder"), rough(5, [80, 70]));
    let cache = Cache::in_folder(folder.path().to_owned());
    let mut count = 0;
    let mut is_new = |dem: &Dem, exaggeration: f64, crease: FlowLines| {
        creases(&cache, dem, exaggeration, &[crease]);
        let before = std::mem::replace(&mut count, files(&folder).len());
        assert_eq!(count, before + 1, "{crease:?}, {exaggeration}");
    };
    is_new(&dem, 1.0, FlowLines::Ridges);
    is_new(&dem, 2.0, FlowLines::Ridges);
    is_new(&rough(6, [80, 70]), 1.0, FlowLines::Ridges);
    is_new(&dem, 1.0, FlowLines::Drainage(ChannelArea::Auto));
    is_new(&dem, 1.0, FlowLines::Drainage(ChannelArea::SquareMetres(1e4)));
    is_new(&dem, 1.0, FlowLines::Drainage(ChannelArea::SquareMetres(2e4)));
}

#[test]
fn what_is_damaged_is_made_anew() {
    let (folder, dem) = (TempDir::new().expect("a folder"), rough(5, [80, 70]));
    let cache = Cache::in_folder(folder.path().to_owned());
    let (fresh, _) = creases(&cache, &dem, 1.0, &BOTH);
    for file in files(&folder) {
        let mut bytes = std::fs::read(&file).expect("bytes");
        bytes[40] ^= 1;
        std::fs::write(&file, bytes).expect("a file");
    }
    let (again, said) = creases(&cache, &dem, 1.0, &BOTH);
    assert_eq!(again, fresh);
    assert_eq!(said, ["what is kept of creases is damaged: it is made anew"; 2]);
    assert_eq!(creases(&cache, &dem, 1.0, &BOTH), (fresh, Vec::new()));
}

#[test]
fn heights_count_without_exaggeration() {
    let dem = rough(5, [80, 70]);
    let samples = dem.held().expect("samples");
    let doubled =
        (0..70).flat_map(|r| samples.row_from(0, r)).map(|height| height.map_or(f32::NAN, |height| 2.0 * height));
    let doubled = Dem::from_heights(80, dem.cell(), glam::DVec2::ZERO, doubled.collect());
    let cache = Cache::none();
    assert_eq!(creases(&cache, &doubled, 2.0, &BOTH).0, creases(&cache, &dem, 1.0, &BOTH).0);
    assert_ne!(creases(&cache, &doubled, 1.0, &BOTH).0, creases(&cache, &dem, 1.0, &BOTH).0);
}
