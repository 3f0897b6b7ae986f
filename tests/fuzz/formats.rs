//! Everything that hachure parses itself, each format by its name, from bytes that may hold anything.
//!
//! A file is read, or refused in one line with a remedy, by an exit code of 1 or 2: never by a panic, a mistake of ours, ten
//! seconds of work or gigabytes of memory. What is read here ends as soon as that is known: nothing is drawn.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::{Mutex, OnceLock, PoisonError};

use glam::{DVec2, DVec3};
use hachure::cache::{Cache, CacheObserver};
use hachure::door::cli::{values, words};
use hachure::door::formats;
use hachure::door::job::{Frames, Merged, Pattern, Shard, serve};
use hachure::door::relief::FlowLines;
use hachure::door::relief::slope::{SlopeRules, Slopes};
use hachure::error::Error;
use hachure::geo::{self, ReadOptions};
use hachure::ink::styles;
use hachure::relief::ChannelArea;
use hachure::surface::Level;
use hachure::surface::Surface;
use hachure::truth::Terrain;
use hachure::view::Camera;
use tempfile::TempDir;
use xxhash_rust::xxh3::xxh3_64;

/// Reads bytes as such a file. Panics where that is not done or refused as it should be.
pub fn read(format: &str, bytes: &[u8]) {
    // One at a time in a folder.
    static FOLDER: OnceLock<Mutex<TempDir>> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| Mutex::new(TempDir::new().expect("a temporary folder")));
    let folder = folder.lock().unwrap_or_else(PoisonError::into_inner);
    let file = |name: &str| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file");
        path
    };
    match format {
        "views" => refused_in_words(formats::views(&file("views.json"))),
        "styles" => refused_in_words(styles::find(&file("style.toml").to_string_lossy()).map(drop)),
        "flights" => refused_in_words(formats::flight(&file("flight.toml"))),
        "batches" => refused_in_words(formats::batch(&file("batch.toml"))),
        "job_lines" => job_lines(bytes),
        "manifests" => {
            file("hachure-0-of-1.json");
            refused_in_words(Merged::all(folder.path()).map(drop));
        }
        "seals" => drop(formats::seal(&file("a.png"))),
        "values" => String::from_utf8(bytes.to_vec()).iter().for_each(|text| each_value(text)),
        "caches" => caches(bytes),
        _ => panic!("no format is named {format}"),
    }
}

fn refused_in_words(outcome: Result<(), Error>) {
    let Err(error) = outcome else { return };
    let line = words::line(&error);
    assert!([1, 2].contains(&words::exit_code(&error)) && !matches!(error, Error::Mistake { .. }), "{line}");
    assert!(line.contains("; ") && !line.contains(char::is_control), "no line with a remedy: {line:?}");
}

/// Each line that is none is refused, and the next one is read.
fn job_lines(mut bytes: &[u8]) {
    while let Some(job) = serve::next(&mut bytes).expect("memory can be read") {
        let Err(refusal) = job else { continue };
        assert!(refusal.why.contains("; "), "no remedy: {}", refusal.why);
    }
}

/// Whatever is typed as the value of a flag.
fn each_value(text: &str) {
    macro_rules! each {
        ($($parse:ident)*) => { $(drop(values::$parse(text));)* };
    }
    each!(bytes number eye lonlat look_at place pixel height clearance frames seconds fps epsg metres elevation_unit nodata
        encoding order crop size samples level level_choice peaks error_px min_jump min_gap distance split page margin scale
        dpi truth_level repeat method adapter azimuth altitude fov exaggeration);
    if let Ok(frames) = text.parse::<Frames>() {
        assert_eq!(frames.to_string().parse(), Ok(frames), "frames read as they are written");
    }
    drop(text.parse::<Shard>().map(|shard| shard.of(&Frames::first(10))));
    drop(Pattern::parse(text).map(|pattern| (pattern.path(u32::MAX), pattern.folder())));
}

/// A DEM in its file, and all that is kept of it.
struct Kept {
    folder: TempDir,
    files: BTreeMap<String, Vec<u8>>,
}

/// Bytes at the end of a kept file: its name, the length of the text before, a hash, a mark.
const TAIL: usize = 40;

/// Does to a kept file what `bytes` say: which file, then where it gets which bytes. Hashes are mended, for what is read behind
/// them is what is asked about.
fn caches(bytes: &[u8]) {
    static KEPT: OnceLock<Kept> = OnceLock::new();
    let kept = KEPT.get_or_init(Kept::new);
    let Some((which, edits)) = bytes.split_first() else { return };
    let (name, whole) = kept.files.iter().nth(usize::from(*which) % kept.files.len()).expect("a file");
    fs::write(kept.path(name), edited(whole, edits)).expect("a file");
    kept.use_all();
    fs::write(kept.path(name), whole).expect("a file");
}

