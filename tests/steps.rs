//! Files of whole metres: the smoothest surface within half a step is drawn, flat water stays flat, and samples that stay in
//! their files are those that are held.

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::slice;
use std::sync::Arc;

use gdal::DriverManager;
use gdal::raster::{Buffer, GdalType, RasterCreationOptions};
use gdal::spatial_ref::SpatialRef;
use glam::DVec3;
use hachure::cache::Cache;
use hachure::dem::Dem;
use hachure::door::geo::Reading;
use hachure::error::Error;
use hachure::geo::{Info, ReadOptions, ReadStage, info, read, read_all};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use tempfile::TempDir;
use xxhash_rust::xxh3::xxh3_64;

use crate::common::{gpu, words};
use crate::frames::Planned;
use crate::scenes::look;

/// Less memory than any tile: samples stay in their file.
const FILED: u64 = 1 << 11;
/// Less than the largest DEM here needs, and enough for its tiles.
const TILES: u64 = 12 << 20;
const UTM: u32 = 32632;
/// What says that a sample has no elevation.
const VOID: f64 = -9999.0;
const LAKE: f64 = 231.0;

/// Gentle hills in metres, 10 m apart, that no step divides; a lake and voids among them.
fn land(c: usize, r: usize) -> f64 {
    let (x, y) = (c as f64 * 10.0, r as f64 * 10.0);
    let hills = 260.0 + 0.02 * y + 9.0 * (x / 260.0).sin() * (y / 310.0).cos() + 4.0 * (x / 97.0).cos();
    let from_lake = (c as f64 - 150.0).hypot(r as f64 - 90.0) - 30.0;
    let shore = LAKE + from_lake.max(0.0) * 2.5;
    let is_void = (40..55).contains(&c) && (150..170).contains(&r) || (c * 7919 + r * 104_729).is_multiple_of(3001);
    if is_void { VOID } else { hills.min(shore).max(LAKE) }
}

/// `land` in numbers that are multiples of a step.
fn stepped(step: f64) -> impl Fn(usize, usize) -> f64 {
    move |c, r| match land(c, r) {
        VOID => VOID,
        height => (height / step).round() * step,
    }
}

fn folder() -> TempDir {
    // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
    let _ = read(Path::new(""), &ReadOptions::default());
    tempfile::tempdir().expect("a folder")
}

/// Where a raster lies, and in which system.
#[derive(Clone, Copy)]
struct Place {
    epsg: u32,
    transform: [f64; 6],
}

/// Cells of 10 m, so many columns and rows from the first.
fn metres(column: f64, row: f64) -> Place {
    Place { epsg: UTM, transform: [5e5 + column * 10.0, 10.0, 0.0, 5e6 - row * 10.0, 0.0, -10.0] }
}

fn written<T: GdalType + Copy>(
    path: PathBuf,
    [width, height]: [usize; 2],
    place: Place,
    numbers: impl Fn(usize, usize) -> T,
) -> PathBuf {
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    let tiled = RasterCreationOptions::from_iter(["TILED=YES"]);
    let mut file = driver.create_with_band_type_with_options::<T, _>(&path, width, height, 1, &tiled).expect("a file");
    file.set_geo_transform(&place.transform).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(place.epsg).expect("a system")).expect("a system");
    let mut band = file.rasterband(1).expect("a band");
    band.set_no_data_value(Some(VOID)).expect("a number");
    let numbers = (0..width * height).map(|i| numbers(i % width, i / width)).collect();
    band.write((0, 0), (width, height), &mut Buffer::new((width, height), numbers)).expect("samples");
    file.close().expect("a file");
    path
}

/// `land` in whole metres.
fn whole_metres(folder: &TempDir, size: [usize; 2]) -> PathBuf {
    written(folder.path().join("whole.tif"), size, metres(0.0, 0.0), |c, r| stepped(1.0)(c, r) as i16)
}

fn options(memory: u64) -> ReadOptions {
    ReadOptions { memory, ..Default::default() }
}

/// The same files held, and filed within `memory`.
fn both(paths: &[PathBuf], options: &ReadOptions, memory: u64) -> [Dem; 2] {
    let dems = [1 << 30, memory]
        .map(|memory| read_all(paths, &ReadOptions { memory, ..options.clone() }, &|_, _| ()).expect("a DEM"));
    assert_eq!([dems[0].is_filed(), dems[1].is_filed()], [false, true]);
    dems
}

/// Bits of all heights, those of no number at voids.
fn bits(dem: &Dem) -> Vec<u32> {
    let samples = dem.window([0, 0], [dem.columns(), dem.rows()]).expect("samples");
    (0..dem.rows())
        .flat_map(|r| samples.row_from(0, r).map(|height| height.unwrap_or(f32::NAN).to_bits()).collect::<Vec<_>>())
        .collect()
}

/// The first sample that is farther than `half` from `numbers`, or void where they are not.
fn beyond(dem: &Dem, half: impl Fn(usize, usize) -> f64, numbers: impl Fn(usize, usize) -> f64) -> Option<String> {
    let places = (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| (c, r)));
    let is_beyond = |(c, r): &(usize, usize)| match (dem.height(*c, *r), numbers(*c, *r)) {
        (None, VOID) => false,
        (None, _) | (_, VOID) => true,
        (Some(height), number) => (f64::from(height) - f64::from(number as f32)).abs() > half(*c, *r),
    };
    places.into_iter().find(is_beyond).map(|(c, r)| format!("{c}, {r}: {:?}, not {}", dem.height(c, r), numbers(c, r)))
}

/// Mean of the squared second differences along rows, square metres.
fn bending(dem: &Dem) -> f64 {
    let of = |c: usize, r: usize| {
        let [west, middle, east] = [c - 1, c, c + 1].map(|c| dem.height(c, r));
        west.zip(middle).zip(east).map(|((west, middle), east)| f64::from(west - 2.0 * middle + east).powi(2))
    };
    let all: Vec<_> = (0..dem.rows()).flat_map(|r| (1..dem.columns() - 1).filter_map(move |c| of(c, r))).collect();
    all.iter().sum::<f64>() / all.len() as f64
}

#[test]
fn stairs_are_smoothed_within_half_a_step_and_water_stays_flat() {
    let dir = folder();
    let path = whole_metres(&dir, [256, 256]);
    let dem = read(&path, &ReadOptions::default()).expect("a DEM");
    assert_eq!(beyond(&dem, |_, _| 0.5, stepped(1.0)), None);
    let is_lake = |c: usize, r: usize| stepped(1.0)(c, r) == LAKE;
    let lake = (0..256 * 256).filter(|i| is_lake(i % 256, i / 256)).count();
    assert!(lake > 2000, "{lake}");
    assert_eq!(beyond(&dem, |c, r| if is_lake(c, r) { 0.0 } else { 0.5 }, stepped(1.0)), None, "flat water");
    assert!(beyond(&dem, |_, _| 0.0, stepped(1.0)).is_some(), "nothing was smoothed");
    let told = "heights are multiples of 1 m: drawn is the smoothest surface within 0.5 m of them \
                (as they are: --keep-steps)";
    assert_eq!(words(dem.history().converted()), [told]);
    assert_eq!(dem.history().steps(), [1.0]);

    let kept = read(&path, &ReadOptions { keep_steps: true, ..Default::default() }).expect("a DEM");
    assert_eq!(beyond(&kept, |_, _| 0.0, stepped(1.0)), None, "as the file has them");
    assert!(kept.history().converted().is_empty() && kept.history().steps().is_empty());
    let float = written(dir.path().join("float.tif"), [256, 256], metres(0.0, 0.0), |c, r| land(c, r) as f32);
    let float = read(float, &ReadOptions::default()).expect("a DEM");
    assert_eq!(beyond(&float, |_, _| 0.0, land), None, "no step, nothing smoothed");
    let [stairs, smooth, true_land] = [&kept, &dem, &float].map(bending);
    assert!(smooth < 0.2 * stairs && smooth > 0.5 * true_land, "{stairs} to {smooth}, truly {true_land}");
}