/// Places in a kept file as two bytes, what is written there as one that stands for eight.
fn edited(whole: &[u8], edits: &[u8]) -> Vec<u8> {
    let text = u64::from_le_bytes(whole[whole.len() - TAIL + 16..][..8].try_into().expect("8 bytes")) as usize;
    let (content, rest) = whole.split_at(whole.len() - TAIL - text);
    let hashed = hashed(content);
    let mut content = content.to_vec();
    for edit in edits.chunks_exact(3) {
        let place = usize::from(u16::from_le_bytes([edit[0], edit[1]]));
        // From the end too: there stand the lengths of what is before.
        let place = if edit[0] & 1 == 0 { place % content.len() } else { content.len() - 1 - place % content.len() };
        let value = match edit[2] {
            low @ 0..64 => u64::from(low),
            power @ 64..128 => 1 << (power - 64),
            power @ 128..192 => (1_u64 << (power - 128)).wrapping_sub(1),
            nan @ 192..224 => f64::NAN.to_bits() ^ u64::from(nan),
            high => !u64::from(high - 224),
        };
        let end = content.len().min(place + [1, 4, 8][place % 3]);
        content[place..end].copy_from_slice(&value.to_le_bytes()[..end - place]);
    }
    if let Some([begin, end]) = hashed {
        let hash = xxh3_64(&content[begin..end]).to_le_bytes();
        let last = content.len() - hash.len();
        content[last..].copy_from_slice(&hash);
    }
    [&content, rest].concat()
}

/// From where to where the bytes are of which the last eight are the hash.
fn hashed(content: &[u8]) -> Option<[usize; 2]> {
    let (before, hash) = content.split_last_chunk::<8>()?;
    let hash = u64::from_le_bytes(*hash);
    let ends = [before.len(), before.len().saturating_sub(8)];
    let ranges = ends.into_iter().flat_map(|end| (0..end).step_by(4).map(move |begin| [begin, end]));
    ranges.into_iter().find(|[begin, end]| xxh3_64(&content[*begin..*end]) == hash)
}

impl Kept {
    fn new() -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let height = |c: usize, r: usize| {
            let (x, y) = (c as f64 / 4.0, r as f64 / 5.0);
            if (c, r) == (7, 9) { f32::NAN } else { (60.0 * (x.sin() + y.cos()) + x).round() as f32 }
        };
        let row = |r| (0..40).map(|c| height(c, r)).collect();
        geo::write(&folder.path().join("land.tif"), [40, 36], 30.0, row, &|_| ()).expect("a DEM");
        let mut kept = Self { folder, files: BTreeMap::new() };
        kept.use_all();
        let named = fs::read_dir(kept.path("")).expect("a cache").map(|entry| entry.expect("an entry").path());
        let named = named.filter(|path| path.is_file() && fs::metadata(path).is_ok_and(|about| about.len() > 40));
        kept.files = named
            .map(|path| {
                (path.file_name().expect("a name").to_string_lossy().into_owned(), fs::read(&path).expect("bytes"))
            })
            .collect();
        kept
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("cache").join(name)
    }

    /// Asks for everything that is kept, which is found or made.
    fn use_all(&self) {
        let cache = Cache::in_folder(self.path(""));
        let silent = CacheObserver { warn: &|_| (), progress: &|_| () };
        let path = self.folder.path().join("land.tif");
        let filed = ReadOptions { memory: 1, cache: cache.clone(), ..Default::default() };
        let surface = Arc::new(Surface::new(geo::read(&path, &filed).expect("a DEM")));
        match cache.prepare(&surface, &|_| (), &|_| ()) {
            Ok(_) => {}
            // Samples that are all void under a hash that is right: refused, as such a file is.
            Err(error @ Error::Input { .. }) if error.to_string().contains("samples are void") => return,
            Err(error) => panic!("samples: {error}"),
        }
        let held = geo::read(&path, &ReadOptions::default()).expect("a DEM");
        let of = [FlowLines::Drainage(ChannelArea::Auto), FlowLines::Ridges];
        let stops = cache.creases(&held, 1.0, &of, silent).expect("creases").concat();
        let surface = Arc::new(Surface::new(held));
        let rules = SlopeRules { min_slope: 3.0, max_turn: 60.0 };
        let slopes = Slopes::new(surface.clone(), 1.0, rules, &stops, None).expect("slopes");
        let slopes = slopes.kept_in(&cache, surface.dem()).expect("a cache");
        drop(slopes.blocks(&|_: [DVec3; 2]| 60.0).expect("blocks"));
        let [west, south, ..] = surface.dem().extent();
        let eye = DVec3::new(west, south, 400.0) + DVec2::splat(300.0).extend(0.0);
        let camera = Camera { eye, azimuth: 30.0, altitude: -10.0, fov: 60.0, width: 64, height: 48 };
        let level = Level::new(1).expect("a level");
        drop(cache.truth(&Terrain::new(&surface), &camera, level, &|_| ()));
        drop(cache.content(7, "land", &|_| (), || Ok(vec![path.clone()])));
    }
}