#[test]
fn samples_that_stay_in_their_files_are_the_held_ones() {
    let dir = folder();
    // Several tiles with their halos.
    let path = whole_metres(&dir, [1090, 1080]);
    let [held, filed] = both(slice::from_ref(&path), &ReadOptions { exaggeration: 1.5, ..Default::default() }, TILES);
    assert!(bits(&held) == bits(&filed), "other heights");
    assert_eq!(words(held.history().converted()), words(filed.history().converted()));
    assert_eq!((held.range(), held.voids(), held.patches()), (filed.range(), filed.voids(), filed.patches()));
    let stamp = |options: ReadOptions| read(&path, &options).expect("a DEM").stamp();
    let kept = stamp(ReadOptions { keep_steps: true, ..options(FILED) });
    assert!(kept.is_some() && filed.stamp() != kept, "what is kept of stairs is not of the smooth surface");

    let surfaces = [held, filed].map(|dem| Arc::new(Surface::new(dem)));
    let [west, south, east, north] = surfaces[0].dem().extent();
    let eye = DVec3::new((west + east) / 2.0, south + 300.0, 480.0);
    let camera = look(eye, DVec3::new(west + 0.4 * (east - west), north, 380.0), 60.0, [640, 360]);
    let plan = Plan::new(Detail::Adaptive { error_px: 1.0 }, Method::Walk, Border::On);
    let pages = surfaces.each_ref().map(|surface| Planned::new(gpu(), surface, plan).bytes(&camera));
    assert!(pages[0] == pages[1], "another picture");
    let stairs = read(&path, &ReadOptions { keep_steps: true, exaggeration: 1.5, ..Default::default() });
    let stairs = Arc::new(Surface::new(stairs.expect("a DEM")));
    assert!(Planned::new(gpu(), &stairs, plan).bytes(&camera) != pages[0], "stairs draw the same");
}

#[test]
fn what_is_found_and_smoothed_is_kept() {
    let dir = folder();
    let cache = Cache::in_folder(dir.path().join("cache"));
    // Which work was done, and the heights.
    let read = |path: &Path, memory: u64| {
        let stages = Cell::new((false, false));
        let options = ReadOptions { cache: cache.clone(), ..options(memory) };
        let heard = |stage, _| {
            let (look, smooth) = stages.get();
            stages.set((look || stage == ReadStage::Look, smooth || stage == ReadStage::Smooth));
        };
        let dem = read_all(&[path.to_owned()], &options, &heard).expect("a DEM");
        (stages.get(), bits(&dem))
    };
    let kept = |kind: &str| -> Vec<PathBuf> {
        let Ok(files) = fs::read_dir(dir.path().join("cache")) else { return Vec::new() };
        let files = files.map(|file| file.expect("a file").path());
        files.filter(|file| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind))).collect()
    };
    let float = written(dir.path().join("float.tif"), [256, 256], metres(0.0, 0.0), |c, r| land(c, r) as f32);
    assert_eq!(read(&float, FILED).0, (false, false), "a look for nothing");
    assert!(kept("").is_empty());

    let path = whole_metres(&dir, [256, 256]);
    let (done, first) = read(&path, FILED);
    assert!(done == (true, true) && first == read(&path, 1 << 30).1);
    let files = ["steps-", "smooth-"].map(|kind| kept(kind).pop().expect("a file"));
    let whole = files.each_ref().map(|file| fs::read(file).expect("a file"));
    assert!(read(&path, FILED) == ((false, false), first.clone()), "a second look, or other heights");
    // A byte of the steps; of the hashes of smooth tiles; of a tile, which shows when it is read.
    let hashes = 256 * 256 * 4 + 3;
    for (k, byte, expected) in [(0, 40, (true, false)), (1, hashes, (false, true)), (1, 5001, (false, false))] {
        let mut damaged = whole[k].clone();
        damaged[byte] ^= 1;
        fs::write(&files[k], damaged).expect("a file");
        assert!(read(&path, FILED) == (expected, first.clone()), "damage goes unnoticed");
        assert!((fs::read(&files[k]).expect("a file") == whole[k]) == (expected != (false, false)));
    }
    // What is kept is what is read: other heights that prove themselves are taken.
    let (mut other, tile) = (whole[1].clone(), 256 * 256 * 4);
    other[..4].copy_from_slice(&777.0_f32.to_le_bytes());
    let hash = xxh3_64(&other[..tile]).to_le_bytes();
    other[tile..tile + 8].copy_from_slice(&hash);
    // What was found, and its length.
    let end = tile + 8 + other[tile + 8..].iter().position(|byte| *byte == b'}').expect("words") + 1 + 8;
    let hash = xxh3_64(&other[tile..end]).to_le_bytes();
    other[end..end + 8].copy_from_slice(&hash);
    fs::write(&files[1], other).expect("a file");
    assert_eq!(read(&path, FILED).1[0], 777.0_f32.to_bits(), "what is kept is not read");
    let mut kinds: Vec<_> = cache.list().iter().map(|file| file.kind).collect();
    kinds.sort_unstable();
    assert_eq!((kinds, cache.clear().files), (vec!["smooth", "steps"], 2), "a cache must know its own files");
}

#[test]
fn what_is_assumed_of_numbers_is_kept_with_smooth_heights() {
    let dir = folder();
    let cache = Cache::in_folder(dir.path().join("cache"));
    // A corner of a mark that the file does not declare.
    let numbers = |c, r| if c < 5 && r < 4 { -9998 } else { stepped(1.0)(c, r) as i16 };
    let path = written(dir.path().join("marks.tif"), [256, 256], metres(0.0, 0.0), numbers);
    let survey = || {
        let dem = read(&path, &ReadOptions { cache: cache.clone(), ..options(FILED) }).expect("a DEM");
        let survey = dem.survey(&|_| ()).expect("a survey").clone();
        assert!(!dem.history().steps().is_empty());
        (words(&survey.assumed), survey.marks, dem.samples_read())
    };
    let (first, second) = (survey(), survey());
    assert!(first.0.concat().contains("-9998"), "{first:?}");
    assert_eq!(first, second, "heights that are kept say nothing of the numbers");
}

#[test]
fn heights_that_a_cache_has_no_room_for_are_not_kept() {
    let dir = folder();
    let path = whole_metres(&dir, [256, 256]);
    let within = |size: u64| {
        let cache = Cache::in_folder(dir.path().join(size.to_string())).with_size(size);
        let dem = read(&path, &ReadOptions { cache: cache.clone(), ..options(FILED) }).expect("a DEM");
        let kinds: Vec<_> = cache.list().iter().map(|file| file.kind).collect();
        (bits(&dem), kinds.contains(&"smooth"), words(dem.history().converted()))
    };
    let [small, large] = [4 * 256 * 256 - 1, 1 << 30].map(within);
    assert!(small.0 == large.0 && [small.1, large.1] == [false, true]);
    let told = "smoothed heights are worked out anew in each run: they take 1 MiB, more than --cache-size allows";
    assert_eq!(small.2.strip_prefix(large.2.as_slice()), Some(&[told.to_owned()][..]));
}

#[test]
fn a_look_at_numbers_smooths_none_that_stay_in_their_files() {
    let dir = folder();
    let path = whole_metres(&dir, [256, 256]);
    let ranges = [ReadOptions { keep_steps: true, ..Default::default() }, ReadOptions::default()]
        .map(|options| read(&path, &options).expect("a DEM").range());
    assert_ne!(ranges[0], ranges[1], "smoothing shows");
    let told = |memory| info(slice::from_ref(&path), &options(memory), &|_, _| ()).expect("figures");
    let [held, filed] = [1 << 30, FILED].map(told);
    assert_eq!([Some(filed.range), Some(held.range)], ranges);
    assert_eq!(filed.history, held.history, "how it is drawn is told all the same");
    let says = |info: &Info| info.to_string().contains("m, before they are smoothed\n");
    assert_eq!([says(&filed), says(&held)], [true, false]);
    let refused = Reading::new(slice::from_ref(&path), &options(FILED)).map(|reading| reading.check_held());
    assert!(matches!(refused, Ok(Err(Error::Limit { .. }))), "held without a look at a sample");
}

#[test]
fn each_file_has_its_own_step() {
    let dir = folder();
    let size = [200, 180];
    let right = |c: usize| c + 200;
    let name = |name: &str| dir.path().join(name);
    let paths = [
        written(name("metres.tif"), size, metres(0.0, 0.0), |c, r| stepped(1.0)(c, r) as i16),
        written(name("fives.tif"), size, metres(200.0, 0.0), |c, r| stepped(5.0)(right(c), r) as f32),
        written(name("float.tif"), size, metres(0.0, 180.0), |c, r| land(c, r + 180) as f32),
    ];
    let step = |c: usize, r: usize| {
        if r >= 180 {
            0.0
        } else if c < 200 {
            1.0
        } else {
            5.0
        }
    };
    let numbers = |c: usize, r: usize| match step(c, r) {
        0.0 if c >= 200 => VOID,
        0.0 => land(c, r),
        step => stepped(step)(c, r),
    };
    let [held, filed] = both(&paths, &ReadOptions::default(), FILED);
    assert_eq!(beyond(&held, |c, r| step(c, r) / 2.0, numbers), None);
    assert!(beyond(&held, |c, r| step(c, r) / 5.0, numbers).is_some(), "nothing was smoothed");
    assert!(bits(&held) == bits(&filed));
    assert_eq!((held.history().steps(), filed.history().steps()), (&[1.0, 5.0, 0.0][..], &[1.0, 5.0, 0.0][..]));
    let told = words(held.history().converted()).concat();
    assert!(told.contains("heights of 2 of 3 files are multiples of 1 or 5 m"), "{told}");
}

#[test]
fn steps_are_smoothed_before_a_warp() {
    let dir = folder();
    let size = [160, 160];
    let name = |name: &str| dir.path().join(name);
    let degrees = Place { epsg: 4326, transform: [9.0, 1e-4, 0.0, 45.0, 0.0, -1e-4] };
    let numbers = |c, r| stepped(1.0)(c, r) as i16;
    let smooth = read(written(name("map.tif"), size, metres(0.0, 0.0), numbers), &ReadOptions::default());
    let smooth = smooth.expect("a DEM");
    let number = |c, r| smooth.height(c, r).unwrap_or(VOID as f32);
    let expected = read(written(name("smooth.tif"), size, degrees, number), &ReadOptions::default()).expect("a DEM");
    let stairs = written(name("stairs.tif"), size, degrees, numbers);
    let warped = read(&stairs, &ReadOptions::default()).expect("a DEM");
    assert!(expected.columns() > 100 && bits(&warped) == bits(&expected), "not the smooth surface warped");
    let kept = read(&stairs, &ReadOptions { keep_steps: true, ..Default::default() }).expect("a DEM");
    assert!(bits(&kept) != bits(&expected), "stairs warped are the same");
}

#[test]
fn generalised_heights_are_the_same_from_files_and_from_memory() {
    let dir = folder();
    let rough = |c: usize, r: usize| (land(c, r) + 3.0 * f64::from((c * 31 + r * 17) as u32 % 7)) as f32;
    let path = written(dir.path().join("rough.tif"), [600, 500], metres(0.0, 0.0), |c, r| match land(c, r) {
        VOID => VOID as f32,
        _ => rough(c, r),
    });
    let smoothed = |metres| ReadOptions { generalise: Some(metres), exaggeration: 2.0, ..Default::default() };
    let [held, filed] = both(slice::from_ref(&path), &smoothed(40.0), 3 << 20);
    assert!(bits(&held) == bits(&filed), "other heights");
    assert_eq!(held.voids(), filed.voids());
    assert_eq!(words(held.history().converted()), ["smoothed at a scale of 40 m (--generalise)"]);
    let plain = read(&path, &ReadOptions { exaggeration: 2.0, ..Default::default() }).expect("a DEM");
    assert!(bending(&held) < 0.5 * bending(&plain), "{} of {}", bending(&held), bending(&plain));
    let stamps = [30.0, 40.0].map(|metres| read(&path, &ReadOptions { memory: FILED, ..smoothed(metres) }));
    let [one, other] = stamps.map(|dem| dem.expect("a DEM").stamp());
    assert!(one.is_some() && one != other && other == filed.stamp());

    for (metres, remedy) in [(24.0, "give 25 to 2560 metres"), (2561.0, "larger cells with resample")] {
        match read(&path, &smoothed(metres)) {
            Err(error @ Error::Setting { .. }) => assert!(error.to_string().contains(remedy), "{error}"),
            other => panic!("{metres} m: {other:?}"),
        }
    }
}
